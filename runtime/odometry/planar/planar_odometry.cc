#include "runtime/odometry/planar/planar_odometry.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "runtime/odometry/leveling.h"
#include "runtime/odometry/planar/planar_registration.h"
#include "runtime/odometry/planar/submap.h"

namespace plumb::runtime {
namespace {

using GivenMotion = Odometry::GivenMotion;

constexpr double kKeyscan_m = 0.25, kKeyscan_rad = 0.2;     // a scan joins the map after moving this far
constexpr size_t kMaxKeyscans = 60;
constexpr size_t kMinFirstPoints = 40;
constexpr double kMinShare = 0.65;                          // of likelihood that a pose found must explain; less: look further
constexpr int kMaxWidenings = 2;
constexpr double kWidening = 2.5;
constexpr double kSureMotion_m = 0.05, kSureTurn_rad = 0.02;  // a prior within this at three sigma needs no search
constexpr double kMaxWindow_m = 3.0, kMaxWindow_rad = 1.2;
constexpr double kKnownGroundShare = 0.35;                  // of a scan's points on lines of the map
constexpr double kSurePrior_m = 0.25, kAgreeSigmas = 2.0;
constexpr int kMinFailures = 3;                             // in a row, ...
constexpr double kMaxLost_s = 1.0;                          // ... for this long: a new map
constexpr double kMaxPrediction_s = 1.0;                    // velocity is not trusted for longer
// One sigma. Wheels slip by a share of the way, and turn the robot on the way.
constexpr double kGivenShare = 0.2, kGivenTurnShare = 0.15, kGivenTurn_radpm = 0.1;
constexpr double kGivenDrift_mprs = 0.05, kGivenDrift_radprs = 0.04;  // and per root of a second
constexpr double kMaxSlip = 5.0, kSlipMemory = 0.7;
constexpr double kAcceleration_mps2 = 1.0, kTurning_radps2 = 1.5;
constexpr double kFloor_m = 0.005, kFloor_rad = 0.003;
constexpr double kMaxGivenSpeed_mps = 30.0;                 // beyond, the given odometry has jumped
constexpr double kDrift_m = 0.003, kDrift_rad = 0.001;      // of a step: what neighbouring scans share beyond points' noise

// Speed in the levelled lidar frame: x, y in m/s, yaw in rad/s.
using Twist2 = Eigen::Vector3d;

Twist2 TwistOf(const Pose2& moved, double dt_s) { return Twist2(moved.t_m.x(), moved.t_m.y(), moved.yaw_rad) / dt_s; }
Pose2 MotionAt(const Twist2& twist, double dt_s) { return {dt_s * twist.head<2>(), dt_s * twist.z()}; }

Eigen::Matrix3d Diagonal(double at_m, double at_rad) { return Eigen::Vector3d(at_m * at_m, at_m * at_m, at_rad * at_rad).asDiagonal(); }

}  // namespace

struct PlanarOdometry::Impl {
  Impl(const OdometryOptions& o, const Eigen::Vector3d& normal) : options(o), leveling(LevelingRotation(normal)), lines(o.range_sigma_m) {}

  struct Keyscan {
    PlanarScan scan;
    Pose2 pose;
  };

  [[nodiscard]] Pose2 Planar(const Eigen::Isometry3d& moved) const;
  [[nodiscard]] PlanarPrior Predict(double stamp_s, const std::optional<GivenMotion>& given) const;
  [[nodiscard]] Pose2 DuringSweep(double sweep_s, const std::optional<GivenMotion>& given) const;
  [[nodiscard]] PlanarRegistrationOptions Registration(const Pose2& during, double sweep_s, bool given) const;
  [[nodiscard]] PlanarRegistration Align(const PlanarScan& scan, const PlanarPrior& prior, const PlanarRegistrationOptions& registration);
  [[nodiscard]] std::vector<PlacedScan> Placed() const;
  void AddToMap(PlanarScan scan, const Pose2& at);
  void Learn(const PlanarPrior& prior, const Pose2& at, double dt_s, const Pose2& during, double sweep_s);
  [[nodiscard]] static bool IsCredible(const PlanarRegistration& aligned, const PlanarPrior& prior);
  [[nodiscard]] bool IsNewGround(const Pose2& at) const;
  [[nodiscard]] PlanarScan Swept(const PreparedScan& prepared, const Pose2& during) const;
  // Returns the motion during the sweep.
  [[nodiscard]] Pose2 Track(const PreparedScan& prepared, const std::optional<GivenMotion>& given, OdometryResult* result);

