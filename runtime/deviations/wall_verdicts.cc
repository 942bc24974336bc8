#include "runtime/deviations/wall_verdicts.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

// P(chi-square with 2 dof > that of the wall's deviation).
double PValue(const WallEstimate& wall, const DeviationOptions& options) {
  Eigen::Matrix2d s = wall.evidence.covariance;
  s(0, 0) += options.tolerance_offset_m * options.tolerance_offset_m;
  s(1, 1) += options.tolerance_yaw_rad * options.tolerance_yaw_rad;
  const Eigen::Vector2d& e = wall.evidence.measured;
  return std::exp(-0.5 * e.dot(s.inverse() * e));
}

// What the evidence says where it says it best, along the wall: far from where a wall was seen its offset hangs on its turn.
struct BestKnown {
  double offset_m = 0;
  Eigen::Vector2d gain = Eigen::Vector2d::UnitX();  // of (offset_m, yaw_rad)
};
BestKnown WhereKnownBest(const WallEvidence& evidence) {
  BestKnown out;
  if (evidence.covariance(1, 1) > 0) out.gain.y() = -evidence.covariance(0, 1) / evidence.covariance(1, 1);
  out.offset_m = out.gain.dot(evidence.measured);
  return out;
}

// What a room has of boxes stands in front of its walls: behind the planned face it would not be seen if the wall stood there.
bool StandsBehind(const AGraph& plan, const std::vector<WallFrame>& frames, const WallEstimate& wall, const BestKnown& best,
                  const DeviationOptions& options) {
  if (wall.seen.empty()) return false;
  const auto most = std::max_element(wall.seen.begin(), wall.seen.end(),
                                     [](const SeenSurface& a, const SeenSurface& b) { return a.observed_m2 < b.observed_m2; });
  const double side = MakeFace(frames[wall.wall.index()], plan.surfaces[most->surface.index()]).side();
  return side * best.offset_m < -2 * std::sqrt(TestVariance_m2(wall, best.gain, options));
}

// Which hypotheses are rejected at the given false discovery rate.
std::vector<bool> BenjaminiHochberg(const std::vector<double>& p_values, double rate) {
  std::vector<double> sorted = p_values;
  std::sort(sorted.begin(), sorted.end());
  double threshold = -1;
  for (size_t k = 0; k < sorted.size(); ++k) {
    if (sorted[k] <= rate * static_cast<double>(k + 1) / static_cast<double>(sorted.size())) threshold = sorted[k];
  }
  std::vector<bool> rejected;
  for (double p : p_values) rejected.push_back(p <= threshold);
  return rejected;
}

// `rejected`: by Benjamini-Hochberg.
WallVerdict VerdictOn(const AGraph& plan, const std::vector<WallFrame>& frames, const WallEstimate& w, bool rejected,
                      const DeviationOptions& options) {
  const bool large = std::abs(w.deviation.offset_m) >= options.min_offset_m || std::abs(w.deviation.yaw_rad) >= options.min_yaw_rad;
  const double variance_m2 = TestVariance_m2(w, Eigen::Vector2d::UnitX(), options), two_sigma_m = 2 * std::sqrt(variance_m2);
  const bool testable = MinimalDetectable_m(variance_m2) <= options.max_mdb_m;
  if (rejected && large && w.p_deviated >= options.min_p_deviated) {
    // A turn read off a short piece of a wall that may stand anywhere is no finding.
    const BestKnown best = WhereKnownBest(w.evidence);
    const bool placed = testable || std::abs(best.offset_m) > 2 * std::sqrt(TestVariance_m2(w, best.gain, options));
    const bool a_box = std::abs(w.deviation.yaw_rad) >= options.turned_rad && w.observed_m2 < options.min_turned_m2 &&
                       w.span_m < options.min_turned_m && !StandsBehind(plan, frames, w, best, options);
    // Nor is one that stands farther off than it was seen long: its like stands anywhere.
    const bool known_again = w.span_m >= std::abs(best.offset_m);
    if (a_box || !known_again) return {SurfaceStatus::kUnobserved, Unjudged::kMayBeFurniture};
    if (placed) return {SurfaceStatus::kDeviated, Unjudged::kNone};
    return {SurfaceStatus::kUnobserved, Unjudged::kUncertain};
  }
  // Nor is a wall as planned whose evidence alone says that it is not, or that is more likely not to be.
  if (w.p_deviated > options.max_p_as_planned || (rejected && large)) return {SurfaceStatus::kUnobserved, Unjudged::kUndecided};
  const bool tested = testable && std::abs(w.evidence.measured.x()) + two_sigma_m <= options.max_undecided_m;
  if (!tested) return {SurfaceStatus::kUnobserved, Unjudged::kUncertain};
  return {SurfaceStatus::kAsPlanned, Unjudged::kNone};
}

}  // namespace

double MinimalDetectable_m(double variance_m2) {
  constexpr double kNoncentrality = 17.1;
  return std::sqrt(kNoncentrality * variance_m2);
}

double TestVariance_m2(const WallEstimate& wall, const Eigen::Vector2d& gain, const DeviationOptions& options) {
  return gain.dot(wall.evidence.covariance * gain) + wall.place_sigma_m * wall.place_sigma_m +
         options.tolerance_offset_m * options.tolerance_offset_m;
}

std::vector<WallVerdict> JudgeWalls(const AGraph& plan, const std::vector<WallFrame>& frames, const JointResult& estimate,
                                    const DeviationOptions& options) {
  // Without covariances nothing can be tested, and untested is not "as planned".
  if (!estimate.covariances_exact)
    return std::vector<WallVerdict>(estimate.walls.size(), {SurfaceStatus::kUnobserved, Unjudged::kNoCovariance});
  std::vector<WallVerdict> verdicts(estimate.walls.size(), {SurfaceStatus::kUnobserved, Unjudged::kSeenTooLittle});
  std::vector<size_t> observed;
  std::vector<double> p_values;
  for (size_t i = 0; i < estimate.walls.size(); ++i) {
    if (estimate.walls[i].observed_m2 < options.min_observed_m2) continue;
    observed.push_back(i);
    p_values.push_back(PValue(estimate.walls[i], options));
  }
  const std::vector<bool> rejected = BenjaminiHochberg(p_values, options.false_discovery_rate);
  for (size_t k = 0; k < observed.size(); ++k) {
    verdicts[observed[k]] = VerdictOn(plan, frames, estimate.walls[observed[k]], rejected[k], options);
  }
  return verdicts;
}

}  // namespace plumb::runtime
