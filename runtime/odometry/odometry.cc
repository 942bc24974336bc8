#include "runtime/odometry/odometry.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/odometry/leveling.h"
#include "runtime/odometry/planar/planar_odometry.h"
#include "runtime/odometry/planar/planar_scan.h"
#include "runtime/odometry/registration.h"
#include "runtime/odometry/scan_preparation.h"
#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {
namespace {

constexpr double kMaxTilt_rad = 0.1745;         // the sensor starts this upright
constexpr double kLevelingVoxel_m = 1.0;        // wide enough for two rings on the floor
constexpr int kMinFirstPoints = 200;
constexpr int kMaxFailures = 10;                // in a row, scans without points not counted; then a new map begins at the predicted pose
constexpr double kLeastShare = 0.4;             // of what the last scan found on the map, the next finds so much; less is another place
constexpr double kSureGap_s = 0.25;             // after longer gaps the robot may have turned any way
constexpr size_t kSearchPoints = 800;
constexpr std::array<double, 7> kSearchYaw_rad = {0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6};
constexpr double kMaxPrediction_s = 1.0;        // velocity is not trusted for longer
// Of a robot or a walking person, one sigma; less in tilt.
const Eigen::Vector3d kAcceleration_mps2(3.0, 3.0, 1.0), kTurning_radps2(1.5, 1.5, 6.0);
// Hardly any up and down where no floor or ceiling measures it: in a small room, what noise in the walls' normals says of the height would soon
// add up to decimetres.
const Eigen::Vector3d kLevelAcceleration_mps2(3.0, 3.0, 0.05);
constexpr double kGivenScaleSigma = 0.1;        // a given odometry's relative error
constexpr double kMaxGivenSpeed_mps = 30.0;     // beyond, the given odometry has jumped
constexpr double kVerticalDamping = 0.5;        // robots move along the floor: climbing at this rate dies out where no plane measures it
constexpr double kPlanarSpacing_m = 0.04;       // of a planar laser's few points
constexpr double kBootstrapSpeed_mps = 0.03, kBootstrapTurn_radps = 0.03;

struct Twist {
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero(), w_radps = Eigen::Vector3d::Zero();  // lidar frame
};

Twist TwistBetween(const Eigen::Isometry3d& T_0, const Eigen::Isometry3d& T_1, double dt_s) {
  const Eigen::Isometry3d T = T_0.inverse() * T_1;
  return {T.translation() / dt_s, LogSo3(T.linear()) / dt_s};
}

Eigen::Isometry3d Advanced(const Eigen::Isometry3d& T, const Twist& twist, double dt_s, bool upright) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = ExpSo3(twist.w_radps * dt_s);
  motion.translation() = twist.v_mps * dt_s;
  Eigen::Isometry3d out = T * motion;
  if (upright) out.translation().z() = T.translation().z() + kVerticalDamping * (out.translation().z() - T.translation().z());
  return out;
}

double RotationAngle(const Eigen::Isometry3d& T) { return LogSo3(T.linear()).norm(); }

constexpr double kFloor_m = 0.003, kFloorVertical_m = 0.0005, kFloor_rad = 0.002;  // least sigma of any prediction: a sweep is not exactly linear in time

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Matrix6d DiagonalCovariance(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  Vector6d variances;
  variances << rotation_rad.array().square(), translation_m.array().square();
  return variances.asDiagonal();
}

// What speeding up or braking adds to a motion over dt_s that is predicted from one over earlier_s.
Matrix6d CoastingCovariance(double dt_s, double earlier_s, bool level) {
  const double product_s2 = std::abs(dt_s) * std::max(std::abs(dt_s), earlier_s);
  return DiagonalCovariance((kTurning_radps2 * product_s2).array() + kFloor_rad,
                            (level ? kLevelAcceleration_mps2 : kAcceleration_mps2) * product_s2 +
                                Eigen::Vector3d(kFloor_m, kFloor_m, level ? kFloorVertical_m : kFloor_m));
}

Matrix6d GivenCovariance(const Eigen::Isometry3d& moved) {
  return DiagonalCovariance(Eigen::Vector3d::Constant(kFloor_rad + kGivenScaleSigma * RotationAngle(moved)),
                            Eigen::Vector3d::Constant(kFloor_m + kGivenScaleSigma * moved.translation().norm()));
}

}  // namespace

