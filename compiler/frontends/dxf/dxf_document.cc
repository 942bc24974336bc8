#include "compiler/frontends/dxf/dxf_document.h"

#include <dl_creationadapter.h>
#include <dl_dxf.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <numbers>
#include <streambuf>
#include <string_view>
#include <unordered_map>

#include "compiler/frontends/dxf/dxf_curves.h"
#include "compiler/frontends/dxf/dxf_groups.h"
#include "compiler/frontends/dxf/dxf_text.h"

namespace plumb::compiler {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kInPlane = 0.99;       // of the extrusion's direction along z
constexpr double kLetter = 0.7;         // its width, in the text's height
constexpr double kLine = 1.6;           // from line to line, in the text's height
constexpr double kMaxCoordinate = 1e12;
constexpr size_t kMaxValue = 1000;

// What is asked of each entity before dxflib has it.
struct Header {
  std::string type;
  uint32_t line = 0, handle = 0xffffffffu;
  std::string layer = "0";
  bool paper = false, invisible = false, mirrored = false, tilted = false;
};

// Read, or nothing that a wall is drawn by.
bool IsKnown(std::string_view type) {
  constexpr std::string_view kKnown[] = {"LINE",   "LWPOLYLINE", "POLYLINE", "VERTEX",    "SEQEND", "ARC",       "CIRCLE", "ELLIPSE", "SPLINE",   "INSERT",
                                         "HATCH",  "SOLID",      "TRACE",    "3DFACE",    "TEXT",   "MTEXT",     "ATTRIB", "ATTDEF",  "POINT",    "DIMENSION",
                                         "LEADER", "MULTILEADER", "VIEWPORT", "IMAGE",     "WIPEOUT", "XLINE",   "RAY",    "BLOCK",   "ENDBLK",   "TOLERANCE",
                                         "ARCALIGNEDTEXT", "OLE2FRAME", "OLEFRAME", "SHAPE", "ACAD_TABLE"};
  return std::find(std::begin(kKnown), std::end(kKnown), type) != std::end(kKnown);
}

class Builder : public DL_CreationAdapter {
 public:
  Builder(const DxfReadOptions& options, DxfDocument& out) : options_(options), out_(out) {}

  void Begin(Header header) { header_ = std::move(header); }
  [[nodiscard]] bool full() const { return points_ > options_.max_points; }
  [[nodiscard]] size_t bad() const { return bad_; }
  [[nodiscard]] const Header& first_bad() const { return first_bad_; }

