#include "tools/drawing/floor_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "tools/drawing/door_symbol.h"
#include "tools/drawing/plane.h"
#include "tools/drawing/section.h"
#include "tools/drawing/undrawn_walls.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

// A wall by its axis and thickness.
Ring AxisRing(const Wall& w) {
  const Vector2d along = w.axis_end - w.axis_start;
  return RectangleAlong(0.5 * (w.axis_start + w.axis_end), along.normalized(), along.norm(), w.thickness_m);
}

// The cut never lies exactly in a horizontal face: tops of sills and benches are drawn at round heights.
double CutHeight(const AGraph& g, StoreyId storey, const FloorPlanOptions& options) {
  return g.storeys[storey.index()].elevation_m + SectionHeight(g, storey, options) + 0.00037;
}

const char* CutClass(ElementKind kind) {
  switch (kind) {
    case ElementKind::kWall:
    case ElementKind::kColumn: return "cut";
    case ElementKind::kCurtainWall: return "cut-glass";
    case ElementKind::kSlab:
    case ElementKind::kRoof:
    case ElementKind::kBeam:
    case ElementKind::kStair:
    case ElementKind::kProxy: return "cut-light";
    default: return nullptr;
  }
}

// Walls by their triangles; where their solids do not close by axis and thickness.
std::string DrawCut(const AGraph& g, StoreyId storey, const Sheet& sheet, double z_m) {
  std::string light, dark;
  const std::vector<SectionSegment> segments = SegmentsAt(g, z_m);
  const std::vector<ElementSection> sections = ClosedSections(segments);
  for (const ElementSection& section : sections) {
    const char* style = CutClass(g.elements[section.element].kind);
    if (!style) continue;
    std::string data;
    for (const Ring& ring : section.rings) data += sheet.Closed(ring);
    const bool is_dark = std::string_view(style) == "cut";
    fmt::format_to(std::back_inserter(is_dark ? dark : light), "<path class=\"{}\" d=\"{}\"/>\n", style, data);
  }
  for (const Ring& piece : UndrawnWalls(g, storey, z_m, segments, sections))
    fmt::format_to(std::back_inserter(dark), "<path class=\"cut\" d=\"{}\"/>\n", sheet.Closed(piece));
  return light + dark;
}

std::string DrawRoomFloors(const AGraph& g, StoreyId storey, const Sheet& sheet) {
  std::string out;
  for (const Room& room : g.rooms) {
    if (room.storey != storey) continue;
    std::string data = sheet.Closed(room.polygon);
    for (const Ring& hole : room.holes) data += sheet.Closed(hole);
    fmt::format_to(std::back_inserter(out), "<path class=\"floor\" d=\"{}\"/>\n", data);
  }
  return out;
}

std::string DrawWindow(const AGraph& g, const Window& w, const Sheet& sheet, double cut_m) {
  const Vector2d along = Left(Direction(w.yaw_rad)), middle = w.position.head<2>();
  const Ring ring = RectangleAlong(middle, along, w.width_m, w.wall.valid() ? g.walls[w.wall.index()].thickness_m : kUnknownThickness_m);
  const bool is_cut = w.position.z() < cut_m && cut_m < w.position.z() + w.height_m;
  std::string out = fmt::format("<path class=\"{}\" d=\"{}\"/>\n", is_cut ? "window" : "window-above", sheet.Closed(ring));
  const Vector2d half = 0.5 * w.width_m * along;
  if (is_cut) fmt::format_to(std::back_inserter(out), "<path class=\"glass\" d=\"{}\"/>\n", sheet.Line(middle - half, middle + half));
  return out;
}

// Under a cut that goes over its lintel, through the wall.
std::string DrawDoorBelow(const AGraph& g, const Doorway& d, const Sheet& sheet) {
  const double thickness_m = d.wall.valid() ? g.walls[d.wall.index()].thickness_m : kUnknownThickness_m;
  const Ring ring = RectangleAlong(d.position.head<2>(), Left(Direction(d.yaw_rad)), d.width_m, thickness_m);
  return fmt::format("<path class=\"window-above\" d=\"{}\"/>\n", sheet.Closed(ring));
}

}  // namespace

