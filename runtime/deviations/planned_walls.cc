#include "runtime/deviations/planned_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::runtime {
namespace {

constexpr double kMaxTurn_rad = 0.5236;  // 30 degrees
constexpr double kMinOverlap = 0.5;      // of the shorter of the two
constexpr double kFar_m = std::numeric_limits<double>::infinity();

// From the panel to the wall's near side; infinite where the panel cannot be the wall.
double Distance(const Wall& wall, const Panel& panel) {
  if (panel.z_max_m < wall.z_min_m || panel.z_min_m > wall.z_max_m) return kFar_m;
  Panel axis;
  axis.start = wall.axis_start;
  axis.length_m = (wall.axis_end - wall.axis_start).norm();
  if (axis.length_m == 0) return kFar_m;
  axis.along = (wall.axis_end - wall.axis_start) / axis.length_m;
  axis.normal = {-axis.along.y(), axis.along.x()};
  const double cos_turn = std::abs(axis.along.dot(panel.along));
  if (cos_turn < std::cos(kMaxTurn_rad)) return kFar_m;
  const Eigen::Vector2d end = panel.start + panel.length_m * panel.along;
  const double from = std::min(axis.U(panel.start), axis.U(end)), to = std::max(axis.U(panel.start), axis.U(end));
  if (std::min(to, axis.length_m) - std::max(from, 0.0) < kMinOverlap * std::min(to - from, axis.length_m)) return kFar_m;
  const double at_panel_m = std::abs(axis.W(0.5 * (panel.start + end)));
  const double at_wall_m =
      std::abs(panel.W(0.5 * (wall.axis_start + wall.axis_end))) / cos_turn;  // along the wall's normal, as deviations are
  return std::max(0.0, std::min(at_panel_m, at_wall_m) - 0.5 * wall.thickness_m);
}

}  // namespace

PlannedWalls::PlannedWalls(const AGraph& plan, const std::vector<Match>& matches) : plan_(plan), matched_(plan.walls.size(), false) {
  for (const Match& m : matches) {
    if (m.plan_surface.valid()) matched_[plan.surfaces[m.plan_surface.index()].wall.index()] = true;
  }
}

bool PlannedWalls::MayBeUnmatchedOne(const Panel& panel, double max_distance_m) const {
  double nearest_m = max_distance_m;
  bool unmatched = false;
  for (size_t w = 0; w < plan_.walls.size(); ++w) {
    const double distance_m = Distance(plan_.walls[w], panel);
    if (distance_m > nearest_m) continue;
    nearest_m = distance_m;
    unmatched = !matched_[w];
  }
  return unmatched;
}

}  // namespace plumb::runtime