  void addLayer(const DL_LayerData& data) override {
    DxfLayer& layer = out_.layers[LayerOf(DecodeDxfText(data.name))];
    layer.hidden = data.off || (data.flags & 1) != 0 || getAttributes().getColor() < 0;
  }
  void addBlock(const DL_BlockData& data) override {
    const std::string name = DecodeDxfText(data.name);
    in_paper_ = IsPaper(name);
    block_ = &out_.blocks[name];
    *block_ = {};
    block_->base = {data.bpx, data.bpy};
  }
  void endBlock() override {
    block_ = nullptr;
    in_paper_ = false;
  }
  void addLine(const DL_LineData& d) override { AddPath({{{d.x1, d.y1}, {d.x2, d.y2}}, false, false, false, {}}, false); }
  void addArc(const DL_ArcData& d) override { AddArc({{d.cx, d.cy}, d.radius, d.angle1 * kDegree, Turn((d.angle2 - d.angle1) * kDegree)}); }
  void addCircle(const DL_CircleData& d) override { AddArc({{d.cx, d.cy}, d.radius, 0, 2 * std::numbers::pi}); }
  void addEllipse(const DL_EllipseData& d) override {
    DxfPath path;
    path.curved = true;
    const double sign = header_.mirrored ? -1 : 1;
    AppendEllipse({{d.cx, d.cy}, {d.mx, d.my}, sign * d.ratio, d.angle1, Turn(d.angle2 - d.angle1)}, options_.chord_share, path.points);
    AddPath(std::move(path), false);
  }
  void addPolyline(const DL_PolylineData& d) override {
    Finish();
    constexpr int kMeshes = 16 | 64;
    polyline_open_ = (d.flags & kMeshes) == 0;
    polyline_closed_ = (d.flags & 1) != 0;
    polyline_header_ = header_;
    if (!polyline_open_) ++out_.not_read["POLYLINE (mesh)"];
  }
  void addVertex(const DL_VertexData& d) override {
    if (polyline_open_) vertices_.emplace_back(d.x, d.y, d.bulge);
    points_ += 1;
  }
  void endSequence() override { Finish(); }
  void addSpline(const DL_SplineData& d) override {
    Finish();
    spline_ = {};
    spline_.degree = d.degree;
    spline_.closed = (d.flags & 1) != 0;
    spline_open_ = true;
    polyline_header_ = header_;
  }
  void addControlPoint(const DL_ControlPointData& d) override {
    spline_.control.emplace_back(d.x, d.y);
    spline_.weights.push_back(d.w);
    points_ += 1;
  }
  void addFitPoint(const DL_FitPointData& d) override { spline_.fit.emplace_back(d.x, d.y); }
  void addKnot(const DL_KnotData& d) override { spline_.knots.push_back(d.k); }
  void addInsert(const DL_InsertData& d) override {
    DxfInsert insert{DecodeDxfText(d.name), {d.ipx, d.ipy}, {d.sx, d.sy}, {d.colSp, d.rowSp}, d.angle * kDegree, d.cols, d.rows};
    const bool finite = insert.at.allFinite() && insert.scale.allFinite() && insert.spacing.allFinite() && std::isfinite(insert.angle_rad);
    if (!finite) return CountBad();
    if (DxfEntity* e = NewEntity()) e->insert = std::move(insert);
  }
  void addTrace(const DL_TraceData& d) override { AddQuad(d, true); }
  void addSolid(const DL_SolidData& d) override { AddQuad(d, true); }
  void add3dFace(const DL_3dFaceData& d) override { AddPath({{{d.x[0], d.y[0]}, {d.x[1], d.y[1]}, {d.x[2], d.y[2]}, {d.x[3], d.y[3]}}, true, false, false, {}}, false); }
  void addText(const DL_TextData& d) override { AddText(d); }
  void addAttribute(const DL_AttributeData& d) override { AddText(d); }
  void addMTextChunk(const std::string& text) override { mtext_ += text; }
  void addMText(const DL_MTextData& d) override {
    const std::vector<std::string> lines = PlainLines(mtext_ + d.text);
    const bool underlined = (mtext_ + d.text).find("\\L") != std::string::npos;
    mtext_.clear();
    DxfEntity* e = NewEntity();
    if (e == nullptr) return;
    const int column = (d.attachmentPoint - 1) % 3, row = (d.attachmentPoint - 1) / 3;
    const double count = static_cast<double>(lines.size());
    for (size_t i = 0; i < lines.size(); ++i) {
      const double width = kLetter * d.height * static_cast<double>(lines[i].size());
      const double down = kLine * d.height * (static_cast<double>(i) + 0.5 - (row == 1 ? 0.5 * count : row == 2 ? count : 0.0));
      AppendText(lines[i], {d.ipx, d.ipy}, {width * (column == 0 ? 0.5 : column == 2 ? -0.5 : 0.0), -down}, d.angle, d.height, *e);
      e->texts.back().underlined = underlined;
    }
  }
  void addHatch(const DL_HatchData&) override { Finish(), hatch_open_ = true, polyline_header_ = header_; }
  void addHatchLoop(const DL_HatchLoopData&) override { loops_.emplace_back(); }
  void addHatchEdge(const DL_HatchEdgeData& d) override;
  void endEntity() override { Finish(); }
  void setVariableInt(const std::string& key, int value, int) override {
    if (key == "$INSUNITS") out_.insunits = value;
    if (key == "$MEASUREMENT") out_.measurement = value;
  }
  void setVariableString(const std::string& key, const std::string& value, int) override {
    if (key == "$ACADVER") out_.version = value;
  }

  // What comes in several calls is complete.
  void Finish();

