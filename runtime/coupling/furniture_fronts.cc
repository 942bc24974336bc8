#include "runtime/coupling/furniture_fronts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace plumb::runtime {
namespace {

// No wall is built thicker than planned by more; a planar laser sees the one face at one height, the other at another.
constexpr double kMaxThicker_m = 0.04, kMaxPlanarThicker_m = 0.10;
constexpr double kHigher_m = 0.10;  // of what reaches further up
constexpr double kMuchLarger = 2;   // in area

// What was seen of one side of a wall.
struct Side {
  std::vector<size_t> patches;  // the first is the largest
  double area = 0, z_max = -1e300;
};

std::map<int, Side> Sides(const std::vector<Patch>& patches, const AssignedFaces& assigned) {
  std::map<int, Side> sides;
  for (size_t i = 0; i < patches.size(); ++i) {
    if (assigned[i].empty()) continue;
    Side& side = sides[assigned[i].front().side];
    side.patches.push_back(i);
    if (patches[i].area > patches[side.patches.front()].area) std::swap(side.patches.front(), side.patches.back());
    side.area += patches[i].area;
    side.z_max = std::max(side.z_max, patches[i].z_max);
  }
  return sides;
}

// By how much the wall between two patches is thicker than between the planned faces. Each patch is led on to the other: the shorter one's
// direction is the worse, so the smaller counts.
double Thicker_m(const Patch& a, const Surface& a_face, const Patch& b, const Surface& b_face) {
  const double planned = a_face.normal.head<2>().dot(a_face.midpoint() - b_face.midpoint());
  const Eigen::Vector2d arm = a.midpoint() - b.midpoint();
  return std::min(a.normal.head<2>().normalized().dot(arm), -b.normal.head<2>().normalized().dot(arm)) - planned;
}

// The worse seen of two sides; null where they are seen alike.
const Side* LesserOf(const Side& a, const Side& b) {
  if (std::abs(a.z_max - b.z_max) > kHigher_m) return a.z_max < b.z_max ? &a : &b;
  if (a.area > kMuchLarger * b.area) return &b;
  return b.area > kMuchLarger * a.area ? &a : nullptr;
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

void DropLowFronts(const AGraph& plan, const std::vector<Patch>& patches, AssignedFaces& assigned) {
  const std::map<int, Side> sides = Sides(patches, assigned);
  for (const auto& [key, side] : sides) {
    const auto other = sides.find(key ^ 1);
    if (key % 2 != 0 || other == sides.end()) continue;
    const size_t a = side.patches.front(), b = other->second.patches.front();
    const auto face = [&](size_t i) -> const Surface& { return plan.surfaces[assigned[i].front().surface.index()]; };
    if (Thicker_m(patches[a], face(a), patches[b], face(b)) <= kMaxThicker_m) continue;
    if (const Side* lesser = LesserOf(side, other->second)) {
      for (const size_t i : lesser->patches) assigned[i].clear();
    }
  }
}

}  // namespace plumb::runtime
