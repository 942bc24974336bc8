#include "compiler/passes/wall_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kParallel = 0.9962;         // cos 5 deg
constexpr double kStatedThickness_m = 0.01;  // how far the footprint may differ from what the source states
// Sides that face each other over less than this share of the perimeter do not make a straight wall. A square has 1/4.
constexpr double kMinFacingShare = 0.1;

struct FacingSides {
  double overlap_m = 0, thickness_m = 0;
  Eigen::Vector2d direction, on_axis;
};

std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> EdgesOf(const std::vector<Ring>& rings) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> out;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) out.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
  }
  return out;
}

// Whether the footprint fills the way from one side to the other; it does not between the far sides of a wall that goes around a court.
bool SolidAcross(const std::vector<Ring>& rings, const Eigen::Vector2d& middle, const Eigen::Vector2d& to_side) {
  for (const double f : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    if (WindingNumber(rings, middle + f * to_side) == 0) return false;
  }
  return true;
}

// The pair of opposite sides, the wall between them, with the greatest overlap; the thinner pair on a tie.
FacingSides BestFacingSides(const std::vector<Ring>& rings, const Eigen::Vector2d& direction) {
  const auto edges = EdgesOf(rings);
  FacingSides best;
  for (size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector2d a = edges[i].first, u = (edges[i].second - a).normalized(), n = Rot90Ccw(u);
    const double length = (edges[i].second - a).norm();
    if (direction.norm() > 0 && std::abs(u.dot(direction.normalized())) < kParallel) continue;
    for (size_t j = 0; j < edges.size(); ++j) {
      const Eigen::Vector2d v = edges[j].second - edges[j].first, w0 = edges[j].first - a, w1 = edges[j].second - a;
      if (u.dot(v) > -kParallel * v.norm()) continue;
      const double thickness = 0.5 * n.dot(w0 + w1);
      const double overlap = std::min(length, u.dot(w0)) - std::max(0.0, u.dot(w1));
      if (thickness <= 0 || overlap <= 0) continue;
      // Half a millimetre decides nothing: rounding must not swap equal pairs.
      const bool longer = overlap > best.overlap_m + 5e-4, equal = overlap > best.overlap_m - 5e-4;
      if (!longer && !(equal && thickness < best.thickness_m - 5e-4)) continue;
      const Eigen::Vector2d on_axis = a + 0.5 * thickness * n, middle = on_axis + (std::max(0.0, u.dot(w1)) + 0.5 * overlap) * u;
      if (!SolidAcross(rings, middle, 0.5 * thickness * n)) continue;
      best = {overlap, thickness, u, on_axis};
    }
  }
  return best;
}

// From where the line enters the footprint first to where it leaves it last.
std::pair<double, double> ExtentAlong(const std::vector<Ring>& rings, const Eigen::Vector2d& at, const Eigen::Vector2d& u) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const auto& [p, q] : EdgesOf(rings)) {
    const double sp = Cross(u, p - at), sq = Cross(u, q - at);
    if ((sp <= 0) == (sq <= 0)) continue;
    const double t = u.dot(p - at + (q - p) * (sp / (sp - sq)));
    lo = std::min(lo, t);
    hi = std::max(hi, t);
  }
  return {lo, hi};
}

WallAxis AxisOfStrip(const std::vector<Ring>& rings) {
  WallAxis out;
  std::vector<Eigen::Vector2d> points;
  double perimeter = 0;
  for (const auto& [p, q] : EdgesOf(rings)) {
    points.push_back(p);
    perimeter += (q - p).norm();
  }
  const Ring box = LeastRectangle(points);
  if (box.size() < 4) return out;
  const bool first_is_long = (box[1] - box[0]).norm() >= (box[2] - box[1]).norm();
  out.start = first_is_long ? 0.5 * (box[0] + box[3]) : 0.5 * (box[0] + box[1]);
  out.end = first_is_long ? 0.5 * (box[1] + box[2]) : 0.5 * (box[2] + box[3]);
  // l + t = perimeter / 2 and l * t = area.
  const double half = 0.5 * perimeter, area = RegionArea(rings);
  out.thickness_m = 0.5 * (half - std::sqrt(std::max(0.0, half * half - 4 * area)));
  return out;
}