 private:
  static bool IsPaper(std::string_view block) {
    return block.starts_with("*Paper_Space") || block.starts_with("*PAPER_SPACE") || block.starts_with("$PAPER_SPACE");
  }
  static double Turn(double angle) {  // into (0, 2 pi]
    const double out = std::fmod(angle, 2 * std::numbers::pi);
    return out <= 1e-12 ? out + 2 * std::numbers::pi : out;
  }

  uint32_t LayerOf(const std::string& name) {
    const auto [at, added] = layer_ids_.emplace(name, static_cast<uint32_t>(out_.layers.size()));
    if (added) out_.layers.push_back({name, false});
    return at->second;
  }

  void CountBad() {
    if (bad_++ == 0) first_bad_ = header_;
  }

  static const char* TypeName(const std::string& type) {
    static std::map<std::string, std::string> names;
    return names.emplace(type, type).first->second.c_str();
  }

  DxfEntity* NewEntity() {
    if (header_.paper || in_paper_ || header_.invisible) return nullptr;
    if (header_.tilted) {
      ++out_.not_read[header_.type + " (not in the plane)"];
      return nullptr;
    }
    std::vector<DxfEntity>& list = block_ != nullptr ? block_->entities : out_.entities;
    DxfEntity& e = list.emplace_back();
    e.layer = LayerOf(header_.layer);
    e.handle = header_.handle;
    e.line = header_.line;
    e.type = TypeName(header_.type);
    e.mirrored = header_.mirrored;
    return &e;
  }

  // Points of arcs, polylines and fills are in the entity's own frame, those of lines in the drawing's.
  void AddPath(DxfPath path, bool own_frame) {
    const auto usable = [](const Eigen::Vector2d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kMaxCoordinate; };
    if (path.points.size() < 2 || !std::all_of(path.points.begin(), path.points.end(), usable)) return CountBad();
    if (own_frame && header_.mirrored) {
      for (auto& p : path.points) p.x() = -p.x();
      for (Arc& a : path.arcs) a.center.x() = -a.center.x(), a.start_rad = std::numbers::pi - a.start_rad, a.sweep_rad = -a.sweep_rad;
    }
    points_ += path.points.size();
    if (DxfEntity* e = NewEntity()) e->paths.push_back(std::move(path));
  }

  void AddArc(const Arc& arc) {
    if (!(arc.radius_m > 0) || !std::isfinite(arc.start_rad + arc.sweep_rad)) return CountBad();
    DxfPath path;
    path.curved = true;
    AppendArc(arc, options_.chord_share, path.points);
    path.closed = arc.sweep_rad >= 2 * std::numbers::pi - 1e-9;
    if (path.closed) path.points.pop_back();
    path.arcs.push_back(arc);
    AddPath(std::move(path), true);
  }

  template <class Quad>
  void AddQuad(const Quad& d, bool filled) {
    DxfPath path{{{d.x[0], d.y[0]}, {d.x[1], d.y[1]}, {d.x[3], d.y[3]}, {d.x[2], d.y[2]}}, true, filled, false, {}};
    AddPath(std::move(path), true);
  }

  void AddText(const DL_TextData& d) {
    const std::string text = PlainText(d.text);
    DxfEntity* e = text.empty() ? nullptr : NewEntity();
    if (e == nullptr) return;
    const bool aligned = d.hJustification != 0 || d.vJustification != 0;
    const double width = kLetter * d.height * static_cast<double>(text.size());
    const double x = d.hJustification == 1 || d.hJustification == 4 ? 0 : d.hJustification == 2 ? -0.5 * width : 0.5 * width;
    const double y = d.vJustification == 3 ? -0.5 * d.height : d.vJustification == 2 || d.hJustification == 4 ? 0 : 0.5 * d.height;
    AppendText(text, aligned ? Eigen::Vector2d(d.apx, d.apy) : Eigen::Vector2d(d.ipx, d.ipy), {x, y}, d.angle, d.height, *e);
    e->texts.back().underlined = d.text.find("%%u") != std::string::npos || d.text.find("%%U") != std::string::npos;
    if (header_.mirrored) e->texts.back().at.x() = -e->texts.back().at.x();
  }