  OdometryOptions options;
  Eigen::Matrix3d leveling;
  std::deque<Keyscan> keyscans;
  LineMap lines;
  std::optional<LikelihoodGrid> grid;  // of the keyscans; made when a search needs it
  bool started = false;
  int failures = 0;
  double found_s = 0;  // stamp of the last scan that was placed
  // Of the last scan.
  double stamp_s = 0;
  Pose2 pose;
  double sigma_m = 0, sigma_rad = 0;  // grown over scans that were not placed
  Twist2 twist = Twist2::Zero();      // during the last sweep, or without times the last step
  double slip = 1;  // how many times its usual sigma the prior was lately off
  std::optional<GivenMotion> last_given;
};

// A motion of the lidar as one of its levelled frame.
Pose2 PlanarOdometry::Impl::Planar(const Eigen::Isometry3d& moved) const {
  const Eigen::Matrix3d R = leveling * moved.linear() * leveling.transpose();
  return {(leveling * moved.translation()).head<2>(), std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1))};
}

PlanarPrior PlanarOdometry::Impl::Predict(double next_stamp_s, const std::optional<GivenMotion>& given) const {
  PlanarPrior prior;
  const double dt_s = std::max(next_stamp_s - stamp_s, 0.0);
  prior.sigma_m = kFloor_m;
  prior.sigma_rad = kFloor_rad;
  // A given odometry that jumps between two sweeps was restarted: its step says nothing.
  const bool continues =
      given && last_given &&
      (last_given->T_start.translation() - given->T_start.translation()).norm() <= kMaxGivenSpeed_mps * std::max(dt_s, 0.1);
  if (continues) {
    const Pose2 moved = Planar(last_given->T_start.inverse() * given->T_start);
    prior.mean = pose * moved;
    prior.sigma_m += slip * (kGivenShare * moved.t_m.norm() + kGivenDrift_mprs * std::sqrt(dt_s));
    prior.sigma_rad +=
        slip * (kGivenTurnShare * std::abs(moved.yaw_rad) + kGivenTurn_radpm * moved.t_m.norm() + kGivenDrift_radprs * std::sqrt(dt_s));
  } else {
    const double used_s = std::min(dt_s, kMaxPrediction_s);
    prior.mean = pose * MotionAt(twist, used_s);
    prior.sigma_m += kAcceleration_mps2 * dt_s * dt_s;
    prior.sigma_rad += kTurning_radps2 * dt_s * dt_s;
  }
  prior.sigma_m = std::hypot(prior.sigma_m, sigma_m);
  prior.sigma_rad = std::hypot(prior.sigma_rad, sigma_rad);
  return prior;
}

// During a sweep, as far as it is known beforehand.
Pose2 PlanarOdometry::Impl::DuringSweep(double sweep_s, const std::optional<GivenMotion>& given) const {
  if (sweep_s <= 0) return {};
  if (given) return Planar(given->T_start.inverse() * given->T_end);
  return MotionAt(twist, sweep_s);
}

std::vector<PlacedScan> PlanarOdometry::Impl::Placed() const {
  std::vector<PlacedScan> placed;
  placed.reserve(keyscans.size());
  for (const Keyscan& keyscan : keyscans) placed.push_back({&keyscan.scan, keyscan.pose});
  return placed;
}

