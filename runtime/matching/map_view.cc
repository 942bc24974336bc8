#include "runtime/matching/map_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/matching/wall_grid.h"

namespace plumb::runtime {
namespace {

constexpr double kKeyframeSpacing_m = 0.3;  // closer ones see the same from the same place: no new evidence
constexpr double kKeyframeTurn_rad = 0.52;  // ... unless they look elsewhere
constexpr double kOnSurface_m = 0.10;
constexpr double kMinRange_m = 0.4;
constexpr int kAzimuths = 120, kElevations = 6;
constexpr double kFloorStep_m = 0.15;       // between two heights of floors
constexpr double kLowerFloorPoints = 0.02;  // of those of the floor with most points
constexpr size_t kMaxLowerFloors = 2;
constexpr double kHighestTable_m = 1.2;  // what is further below is another storey's
constexpr double kRangeBin_m = 0.25, kMaxRange_m = 60.0;

struct Horizontal {
  double z_m;
  double num_points;
};

// What is level, most points first. A map over several storeys has several floors; any of them fixes the height. Only floors below the
// sensor and ceilings above it: undersides and tops of tables pass for both.
std::vector<Horizontal> Horizontals(const SGraph& map, SurfaceKind kind, const Eigen::Vector2d& at, double sensor_z_m) {
  std::vector<Horizontal> found;
  for (const MapSurface& s : map.surfaces) {
    if (s.kind != kind || s.num_points <= 0 || std::abs(s.plane.n.z()) < 0.9) continue;
    const double z_m = -(s.plane.d + s.plane.n.head<2>().dot(at)) / s.plane.n.z();
    if ((z_m < sensor_z_m) == (kind == SurfaceKind::kFloor)) found.push_back({z_m, static_cast<double>(s.num_points)});
  }
  std::stable_sort(found.begin(), found.end(), [](const Horizontal& a, const Horizontal& b) { return a.num_points > b.num_points; });
  return found;
}

// A table that the sensor stands close to has more points than the floor: what is level and clearly below may be the floor as well.
std::vector<double> LowerFloors(const std::vector<Horizontal>& floors) {
  std::vector<double> lower_m;
  for (const Horizontal& f : floors) {
    if (lower_m.size() == kMaxLowerFloors || f.num_points < kLowerFloorPoints * floors.front().num_points) break;
    const double above_m = lower_m.empty() ? floors.front().z_m : *std::min_element(lower_m.begin(), lower_m.end());
    if (f.z_m < above_m - kFloorStep_m && f.z_m > floors.front().z_m - kHighestTable_m) lower_m.push_back(f.z_m);
  }
  return lower_m;
}

// Farthest-point order: any number of them covers the map as well as that number can.
std::vector<const Keyframe*> SpreadKeyframes(const SGraph& map, int max_keyframes) {
  std::vector<const Keyframe*> chosen;
  if (map.keyframes.empty()) return chosen;
  const auto distance = [](const Keyframe& a, const Keyframe& b) {
    const double turn_rad = Eigen::AngleAxisd(a.T_map_kf.linear().transpose() * b.T_map_kf.linear()).angle();
    const double gap_m = (a.T_map_kf.translation() - b.T_map_kf.translation()).norm();
    return std::max(gap_m / kKeyframeSpacing_m, turn_rad / kKeyframeTurn_rad);
  };
  std::vector<double> nearest(map.keyframes.size(), 1e300);
  for (size_t i = 0; i < nearest.size(); ++i) {
    if (map.keyframes[i].merged) nearest[i] = 0;
  }
  size_t next = 0;
  while (static_cast<int>(chosen.size()) < max_keyframes) {
    chosen.push_back(&map.keyframes[next]);
    for (size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], distance(map.keyframes[i], *chosen.back()));
    next = static_cast<size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    if (nearest[next] < 1) break;
  }
  return chosen;
}

// One point per direction cell, cell by cell, until there are `count`: dense near surfaces do not crowd out the rest.
std::vector<uint32_t> SpreadPoints(const Keyframe& keyframe, int count) {
  std::vector<std::vector<uint32_t>> cells(kAzimuths * kElevations);
  for (uint32_t i = 0; i < keyframe.points.size(); ++i) {
    const Eigen::Vector3f& p = keyframe.points[i];
    const double range_m = p.norm();
    if (!(range_m > kMinRange_m)) continue;
    const double azimuth = (std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) + 0.5) * kAzimuths;
    const double elevation = (std::asin(std::clamp(p.z() / range_m, -1.0, 1.0)) / (std::numbers::pi / 3) + 0.5) * kElevations;
    const int a = std::clamp(static_cast<int>(azimuth), 0, kAzimuths - 1);
    const int e = std::clamp(static_cast<int>(elevation), 0, kElevations - 1);
    cells[e * kAzimuths + a].push_back(i);
  }
  // 37 is coprime to the number of cells: a prefix of the order is spread over all of them.
  std::vector<uint32_t> points;
  const size_t n = cells.size();
  size_t longest = 0;
  for (const auto& cell : cells) longest = std::max(longest, cell.size());
  for (size_t round = 0; round < longest; ++round) {
    for (size_t k = 0; k < n; ++k) {
      const std::vector<uint32_t>& cell = cells[(k * 37) % n];
      if (round >= cell.size()) continue;
      points.push_back(cell[(round + k) % cell.size()]);
      if (static_cast<int>(points.size()) == count) return points;
    }
  }
  return points;
}

