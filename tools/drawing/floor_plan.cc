#include "tools/drawing/floor_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>

#include "tools/drawing/section.h"
#include "tools/drawing/undrawn_walls.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

Vector2d Direction(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
Vector2d Left(const Vector2d& v) { return {-v.y(), v.x()}; }

double WallThickness(const AGraph& g, WallId wall) { return wall.valid() ? g.walls[wall.index()].thickness_m : 0.2; }

// A wall by its axis and thickness.
Ring AxisRing(const Wall& w) {
  const Vector2d along = w.axis_end - w.axis_start;
  return RectangleAlong(0.5 * (w.axis_start + w.axis_end), along.normalized(), along.norm(), w.thickness_m);
}

// The cut never lies exactly in a horizontal face: tops of sills and benches are drawn at round heights.
double CutHeight(const AGraph& g, StoreyId storey) { return g.storeys[storey.index()].elevation_m + kSectionHeight_m + 0.00037; }

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
std::string DrawCut(const AGraph& g, StoreyId storey, const Sheet& sheet) {
  const double z_m = CutHeight(g, storey);
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

std::string DrawWindow(const AGraph& g, const Window& w, const Sheet& sheet) {
  const Vector2d along = Left(Direction(w.yaw_rad)), middle = w.position.head<2>();
  const Ring ring = RectangleAlong(middle, along, w.width_m, WallThickness(g, w.wall));
  const double cut_m = CutHeight(g, w.storey);
  const bool is_cut = w.position.z() < cut_m && cut_m < w.position.z() + w.height_m;
  std::string out = fmt::format("<path class=\"{}\" d=\"{}\"/>\n", is_cut ? "window" : "window-above", sheet.Closed(ring));
  const Vector2d half = 0.5 * w.width_m * along;
  if (is_cut) fmt::format_to(std::back_inserter(out), "<path class=\"glass\" d=\"{}\"/>\n", sheet.Line(middle - half, middle + half));
  return out;
}

size_t DoorwaysOf(const AGraph& g, RoomId room) {
  return static_cast<size_t>(
      std::count_if(g.doorways.begin(), g.doorways.end(), [room](const Doorway& d) { return d.room_a == room || d.room_b == room; }));
}

// The room into which a leaf opens, as is common where plans do not say: from outside inwards, from a corridor into the room, else into the
// smaller.
bool OpensTowardsB(const AGraph& g, const Doorway& d) {
  if (!d.room_b.valid()) return false;
  if (!d.room_a.valid()) return true;
  const size_t ways_a = DoorwaysOf(g, d.room_a), ways_b = DoorwaysOf(g, d.room_b);
  if (ways_a != ways_b) return ways_b < ways_a;
  return g.rooms[d.room_b.index()].area_m2 <= g.rooms[d.room_a.index()].area_m2;
}

// The jamb at which a leaf hangs: the one nearer to a corner of the room, so that it opens against a wall.
bool HangsAtEnd(const AGraph& g, RoomId room, const Vector2d& start, const Vector2d& end) {
  if (!room.valid()) return false;
  double to_start = std::numeric_limits<double>::max(), to_end = to_start;
  for (const Vector2d& corner : g.rooms[room.index()].polygon) {
    to_start = std::min(to_start, (corner - start).norm());
    to_end = std::min(to_end, (corner - end).norm());
  }
  return to_end < to_start;
}

// A leaf standing open by 90 degrees, and the way that its free end takes.
std::string DrawLeaf(const Vector2d& hinge, const Vector2d& latch, const Vector2d& swing, const Sheet& sheet) {
  const Vector2d closed = latch - hinge, tip = hinge + closed.norm() * swing, open = tip - hinge;
  // Sweep flag 1 is clockwise on the sheet.
  const int sweep = open.x() * closed.y() - open.y() * closed.x() < 0 ? 1 : 0;
  const std::string radius = Decimal(sheet.Length(closed.norm()));
  return fmt::format("<path class=\"leaf\" d=\"{}\"/>\n<path class=\"swing\" d=\"M{}A{} {} 0 0 {} {}\"/>\n", sheet.Line(hinge, tip),
                     sheet.At(tip), radius, radius, sweep, sheet.At(latch));
}

std::string DrawDoor(const AGraph& g, const Doorway& d, const Sheet& sheet) {
  constexpr double kWidestLeaf_m = 1.4;  // wider doors have two
  const double thickness_m = WallThickness(g, d.wall);
  const Vector2d through = Direction(d.yaw_rad), along = Left(through), middle = d.position.head<2>();
  const Ring ring = RectangleAlong(middle, along, d.width_m, thickness_m + 0.02);
  std::string out = fmt::format("<path class=\"opening\" d=\"{}\"/>\n", sheet.Closed(ring));
  const std::string edges = sheet.Line(ring[0], ring[1]) + sheet.Line(ring[2], ring[3]);
  if (!d.has_leaf) return out + fmt::format("<path class=\"lintel\" d=\"{}\"/>\n", edges);
  const bool to_b = OpensTowardsB(g, d);
  const Vector2d swing = to_b ? through : Vector2d(-through);
  const Vector2d face = middle + 0.5 * thickness_m * swing, half = 0.5 * d.width_m * along;
  const Vector2d start = face - half, end = face + half;
  if (d.width_m > kWidestLeaf_m) {
    out += DrawLeaf(start, face, swing, sheet) + DrawLeaf(end, face, swing, sheet);
  } else if (HangsAtEnd(g, to_b ? d.room_b : d.room_a, start, end)) {
    out += DrawLeaf(end, start, swing, sheet);
  } else {
    out += DrawLeaf(start, end, swing, sheet);
  }
  return out + fmt::format("<path class=\"sill\" d=\"{}\"/>\n", edges);
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

std::string DrawFloorPlan(const AGraph& graph, StoreyId storey, const Sheet& sheet) {
  std::string out = DrawRoomFloors(graph, storey, sheet);
  const double floor_m = graph.storeys[storey.index()].elevation_m;
  std::string edges;
  for (const auto& [a, b] : EdgesSeenFromAbove(graph, floor_m - 0.1, CutHeight(graph, storey))) edges += sheet.Line(a, b);
  if (!edges.empty()) fmt::format_to(std::back_inserter(out), "<path class=\"below\" d=\"{}\"/>\n", edges);
  out += DrawCut(graph, storey, sheet);
  for (const Window& w : graph.windows) {
    if (w.storey == storey) out += DrawWindow(graph, w, sheet);
  }
  for (const Doorway& d : graph.doorways) {
    if (d.storey == storey) out += DrawDoor(graph, d, sheet);
  }
  return out;
}

}  // namespace plumb::tools