void PlanarOdometry::Impl::AddToMap(PlanarScan scan, const Pose2& at) {
  keyscans.push_back({std::move(scan), at});
  if (keyscans.size() > kMaxKeyscans) keyscans.pop_front();
  lines = LinesOf(Placed(), options.range_sigma_m);
  grid.reset();
}

PlanarRegistrationOptions PlanarOdometry::Impl::Registration(const Pose2& during, double sweep_s, bool given) const {
  PlanarRegistrationOptions registration;
  registration.max_iterations = options.max_iterations;
  registration.sigma_m = options.range_sigma_m;
  registration.initial_kernel_m = 0.1;
  if (sweep_s > 0) {
    registration.sweep_sigma_m = kFloor_m + (given ? kGivenShare * during.t_m.norm() : kAcceleration_mps2 * sweep_s * sweep_s);
    registration.sweep_sigma_rad = kFloor_rad + (given ? kGivenTurnShare * std::abs(during.yaw_rad) : kTurning_radps2 * sweep_s * sweep_s);
  }
  return registration;
}

PlanarRegistration PlanarOdometry::Impl::Align(const PlanarScan& scan, const PlanarPrior& prior,
                                               const PlanarRegistrationOptions& registration) {
  SearchWindow window{std::min(3 * prior.sigma_m, kMaxWindow_m), std::min(3 * prior.sigma_rad, kMaxWindow_rad)};
  if (window.half_m < kSureMotion_m && window.half_rad < kSureTurn_rad) {
    PlanarRegistration aligned = RegisterPlanar(scan, lines, prior.mean, prior, registration);
    if (aligned.ok) return aligned;
  }
  if (!grid) grid = GridOf(Placed(), pose.t_m);
  const std::vector<Eigen::Vector2d> points = SearchPoints(scan);
  SearchResult found = grid->Search(points, prior, window);
  for (int i = 0; i < kMaxWidenings && found.share < kMinShare; ++i) {
    window = {std::min(std::max(kWidening * window.half_m, 0.3), kMaxWindow_m),
              std::min(std::max(kWidening * window.half_rad, 0.2), kMaxWindow_rad)};
    found = grid->Search(points, prior, window);
  }
  return RegisterPlanar(scan, lines, found.pose, prior, registration);
}

// Speed, slip and confidence after a scan that was placed.
void PlanarOdometry::Impl::Learn(const PlanarPrior& prior, const Pose2& at, double dt_s, const Pose2& during, double sweep_s) {
  if (sweep_s > 0) {
    twist = TwistOf(during, sweep_s);
  } else if (dt_s > 1e-3 && failures == 0) {
    twist = TwistOf(Between(pose, at), dt_s);
  }
  const double sigmas2 = ((at.t_m - prior.mean.t_m).squaredNorm() / (prior.sigma_m * prior.sigma_m) +
                          std::pow(WrapYaw(at.yaw_rad - prior.mean.yaw_rad) / prior.sigma_rad, 2)) / 3;
  slip = std::clamp(slip * std::sqrt(kSlipMemory + (1 - kSlipMemory) * sigmas2), 1.0, kMaxSlip);
  sigma_m = sigma_rad = 0;
  failures = 0;
}

bool PlanarOdometry::Impl::IsNewGround(const Pose2& at) const {
  if (keyscans.empty()) return true;
  const Pose2 moved = Between(keyscans.back().pose, at);
  return moved.t_m.norm() >= kKeyscan_m || std::abs(moved.yaw_rad) >= kKeyscan_rad;
}

// A scan of which little is on the map, as through a door, fits in many places: only a prior that knows the place can say which.
bool PlanarOdometry::Impl::IsCredible(const PlanarRegistration& aligned, const PlanarPrior& prior) {
  if (aligned.inlier_share >= kKnownGroundShare) return true;
  return prior.sigma_m <= kSurePrior_m && (aligned.pose.t_m - prior.mean.t_m).norm() <= kAgreeSigmas * prior.sigma_m &&
         std::abs(WrapYaw(aligned.pose.yaw_rad - prior.mean.yaw_rad)) <= kAgreeSigmas * prior.sigma_rad;
}

