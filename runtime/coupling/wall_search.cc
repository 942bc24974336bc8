#include "runtime/coupling/wall_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kMinArea_m2 = 1.0;
constexpr size_t kMinObservations = 2;
constexpr double kMinLength_m = 1.0, kMinOverlapRatio = 0.5;
constexpr double kMinExplained = 0.5;                           // of the patch, by the face
constexpr double kMinReach_m = 1.4;                             // above the face's foot: most furniture that stands alone is lower
constexpr size_t kMinLines = 20;                                // that end on it, and that go through the planned place
constexpr double kMinPassedRatio = 0.6;                         // of those that meet the planned place
constexpr double kBelowTop_m = 0.3;                             // furniture up to a ceiling leaves this much
constexpr double kMinClosed = 0.9;                              // of the face's length, if the planned place cannot be seen
constexpr double kMostSeenOff = 3;                              // of the offset where the wall is least off
constexpr double kSameNormal_cos = 0.999, kSamePlane_m = 0.02;  // of faces of one side
constexpr double kRivalNats = 3;                                // a candidate that is better by less is no better
constexpr double kSameOffset_m = 0.15, kSameYaw_rad = 0.1;      // one wall's two faces tell the same to this

struct Found {
  size_t patch;
  FarWall wall;
  double cost_nats;
};

// How the wall would stand if its face were in the patch's plane.
WallDeviation DeviationOf(const Patch& patch, const Face& face, double yaw_rad) {
  const Eigen::Rotation2Dd turn(yaw_rad);
  const Eigen::Vector2d pivot = face.pivot.head<2>(), n = patch.normal.head<2>().normalized(), wall_normal = face.wall_normal.head<2>();
  const Eigen::Vector2d turned = pivot + turn * (face.point.head<2>() - pivot);
  return {n.dot(patch.midpoint() - turned) / n.dot(wall_normal), yaw_rad};
}

// Mean of exp(-x^2 / 2) from a to b: walls turn about any place in them.
double MeanDensity(double a, double b) {
  constexpr double kParallel = 1e-3, kLeast = 1e-30;
  if (std::abs(b - a) < kParallel) return std::max(kLeast, std::exp(-0.5 * a * a));
  const double integral = std::sqrt(0.5 * std::numbers::pi) * (std::erf(b / std::numbers::sqrt2) - std::erf(a / std::numbers::sqrt2));
  return std::max(kLeast, integral / (b - a));
}

// Not only by the margin that what is seen of a face may reach beyond it: the wall may stand as planned in the next room.
bool RunsAlong(const Patch& patch, const Surface& face) {
  const Eigen::Vector2d along = (face.end - face.start).normalized();
  const auto [from, to] = std::minmax({along.dot(patch.start - face.start), along.dot(patch.end - face.start)});
  return from < face.length_m() && to > 0;
}

class Search {
 public:
  Search(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<std::vector<WallOpening>>& openings,
         const SightLines& sight, const CouplingOptions& options)
      : plan_(plan), frames_(frames), openings_(openings), sight_(sight), options_(options) {}

  [[nodiscard]] std::optional<Found> Compare(size_t index, const Patch& patch, const Surface& surface) const {
    if (patch.num_observations < kMinObservations || patch.area < kMinArea_m2 || patch.z_max < surface.z_min_m + kMinReach_m)
      return std::nullopt;
    const Eigen::Vector3d& n = surface.normal;
    const double yaw = std::atan2(n.x() * patch.normal.y() - n.y() * patch.normal.x(), n.head<2>().dot(patch.normal.head<2>()));
    if (std::abs(yaw) > options_.far_yaw_rad) return std::nullopt;
    if (OverlapRatio(patch.z_min, patch.z_max, surface.z_min_m, surface.z_max_m) < options_.min_height_overlap_ratio) return std::nullopt;
    const Eigen::Vector2d along = (surface.end - surface.start).normalized();
    const double a0 = along.dot(patch.start - surface.start), a1 = along.dot(patch.end - surface.start);
    const double from = std::max(0.0, std::min(a0, a1)), to = std::min(surface.length_m(), std::max(a0, a1));
    if (to - from < kMinLength_m || OverlapRatio(std::min(a0, a1), std::max(a0, a1), 0, surface.length_m()) < kMinOverlapRatio)
      return std::nullopt;
    const std::vector<const Surface*> side = SideOf(surface);
    double explained = 0;
    for (const Surface* face : side) explained += ExplainedRatio(patch, *face);
    explained = std::min(1.0, explained);  // each with its margins
    if (explained < kMinExplained) return std::nullopt;
    // Gated where the wall is least off: a long one that is turned is off by more than a metre away from there.
    const auto [a, b] = EndOffsets_m(patch, surface);
    if (a * b > 0 && std::min(std::abs(a), std::abs(b)) > options_.far_offset_m) return std::nullopt;
    // What is seen farther off than that is not this wall's, however the two lines cross.
    const Eigen::Vector2d seen_at = 0.5 * (patch.start + patch.end);
    if (std::abs(n.head<2>().dot(seen_at - surface.start)) > kMostSeenOff * options_.far_offset_m) return std::nullopt;
    const WallDeviation deviation = DeviationOf(patch, MakeFace(frames_[surface.wall.index()], surface), yaw);
    if (!IsProven(patch, surface, side, to - from)) return std::nullopt;
    const double yaw_sigmas = yaw / options_.yaw_tau1_rad;
    return Found{index,
                 {surface.wall, deviation},
                 0.5 * yaw_sigmas * yaw_sigmas - std::log(MeanDensity(a / options_.offset_tau1_m, b / options_.offset_tau1_m) * explained)};
  }

