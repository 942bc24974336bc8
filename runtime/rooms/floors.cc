#include "runtime/rooms/floors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::runtime {
namespace {

constexpr double kSameHeight_m = 0.3;                                  // keyframes of one stretch, about their mean
constexpr double kSettledExtent_m = 2.0;                               // of a stretch's positions
constexpr double kMinSensorHeight_m = 0.03, kMaxSensorHeight_m = 2.5;  // above its floor
constexpr double kMinCeilingHeight_m = 1.8;                            // above the floor
constexpr double kMaxCeilingHeight_m = 8.0;                            // above the sensor
constexpr double kOneLevel_m = 0.15;                                   // surfaces of one level
constexpr double kMinLevelShare = 0.3;                                 // of the largest level's area: table tops and ledges are smaller

// Keyframes that follow each other at one height.
struct Stretch {
  double z_m = 0;
  size_t count = 0;
  Eigen::AlignedBox2d box;
};

std::vector<Stretch> StretchesOf(const std::vector<Keyframe>& keyframes) {
  std::vector<Stretch> stretches;
  for (const Keyframe& keyframe : keyframes) {
    const Eigen::Vector3d at = keyframe.T_map_kf.translation();
    if (stretches.empty() || std::abs(at.z() - stretches.back().z_m) > kSameHeight_m) stretches.emplace_back();
    Stretch& s = stretches.back();
    ++s.count;
    s.z_m += (at.z() - s.z_m) / static_cast<double>(s.count);
    s.box.extend(Eigen::Vector2d(at.head<2>()));
  }
  return stretches;
}

struct Level {
  double z_m = 0, area_m2 = 0;
};

// The heights of the floors or ceilings that the keyframes saw, by area; ascending.
std::vector<Level> LevelsSeen(const SGraph& graph, const std::vector<bool>& by, SurfaceKind kind, double low_m, double high_m) {
  std::vector<Level> seen;
  for (const MapSurface& s : graph.surfaces) {
    if (s.kind != kind || s.z_min_m < low_m || s.z_min_m > high_m) continue;
    if (std::any_of(s.observations.begin(), s.observations.end(), [&](const Observation& o) { return by[o.keyframe]; }))
      seen.push_back({s.z_min_m, s.area_m2});
  }
  std::sort(seen.begin(), seen.end(),
            [](const Level& a, const Level& b) { return a.z_m != b.z_m ? a.z_m < b.z_m : a.area_m2 < b.area_m2; });
  std::vector<Level> levels;
  for (const Level& s : seen) {
    if (levels.empty() || s.z_m - levels.back().z_m > kOneLevel_m) {
      levels.push_back(s);
      continue;
    }
    Level& level = levels.back();
    level.area_m2 += s.area_m2;
    if (level.area_m2 > 0) level.z_m += (s.z_m - level.z_m) * s.area_m2 / level.area_m2;
  }
  double largest_m2 = 0;
  for (const Level& level : levels) largest_m2 = std::max(largest_m2, level.area_m2);
  std::erase_if(levels, [&](const Level& level) { return level.area_m2 < kMinLevelShare * largest_m2; });
  return levels;
}

std::vector<bool> NearHeight(const std::vector<Keyframe>& keyframes, double z_m) {
  std::vector<bool> near;
  for (const Keyframe& keyframe : keyframes) near.push_back(std::abs(keyframe.T_map_kf.translation().z() - z_m) <= kSameHeight_m);
  return near;
}

// The lowest of the large ones: floors may be seen through furniture, but nothing is seen through them.
std::optional<double> FloorUnder(const SGraph& graph, const std::vector<bool>& by, double z_m) {
  const std::vector<Level> levels = LevelsSeen(graph, by, SurfaceKind::kFloor, z_m - kMaxSensorHeight_m, z_m - kMinSensorHeight_m);
  return levels.empty() ? std::nullopt : std::optional(levels.front().z_m);
}

// The largest one above a person's head: the undersides of tables are lower.
std::optional<double> CeilingOver(const SGraph& graph, const std::vector<bool>& by, double z_m, const std::optional<double>& floor_z_m) {
  const double low_m = std::max(z_m, floor_z_m.value_or(z_m) + (floor_z_m ? kMinCeilingHeight_m : 0));
  const std::vector<Level> levels = LevelsSeen(graph, by, SurfaceKind::kCeiling, low_m, z_m + kMaxCeilingHeight_m);
  if (levels.empty()) return std::nullopt;
  return std::max_element(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.area_m2 < b.area_m2; })->z_m;
}

bool HasFloors(const SGraph& graph) {
  return std::any_of(graph.surfaces.begin(), graph.surfaces.end(),
                     [](const MapSurface& s) { return s.kind == SurfaceKind::kFloor && !s.observations.empty(); });
}

}  // namespace

std::vector<MapFloor> FindFloors(const SGraph& graph, const RoomOptions& options) {
  std::vector<Stretch> stretches = StretchesOf(graph.keyframes);
  // The longest first: it is a floor, whatever else it lacks.
  std::stable_sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) { return a.count > b.count; });
  const bool floors_seen = HasFloors(graph);
  std::vector<MapFloor> floors;
  for (const Stretch& s : stretches) {
    const bool apart = std::all_of(floors.begin(), floors.end(),
                                   [&](const MapFloor& f) { return std::abs(f.sensor_z_m - s.z_m) >= options.storey_step_m; });
    const bool settled =
        s.box.diagonal().norm() >= kSettledExtent_m && (!floors_seen || FloorUnder(graph, NearHeight(graph.keyframes, s.z_m), s.z_m));
    if (floors.empty() || (apart && settled)) floors.emplace_back().sensor_z_m = s.z_m;
  }
  std::sort(floors.begin(), floors.end(), [](const MapFloor& a, const MapFloor& b) { return a.sensor_z_m < b.sensor_z_m; });
  for (const Keyframe& keyframe : graph.keyframes) {
    if (keyframe.merged) continue;
    const double z_m = keyframe.T_map_kf.translation().z();
    const auto nearest = std::min_element(floors.begin(), floors.end(), [&](const MapFloor& a, const MapFloor& b) {
      return std::abs(a.sensor_z_m - z_m) < std::abs(b.sensor_z_m - z_m);
    });
    nearest->keyframes.push_back(keyframe.id);
  }
  for (size_t i = 0; i < floors.size(); ++i) {
    MapFloor& floor = floors[i];
    floor.id = static_cast<uint32_t>(i);
    const std::vector<bool> by = NearHeight(graph.keyframes, floor.sensor_z_m);
    floor.floor_z_m = FloorUnder(graph, by, floor.sensor_z_m);
    floor.ceiling_z_m = CeilingOver(graph, by, floor.sensor_z_m, floor.floor_z_m);
  }
  return floors;
}

}  // namespace plumb::runtime