std::string FloorPlanStyle() {
  return R"(.plan{--ink:#1d2329;--paper:#fff;--floor:#f7f6f2;--soft:#8b939b;--light:#c9ccd0;--glass-line:#3f7fa8;font-family:system-ui,"Segoe UI",Roboto,Helvetica,Arial,sans-serif}
.plan .paper{fill:var(--paper)}
.plan .floor{fill:var(--floor)}
.plan .cut{fill:var(--ink);fill-rule:evenodd;stroke:var(--ink);stroke-width:1}
.plan .cut-light{fill:var(--light);fill-rule:evenodd;stroke:var(--soft);stroke-width:1}
.plan .cut-glass{fill:none;stroke:var(--glass-line);stroke-width:2}
.plan .below{fill:none;stroke:var(--soft);stroke-width:1}
.plan .opening{fill:var(--floor)}
.plan .window{fill:var(--paper);stroke:var(--ink);stroke-width:1.6}
.plan .window-above{fill:none;stroke:var(--light);stroke-width:1.2;stroke-dasharray:8 5}
.plan .glass{stroke:var(--glass-line);stroke-width:2.4;fill:none}
.plan .leaf{stroke:var(--ink);stroke-width:3.2;fill:none}
.plan .swing{stroke:var(--soft);stroke-width:1.2;fill:none}
.plan .assumed{stroke-dasharray:10 5;opacity:.6}
.plan .sill{stroke:var(--soft);stroke-width:1;fill:none}
.plan .lintel{stroke:var(--soft);stroke-width:1.2;stroke-dasharray:8 5;fill:none}
.plan text{fill:var(--ink);text-anchor:middle}
.plan .room-name{font-weight:600}.plan .room-name,.plan .room-area{paint-order:stroke;stroke:var(--floor);stroke-width:5;stroke-linejoin:round}
.plan .room-area{fill:var(--soft)}
.plan .scale{stroke:var(--ink);stroke-width:1.2;fill:var(--ink)}.plan .scale.odd{fill:var(--paper)}
.plan .dim{stroke:var(--ink);stroke-width:1;fill:none}.plan .dim-text{paint-order:stroke;stroke:var(--paper);stroke-width:5;stroke-linejoin:round}
.plan .dim-tick{stroke:var(--ink);stroke-width:2.6;fill:none}
)";
}

Ring PointsAlong(const Surface& surface) {
  if (!surface.arc) return {surface.start, surface.end};
  constexpr double kStep_rad = 2 * std::numbers::pi / 180;
  const Arc& arc = *surface.arc;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep_rad) / kStep_rad)));
  Ring points;
  for (int i = 0; i <= steps; ++i) {
    const double angle_rad = arc.start_rad + arc.sweep_rad * i / steps;
    points.push_back(arc.center + arc.radius_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return points;
}

Eigen::AlignedBox2d BoundsOf(const AGraph& graph, StoreyId storey) {
  Eigen::AlignedBox2d box;
  const auto add_ring = [&box](const Ring& ring) {
    for (const Vector2d& p : ring) box.extend(p);
  };
  for (const Wall& w : graph.walls) {
    if (w.storey == storey) add_ring(AxisRing(w));
  }
  for (const Surface& s : graph.surfaces) {
    if (s.storey == storey) add_ring(PointsAlong(s));
  }
  for (const Column& c : graph.columns) {
    if (c.storey == storey) add_ring(c.outline);
  }
  for (const Room& r : graph.rooms) {
    if (r.storey == storey) add_ring(r.polygon);
  }
  return box;
}

Sheet SheetOf(const AGraph& graph, StoreyId storey) {
  const Eigen::AlignedBox2d box = BoundsOf(graph, storey);
  return box.isEmpty() ? Sheet(Vector2d::Zero(), Vector2d::Zero(), 0.8) : Sheet(box.min(), box.max(), 0.8);
}

std::string FloorPlanOptions::Check() const {
  const bool ok = section_height_m > 0 && section_height_m <= 20;
  return ok ? "" : fmt::format("FloorPlanOptions.section_height_m = {}; must be in (0, 20]", section_height_m);
}

double SectionHeight(const AGraph& graph, StoreyId storey, const FloorPlanOptions& options) {
  constexpr double kBelow_m = 0.1;
  const double zero_m = graph.storeys[storey.index()].elevation_m;
  const bool has_rooms = std::any_of(graph.rooms.begin(), graph.rooms.end(), [&](const Room& room) { return room.storey == storey; });
  double highest_m = 0;
  for (const Room& room : graph.rooms) {
    if (room.storey == storey) highest_m = std::max(highest_m, room.ceiling_z_m - zero_m);
  }
  for (const Wall& wall : graph.walls) {
    if (wall.storey == storey && !has_rooms) highest_m = std::max(highest_m, wall.z_max_m - zero_m);
  }
  const bool is_above = highest_m > 0 && options.section_height_m >= highest_m;
  return is_above ? std::max(highest_m - kBelow_m, 0.5 * highest_m) : options.section_height_m;
}

std::string DrawFloorPlan(const AGraph& graph, StoreyId storey, const Sheet& sheet, const FloorPlanOptions& options) {
  const double cut_m = CutHeight(graph, storey, options);
  std::string out = DrawRoomFloors(graph, storey, sheet);
  const double floor_m = graph.storeys[storey.index()].elevation_m;
  std::string edges;
  for (const auto& [a, b] : EdgesSeenFromAbove(graph, floor_m - 0.1, cut_m)) edges += sheet.Line(a, b);
  if (!edges.empty()) fmt::format_to(std::back_inserter(out), "<path class=\"below\" d=\"{}\"/>\n", edges);
  out += DrawCut(graph, storey, sheet, cut_m);
  for (const Window& w : graph.windows) {
    if (w.storey == storey) out += DrawWindow(graph, w, sheet, cut_m);
  }
  for (const Doorway& d : graph.doorways) {
    if (d.storey == storey) out += d.position.z() + d.height_m > cut_m ? DrawDoor(graph, d, sheet) : DrawDoorBelow(graph, d, sheet);
  }
  return out;
}

}  // namespace plumb::tools
