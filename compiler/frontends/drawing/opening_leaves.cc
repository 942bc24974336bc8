#include "compiler/frontends/drawing/opening_leaves.h"

#include <algorithm>
#include <cmath>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kMinOpenShare = 0.8;                         // of the door's width, for a line to be its one leaf
constexpr double kMinPairShare = 0.42, kMaxPairShare = 0.58;  // ... one of two
constexpr double kOutOfWall = 0.25;                           // of its length, that an open leaf stands out of the wall's face
constexpr double kMinPanelShare = 0.4, kMaxPanelShare = 0.7;  // of the door's width, that a sliding panel takes
constexpr double kBesides_m = 0.01;                           // between panels that slide past each other
constexpr double kAlong = 0.1;                                // rise of a line along the wall, per length

Eigen::AlignedBox2d ReachOf(const DrawnOpening& door, double slack_m) {
  const Vector2d reach = Vector2d::Constant(0.5 * door.width_m() + 0.5 * door.depth_m + slack_m);
  return {door.middle() - reach, door.middle() + reach};
}

}  // namespace

OpeningLeaves::OpeningLeaves(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options)
    : options_(options) {
  std::vector<Eigen::AlignedBox2d> hinges, boxes;
  for (const uint32_t p : symbols) {
    const DrawnPath& path = drawing.paths[p];
    if (path.role == LineRole::kWindow) continue;
    for (const Arc& arc : path.arcs) {
      if (!IsSwing(arc, options)) continue;
      swings_.push_back(arc);
      hinges.emplace_back(arc.center);
    }
    const size_t sides = path.points.size() < 2 || path.curved ? 0 : path.points.size() - (path.closed ? 0 : 1);
    for (size_t i = 0; i < sides; ++i) {
      strokes_.push_back({path.points[i], path.points[(i + 1) % path.points.size()]});
      Eigen::AlignedBox2d box(strokes_.back().a);
      boxes.push_back(box.extend(strokes_.back().b));
    }
  }
  hinges_ = BoxTree<2>(std::move(hinges));
  stroke_boxes_ = BoxTree<2>(std::move(boxes));
}

std::vector<PlanLeaf> OpeningLeaves::Of(const DrawnOpening& door) const {
  if (door.use != DrawnUse::kDoor) return {};
  std::vector<FramedLeaf> leaves = Swinging(door);
  if (leaves.empty()) leaves = StandingOpen(door);
  if (leaves.empty()) leaves = Sliding(door);
  std::vector<PlanLeaf> out;
  for (const FramedLeaf& l : leaves) out.push_back({l.operation, l.at_x * door.along(), l.opens_to_y * Perp(door.along()), l.width_m});
  return out;
}

bool OpeningLeaves::IsAtJamb(const DrawnOpening& door, const Vector2d& local) const {
  return std::abs(std::abs(local.x()) - 0.5 * door.width_m()) < options_.symbol_slack_m &&
         std::abs(local.y()) < 0.5 * door.depth_m + options_.symbol_slack_m;
}

std::vector<FramedLeaf> OpeningLeaves::Swinging(const DrawnOpening& door) const {
  std::vector<FramedLeaf> found;
  hinges_.ForEachIn(ReachOf(door, options_.symbol_slack_m), [&](uint32_t i) {
    const Arc& arc = swings_[i];
    const Vector2d hinge = door.Local(arc.center);
    if (!IsAtJamb(door, hinge)) return;
    const auto tip = [&](double at_rad) { return door.Local(arc.center + arc.radius_m * Vector2d(std::cos(at_rad), std::sin(at_rad))); };
    const auto leaf = LeafOfSwing(hinge, tip(arc.start_rad), tip(arc.start_rad + arc.sweep_rad), door.width_m());
    // Of two doors side by side, a hinge between them belongs to the one that its leaf closes.
    if (leaf && leaf->at_x * hinge.x() > 0) found.push_back(*leaf);
  });
  return OnePerJamb(found, door.width_m());
}

std::vector<OpeningLeaves::Stroke> OpeningLeaves::StrokesAt(const DrawnOpening& door) const {
  std::vector<uint32_t> near;
  stroke_boxes_.ForEachIn(ReachOf(door, options_.symbol_slack_m), [&](uint32_t i) { near.push_back(i); });
  std::vector<Stroke> out;
  for (const uint32_t i : near) out.push_back({door.Local(strokes_[i].a), door.Local(strokes_[i].b)});
  return out;
}

std::vector<FramedLeaf> OpeningLeaves::StandingOpen(const DrawnOpening& door) const {
  const double width_m = door.width_m();
  std::vector<FramedLeaf> found;
  for (Stroke s : StrokesAt(door)) {
    if (std::abs(s.a.y()) > std::abs(s.b.y())) std::swap(s.a, s.b);
    const Vector2d leaf = s.b - s.a;
    const double length_m = leaf.norm(), share = length_m / width_m;
    const bool stands_out = std::abs(s.b.y()) > 0.5 * door.depth_m + kOutOfWall * length_m && std::abs(leaf.y()) > kOutOfWall * length_m;
    const bool as_long = (share > kMinOpenShare && share < 2 - kMinOpenShare) || (share > kMinPairShare && share < kMaxPairShare);
    if (!IsAtJamb(door, s.a) || !stands_out || !as_long) continue;
    found.push_back({LeafOperation::kSwing, s.a.x() > 0 ? 1 : -1, s.b.y() > 0 ? 1 : -1, length_m});
  }
  std::vector<FramedLeaf> leaves = OnePerJamb(found, width_m);
  if (leaves.size() == 1 && leaves[0].width_m < kMinOpenShare * width_m) leaves.clear();
  return leaves;
}

// A panel in each half of the door, one behind the other; those of two leaves that meet stand in one line.
std::vector<FramedLeaf> OpeningLeaves::Sliding(const DrawnOpening& door) const {
  Eigen::AlignedBox1d low, high;  // where they stand across the wall
  for (const Stroke& s : StrokesAt(door)) {
    const Vector2d d = s.b - s.a, middle = 0.5 * (s.a + s.b);
    const double share = std::abs(d.x()) / door.width_m();
    const bool inside = std::max(std::abs(s.a.x()), std::abs(s.b.x())) < 0.5 * door.width_m() + options_.symbol_slack_m &&
                        std::abs(middle.y()) < 0.5 * door.depth_m + options_.symbol_slack_m;
    if (!inside || std::abs(d.y()) > kAlong * std::abs(d.x()) || share < kMinPanelShare || share > kMaxPanelShare) continue;
    (middle.x() < 0 ? low : high).extend(Eigen::Matrix<double, 1, 1>(middle.y()));
  }
  if (low.isEmpty() || high.isEmpty()) return {};
  const bool apart = low.min().x() > high.max().x() - kBesides_m / 2 || high.min().x() > low.max().x() - kBesides_m / 2;
  if (!apart || std::abs(low.center().x() - high.center().x()) < kBesides_m) return {};
  return {{LeafOperation::kSliding, 0, 0, 0}, {LeafOperation::kSliding, 0, 0, 0}};
}

}  // namespace plumb::compiler
