#include "runtime/odometry/odometry.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/odometry/level_motion.h"
#include "runtime/odometry/leveling.h"
#include "runtime/odometry/motion_prediction.h"
#include "runtime/odometry/planar/planar_odometry.h"
#include "runtime/odometry/planar/planar_scan.h"
#include "runtime/odometry/registration.h"
#include "runtime/odometry/scan_preparation.h"
#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {
namespace {

constexpr double kMaxTilt_rad = 0.6109;   // the sensor starts this near to what is expected
constexpr double kLevelingVoxel_m = 1.0;  // wide enough for two rings on the floor
constexpr int kLevelingTries = 20;        // scans after the first: while the map is small
constexpr double kToldLevel_m = 0.01;     // sigma of what was climbed in the first sweep, if up was told, not seen
constexpr int kMinFirstPoints = 200;
constexpr int kMaxFailures = 10;     // in a row, scans without points not counted; then a new map begins at the predicted pose
constexpr double kLeastShare = 0.4;  // of what the last scan found on the map, the next finds so much; less is another place
// Of the usual share of inliers among matched points: below the first a scan may be misplaced, below the second it is.
constexpr double kDoubtfulRatio = 0.9, kLeastRatio = 0.75;
constexpr double kRatioMemory = 0.1;  // weight of the newest scan in that usual share
constexpr double kSureGap_s = 0.25;   // after longer gaps the robot may have turned any way
constexpr size_t kSearchPoints = 800;
constexpr std::array<double, 7> kSearchYaw_rad = {0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6};
constexpr double kMaxGivenSpeed_mps = 30.0;  // beyond, the given odometry has jumped
constexpr double kPlanarSpacing_m = 0.04;    // of a planar laser's few points
constexpr double kScanPoints = 4000;         // of a thinned scan: in a small room tilt and height rest on how many lie on it
constexpr double kFinest = 0.3;              // of scan_spacing_m
constexpr double kMeanDepth_m = 0.1;         // of the returns that become one point of it
constexpr double kBootstrapSpeed_mps = 0.03, kBootstrapTurn_radps = 0.03;

}  // namespace

std::string OdometryOptions::Check() const {
  const auto bad = [](const char* field, auto value, const char* rule) {
    return fmt::format("OdometryOptions.{} = {}; must be {}", field, value, rule);
  };
  if (!(voxel_m >= 0.1 && voxel_m <= 5)) return bad("voxel_m", voxel_m, "in [0.1, 5]");
  if (!(up_in_lidar.allFinite() && up_in_lidar.norm() > 0.1)) return "OdometryOptions.up_in_lidar; must be a direction";
  if (!(scan_spacing_m >= 0.01 && scan_spacing_m <= 2)) return bad("scan_spacing_m", scan_spacing_m, "in [0.01, 2]");
  if (!(range_sigma_m >= 0.001 && range_sigma_m <= 0.2)) return bad("range_sigma_m", range_sigma_m, "in [0.001, 0.2]");
  if (!(min_range_m > 0)) return bad("min_range_m", min_range_m, "> 0");
  if (!(max_range_m > min_range_m)) return bad("max_range_m", max_range_m, "> min_range_m");
  if (max_iterations < 1) return bad("max_iterations", max_iterations, ">= 1");
  if (max_voxels < 1000) return bad("max_voxels", max_voxels, ">= 1000");
  return {};
}

struct Odometry::Impl {
  explicit Impl(const OdometryOptions& o) : options(o), map(MapOptions(o)) {}

  static SurfelMapOptions MapOptions(const OdometryOptions& o) {
    SurfelMapOptions m;
    m.voxel_m = o.voxel_m;
    m.range_sigma_m = o.range_sigma_m;
    m.max_rms_m = 1.75 * o.range_sigma_m;
    m.min_minor_m = 2 * o.range_sigma_m;
    m.max_voxels = static_cast<size_t>(o.max_voxels);
    return m;
  }