std::string OdometryOptions::Check() const {
  const auto bad = [](const char* field, auto value, const char* rule) { return fmt::format("OdometryOptions.{} = {}; must be {}", field, value, rule); };
  if (!(voxel_m >= 0.1 && voxel_m <= 5)) return bad("voxel_m", voxel_m, "in [0.1, 5]");
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

  void Start(const PreparedScan& prepared, const std::optional<GivenMotion>& given);
  [[nodiscard]] SweepPrior Predict(double stamp_s, double sweep_s, const std::optional<GivenMotion>& given) const;
  [[nodiscard]] RegistrationResult Align(const PreparedScan& prepared, const SweepPrior& prior, double gap_s) const;
  [[nodiscard]] RegistrationResult Search(const PreparedScan& prepared, const SweepPrior& prior, const RegistrationOptions& registration,
                                          bool headings) const;
  void RestartWithVelocity(const PreparedScan& second, const SweepPrior& prior, RegistrationResult* aligned);
  void Insert(const PreparedScan& prepared, const SweepMotion& motion);
  void Advance(const PreparedScan& prepared, const RegistrationResult& aligned, const std::optional<GivenMotion>& given);
  void LearnPredictionError(const SweepMotion& predicted, const SweepMotion& actual);

  OdometryOptions options;
  std::optional<PlanarOdometry> planar;  // of a planar laser; then nothing below is used
  SurfelMap map;
  std::optional<PreparedScan> first;  // until the second scan tells how fast the first one moved
  bool started = false;
  bool upright = false;     // z of the odometry's frame is up; else it is the sensor's own axis, which may lie
  int failures = 0;         // in a row: nothing says where the robot went meanwhile
  int misfits = 0;          // of these, scans with enough points: the map is not of this place
  // Of the last scan.
  double stamp_s = 0, sweep_s = 0;
  SweepMotion motion;
  Matrix12d covariance = Matrix12d::Zero();  // of `motion`'s start and motion during the sweep
  Twist twist;
  std::optional<GivenMotion> last_given;
  double found_share = 0;   // of the last registered scan's points that lay on the map
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

void Odometry::Impl::Start(const PreparedScan& prepared, const std::optional<GivenMotion>& given) {
  SurfelMapOptions coarse = map.options();
  coarse.voxel_m = kLevelingVoxel_m;
  coarse.max_points = std::numeric_limits<double>::infinity();
  SurfelMap around(coarse);
  for (const Eigen::Vector3f& p : prepared.scan.points) around.Insert(p.cast<double>(), Eigen::Vector3d::Zero());
  around.EndScan();
  motion = {};
  const std::optional<Eigen::Vector3d> up = FindUp(around, kMaxTilt_rad);
  upright = up.has_value();
  if (up) motion.T_start.linear() = LevelingRotation(*up);
  motion.T_end = motion.T_start;
  sweep_s = prepared.sweep_s;
  covariance.bottomRightCorner<6, 6>() = DiagonalCovariance(Eigen::Vector3d::Constant(0.05), Eigen::Vector3d::Constant(0.1));
  if (given) {
    motion.T_end = motion.T_start * given->T_start.inverse() * given->T_end;
    if (sweep_s > 0) twist = TwistBetween(motion.T_start, motion.T_end, sweep_s);
  }
  if (sweep_s <= 0) motion.T_end = motion.T_start;
  Insert(prepared, motion);
  first = prepared;
  stamp_s = prepared.scan.stamp_s;
  last_given = given;
  started = true;
}

SweepPrior Odometry::Impl::Predict(double next_stamp_s, double next_sweep_s, const std::optional<GivenMotion>& given) const {
  SweepPrior prior;
  const double gap_s = std::clamp(next_stamp_s - stamp_s - sweep_s, -sweep_s, kMaxPrediction_s);
  // The next start and motion, given the last ones' increments: start' = d + (1 + gap / sweep) e, motion' = (sweep' / sweep) e.
  Matrix12d F = Matrix12d::Zero(), Q = Matrix12d::Zero(), Q_level = Matrix12d::Zero();
  F.topLeftCorner<6, 6>().setIdentity();
  if (sweep_s > 0) F.topRightCorner<6, 6>().setIdentity();
  // A given odometry that jumps between two sweeps was restarted: its step says nothing.
  const bool continues = given && last_given && (last_given->T_end.translation() - given->T_start.translation()).norm() <=
                                                    kMaxGivenSpeed_mps * std::max(next_stamp_s - stamp_s - sweep_s, 0.1);
  if (continues) {
    const Eigen::Isometry3d moved = last_given->T_end.inverse() * given->T_start;
    prior.mean.T_start = motion.T_end * moved;
    Q.topLeftCorner<6, 6>() = Q_level.topLeftCorner<6, 6>() = GivenCovariance(moved);
  } else {
    prior.mean.T_start = Advanced(motion.T_end, twist, gap_s, upright);
    Q.topLeftCorner<6, 6>() = CoastingCovariance(gap_s, 0, false);
    Q_level.topLeftCorner<6, 6>() = CoastingCovariance(gap_s, 0, true);
    if (sweep_s > 0) F.topRightCorner<6, 6>() *= 1 + gap_s / sweep_s;
  }
  if (given) {
    const Eigen::Isometry3d moved = given->T_start.inverse() * given->T_end;
    prior.mean.T_end = prior.mean.T_start * moved;
    Q.bottomRightCorner<6, 6>() = Q_level.bottomRightCorner<6, 6>() = GivenCovariance(moved);
  } else {
    prior.mean.T_end = Advanced(prior.mean.T_start, twist, next_sweep_s, upright);
    Q.bottomRightCorner<6, 6>() = CoastingCovariance(next_sweep_s, sweep_s, false);
    Q_level.bottomRightCorner<6, 6>() = CoastingCovariance(next_sweep_s, sweep_s, true);
    if (sweep_s > 0) F.bottomRightCorner<6, 6>() = next_sweep_s / sweep_s * Matrix6d::Identity();
  }
  if (next_sweep_s <= 0) prior.mean.T_end = prior.mean.T_start;
  prior.covariance = F * covariance * F.transpose() + Q;
  if (upright) prior.level_covariance = prior.covariance - Q + Q_level;
  return prior;
}

RegistrationResult Odometry::Impl::Align(const PreparedScan& prepared, const SweepPrior& prior, double gap_s) const {
  RegistrationOptions registration;
  registration.max_iterations = options.max_iterations;
  registration.range_sigma_m = options.range_sigma_m;
  const double expected_m = 3 * std::sqrt(prediction_error2_m2);
  const bool unsure = failures > 0 || gap_s > kSureGap_s || expected_m > 0.5 * options.voxel_m;
  if (!unsure) {
    registration.initial_kernel_m = std::clamp(expected_m, 0.1, options.voxel_m);
    return RegisterSweep(prepared.points, prepared.sweep_s > 0, map, prior, registration);
  }
  registration.initial_kernel_m = 2 * options.voxel_m;
  registration.search_neighbours = true;
  return Search(prepared, prior, registration, gap_s > kSureGap_s || failures > 0);
}

// Starts from several headings, since registration finds home only from some ten degrees, on few points; then from the best on all.
RegistrationResult Odometry::Impl::Search(const PreparedScan& prepared, const SweepPrior& prior, const RegistrationOptions& registration,
                                          bool headings) const {
  std::vector<SweepPoint> few;
  const size_t step = prepared.points.size() / kSearchPoints + 1;
  for (size_t i = 0; i < prepared.points.size(); i += step) few.push_back(prepared.points[i]);
  SweepPrior best = prior;
  int most = -1;
  for (const double yaw_rad : kSearchYaw_rad) {
    if (yaw_rad != 0 && !headings) break;
    SweepPrior turned = prior;
    const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
    turned.mean.T_start.linear() = turn * prior.mean.T_start.linear();
    turned.mean.T_end = turned.mean.T_start * prior.mean.T_start.inverse() * prior.mean.T_end;
    const RegistrationResult r = RegisterSweep(few, prepared.sweep_s > 0, map, turned, registration);
    if (r.num_inliers <= most) continue;
    most = r.num_inliers;
    best.mean = r.motion;
  }
  RegistrationOptions fine = registration;
  fine.search_neighbours = false;
  fine.initial_kernel_m = 0.5 * options.voxel_m;
  return RegisterSweep(prepared.points, prepared.sweep_s > 0, map, best, fine);
}

// The first scan went into the map as if the robot had stood still. Now that its velocity is known, begin again without that blur.
void Odometry::Impl::RestartWithVelocity(const PreparedScan& second, const SweepPrior& prior, RegistrationResult* aligned) {
  if (first->sweep_s <= 0 || second.sweep_s <= 0) return;
  const Twist measured = TwistBetween(aligned->motion.T_start, aligned->motion.T_end, second.sweep_s);
  if (measured.v_mps.norm() < kBootstrapSpeed_mps && measured.w_radps.norm() < kBootstrapTurn_radps) return;
  SweepPrior better = prior;
  twist = measured;
  motion.T_end = Advanced(motion.T_start, twist, sweep_s, upright);
  better.mean.T_start = Advanced(motion.T_start, twist, second.scan.stamp_s - stamp_s, upright);
  better.mean.T_end = Advanced(better.mean.T_start, twist, second.sweep_s, upright);
  map = SurfelMap(map.options());
  Insert(*first, motion);
  const RegistrationResult again = Align(second, better, 0);
  if (again.ok) *aligned = again;
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
  const double dt_s = prepared.scan.stamp_s - stamp_s;
  if (prepared.sweep_s > 0) {
    twist = TwistBetween(aligned.motion.T_start, aligned.motion.T_end, prepared.sweep_s);
  } else if (dt_s > 1e-3) {
    twist = TwistBetween(motion.T_start, aligned.motion.T_start, dt_s);
  }
  motion = aligned.motion;
  covariance = aligned.covariance;
  stamp_s = prepared.scan.stamp_s;
  sweep_s = prepared.sweep_s;
  last_given = given;
}

Odometry::Odometry(const OdometryOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Odometry::~Odometry() = default;

OdometryResult Odometry::Register(const Scan& scan, const std::optional<GivenMotion>& given_motion) {
  Impl& s = *impl_;
  OdometryResult result;
  if (!s.started && !s.planar) {
    if (const std::optional<Eigen::Vector3d> normal = ScanPlaneNormal(scan)) s.planar.emplace(s.options, *normal);
  }
  const double spacing_m = s.planar ? std::min(kPlanarSpacing_m, s.options.scan_spacing_m) : s.options.scan_spacing_m;
  const PreparedScan prepared = PrepareScan(scan, spacing_m, s.options.min_range_m, s.options.max_range_m);
  const std::optional<GivenMotion> given = Plausible(given_motion, prepared.sweep_s);
  if (s.planar) return s.planar->Register(prepared, given);
  result.timed = prepared.sweep_s > 0;
  const bool too_few = static_cast<int>(prepared.points.size()) < kMinFirstPoints;
  if (!s.started) {
    if (!too_few) s.Start(prepared, given);
    result.ok = !too_few;
  } else {
    const SweepPrior prior = s.Predict(scan.stamp_s, prepared.sweep_s, given);
    const double gap_s = scan.stamp_s - s.stamp_s - s.sweep_s;
    RegistrationResult aligned = s.Align(prepared, prior, gap_s);
    if (aligned.ok && s.first) s.RestartWithVelocity(prepared, prior, &aligned);
    const double found = prepared.points.empty() ? 0 : static_cast<double>(aligned.num_inliers) / static_cast<double>(prepared.points.size());
    // A floor, a ceiling and some wall or other are found anywhere.
    aligned.ok = aligned.ok && found >= kLeastShare * s.found_share;
    if (aligned.ok) s.found_share = found;
    if (!aligned.ok) {
      aligned.motion = prior.mean;
      aligned.covariance = prior.covariance;
    }
    s.failures = aligned.ok ? 0 : s.failures + 1;
    if (aligned.ok && !s.first) s.LearnPredictionError(prior.mean, aligned.motion);
    if (!too_few) s.misfits = aligned.ok ? 0 : s.misfits + 1;
    result.restarted = s.misfits >= kMaxFailures;
    if (result.restarted) {
      s.map = SurfelMap(s.map.options());
      s.misfits = s.failures = 0;
      s.found_share = 0;
    }
    if (aligned.ok || result.restarted) s.Insert(prepared, aligned.motion);
    s.first.reset();  // `motion` is the first scan's only until now
    s.Advance(prepared, aligned, given);
    result.ok = aligned.ok;
    result.iterations = aligned.iterations;
    result.num_inliers = aligned.num_inliers;
    result.rms_m = aligned.rms_m;
  }
  result.T_odom_lidar = s.motion.T_start;
  result.deskewed = Deskew(prepared, s.motion);
  return result;
}

}  // namespace plumb::runtime
