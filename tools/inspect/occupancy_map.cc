#include "tools/inspect/occupancy_map.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/drawing/floor_plan.h"
#include "tools/drawing/section.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

// z of the floor with the most area.
double FloorHeight(const AGraph& graph, StoreyId storey) {
  std::map<double, double> area_m2;
  for (const Room& r : graph.rooms) {
    if (r.storey == storey) area_m2[r.floor_z_m] += r.area_m2;
  }
  const auto most = std::max_element(area_m2.begin(), area_m2.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == area_m2.end() ? graph.storeys[storey.index()].elevation_m : most->first;
}

bool IsWall(ElementKind kind) { return kind == ElementKind::kWall || kind == ElementKind::kCurtainWall || kind == ElementKind::kWindow; }

class Painter {
 public:
  explicit Painter(OccupancyMap& map) : map_(map) {}

  // Cells whose middle lies inside, even-odd over all rings.
  void Fill(const std::vector<Ring>& rings, Occupancy value) {
    Eigen::AlignedBox2d box;
    for (const Ring& ring : rings) {
      for (const Vector2d& p : ring) box.extend(p);
    }
    if (box.isEmpty()) return;
    const size_t first = Row(box.min().y()), last = Row(box.max().y());
    for (size_t row = first; row <= last; ++row) FillRow(rings, row, value);
  }

  // Every cell that the segment touches.
  void Draw(const Vector2d& from, const Vector2d& to, Occupancy value) {
    Vector2d a = InCells(from), b = InCells(to);
    if (a.x() > b.x()) std::swap(a, b);
    const double slope = b.x() > a.x() ? (b.y() - a.y()) / (b.x() - a.x()) : 0;
    for (size_t column = Index(a.x(), map_.columns); column <= Index(b.x(), map_.columns); ++column) {
      // The part of the segment within the column; all of it where it is upright.
      const double x0 = std::max(a.x(), static_cast<double>(column)), x1 = std::min(b.x(), static_cast<double>(column) + 1);
      const bool upright = b.x() - a.x() < 1e-9;
      const double y0 = upright ? a.y() : a.y() + slope * (x0 - a.x()), y1 = upright ? b.y() : a.y() + slope * (x1 - a.x());
      for (size_t row = Index(std::min(y0, y1), map_.rows); row <= Index(std::max(y0, y1), map_.rows); ++row) map_.at(column, row) = value;
    }
  }

 private:
  [[nodiscard]] Vector2d InCells(const Vector2d& p) const { return (p - map_.origin) / map_.resolution_m; }
  static size_t Index(double at, size_t size) {
    return static_cast<size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(size - 1)));
  }
  [[nodiscard]] size_t Row(double y_m) const { return Index((y_m - map_.origin.y()) / map_.resolution_m, map_.rows); }

  void FillRow(const std::vector<Ring>& rings, size_t row, Occupancy value) {
    const double y_m = map_.origin.y() + (static_cast<double>(row) + 0.5) * map_.resolution_m;
    std::vector<double> crossings;
    for (const Ring& ring : rings) {
      for (size_t i = 0; i < ring.size(); ++i) {
        const Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.y() > y_m) == (b.y() > y_m)) continue;
        crossings.push_back((a.x() + (y_m - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) - map_.origin.x()) / map_.resolution_m);
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double first = std::ceil(crossings[i] - 0.5), end = std::ceil(crossings[i + 1] - 0.5);
      for (double column = std::max(0.0, first); column < std::min(end, static_cast<double>(map_.columns)); ++column) {
        map_.at(static_cast<size_t>(column), row) = value;
      }
    }
  }

  OccupancyMap& map_;
};