  [[nodiscard]] PreparedScan Prepare(const Scan& scan);
  [[nodiscard]] std::optional<Eigen::Vector3d> UpAtStart(const PreparedScan& prepared) const;
  [[nodiscard]] Eigen::Vector3d SupposedUp(const std::optional<GivenMotion>& given) const;
  void Start(const PreparedScan& prepared, const std::optional<GivenMotion>& given);
  [[nodiscard]] SweepPrior PriorAbout(const SweepGaussian& predicted, double stamp_s, double sweep_s, bool given) const;
  [[nodiscard]] RegistrationResult Align(const PreparedScan& prepared, const SweepPrior& prior, double gap_s) const;
  [[nodiscard]] RegistrationOptions Fine() const;
  [[nodiscard]] RegistrationResult Search(const PreparedScan& prepared, const SweepPrior& prior, bool headings) const;
  RegistrationResult Fitted(const PreparedScan& prepared, const SweepPrior& prior, double gap_s);
  void RestartWithVelocity(const PreparedScan& second, const SweepPrior& prior, RegistrationResult* aligned);
  void Insert(const PreparedScan& prepared, const SweepMotion& motion);
  void Advance(const PreparedScan& prepared, const RegistrationResult& aligned, const std::optional<GivenMotion>& given);
  void LearnLevel(const RegistrationResult& aligned);
  // Along which climbing dies out: an axis that was only told may lean, and the robot drives along it then.
  [[nodiscard]] std::optional<Eigen::Vector3d> up() const { return leveled ? std::optional(level.up()) : std::nullopt; }
  void LearnPredictionError(const SweepMotion& predicted, const SweepMotion& actual);

  OdometryOptions options;
  std::optional<PlanarOdometry> planar;  // of a planar laser; then nothing below is used
  SurfelMap map;
  std::optional<PreparedScan> first;  // until the second scan tells how fast the first one moved
  bool started = false;
  double spacing_m = options.scan_spacing_m;  // that the next scan is thinned to
  // Until the map shows which way is up, z of odometry's frame, which was told, is taken for it. The frame itself never turns.
  LevelMotion level{Eigen::Vector3d::UnitZ()};
  bool leveled = false;
  int leveling_tries = 0;
  int failures = 0;  // in a row: nothing says where the robot went meanwhile
  int misfits = 0;   // of these, scans with enough points: the map is not of this place
  EstimatedSweep last;
  double found_share = 0;              // of the last registered scan's points that lay on the map
  double usual_ratio = 0;              // of points near a plane of the map, those that lie on it: running mean of registered scans
  double prediction_error2_m2 = 0.04;  // running mean square of what predictions move points by, wrongly
};

namespace {

using GivenMotion = Odometry::GivenMotion;

// The given odometry, if its motion over the sweep is one.
std::optional<GivenMotion> Plausible(const std::optional<GivenMotion>& given, double sweep_s) {
  if (!given || !given->T_start.matrix().allFinite() || !given->T_end.matrix().allFinite()) return std::nullopt;
  const double moved_m = (given->T_end.translation() - given->T_start.translation()).norm();
  if (moved_m > kMaxGivenSpeed_mps * std::max(sweep_s, 0.1)) return std::nullopt;
  return given;
}

}  // namespace

void Odometry::Impl::Insert(const PreparedScan& prepared, const SweepMotion& at) {
  const SweepPoses poses(at);
  for (const SweepPoint& point : prepared.points) map.Insert(poses.Apply(point.p, point.s), poses.Position(point.s));
  map.EndScan();
}

// What keeps about kScanPoints, judged by the scan before.
PreparedScan Odometry::Impl::Prepare(const Scan& scan) {
  PreparedScan prepared = PrepareScan(scan, spacing_m, options.min_range_m, options.max_range_m, kMeanDepth_m);
  if (prepared.points.size() < kMinFirstPoints) return prepared;
  const double used_m = spacing_m, ratio = static_cast<double>(prepared.points.size()) / kScanPoints;
  spacing_m = std::clamp(used_m * std::sqrt(ratio), kFinest * options.scan_spacing_m, options.scan_spacing_m);
  if (!started && spacing_m < used_m) prepared = PrepareScan(scan, spacing_m, options.min_range_m, options.max_range_m, kMeanDepth_m);
  return prepared;
}

