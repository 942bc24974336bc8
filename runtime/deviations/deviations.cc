#include "runtime/deviations/deviations.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/room_deviation.h"

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

// Of a displacement with that variance (alpha 0.1 %, power 80 %, one degree of freedom).
double MinimalDetectable_m(double variance_m2) {
  constexpr double kNoncentrality = 17.1;
  return std::sqrt(kNoncentrality * variance_m2);
}

double TestVariance_m2(const WallEstimate& wall, const Eigen::Vector2d& gain, const DeviationOptions& options) {
  return gain.dot(wall.evidence.covariance * gain) + wall.place_sigma_m * wall.place_sigma_m +
         options.tolerance_offset_m * options.tolerance_offset_m;
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

std::vector<SurfaceStatus> WallStatuses(const AGraph& plan, const std::vector<WallFrame>& frames, const JointResult& estimate,
                                        const DeviationOptions& options) {
  std::vector<SurfaceStatus> statuses(estimate.walls.size(), SurfaceStatus::kUnobserved);
  if (!estimate.covariances_exact) return statuses;  // without them nothing can be tested, and untested is not "as planned"
  std::vector<size_t> observed;
  std::vector<double> p_values;
  for (size_t i = 0; i < estimate.walls.size(); ++i) {
    if (estimate.walls[i].observed_m2 < options.min_observed_m2) continue;
    observed.push_back(i);
    p_values.push_back(PValue(estimate.walls[i], options));
  }
  const std::vector<bool> rejected = BenjaminiHochberg(p_values, options.false_discovery_rate);
  for (size_t k = 0; k < observed.size(); ++k) {
    const WallEstimate& w = estimate.walls[observed[k]];
    const bool large = std::abs(w.deviation.offset_m) >= options.min_offset_m || std::abs(w.deviation.yaw_rad) >= options.min_yaw_rad;
    const double variance_m2 = TestVariance_m2(w, Eigen::Vector2d::UnitX(), options), two_sigma_m = 2 * std::sqrt(variance_m2);
    const double measured_m = std::abs(w.evidence.measured.x());
    const bool testable = MinimalDetectable_m(variance_m2) <= options.max_mdb_m;
    // A turn read off a short piece of a wall that may stand anywhere is no finding.
    const BestKnown best = WhereKnownBest(w.evidence);
    const bool placed = testable || std::abs(best.offset_m) > 2 * std::sqrt(TestVariance_m2(w, best.gain, options));
    const bool a_box = std::abs(w.deviation.yaw_rad) >= options.turned_rad && w.observed_m2 < options.min_turned_m2 &&
                       w.span_m < options.min_turned_m && !StandsBehind(plan, frames, w, best, options);
    // Nor is one that stands farther off than it was seen long: its like stands anywhere.
    const bool known_again = w.span_m >= std::abs(best.offset_m);
    const bool deviated = rejected[k] && large && w.p_deviated >= options.min_p_deviated && placed && !a_box && known_again;
    // Nor is a wall as planned whose evidence alone says that it is not, or that is more likely not to be.
    const bool tested = testable && measured_m + two_sigma_m <= options.max_undecided_m && !(rejected[k] && large) &&
                        w.p_deviated <= options.max_p_as_planned;
    statuses[observed[k]] = deviated ? SurfaceStatus::kDeviated : tested ? SurfaceStatus::kAsPlanned : SurfaceStatus::kUnobserved;
  }
  return statuses;
}

SurfaceDeviation DeviationOfFace(const Face& face, const WallEstimate& wall, const DeviationOptions& options) {
  const double parameters[kNumWallParameters] = {wall.deviation.offset_m, wall.deviation.yaw_rad, wall.tilt_rad, wall.thickness_error_m};
  Plane built;
  BuiltPlane(face, parameters, &built.n, &built.d);
  const FaceDeviation d = CompareToPlan(face, built);
  // First order: how the displacement at the face's midpoint follows from the wall's parameters. Tilt acts at half height: not at all.
  const Eigen::Vector4d gain(face.wall_normal.dot(face.normal), face.normal.dot(Eigen::Vector3d::UnitZ().cross(face.point - face.pivot)), 0,
                             0.5);
  SurfaceDeviation out;
  out.translation_m = d.offset_m;
  out.rotation_rad = d.yaw_rad;
  out.tilt_rad = d.tilt_rad;
  out.sigma_translation_m = std::sqrt(std::max(0.0, gain.dot(wall.cov_all * gain)));
  out.sigma_rotation_rad = std::sqrt(std::max(0.0, wall.cov(1, 1)));
  out.p_deviated = wall.p_deviated;
  out.mdb_m = MinimalDetectable_m(TestVariance_m2(wall, gain.head<2>(), options));
  return out;
}

// Doorways that deviate from where a wall would have them that is not believed itself.
void LeaveOutDoubtful(const AGraph& plan, const std::vector<const WallEstimate*>& by_wall, const std::vector<SurfaceStatus>& statuses,
                      const JointResult& estimate, std::vector<DoorwayDeviation>& doorways) {
  for (DoorwayDeviation& d : doorways) {
    const WallId wall = plan.doorways[d.doorway.index()].wall;
    if (d.status != DoorwayStatus::kDeviated || !wall.valid() || !by_wall[wall.index()]) continue;
    const auto at = static_cast<size_t>(by_wall[wall.index()] - estimate.walls.data());
    if (statuses[at] == SurfaceStatus::kUnobserved) d = {.doorway = d.doorway};
  }
}

// A wall that is not there has no deviation, only the evidence that it is not.
void MarkMissing(const AGraph& plan, const WallChanges& changes, DeviationReport& report) {
  for (size_t w = 0; w < changes.presence.size(); ++w) {
    if (!changes.presence[w].missing) continue;
    for (size_t i = 0; i < plan.surfaces.size(); ++i) {
      if (plan.surfaces[i].wall != WallId(w)) continue;
      report.surfaces[i] = {};
      report.surfaces[i].surface = SurfaceId(i);
      report.surfaces[i].status = SurfaceStatus::kMissing;
    }
    for (const FacePresence& face : changes.presence[w].faces) {
      report.surfaces[face.surface.index()].observed_m2 = face.open_m2 + face.closed_m2;
      report.surfaces[face.surface.index()].points = face.lines;
    }
  }
}

// " 3 of 20 seen walls deviate, 1 is missing.", by the surfaces' status.
std::string CountsText(const AGraph& plan, const DeviationReport& report) {
  std::vector<SurfaceStatus> gravest(plan.walls.size(), SurfaceStatus::kUnobserved);
  for (const SurfaceDeviation& d : report.surfaces) {
    const WallId wall = plan.surfaces[d.surface.index()].wall;
    if (wall.valid() && d.status != SurfaceStatus::kUnobserved) gravest[wall.index()] = d.status;
  }
  const auto count = [&](SurfaceStatus status) { return std::count(gravest.begin(), gravest.end(), status); };
  const auto deviated = count(SurfaceStatus::kDeviated), missing = count(SurfaceStatus::kMissing);
  std::string text =
      fmt::format(" {} of {} seen walls {}", deviated, deviated + count(SurfaceStatus::kAsPlanned), deviated == 1 ? "deviates" : "deviate");
  if (missing > 0) text += fmt::format(", {} {} missing", missing, missing == 1 ? "is" : "are");
  return text + ".";
}

}  // namespace