Expected<OccupancyMap> EmptyMap(const AGraph& graph, StoreyId storey, const OccupancyOptions& options) {
  const Eigen::AlignedBox2d box = BoundsOf(graph, storey);
  if (box.isEmpty()) {
    return Fail(ErrorCode::kPlanUnsuitable,
                fmt::format("storey `{}` has neither rooms nor walls to make a map of", graph.storeys[storey.index()].name));
  }
  const double step_m = options.resolution_m;
  OccupancyMap map;
  map.resolution_m = step_m;
  constexpr double kSlack = 1e-6;  // of a cell: rounding does not add a column
  const Vector2d lo = ((box.min().array() - options.margin_m) / step_m + kSlack).floor();
  const Vector2d hi = ((box.max().array() + options.margin_m) / step_m - kSlack).ceil();
  const double columns = hi.x() - lo.x(), rows = hi.y() - lo.y();
  if (!(columns * rows <= static_cast<double>(options.max_cells))) {
    return Fail(ErrorCode::kBadOption, fmt::format("a map of {:.1f} x {:.1f} m with cells of {} m has {:.0f} cells; at most {} are written",
                                                   columns * step_m, rows * step_m, step_m, columns * rows, options.max_cells));
  }
  map.origin = lo * step_m;
  map.columns = static_cast<size_t>(columns);
  map.rows = static_cast<size_t>(rows);
  map.cells.assign(map.columns * map.rows, Occupancy::kUnknown);
  return map;
}

// What the plane cuts, walls and panes or everything else. Outlines that do not close leave their line.
void DrawElements(const AGraph& graph, const std::vector<SectionSegment>& segments, bool walls, Painter& painter) {
  std::vector<SectionSegment> chosen;
  for (const SectionSegment& s : segments) {
    const ElementKind kind = graph.elements[s.element].kind;
    if (kind == ElementKind::kDoor || kind == ElementKind::kGround || IsWall(kind) != walls) continue;
    chosen.push_back(s);
    painter.Draw(s.from, s.to, Occupancy::kOccupied);
  }
  for (const ElementSection& section : ClosedSections(chosen)) painter.Fill(section.rings, Occupancy::kOccupied);
}

// From one side of the wall to the other, clear of the jambs, which are occupied as far as they reach into their cells.
void OpenDoorway(const AGraph& graph, const Doorway& d, Painter& painter, double resolution_m) {
  const double thickness_m = d.wall.valid() ? graph.walls[d.wall.index()].thickness_m : 0;
  const Vector2d through(std::cos(d.yaw_rad), std::sin(d.yaw_rad)), along(-through.y(), through.x()), middle = d.position.head<2>();
  const double width_m = std::max(d.width_m - resolution_m, resolution_m);
  painter.Fill({RectangleAlong(middle, along, width_m, thickness_m + 2 * resolution_m)}, Occupancy::kFree);
}

}  // namespace

std::string OccupancyOptions::Check() const {
  if (!(height_m > 0 && height_m < 10)) return fmt::format("OccupancyOptions.height_m = {}; must be in (0, 10)", height_m);
  if (!(resolution_m >= 0.001 && resolution_m <= 10))
    return fmt::format("OccupancyOptions.resolution_m = {}; must be in [0.001, 10]", resolution_m);
  if (!(margin_m >= 0 && margin_m < 1000)) return fmt::format("OccupancyOptions.margin_m = {}; must be in [0, 1000)", margin_m);
  if (max_cells == 0) return "OccupancyOptions.max_cells = 0; must be positive";
  return {};
}

Expected<OccupancyMap> MakeOccupancyMap(const AGraph& graph, StoreyId storey, const OccupancyOptions& options) {
  if (std::string wrong = options.Check(); !wrong.empty()) return Fail(ErrorCode::kBadOption, std::move(wrong));
  Expected<OccupancyMap> map = EmptyMap(graph, storey, options);
  if (!map) return map;
  Painter painter(*map);
  for (const Room& r : graph.rooms) {
    if (r.storey != storey) continue;
    std::vector<Ring> rings = r.holes;
    rings.push_back(r.polygon);
    painter.Fill(rings, Occupancy::kFree);
  }
  const std::vector<SectionSegment> segments = SegmentsAt(graph, FloorHeight(graph, storey) + options.height_m);
  DrawElements(graph, segments, true, painter);
  for (const Doorway& d : graph.doorways) {
    if (d.storey == storey) OpenDoorway(graph, d, painter, options.resolution_m);
  }
  DrawElements(graph, segments, false, painter);
  return map;
}

std::string MapPgm(const OccupancyMap& map) {
  std::string out = fmt::format("P5\n{} {}\n255\n", map.columns, map.rows);
  for (size_t row = map.rows; row-- > 0;) {
    for (size_t column = 0; column < map.columns; ++column) out += static_cast<char>(map.at(column, row));
  }
  return out;
}

std::string MapYaml(const OccupancyMap& map, const std::string& image) {
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{:.6f}, {:.6f}, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
      image, map.resolution_m, map.origin.x(), map.origin.y());
}

}  // namespace plumb::tools