 private:
  // How far the ends of the whole wall would be off along the surface's normal.
  [[nodiscard]] std::pair<double, double> EndOffsets_m(const Patch& patch, const Surface& surface) const {
    const Wall& wall = plan_.walls[surface.wall.index()];
    const Eigen::Vector2d along = (surface.end - surface.start).normalized(), n = surface.normal.head<2>();
    const Eigen::Vector2d step = (patch.end - patch.start) / along.dot(patch.end - patch.start);
    const auto offset_m = [&](const Eigen::Vector2d& at) {
      return n.dot(patch.start + along.dot(at - patch.start) * step - surface.start);
    };
    return {offset_m(wall.axis_start), offset_m(wall.axis_end)};
  }

  // Rooms divide one side of a wall into faces, and a patch may run along several.
  [[nodiscard]] std::vector<const Surface*> SideOf(const Surface& surface) const {
    std::vector<const Surface*> out;
    for (const Surface& s : plan_.surfaces) {
      const bool same = s.wall == surface.wall && s.storey == surface.storey && !s.arc && s.normal.dot(surface.normal) > kSameNormal_cos;
      if (same && std::abs(surface.normal.head<2>().dot(s.start - surface.start)) < kSamePlane_m) out.push_back(&s);
    }
    return out;
  }

  [[nodiscard]] bool IsProven(const Patch& patch, const Surface& surface, const std::vector<const Surface*>& side, double overlap_m) const {
    const std::vector<WallOpening>& openings = openings_[surface.wall.index()];
    SightLines::Count here, planned;
    const auto add = [&](const SightLines::Count& more, SightLines::Count& sum) {
      sum.ended += more.ended;
      sum.passed += more.passed;
    };
    for (const Surface* face : side) {
      if (!RunsAlong(patch, *face)) continue;
      if (IsSeenThrough(patch, *face, openings, sight_)) return false;
      add(sight_.Meeting({patch.midpoint(), patch.normal.head<2>().normalized(), face, &openings}), here);
      add(sight_.Meeting({face->midpoint(), face->normal.head<2>().normalized(), face, &openings}), planned);
    }
    if (here.ended < kMinLines) return false;
    if (planned.passed >= kMinLines &&
        static_cast<double>(planned.passed) >= kMinPassedRatio * static_cast<double>(planned.passed + planned.ended))
      return true;
    const bool closes = overlap_m >= kMinClosed * surface.length_m() && patch.z_max >= surface.z_max_m - kBelowTop_m;
    return closes && here.passed == 0 && planned.passed + planned.ended == 0;
  }

  const AGraph& plan_;
  const std::vector<WallFrame>& frames_;
  const std::vector<std::vector<WallOpening>>& openings_;
  const SightLines& sight_;
  const CouplingOptions& options_;
};

bool IsSame(const WallDeviation& a, const WallDeviation& b) {
  return std::abs(a.offset_m - b.offset_m) < kSameOffset_m && std::abs(a.yaw_rad - b.yaw_rad) < kSameYaw_rad;
}

// Could the patch as well be of another wall, or the wall stand elsewhere?
bool HasRival(const Found& f, const std::vector<Found>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Found& g) {
    if (g.cost_nats > f.cost_nats + kRivalNats) return false;
    if (g.wall.wall == f.wall.wall) return !IsSame(g.wall.deviation, f.wall.deviation);
    return g.patch == f.patch;
  });
}

}  // namespace

std::vector<FarWall> FindFarWalls(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Patch>& unmatched,
                                  const std::vector<bool>& matched, const std::vector<std::vector<WallOpening>>& openings,
                                  const SightLines& sight, const CouplingOptions& options) {
  const Search search(plan, frames, openings, sight, options);
  std::vector<Found> found;
  for (const Surface& surface : plan.surfaces) {
    if (!surface.wall.valid() || matched[surface.wall.index()] || !IsFace(frames[surface.wall.index()], surface)) continue;
    for (size_t i = 0; i < unmatched.size(); ++i) {
      if (auto f = search.Compare(i, unmatched[i], surface)) found.push_back(*f);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.cost_nats < b.cost_nats; });
  std::vector<FarWall> out;
  for (const Found& f : found) {
    const bool known = std::any_of(out.begin(), out.end(), [&](const FarWall& w) { return w.wall == f.wall.wall; });
    if (!known && !HasRival(f, found)) out.push_back(f.wall);
  }
  std::sort(out.begin(), out.end(), [](const FarWall& a, const FarWall& b) { return a.wall < b.wall; });
  return out;
}

}  // namespace plumb::runtime