int WallAt(const std::vector<MapWall>& walls, const WallGrid& grid, const Eigen::Vector3d& p) {
  int best = -1;
  double best_m = kOnSurface_m;
  for (const uint32_t i : grid.Near(p.head<2>())) {
    const MapWall& w = walls[i];
    const Eigen::Vector2d v = p.head<2>() - w.start;
    const double off_m = std::abs(w.normal.dot(v)), u_m = w.along.dot(v);
    if (off_m >= best_m || u_m < -kOnSurface_m || u_m > w.length_m + kOnSurface_m) continue;
    if (p.z() < w.z_min_m - kOnSurface_m || p.z() > w.z_max_m + kOnSurface_m) continue;
    best = static_cast<int>(i);
    best_m = off_m;
  }
  return best;
}

// Rays of all chosen keyframes, interleaved.
std::vector<MapRay> SampleRays(const SGraph& map, const MapView& view, const MatcherOptions& options) {
  const WallGrid grid(view.walls, std::numbers::sqrt2 * kOnSurface_m);
  std::vector<std::vector<MapRay>> per_keyframe;
  for (const Keyframe* keyframe : SpreadKeyframes(map, options.max_keyframes)) {
    Eigen::Isometry3d T = keyframe->T_map_kf;
    T.translation().head<2>() -= view.center_m;
    per_keyframe.emplace_back();
    for (uint32_t i : SpreadPoints(*keyframe, options.rays_per_keyframe)) {
      const Eigen::Vector3d p = T * keyframe->points[i].cast<double>();
      if (view.floor_z_m && std::abs(p.z() - *view.floor_z_m) < kOnSurface_m) continue;  // the floor is the same everywhere
      MapRay ray;
      ray.origin = T.translation();
      ray.range_m = (p - ray.origin).norm();
      ray.direction = (p - ray.origin) / ray.range_m;
      ray.wall = WallAt(view.walls, grid, p);
      per_keyframe.back().push_back(ray);
    }
  }
  std::vector<MapRay> rays;
  for (size_t i = 0;; ++i) {
    const size_t before = rays.size();
    for (const auto& some : per_keyframe) {
      if (i < some.size()) rays.push_back(some[i]);
    }
    if (rays.size() == before) return rays;
  }
}

double LowestHeight(const SGraph& map) {
  std::vector<double> z;
  for (const Keyframe& keyframe : map.keyframes) {
    for (size_t i = 0; i < keyframe.points.size(); i += 8) z.push_back((keyframe.T_map_kf * keyframe.points[i].cast<double>()).z());
  }
  if (z.empty()) return 0;
  const auto nth = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 100);
  std::nth_element(z.begin(), nth, z.end());
  return *nth;
}

}  // namespace

