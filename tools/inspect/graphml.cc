#include "tools/inspect/graphml.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <iterator>
#include <vector>

#include "tools/drawing/floor_plan.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kPixelsPerMetre = 60, kStoreyGap_m = 3;

struct Attribute {
  const char* name;
  const char* type;
};
constexpr Attribute kNodeAttributes[] = {{"kind", "string"},    {"label", "string"},   {"guid", "string"},
                                         {"storey", "string"},  {"x_m", "double"},     {"y_m", "double"},
                                         {"area_m2", "double"}, {"width_m", "double"}, {"length_m", "double"}};

struct Look {
  const char* kind;
  const char* shape;
  const char* fill;
  double width, height;
};
constexpr Look kRoom = {"room", "roundrectangle", "#f2e8c9", 120, 40}, kDoorway = {"doorway", "diamond", "#a8cfe0", 30, 30},
               kSurface = {"surface", "ellipse", "#b9bec4", 16, 16}, kOutside = {"outside", "roundrectangle", "#cfe3c4", 120, 40};

class Writer {
 public:
  explicit Writer(const AGraph& graph) : graph_(graph), write_(out_) { PlaceStoreys(); }

  std::string Run() {
    Head();
    Rooms();
    Doorways();
    Surfaces();
    Edges();
    out_ += "  </graph>\n</graphml>\n";
    return std::move(out_);
  }

 private:
  // The lowest storey at the bottom.
  void PlaceStoreys() {
    top_m_.assign(graph_.storeys.size(), 0);
    double at_m = 0;
    for (size_t i = graph_.storeys.size(); i-- > 0;) {
      const Eigen::AlignedBox2d box = BoundsOf(graph_, StoreyId(i));
      if (box.isEmpty()) continue;
      top_m_[i] = at_m + box.max().y();
      at_m += box.sizes().y() + kStoreyGap_m;
    }
  }

  void Head() {
    out_ +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xmlns:y=\"http://www.yworks.com/xml/graphml\" xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns "
        "http://www.yworks.com/xml/schema/graphml/1.1/ygraphml.xsd\">\n";
    for (const Attribute& a : kNodeAttributes) {
      fmt::format_to(write_, "  <key id=\"{0}\" for=\"node\" attr.name=\"{0}\" attr.type=\"{1}\"/>\n", a.name, a.type);
    }
    out_ +=
        "  <key id=\"edge_kind\" for=\"edge\" attr.name=\"kind\" attr.type=\"string\"/>\n"
        "  <key id=\"node_graphics\" for=\"node\" yfiles.type=\"nodegraphics\"/>\n"
        "  <graph id=\"agraph\" edgedefault=\"undirected\">\n";
  }

  void Text(const char* key, const std::string& value) {
    if (!value.empty()) fmt::format_to(write_, "      <data key=\"{}\">{}</data>\n", key, EscapeXml(value));
  }
  void Number(const char* key, double value) {
    fmt::format_to(write_, "      <data key=\"{}\">{:.4f}</data>\n", key, value == 0 ? 0.0 : value);
  }

  void Open(const std::string& id, const Look& look, const std::string& label, const std::string& guid, StoreyId storey,
            const Vector2d& at) {
    fmt::format_to(write_, "    <node id=\"{}\">\n", id);
    Text("kind", look.kind);
    Text("label", label);
    Text("guid", guid);
    if (storey.valid()) Text("storey", graph_.storeys[storey.index()].name);
    Number("x_m", at.x());
    Number("y_m", at.y());
    const double top_m = storey.valid() ? top_m_[storey.index()] : 0;
    const std::string shown = look.shape == kSurface.shape ? "" : EscapeXml(label);
    fmt::format_to(write_,
                   "      <data key=\"node_graphics\"><y:ShapeNode><y:Geometry x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:g}\" height=\"{:g}\"/>"
                   "<y:Fill color=\"{}\" transparent=\"false\"/><y:NodeLabel>{}</y:NodeLabel><y:Shape type=\"{}\"/></y:ShapeNode></data>\n",
                   kPixelsPerMetre * at.x() - 0.5 * look.width, kPixelsPerMetre * (top_m - at.y()) - 0.5 * look.height, look.width,
                   look.height, look.fill, shown, look.shape);
  }
  void Close() { out_ += "    </node>\n"; }

  void Rooms() {
    for (size_t i = 0; i < graph_.rooms.size(); ++i) {
      const Room& r = graph_.rooms[i];
      Open(fmt::format("room:{}", i), kRoom, r.name, r.guid, r.storey, r.center.head<2>());
      Number("area_m2", r.area_m2);
      Close();
    }
  }

  void Doorways() {
    bool leads_outside = false;
    for (size_t i = 0; i < graph_.doorways.size(); ++i) {
      const Doorway& d = graph_.doorways[i];
      leads_outside = leads_outside || !d.room_a.valid() || !d.room_b.valid();
      Open(fmt::format("doorway:{}", i), kDoorway, d.name, d.guid, d.storey, d.position.head<2>());
      Number("width_m", d.width_m);
      Close();
    }
    if (!leads_outside) return;
    const Eigen::AlignedBox2d box = graph_.storeys.empty() ? Eigen::AlignedBox2d() : BoundsOf(graph_, StoreyId(0));
    const Vector2d beside = box.isEmpty() ? Vector2d(0, 0) : Vector2d(box.min().x() - kStoreyGap_m, box.center().y());
    Open("outside", kOutside, "outside", "", graph_.storeys.empty() ? StoreyId() : StoreyId(0), beside);
    Close();
  }

  void Surfaces() {
    for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
      const Surface& s = graph_.surfaces[i];
      const Wall& wall = graph_.walls[s.wall.index()];
      Open(fmt::format("surface:{}", i), kSurface, wall.name, wall.guid, s.storey, s.midpoint());
      Number("length_m", s.length_m());
      Close();
    }
  }

  void Edge(const std::string& a, const std::string& b, const char* kind) {
    fmt::format_to(write_, "    <edge id=\"e{}\" source=\"{}\" target=\"{}\"><data key=\"edge_kind\">{}</data></edge>\n", edges_++, a, b,
                   kind);
  }
  static std::string Id(RoomId room) { return room.valid() ? fmt::format("room:{}", room.value) : std::string("outside"); }

  void Edges() {
    for (size_t i = 0; i < graph_.doorways.size(); ++i) {
      for (const RoomId room : {graph_.doorways[i].room_a, graph_.doorways[i].room_b})
        Edge(fmt::format("doorway:{}", i), Id(room), "joins");
    }
    for (const OpenBoundary& b : graph_.open_boundaries) Edge(Id(b.room_a), Id(b.room_b), "open");
    for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
      if (graph_.surfaces[i].room.valid()) Edge(fmt::format("surface:{}", i), Id(graph_.surfaces[i].room), "bounds");
    }
    for (const Factor& f : graph_.factors) {
      if (f.kind != FactorKind::kWallSurfaces || f.variables.size() < 3) continue;
      Edge(fmt::format("surface:{}", f.variables[1]), fmt::format("surface:{}", f.variables[2]), "same wall");
    }
  }

  const AGraph& graph_;
  std::string out_;
  std::back_insert_iterator<std::string> write_;
  std::vector<double> top_m_;  // y of the plan that lies at the top of the storey's part of the drawing
  size_t edges_ = 0;
};

}  // namespace

std::string AGraphToGraphMl(const AGraph& graph) { return Writer(graph).Run(); }

}  // namespace plumb::tools