const char* StatusName(SurfaceStatus status) {
  switch (status) {
    case SurfaceStatus::kAsPlanned: return "as_planned";
    case SurfaceStatus::kDeviated: return "deviated";
    case SurfaceStatus::kMissing: return "missing";
    case SurfaceStatus::kUnobserved: break;
  }
  return "unobserved";
}

std::string DeviationOptions::Check() const {
  if (!(false_discovery_rate > 0 && false_discovery_rate < 1)) {
    return fmt::format("DeviationOptions.false_discovery_rate = {}; must be in (0, 1)", false_discovery_rate);
  }
  const std::pair<const char*, double> probabilities[] = {{"min_p_deviated", min_p_deviated}, {"max_p_as_planned", max_p_as_planned}};
  for (const auto& [name, value] : probabilities) {
    if (!(value >= 0 && value <= 1)) return fmt::format("DeviationOptions.{} = {}; must be in [0, 1]", name, value);
  }
  const std::pair<const char*, double> magnitudes[] = {{"tolerance_offset_m", tolerance_offset_m},
                                                       {"tolerance_yaw_rad", tolerance_yaw_rad},
                                                       {"min_offset_m", min_offset_m},
                                                       {"min_yaw_rad", min_yaw_rad},
                                                       {"min_observed_m2", min_observed_m2},
                                                       {"max_mdb_m", max_mdb_m},
                                                       {"max_undecided_m", max_undecided_m},
                                                       {"turned_rad", turned_rad},
                                                       {"min_turned_m2", min_turned_m2},
                                                       {"min_turned_m", min_turned_m}};
  for (const auto& [name, value] : magnitudes) {
    if (!(value >= 0)) return fmt::format("DeviationOptions.{} = {}; must be >= 0", name, value);
  }
  if (std::string fault = presence.Check(); !fault.empty()) return fault;
  if (std::string fault = doorways.Check(); !fault.empty()) return fault;
  return unplanned.Check();
}