// In the lidar's frame.
std::optional<Eigen::Vector3d> Odometry::Impl::UpAtStart(const PreparedScan& prepared) const {
  SurfelMapOptions coarse = map.options();
  coarse.voxel_m = kLevelingVoxel_m;
  coarse.max_points = std::numeric_limits<double>::infinity();
  SurfelMap around(coarse);
  for (const Eigen::Vector3f& p : prepared.scan.points) around.Insert(p.cast<double>(), Eigen::Vector3d::Zero());
  around.EndScan();
  return FindUp(around, options.up_in_lidar.normalized(), kMaxTilt_rad);
}

// Where nothing that is seen tells. A given odometry may have any start frame: it counts if it says about what is expected.
Eigen::Vector3d Odometry::Impl::SupposedUp(const std::optional<GivenMotion>& given) const {
  const Eigen::Vector3d expected = options.up_in_lidar.normalized();
  if (!given) return expected;
  const Eigen::Vector3d told = given->T_start.linear().transpose() * Eigen::Vector3d::UnitZ();
  return told.dot(expected) >= std::cos(kMaxTilt_rad) ? told : expected;
}

void Odometry::Impl::Start(const PreparedScan& prepared, const std::optional<GivenMotion>& given) {
  last = {};
  SweepMotion& motion = last.motion;
  last.stamp_s = prepared.scan.stamp_s;
  last.sweep_s = prepared.sweep_s;
  last.covariance.bottomRightCorner<6, 6>().diagonal() << Eigen::Vector3d::Constant(0.05 * 0.05), Eigen::Vector3d::Constant(0.1 * 0.1);
  const std::optional<Eigen::Vector3d> up = UpAtStart(prepared);
  motion.T_start.linear() = LevelingRotation(up ? *up : SupposedUp(given));
  leveled = up.has_value();
  last.covariance(11, 11) = leveled ? 0 : kToldLevel_m * kToldLevel_m;
  motion.T_end = motion.T_start;
  if (given && prepared.sweep_s > 0) {
    motion.T_end = motion.T_start * given->T_start.inverse() * given->T_end;
    last.twist = TwistBetween(motion.T_start, motion.T_end, prepared.sweep_s);
  }
  Insert(prepared, motion);
  first = prepared;
  last.given = given;
  started = true;
}

SweepPrior Odometry::Impl::PriorAbout(const SweepGaussian& predicted, double stamp_s, double sweep_s, bool given) const {
  SweepPrior prior{predicted, std::nullopt, Eigen::Vector3d::UnitZ()};
  if (given) return prior;
  prior.level = level.Restrict(predicted, last, stamp_s, sweep_s);
  prior.up = level.up();
  return prior;
}

RegistrationOptions Odometry::Impl::Fine() const {
  RegistrationOptions registration;
  registration.max_iterations = options.max_iterations;
  registration.range_sigma_m = options.range_sigma_m;
  return registration;
}

RegistrationResult Odometry::Impl::Align(const PreparedScan& prepared, const SweepPrior& prior, double gap_s) const {
  const double expected_m = 3 * std::sqrt(prediction_error2_m2);
  const bool unsure = failures > 0 || gap_s > kSureGap_s || expected_m > 0.5 * options.voxel_m;
  if (unsure) return Search(prepared, prior, gap_s > kSureGap_s || failures > 0);
  RegistrationOptions registration = Fine();
  registration.initial_kernel_m = std::clamp(expected_m, 0.1, options.voxel_m);
  return RegisterSweep(prepared.points, prepared.sweep_s > 0, map, prior, registration);
}

