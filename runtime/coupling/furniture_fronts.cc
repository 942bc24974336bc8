#include "runtime/coupling/furniture_fronts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace plumb::runtime {
namespace {

// No wall is built thicker than planned by more; a planar laser sees the one face at one height, the other at another.
constexpr double kMaxThicker_m = 0.04, kMaxPlanarThicker_m = 0.10;
constexpr double kHigher_m = 0.10;     // of what reaches further up
constexpr double kMuchLarger = 2;      // in area
constexpr double kMinCommon_m = 0.3;   // that both faces were seen along, for their distance to be known
constexpr size_t kMinWalls = 4;        // whose median tells what a common range bias adds ...
constexpr double kMaxCommon_m = 0.08;  // ... up to two sigmas of one, for both faces

// What was seen of one side of a wall.
struct Side {
  const Patch* largest = nullptr;
  const Surface* face = nullptr;  // that it was matched to
  double area = 0, z_max = -1e300;
};

std::map<int, Side> Sides(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Patch>& patches,
                          const std::vector<Match>& matches) {
  std::map<int, Side> sides;
  for (const Match& m : matches) {
    if (!m.plan_surface.valid()) continue;
    const auto patch = std::lower_bound(patches.begin(), patches.end(), m.map_surface,
                                        [](const Patch& p, uint32_t map_surface) { return p.map_surface < map_surface; });
    const Surface& face = plan.surfaces[m.plan_surface.index()];
    Side& side = sides[SideOf(frames[face.wall.index()], face)];
    if (!side.largest || patch->area > side.largest->area) {
      side.largest = &*patch;
      side.face = &face;
    }
    side.area += patch->area;
    side.z_max = std::max(side.z_max, patch->z_max);
  }
  return sides;
}

// By how much the wall between two patches is thicker than between the planned faces, in the middle of what both run along. None if that is
// too little: led on beyond their ends, lines part.
std::optional<double> Thicker_m(const Side& a, const Side& b) {
  const Eigen::Vector2d along = (a.face->end - a.face->start).normalized();
  const auto range = [&](const Patch& p) { return std::minmax({along.dot(p.start), along.dot(p.end)}); };
  const auto [a_from, a_to] = range(*a.largest);
  const auto [b_from, b_to] = range(*b.largest);
  if (!(std::min(a_to, b_to) - std::max(a_from, b_from) >= kMinCommon_m)) return std::nullopt;
  const double middle = 0.5 * (std::max(a_from, b_from) + std::min(a_to, b_to));
  const auto at = [&](const Patch& p) -> Eigen::Vector2d {
    const double from = along.dot(p.start), to = along.dot(p.end);
    return p.start + (middle - from) / (to - from) * (p.end - p.start);
  };
  return a.largest->normal.head<2>().normalized().dot(at(*a.largest) - at(*b.largest)) -
         a.face->normal.head<2>().dot(a.face->midpoint() - b.face->midpoint());
}

// The worse seen of two sides; null where they are seen alike.
const Side* LesserOf(const Side& a, const Side& b) {
  if (std::abs(a.z_max - b.z_max) > kHigher_m) return a.z_max < b.z_max ? &a : &b;
  if (a.area > kMuchLarger * b.area) return &b;
  return b.area > kMuchLarger * a.area ? &a : nullptr;
}

// What all walls are thicker by: a lidar whose ranges are off by half of it. Few walls do not tell.
double CommonThicker_m(const std::map<int, Side>& sides) {
  std::vector<double> thicker_m;
  for (const auto& [key, side] : sides) {
    const auto other = sides.find(key ^ 1);
    if (key % 2 != 0 || other == sides.end()) continue;
    if (const auto t = Thicker_m(side, other->second)) thicker_m.push_back(*t);
  }
  if (thicker_m.size() < kMinWalls) return 0;
  const auto middle = thicker_m.begin() + static_cast<std::ptrdiff_t>(thicker_m.size() / 2);
  std::nth_element(thicker_m.begin(), middle, thicker_m.end());
  return std::clamp(*middle, -kMaxCommon_m, kMaxCommon_m);
}

}  // namespace

void DropPlanarFronts(const std::vector<Patch>& patches, AssignedFaces& assigned) {
  std::map<int, std::pair<double, double>> sides;  // sum of offset * area, area
  for (size_t i = 0; i < patches.size(); ++i) {
    if (assigned[i].empty()) continue;
    auto& [moment, area] = sides[assigned[i].front().side];
    moment += assigned[i].front().offset_m * patches[i].area;
    area += patches[i].area;
  }
  const auto in_front_m = [&](int side) {
    const auto at = sides.find(side);
    return at == sides.end() || at->second.second <= 0 ? 0.0 : at->second.first / at->second.second;
  };
  for (auto& list : assigned) {
    if (list.empty() || !sides.contains(list.front().side ^ 1)) continue;
    const int side = list.front().side;
    if (in_front_m(side) + in_front_m(side ^ 1) > kMaxPlanarThicker_m && in_front_m(side) > 0.5 * kMaxPlanarThicker_m) list.clear();
  }
}

void DropLowFronts(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Patch>& patches,
                   std::vector<Match>& matches) {
  const std::map<int, Side> sides = Sides(plan, frames, patches, matches);
  const double common_m = CommonThicker_m(sides);
  for (const auto& [key, side] : sides) {
    const auto other = sides.find(key ^ 1);
    if (key % 2 != 0 || other == sides.end()) continue;
    const std::optional<double> thicker_m = Thicker_m(side, other->second);
    if (!thicker_m || *thicker_m - common_m <= kMaxThicker_m) continue;
    const Side* lesser = LesserOf(side, other->second);
    if (!lesser) continue;
    const int front = lesser == &side ? key : other->first;
    std::erase_if(matches, [&](const Match& m) {
      if (!m.plan_surface.valid()) return false;
      const Surface& face = plan.surfaces[m.plan_surface.index()];
      return SideOf(frames[face.wall.index()], face) == front;
    });
  }
}

}  // namespace plumb::runtime