  // dxflib gives angles of texts in radians.
  static void AppendText(const std::string& text, const Eigen::Vector2d& at, const Eigen::Vector2d& offset, double angle_rad, double height, DxfEntity& e) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    e.texts.push_back({text, at + Eigen::Vector2d(c * offset.x() - s * offset.y(), s * offset.x() + c * offset.y()), height, false});
  }

  // Straight sides and arcs of a polyline as paths of their own where both occur, so that only steps of curves count as such.
  void AddVertices(std::vector<Eigen::Vector3d> vertices, bool closed, bool filled);

  const DxfReadOptions& options_;
  DxfDocument& out_;
  Header header_, polyline_header_, first_bad_;
  DxfBlock* block_ = nullptr;
  bool in_paper_ = false, polyline_open_ = false, polyline_closed_ = false, spline_open_ = false, hatch_open_ = false;
  std::vector<Eigen::Vector3d> vertices_;  // x, y, bulge
  SplineCurve spline_;
  std::vector<DxfPath> loops_;
  std::string mtext_;
  std::unordered_map<std::string, uint32_t> layer_ids_;
  size_t points_ = 0, bad_ = 0;
};

void Builder::AddVertices(std::vector<Eigen::Vector3d> v, bool closed, bool filled) {
  const bool bulged = std::any_of(v.begin(), v.end(), [](const auto& p) { return std::abs(p.z()) > 1e-9; });
  DxfPath whole;
  whole.closed = closed;
  whole.filled = filled;
  if (!bulged) {
    for (const auto& p : v) whole.points.emplace_back(p.head<2>());
    return AddPath(std::move(whole), true);
  }
  DxfPath straight;
  const size_t sides = closed ? v.size() : v.size() - 1;
  const auto flush = [&] {
    if (straight.points.size() > 1 && !filled) AddPath(straight, true);
    straight.points.clear();
  };
  for (size_t i = 0; i < sides; ++i) {
    const Eigen::Vector2d a = v[i].head<2>(), b = v[(i + 1) % v.size()].head<2>();
    if (std::abs(v[i].z()) <= 1e-9 || a == b) {
      if (straight.points.empty()) straight.points.push_back(a);
      straight.points.push_back(b);
      whole.points.push_back(a);
      continue;
    }
    flush();
    DxfPath curve;
    curve.curved = true;
    curve.arcs.push_back(ArcOfBulge(a, b, v[i].z()));
    AppendArc(curve.arcs.back(), options_.chord_share, curve.points);
    curve.points.front() = a;
    curve.points.back() = b;
    whole.points.insert(whole.points.end(), curve.points.begin(), curve.points.end() - 1);
    if (!filled) AddPath(std::move(curve), true);
  }
  flush();
  whole.curved = true;
  if (filled) AddPath(std::move(whole), true);
}

void Builder::addHatchEdge(const DL_HatchEdgeData& d) {
  if (loops_.empty()) return;
  DxfPath& loop = loops_.back();
  points_ += 1;
  if (!d.vertices.empty()) {
    std::vector<Eigen::Vector3d> v;
    for (const auto& p : d.vertices) {
      if (p.size() >= 2) v.emplace_back(p[0], p[1], p.size() > 2 ? p[2] : 0.0);
    }
    for (size_t i = 0; i < v.size(); ++i) {
      const Eigen::Vector2d a = v[i].head<2>(), b = v[(i + 1) % v.size()].head<2>();
      if (std::abs(v[i].z()) > 1e-9 && a != b) AppendArc(ArcOfBulge(a, b, v[i].z()), options_.chord_share, loop.points), loop.points.pop_back();
      else loop.points.push_back(a);
    }
    return;
  }
  const double sign = d.ccw ? 1 : -1;
  switch (d.type) {
    case 1: loop.points.emplace_back(d.x1, d.y1); break;
    case 2: AppendArc({{d.cx, d.cy}, d.radius, sign * d.angle1, sign * Turn(d.angle2 - d.angle1)}, options_.chord_share, loop.points); break;
    case 3:
      AppendEllipse({{d.cx, d.cy}, {d.mx, d.my}, d.ratio, sign * d.angle1, sign * Turn(d.angle2 - d.angle1)}, options_.chord_share, loop.points);
      break;
    case 4:
      for (const auto& p : d.controlPoints) {
        if (p.size() >= 2) loop.points.emplace_back(p[0], p[1]);
      }
      break;
    default: break;
  }
}