// Of a wall between two arcs about one centre: the chord of the arc half way between them.
std::optional<WallAxis> AxisOfArcs(const std::vector<Arc>& arcs) {
  if (arcs.size() < 2) return std::nullopt;
  const auto [inner, outer] =
      std::minmax_element(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) { return a.radius_m < b.radius_m; });
  const double thickness = outer->radius_m - inner->radius_m;
  if (thickness <= 0 || (outer->center - inner->center).norm() > 0.1 * thickness) return std::nullopt;
  const double radius = 0.5 * (inner->radius_m + outer->radius_m);
  const auto at = [radius, &center = outer->center](double angle) -> Eigen::Vector2d {
    return center + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  return WallAxis{at(outer->start_rad), at(outer->start_rad + outer->sweep_rad), thickness};
}

// By wall: its lowest footprint; null where no height has a section of it.
std::vector<const Footprint*> LowestFootprints(const FloorIr& floors) {
  std::vector<const Footprint*> out(floors.walls.size(), nullptr);
  for (const Floor& floor : floors.floors) {
    for (const Footprint& f : floor.footprints) {
      if (f.wall < out.size() && out[f.wall] == nullptr) out[f.wall] = &f;
    }
  }
  return out;
}

// All points of the wall's solids from above, where no height of them has a section.
std::vector<Ring> Silhouette(const PlanIr& plan, const PlanWall& wall) {
  std::vector<Eigen::Vector2d> points;
  for (uint32_t e : wall.elements) {
    const PlanElement& element = plan.elements[e];
    for (const auto& v : (element.uncut.empty() ? element.body : element.uncut).vertices) points.push_back(v.head<2>());
  }
  Ring box = LeastRectangle(std::move(points));
  if (box.size() < 4) return {};
  return {std::move(box)};
}

}  // namespace

WallAxis AxisOfFootprint(const std::vector<Ring>& rings, const Eigen::Vector2d& direction) {
  double perimeter = 0;
  for (const auto& [p, q] : EdgesOf(rings)) perimeter += (q - p).norm();
  const FacingSides sides = BestFacingSides(rings, direction);
  if (sides.overlap_m < kMinFacingShare * perimeter) {
    return direction.norm() > 0 ? AxisOfFootprint(rings, Eigen::Vector2d::Zero()) : AxisOfStrip(rings);
  }
  const auto [lo, hi] = ExtentAlong(rings, sides.on_axis, sides.direction);
  if (!(lo < hi)) return AxisOfStrip(rings);
  return {sides.on_axis + lo * sides.direction, sides.on_axis + hi * sides.direction, sides.thickness_m};
}

void AddWalls(const PlanIr& plan, const FloorIr& floors, AGraph& graph) {
  const std::vector<const Footprint*> footprints = LowestFootprints(floors);
  for (uint32_t w = 0; w < floors.walls.size(); ++w) {
    const PlanWall& in = floors.walls[w];
    const PlanElement& element = plan.elements[in.elements[0]];
    Wall out;
    out.guid = element.guid;
    out.name = element.name;
    out.type = element.type;
    out.storey = StoreyId(in.storey);
    out.z_min_m = in.z_min_m;
    out.z_max_m = in.z_max_m;
    out.external = element.external;
    const Eigen::Vector2d stated = element.axis ? Eigen::Vector2d(element.axis->second - element.axis->first) : Eigen::Vector2d(0, 0);
    const std::vector<Ring> rings = footprints[w] != nullptr ? footprints[w]->rings : Silhouette(plan, in);
    WallAxis axis = AxisOfArcs(in.arcs).value_or(AxisOfFootprint(rings, stated));
    if (stated.dot(axis.end - axis.start) < 0) std::swap(axis.start, axis.end);
    out.axis_start = axis.start;
    out.axis_end = axis.end;
    const bool borne_out = element.thickness_m && std::abs(*element.thickness_m - axis.thickness_m) <= kStatedThickness_m;
    out.thickness_m = borne_out ? *element.thickness_m : axis.thickness_m;
    graph.walls.push_back(std::move(out));
  }
}

}  // namespace plumb::compiler