PlanarScan PlanarOdometry::Impl::Swept(const PreparedScan& prepared, const Pose2& during) const {
  return MakePlanarScan(prepared, leveling, {Pose2(), during}, options.range_sigma_m);
}

Pose2 PlanarOdometry::Impl::Track(const PreparedScan& prepared, const std::optional<GivenMotion>& given, OdometryResult* result) {
  const double next_stamp_s = prepared.scan.stamp_s, dt_s = next_stamp_s - stamp_s;
  const PlanarPrior prior = Predict(next_stamp_s, given);
  Pose2 during = DuringSweep(prepared.sweep_s, given);
  PlanarScan scan = Swept(prepared, during);
  const bool too_few = scan.size() < kMinFirstPoints;
  PlanarRegistration aligned = Align(scan, prior, Registration(during, prepared.sweep_s, given.has_value()));
  aligned.ok = aligned.ok && IsCredible(aligned, prior);
  if (aligned.ok && prepared.sweep_s > 0) {
    during = {during.t_m + aligned.sweep_correction.t_m, during.yaw_rad + aligned.sweep_correction.yaw_rad};
    scan = Swept(prepared, during);
  }
  const Pose2 next = aligned.ok ? aligned.pose : prior.mean;
  Eigen::Matrix3d odom_to_last = Eigen::Matrix3d::Identity();
  odom_to_last.topLeftCorner<2, 2>() = pose.Rotation().transpose();
  const Eigen::Matrix3d covariance = aligned.ok ? aligned.covariance : Diagonal(prior.sigma_m, prior.sigma_rad);
  result->step_covariance = odom_to_last * covariance * odom_to_last.transpose() + Diagonal(kDrift_m, kDrift_rad);
  if (aligned.ok) {
    Learn(prior, next, dt_s, during, prepared.sweep_s);
    found_s = next_stamp_s;
  } else {
    failures += too_few ? 0 : 1;
    sigma_m = prior.sigma_m;
    sigma_rad = prior.sigma_rad;
  }
  result->restarted = failures >= kMinFailures && next_stamp_s - found_s >= kMaxLost_s;
  if (result->restarted) {
    keyscans.clear();
    failures = 0;
    sigma_m = sigma_rad = 0;
    found_s = next_stamp_s;
  }
  pose = next;
  if (result->restarted || (aligned.ok && IsNewGround(next))) AddToMap(std::move(scan), next);
  result->ok = aligned.ok;
  result->iterations = aligned.iterations;
  result->num_inliers = aligned.num_inliers;
  result->rms_m = aligned.rms_m;
  return during;
}

PlanarOdometry::PlanarOdometry(const OdometryOptions& options, const Eigen::Vector3d& normal)
    : impl_(std::make_unique<Impl>(options, normal)) {}
PlanarOdometry::~PlanarOdometry() = default;

OdometryResult PlanarOdometry::Register(const PreparedScan& prepared, const std::optional<GivenMotion>& given) {
  Impl& s = *impl_;
  OdometryResult result;
  result.planar = true;
  result.timed = prepared.sweep_s > 0;
  const double stamp_s = prepared.scan.stamp_s;
  Pose2 during;
  if (s.started) {
    during = s.Track(prepared, given, &result);
  } else {
    during = s.DuringSweep(prepared.sweep_s, given);
    PlanarScan scan = s.Swept(prepared, during);
    result.ok = s.started = scan.size() >= kMinFirstPoints;
    s.found_s = stamp_s;
    if (result.ok) s.AddToMap(std::move(scan), s.pose);
  }
  s.stamp_s = stamp_s;
  s.last_given = given;
  const Eigen::Isometry3d T_start = LeveledPose{s.pose, s.leveling, 0}.Lifted(),
                          T_end = LeveledPose{s.pose * during, s.leveling, 0}.Lifted();
  result.T_odom_lidar = T_start;
  result.deskewed = Deskew(prepared, {T_start, T_end});
  return result;
}

}  // namespace plumb::runtime