// Starts from several headings, since registration finds home only from some ten degrees, on few points; then from the best on all.
RegistrationResult Odometry::Impl::Search(const PreparedScan& prepared, const SweepPrior& prior, bool headings) const {
  RegistrationOptions coarse = Fine();
  coarse.initial_kernel_m = 2 * options.voxel_m;
  coarse.search_neighbours = true;
  std::vector<SweepPoint> few;
  const size_t step = prepared.points.size() / kSearchPoints + 1;
  for (size_t i = 0; i < prepared.points.size(); i += step) few.push_back(prepared.points[i]);
  SweepPrior best = prior;
  int most = -1;
  for (const double yaw_rad : kSearchYaw_rad) {
    if (yaw_rad != 0 && !headings) break;
    const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
    SweepMotion motion = prior.mean;
    motion.T_start.linear() = turn * prior.mean.T_start.linear();
    motion.T_end = motion.T_start * prior.mean.T_start.inverse() * prior.mean.T_end;
    SweepPrior turned = prior;
    turned.MoveTo(motion);
    const RegistrationResult r = RegisterSweep(few, prepared.sweep_s > 0, map, turned, coarse);
    if (r.num_inliers <= most) continue;
    most = r.num_inliers;
    best.MoveTo(r.motion);
  }
  RegistrationOptions fine = Fine();
  fine.initial_kernel_m = 0.5 * options.voxel_m;
  return RegisterSweep(prepared.points, prepared.sweep_s > 0, map, best, fine);
}

// The first scan went into the map as if the robot had stood still. Now that its velocity is known, begin again without that blur.
void Odometry::Impl::RestartWithVelocity(const PreparedScan& second, const SweepPrior& prior, RegistrationResult* aligned) {
  if (first->sweep_s <= 0 || second.sweep_s <= 0) return;
  const Twist measured = TwistBetween(aligned->motion.T_start, aligned->motion.T_end, second.sweep_s);
  if (measured.v_mps.norm() < kBootstrapSpeed_mps && measured.w_radps.norm() < kBootstrapTurn_radps) return;
  last.twist = measured;
  last.motion.T_end = Advanced(last.motion.T_start, last.twist, last.sweep_s, up());
  SweepGaussian better = prior;
  better.mean.T_start = Advanced(last.motion.T_start, last.twist, second.scan.stamp_s - last.stamp_s, up());
  better.mean.T_end = Advanced(better.mean.T_start, last.twist, second.sweep_s, up());
  map = SurfelMap(map.options());
  Insert(*first, last.motion);
  const RegistrationResult again = Align(second, PriorAbout(better, second.scan.stamp_s, second.sweep_s, last.given.has_value()), 0);
  if (again.ok) *aligned = again;
}

// A scan in its place, or where it was predicted if nothing says that it fits there.
RegistrationResult Odometry::Impl::Fitted(const PreparedScan& prepared, const SweepPrior& prior, double gap_s) {
  RegistrationResult aligned = Align(prepared, prior, gap_s);
  if (aligned.ok && aligned.inlier_ratio < kDoubtfulRatio * usual_ratio) {
    const RegistrationResult again = Search(prepared, prior, true);
    if (again.ok && again.num_inliers > aligned.num_inliers) aligned = again;
  }
  if (aligned.ok && first) RestartWithVelocity(prepared, prior, &aligned);
  const double found = prepared.points.empty() ? 0 : static_cast<double>(aligned.num_inliers) / static_cast<double>(prepared.points.size());
  // A floor, a ceiling and some wall or other are found anywhere; and a misplaced scan crosses the planes that it is near. Once in the map
  // it would draw the next ones after it.
  aligned.ok = aligned.ok && found >= kLeastShare * found_share && aligned.inlier_ratio >= kLeastRatio * usual_ratio;
  if (!aligned.ok) {
    aligned.motion = prior.mean;
    aligned.covariance = prior.covariance;
    return aligned;
  }
  found_share = found;
  usual_ratio += (usual_ratio > 0 ? kRatioMemory : 1) * (aligned.inlier_ratio - usual_ratio);
  return aligned;
}

// Which way is up, if the first scan did not show it, the map may show soon.
void Odometry::Impl::LearnLevel(const RegistrationResult& aligned) {
  if (!leveled && leveling_tries < kLevelingTries) {
    ++leveling_tries;
    const std::optional<Eigen::Vector3d> up = FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad);
    leveled = up.has_value();
    if (leveled) level.SetUp(*up);
  }
  level.Learn(aligned.motion.T_start, aligned.covariance.topLeftCorner<3, 3>());
}