RangeBackground::RangeBackground(std::span<const MapRay> rays) {
  const size_t bins = static_cast<size_t>(kMaxRange_m / kRangeBin_m);
  constexpr int kReach = 4;  // triangular kernel of +-1 m
  std::vector<double> weight(bins, 1e-3 * (1.0 + static_cast<double>(rays.size()) / static_cast<double>(bins)));
  for (const MapRay& ray : rays) {
    const int bin = std::min(static_cast<int>(ray.range_m / kRangeBin_m), static_cast<int>(bins) - 1);
    for (int k = -kReach; k <= kReach; ++k) {
      if (bin + k >= 0 && bin + k < static_cast<int>(bins)) weight[bin + k] += 1.0 - std::abs(k) / (kReach + 1.0);
    }
  }
  double sum = 0;
  for (double w : weight) sum += w;
  double below = 0;
  for (double w : weight) {
    below_.push_back(std::max(below + 0.5 * w / sum, 1e-3));
    density_.push_back(w / (sum * kRangeBin_m));
    below += w / sum;
  }
}

double RangeBackground::Density(double range_m) const {
  return density_[std::min(static_cast<size_t>(std::max(range_m, 0.0) / kRangeBin_m), density_.size() - 1)];
}

double RangeBackground::Below(double range_m) const {
  return below_[std::min(static_cast<size_t>(std::max(range_m, 0.0) / kRangeBin_m), below_.size() - 1)];
}

MapView ViewMap(const SGraph& map, const MatcherOptions& options) {
  MapView view;
  view.planar = map.planar;
  view.walls = UprightWalls(map);
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const MapWall& w : view.walls) {
    moment += 0.5 * w.length_m * (w.start + w.end);
    view.wall_length_m += w.length_m;
  }
  view.wall_sigma_m = SigmaOfWalls(view.walls);
  if (view.wall_length_m > 0) view.center_m = moment / view.wall_length_m;
  for (MapWall& w : view.walls) {
    w.start -= view.center_m;
    w.end -= view.center_m;
  }
  const Eigen::Vector2d at = map.keyframes.empty() ? view.center_m : map.keyframes.front().T_map_kf.translation().head<2>().eval();
  if (!map.keyframes.empty()) view.sensor_z_m = map.keyframes.front().T_map_kf.translation().z();
  const std::vector<Horizontal> floors = Horizontals(map, SurfaceKind::kFloor, at, view.sensor_z_m);
  const std::vector<Horizontal> ceilings = Horizontals(map, SurfaceKind::kCeiling, at, view.sensor_z_m);
  if (!floors.empty()) view.floor_z_m = floors.front().z_m;
  if (!ceilings.empty()) view.ceiling_z_m = ceilings.front().z_m;
  view.lower_floors_z_m = LowerFloors(floors);
  view.start_m = at - view.center_m;
  view.lowest_z_m = LowestHeight(map);
  view.rays = SampleRays(map, view, options);
  view.background = RangeBackground(view.rays);
  return view;
}

Eigen::Isometry3d PoseOfMap(const PlanarPose& pose, const MapView& view, const Eigen::Vector3d& origin) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const Eigen::Matrix2d R = pose.rotation();
  T.linear().topLeftCorner<2, 2>() = R;
  T.translation().head<2>() = origin.head<2>() + pose.t_m - R * view.center_m;
  T.translation().z() = origin.z() + pose.z_m;
  return T;
}

PlanarPose PoseOfView(const Eigen::Isometry3d& T_plan_map, const MapView& view, const Eigen::Vector3d& origin) {
  PlanarPose pose;
  pose.yaw_rad = std::atan2(T_plan_map.linear()(1, 0), T_plan_map.linear()(0, 0));
  const Eigen::Vector3d t = T_plan_map.translation() - origin;
  pose.t_m = t.head<2>() + pose.rotation() * view.center_m;
  pose.z_m = t.z();
  return pose;
}

MapView Scaled(MapView view, double scale) {
  for (MapWall& wall : view.walls) {
    wall.start *= scale;
    wall.end *= scale;
    wall.length_m *= scale;
  }
  view.wall_length_m *= scale;
  const Eigen::Vector3d factors(scale, scale, 1);
  for (MapRay& ray : view.rays) {
    const Eigen::Vector3d way = factors.cwiseProduct(ray.range_m * ray.direction);
    ray.origin = factors.cwiseProduct(ray.origin);
    ray.range_m = way.norm();
    ray.direction = way / ray.range_m;
  }
  return view;
}

}  // namespace plumb::runtime