void Builder::Finish() {
  if (!polyline_open_ && !spline_open_ && !hatch_open_) return;
  const Header now = std::exchange(header_, polyline_header_);
  if (std::exchange(polyline_open_, false) && vertices_.size() > 1) AddVertices(std::move(vertices_), polyline_closed_, false);
  vertices_.clear();
  if (std::exchange(spline_open_, false)) {
    DxfPath path;
    path.curved = true;
    path.points = SplinePoints(spline_);
    path.closed = spline_.closed;
    AddPath(std::move(path), false);
    spline_ = {};
  }
  if (std::exchange(hatch_open_, false)) {
    for (DxfPath& loop : loops_) {
      loop.closed = loop.filled = true;
      if (loop.points.size() > 2) AddPath(std::move(loop), true);
    }
    loops_.clear();
  }
  header_ = now;
}

using Groups = std::vector<DxfGroup>;

int ToInt(const std::string& text) {
  int out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

double ToReal(const std::string& text) {
  double out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

Header HeaderOf(const Groups& groups) {
  Header out;
  out.type = groups[0].value;
  out.line = groups[0].line;
  for (const DxfGroup& g : groups) {
    if (g.code == 100 || g.code == 102) continue;
    if (g.code == 5 && out.handle == 0xffffffffu) {
      uint32_t handle = 0;
      if (std::from_chars(g.value.data(), g.value.data() + g.value.size(), handle, 16).ec == std::errc()) out.handle = handle;
    }
    if (g.code == 8) out.layer = DecodeDxfText(g.value);
    if (g.code == 67) out.paper = ToInt(g.value) == 1;
    if (g.code == 60) out.invisible = ToInt(g.value) == 1;
    if (g.code == 230) out.mirrored = ToReal(g.value) < -kInPlane, out.tilted = std::abs(ToReal(g.value)) < kInPlane;
  }
  return out;
}

// dxflib trusts the counts that a file states and reserves memory for them.
void MendCounts(Groups& groups) {
  const std::string& type = groups[0].value;
  const auto count = [&](int code) { return std::count_if(groups.begin(), groups.end(), [&](const DxfGroup& g) { return g.code == code; }); };
  const auto set = [&](int code, std::ptrdiff_t value) {
    for (DxfGroup& g : groups) {
      if (g.code == code) g.value = std::to_string(value);
    }
  };
  if (type == "LWPOLYLINE") set(90, count(10));
  if (type == "SPLINE") set(72, count(40)), set(73, count(10)), set(74, count(11));
  if (type == "LEADER") set(76, count(10));
}

// Codes that no entity's shape depends on.
bool IsNeeded(int code, const std::string& type) {
  if (code == 62) return type == "LAYER";  // negative: off
  return code < 300 && code != 5 && code != 6 && code != 48 && code != 100 && code != 102;
}

// Lets a stream read a text in place.
class TextBuffer : public std::streambuf {
 public:
  void Set(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

class Feeder {
 public:
  Feeder(const std::string& bytes, const DxfReadOptions& options, DiagnosticSink& sink)
      : groups_(bytes), builder_(options, out_), options_(options), sink_(sink) {}

  std::optional<DxfDocument> Run() {
    DxfGroup group;
    while (!ended_ && groups_.Next(group)) {
      if (group.code == 999) continue;
      if (group.code == 0 && !Hand()) return std::nullopt;
      entity_.push_back(std::move(group));
    }
    if (!groups_.fault().empty()) {
      sink_.Emit(DiagnosticKind::kDxfSyntax, {groups_.line(), 0, {}, {}, 0}, fmt::format("{}; a DXF file is pairs of a group code and a value", groups_.fault()));
      return std::nullopt;
    }
    if (!Hand()) return std::nullopt;
    Feed(0, "EOF");
    builder_.Finish();
    if (!section_.empty() || (!ended_ && !saw_entities_)) {
      sink_.Emit(DiagnosticKind::kDrawingCutOff, {groups_.line(), 0, {}, {}, 0},
                 fmt::format("the file ends {} after {} {}", section_.empty() ? "before its section ENTITIES" : "within its section " + section_, groups_.line(),
                             groups_.binary() ? "groups" : "lines"),
                 "copy or export the file again");
      return std::nullopt;
    }
    if (builder_.bad() > 0) {
      const Header& at = builder_.first_bad();
      sink_.Emit(DiagnosticKind::kBadEntity, {at.line, 0, at.handle != 0xffffffffu ? fmt::format("{:X}", at.handle) : "", at.type, 0},
                 fmt::format("{} entities have numbers that are none, too large, or no extent, and are left out", builder_.bad()));
    }
    return std::move(out_);
  }

 private:
  void Feed(int code, const std::string& value) {
    // At the start of an entity dxflib makes the one before, for which the builder still has the header. It reads a group from a stream
    // only, by lines that it cuts at 1024 bytes.
    text_ = fmt::format("{}\n{}\n", code, std::string_view(value).substr(0, kMaxValue));
    buffer_.Set(text_);
    stream_.clear();
    dxf_.readDxfGroups(stream_, &builder_);
  }

  // Hands what was collected to dxflib, if it says something of the plan. False: too much.
  bool Hand() {
    if (entity_.empty()) return true;
    Groups groups = std::move(entity_);
    entity_.clear();
    const std::string& type = groups[0].value;
    if (type == "EOF") ended_ = true;
    if (section_ == "ENTITIES" && type == "ENDSEC") saw_entities_ = true;
    if (type == "SECTION") section_ = groups.size() > 1 ? groups[1].value : "?";
    const bool wanted = section_ == "HEADER" || section_ == "TABLES" || section_ == "BLOCKS" || section_ == "ENTITIES";
    if (!wanted || (section_ == "TABLES" && type != "LAYER" && type != "SECTION" && type != "ENDSEC") || (section_ == "HEADER" && !FeedHeader(groups))) {
      if (type == "ENDSEC") section_.clear();
      return true;
    }
    if (type == "ENDSEC") section_.clear();
    if ((section_ == "BLOCKS" || section_ == "ENTITIES") && type != "SECTION" && !IsKnown(type)) ++out_.not_read[type];
    MendCounts(groups);
    Feed(0, type);
    builder_.Begin(HeaderOf(groups));
    for (size_t i = 1; i < groups.size(); ++i) {
      if (IsNeeded(groups[i].code, type)) Feed(groups[i].code, groups[i].value);
    }
    if (!builder_.full()) return true;
    sink_.Emit(DiagnosticKind::kPlanTooComplex, {groups[0].line, 0, {}, type, 0}, fmt::format("the drawing has more than {} points", options_.max_points));
    return false;
  }

  // Variables are one entity to us.
  bool FeedHeader(const Groups& groups) {
    if (groups[0].value == "ENDSEC") return true;
    for (size_t i = 1; i + 1 < groups.size(); ++i) {
      const std::string& name = groups[i].value;
      if (groups[i].code != 9) continue;
      if (name == "$INSUNITS") builder_.setVariableInt(name, ToInt(groups[i + 1].value), 70);
      if (name == "$MEASUREMENT") builder_.setVariableInt(name, ToInt(groups[i + 1].value), 70);
      if (name == "$ACADVER") builder_.setVariableString(name, groups[i + 1].value, 1);
    }
    return false;
  }

  DxfGroups groups_;
  DxfDocument out_;
  Builder builder_;
  DL_Dxf dxf_;
  std::string text_;
  TextBuffer buffer_;
  std::istream stream_{&buffer_};
  const DxfReadOptions& options_;
  DiagnosticSink& sink_;
  Groups entity_;
  std::string section_;
  bool ended_ = false, saw_entities_ = false;
};

}  // namespace

std::optional<DxfDocument> ReadDxfDocument(const std::string& bytes, const DxfReadOptions& options, DiagnosticSink& sink) {
  return Feeder(bytes, options, sink).Run();
}

}  // namespace plumb::compiler