void Odometry::Impl::LearnPredictionError(const SweepMotion& predicted, const SweepMotion& actual) {
  constexpr double kMemory = 0.8, kRange_m = 5.0;
  double worst_m = 0;
  for (const auto& [a, b] : {std::pair{predicted.T_start, actual.T_start}, std::pair{predicted.T_end, actual.T_end}}) {
    const Eigen::Isometry3d off = a.inverse() * b;
    worst_m = std::max(worst_m, off.translation().norm() + kRange_m * RotationAngle(off));
  }
  prediction_error2_m2 = kMemory * prediction_error2_m2 + (1 - kMemory) * worst_m * worst_m;
}

void Odometry::Impl::Advance(const PreparedScan& prepared, const RegistrationResult& aligned, const std::optional<GivenMotion>& given) {
  const double dt_s = prepared.scan.stamp_s - last.stamp_s;
  if (prepared.sweep_s > 0) {
    last.twist = TwistBetween(aligned.motion.T_start, aligned.motion.T_end, prepared.sweep_s);
  } else if (dt_s > 1e-3) {
    last.twist = TwistBetween(last.motion.T_start, aligned.motion.T_start, dt_s);
  }
  last = {prepared.scan.stamp_s, prepared.sweep_s, aligned.motion, aligned.covariance, last.twist, given};
}

Odometry::Odometry(const OdometryOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Odometry::~Odometry() = default;

OdometryResult Odometry::Register(const Scan& scan, const std::optional<GivenMotion>& given_motion) {
  Impl& s = *impl_;
  OdometryResult result;
  if (!s.started && !s.planar) {
    if (const std::optional<Eigen::Vector3d> normal = ScanPlaneNormal(scan)) s.planar.emplace(s.options, *normal);
  }
  const PreparedScan prepared =
      s.planar ? PrepareScan(scan, std::min(kPlanarSpacing_m, s.options.scan_spacing_m), s.options.min_range_m, s.options.max_range_m)
               : s.Prepare(scan);
  const std::optional<GivenMotion> given = Plausible(given_motion, prepared.sweep_s);
  if (s.planar) return s.planar->Register(prepared, given);
  result.timed = prepared.sweep_s > 0;
  const bool too_few = static_cast<int>(prepared.points.size()) < kMinFirstPoints;
  if (!s.started) {
    if (!too_few) s.Start(prepared, given);
    result.ok = !too_few;
  } else {
    const SweepPrior prior = s.PriorAbout(PredictSweep(s.last, scan.stamp_s, prepared.sweep_s, given, s.up()), scan.stamp_s,
                                          prepared.sweep_s, given.has_value());
    const double gap_s = scan.stamp_s - s.last.stamp_s - s.last.sweep_s;
    const RegistrationResult aligned = s.Fitted(prepared, prior, gap_s);
    s.failures = aligned.ok ? 0 : s.failures + 1;
    if (aligned.ok && !s.first) s.LearnPredictionError(prior.mean, aligned.motion);
    if (!too_few) s.misfits = aligned.ok ? 0 : s.misfits + 1;
    result.restarted = s.misfits >= kMaxFailures;
    if (result.restarted) {
      s.map = SurfelMap(s.map.options());
      s.misfits = s.failures = 0;
      s.found_share = s.usual_ratio = 0;
    }
    if (aligned.ok || result.restarted) s.Insert(prepared, aligned.motion);
    if (aligned.ok) s.LearnLevel(aligned);
    s.first.reset();  // `last` is the first scan's only until now
    s.Advance(prepared, aligned, given);
    result.ok = aligned.ok;
    result.iterations = aligned.iterations;
    result.num_inliers = aligned.num_inliers;
    result.rms_m = aligned.rms_m;
  }
  result.T_odom_lidar = s.last.motion.T_start;
  result.deskewed = Deskew(prepared, s.last.motion);
  return result;
}

}  // namespace plumb::runtime
