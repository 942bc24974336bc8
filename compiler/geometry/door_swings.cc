#include "compiler/geometry/door_swings.h"

#include <algorithm>
#include <cmath>

namespace plumb::compiler {
namespace {

constexpr double kMinLeaf_m = 0.3;
constexpr double kMinShare = 0.2, kMaxShare = 1.2;  // of the door's width; frames are counted in or not
constexpr double kClosed = 0.85;                    // cosine between a closed leaf and the door
constexpr double kOpen = 0.4;                       // sine of one that stands open

}  // namespace

std::optional<FramedLeaf> LeafOfSwing(const Eigen::Vector2d& hinge, const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                                      double door_width_m) {
  Eigen::Vector2d closed = start - hinge, open = end - hinge;
  const double radius_m = closed.norm();
  if (radius_m < kMinLeaf_m || std::abs(open.norm() - radius_m) > 0.02 * radius_m) return std::nullopt;
  if (door_width_m > 0 && (radius_m < kMinShare * door_width_m || radius_m > kMaxShare * door_width_m)) return std::nullopt;
  if (std::abs(open.x()) > std::abs(closed.x())) std::swap(open, closed);
  if (std::abs(closed.x()) < kClosed * radius_m || std::abs(open.y()) < kOpen * radius_m) return std::nullopt;
  return FramedLeaf{LeafOperation::kSwing, closed.x() > 0 ? -1 : 1, open.y() > 0 ? 1 : -1, radius_m};
}

std::vector<FramedLeaf> OnePerJamb(std::span<const FramedLeaf> swings, double door_width_m) {
  std::vector<FramedLeaf> out;
  double width_m = 0;
  for (const int at_x : {-1, 1}) {
    FramedLeaf leaf;
    bool to_low = false, to_high = false;
    for (const FramedLeaf& s : swings) {
      if (s.at_x != at_x) continue;
      (s.opens_to_y < 0 ? to_low : to_high) = true;
      if (s.width_m > leaf.width_m) leaf = s;
    }
    if (leaf.at_x == 0) continue;
    if (to_low && to_high) leaf.operation = LeafOperation::kDoubleActing, leaf.opens_to_y = 0;
    width_m += leaf.width_m;
    out.push_back(leaf);
  }
  if (door_width_m > 0 && width_m > kMaxShare * door_width_m) return {};
  return out;
}

}  // namespace plumb::compiler