DeviationReport AssessDeviations(const AGraph& plan, const JointResult& estimate, const DeviationOptions& options,
                                 const WallChanges& changes) {
  DeviationReport report;
  report.gauge = estimate.gauge;
  report.surfaces.resize(plan.surfaces.size());
  for (size_t i = 0; i < plan.surfaces.size(); ++i) report.surfaces[i].surface = SurfaceId(i);

  const std::vector<WallFrame> frames = WallFrames(plan);
  const std::vector<SurfaceStatus> statuses = WallStatuses(plan, frames, estimate, options);
  std::vector<const WallEstimate*> by_wall(plan.walls.size(), nullptr);
  for (const WallEstimate& w : estimate.walls) by_wall[w.wall.index()] = &w;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& surface = plan.surfaces[i];
    if (!surface.wall.valid() || !by_wall[surface.wall.index()] || !IsFace(frames[surface.wall.index()], surface)) continue;
    const WallEstimate& wall = *by_wall[surface.wall.index()];
    SurfaceDeviation d = DeviationOfFace(MakeFace(frames[surface.wall.index()], surface), wall, options);
    d.surface = SurfaceId(i);
    d.status = statuses[static_cast<size_t>(&wall - estimate.walls.data())];
    const size_t w = surface.wall.index();
    if (d.status == SurfaceStatus::kDeviated && w < changes.on_other_shape.size() && changes.on_other_shape[w]) {
      d.status = SurfaceStatus::kUnobserved;
    }
    for (const SeenSurface& seen : wall.seen) {
      if (seen.surface != d.surface) continue;
      d.observed_m2 = seen.observed_m2;
      d.points = seen.num_points;
    }
    report.surfaces[i] = d;
  }
  MarkMissing(plan, changes, report);
  report.unplanned = changes.unplanned;
  report.doorways = changes.doorways;
  LeaveOutDoubtful(plan, by_wall, statuses, estimate, report.doorways);
  for (size_t i = report.doorways.size(); i < plan.doorways.size(); ++i) report.doorways.push_back({.doorway = DoorwayId(i)});
  if (!report.gauge.empty()) report.gauge += CountsText(plan, report);
  for (size_t r = 0; r < plan.rooms.size(); ++r) report.rooms.push_back(DeviationOfRoom(plan, RoomId(r), report.surfaces, options));
  return report;
}

}  // namespace plumb::runtime
