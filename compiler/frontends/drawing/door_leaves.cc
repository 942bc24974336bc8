#include "compiler/frontends/drawing/door_leaves.h"

#include <cmath>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kAgainst = 0.96;  // cosine between leaves that close against each other

}  // namespace

DoorLeaves::DoorLeaves(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options)
    : drawing_(drawing), options_(options) {
  std::vector<Eigen::AlignedBox2d> tips;
  for (const uint32_t p : symbols) {
    for (const DrawnLeaf& leaf : OfSwings(p)) {
      leaves_.push_back(leaf);
      tips.emplace_back(leaf.tip);
    }
  }
  tips_ = BoxTree<2>(std::move(tips));
}

std::vector<DrawnLeaf> DoorLeaves::OfSwings(uint32_t path) const {
  std::vector<DrawnLeaf> out;
  for (const Arc& arc : drawing_.paths[path].arcs) {
    if (!IsSwing(arc, options_)) continue;
    for (const double at : {arc.start_rad, arc.start_rad + arc.sweep_rad})
      out.push_back({arc.center, arc.center + arc.radius_m * Eigen::Vector2d(std::cos(at), std::sin(at))});
  }
  return out;
}

std::optional<Eigen::Vector2d> DoorLeaves::HingeOfMate(const DrawnLeaf& leaf) const {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kLeavesMeet_m);
  uint32_t mate = kNone;
  tips_.ForEachIn({leaf.tip - reach, leaf.tip + reach}, [&](uint32_t i) {
    const Eigen::Vector2d d = leaves_[i].tip - leaves_[i].hinge;
    if (i < mate && d.normalized().dot((leaf.tip - leaf.hinge).normalized()) < -kAgainst) mate = i;
  });
  return mate == kNone ? std::nullopt : std::optional(leaves_[mate].hinge);
}

std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> DoorLeaves::Closed(uint32_t path) const {
  const DrawnPath& drawn = drawing_.paths[path];
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> out;
  const std::vector<DrawnLeaf> leaves = OfSwings(path);
  for (const DrawnLeaf& leaf : leaves) {
    if (const auto other = HingeOfMate(leaf)) out.emplace_back(leaf.hinge, *other);
  }
  for (const DrawnLeaf& leaf : leaves) out.emplace_back(leaf.hinge, leaf.tip);
  if (drawn.arcs.empty() && !drawn.closed && drawn.points.size() == 2 && drawn.role == LineRole::kDoor)
    out.emplace_back(drawn.points[0], drawn.points[1]);
  return out;
}

}  // namespace plumb::compiler
