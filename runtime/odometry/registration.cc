#include "runtime/odometry/registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kInlierSigmas = 3.0;
constexpr double kConverged_m = 1e-4, kConverged_rad = 2e-5;
constexpr double kNormalNoiseMargin = 2.0;
constexpr int kMinInliers = 60;
constexpr double kMinInlierRatio = 0.4, kMinOverlapRatio = 0.1;

// The planes' normal equations, by powers of s: blocks (d,d), (d,e), (e,e) are sums of w s^k a a^T for k = 0, 1, 2.
struct NormalEquations {
  Matrix6d A[3] = {Matrix6d::Zero(), Matrix6d::Zero(), Matrix6d::Zero()};
  Vector6d g[2] = {Vector6d::Zero(), Vector6d::Zero()};
  double weight = 0, weighted_radius2_m2 = 0, weighted_normal_variance = 0;
  int num_matched = 0, num_inliers = 0;
  double inlier_square_sum_m2 = 0;
};

NormalEquations Accumulate(std::span<const SweepPoint> points, const SurfelMap& map, const SweepMotion& motion, double kernel_m,
                           bool neighbours, double range_sigma_m) {
  NormalEquations sum;
  const SweepPoses poses(motion);
  const Eigen::Vector3d center = motion.T_start.translation();
  for (const SweepPoint& point : points) {
    const Eigen::Vector3d q = poses.Apply(point.p, point.s);
    const Surfel* surfel = map.Nearest(q, poses.Position(point.s), neighbours);
    if (surfel == nullptr) continue;
    ++sum.num_matched;
    const PointToPlane e = EvaluatePointToPlane(q, surfel->normal, surfel->mean, center);
    const double variance_m2 = surfel->DistanceVariance(q, range_sigma_m);
    const double square_m2 = e.residual_m * e.residual_m;
    if (square_m2 < kInlierSigmas * kInlierSigmas * variance_m2) {
      ++sum.num_inliers;
      sum.inlier_square_sum_m2 += square_m2;
    }
    const double scale2_m2 = kernel_m * kernel_m * variance_m2 / (range_sigma_m * range_sigma_m);
    const double root = scale2_m2 / (scale2_m2 + square_m2);
    const double w = root * root / variance_m2;
    const Vector6d wa = w * e.jacobian;
    Matrix6d outer;
    outer.noalias() = wa * e.jacobian.transpose();
    sum.A[0] += outer;
    sum.A[1] += point.s * outer;
    sum.A[2] += point.s * point.s * outer;
    sum.g[0] += wa * e.residual_m;
    sum.g[1] += wa * (point.s * e.residual_m);
    sum.weight += w;
    sum.weighted_normal_variance += w * surfel->NormalVariance(range_sigma_m);
    sum.weighted_radius2_m2 += w * (q - center).squaredNorm();
  }
  return sum;
}

// Projector onto the directions of motion that the planes hold. Rotations count by the distance that points move at the mean radius.
Matrix6d HeldDirections(const NormalEquations& sum, double degenerate_ratio) {
  if (sum.weight <= 0) return Matrix6d::Zero();
  const double radius_m = std::max(0.1, std::sqrt(sum.weighted_radius2_m2 / sum.weight));
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1 / radius_m), Eigen::Vector3d::Ones();
  const SymmetricEigen<6> eigen = EigenOf(Matrix6d(scale.asDiagonal() * sum.A[0] * scale.asDiagonal()));
  const double least = std::max(degenerate_ratio * sum.weight, kNormalNoiseMargin * sum.weighted_normal_variance);
  Matrix6d P = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d v = eigen.vectors.col(i);
    if (eigen.values[i] >= least) P += v * v.transpose();
  }
  // Increments x are scale * y with y in the eigenvectors' coordinates.
  return scale.asDiagonal() * P * scale.cwiseInverse().asDiagonal();
}

// What `actual` is off from `mean`: rotation and translation in the common frame.
Vector6d Difference(const Eigen::Isometry3d& actual, const Eigen::Isometry3d& mean) {
  Vector6d d;
  d << LogSo3(actual.linear() * mean.linear().transpose()), actual.translation() - mean.translation();
  return d;
}

struct LinearSystem {
  Matrix12d H;
  Vector12d g;
};

// A prior as the normal equations take it.
struct PriorTerm {
  explicit PriorTerm(const SweepGaussian& prior) : mean(prior.mean), information(prior.covariance.llt().solve(Matrix12d::Identity())) {}

  SweepMotion mean;
  Matrix12d information;
};

LinearSystem WithPrior(const NormalEquations& sum, const Matrix6d& held, const SweepMotion& motion, const PriorTerm& prior,
                       const RegistrationOptions& options) {
  const double share = 1 / options.points_per_independent;
  LinearSystem system;
  const Matrix6d mixed = share * held.transpose() * sum.A[1] * held;
  system.H << share * held.transpose() * sum.A[0] * held, mixed, mixed, share * held.transpose() * sum.A[2] * held;
  system.g << share * held.transpose() * sum.g[0], share * held.transpose() * sum.g[1];
  const Vector6d start = Difference(motion.T_start, prior.mean.T_start);
  Vector12d off;
  off << start, Difference(motion.T_end, prior.mean.T_end) - start;
  system.H += prior.information;
  system.g += prior.information * off;
  return system;
}

// Both priors, of which one counts.
class Priors {
 public:
  explicit Priors(const SweepPrior& prior) : free_(prior), up_(prior.up) {
    if (prior.level) level_.emplace(*prior.level);
  }

  [[nodiscard]] LinearSystem Join(const NormalEquations& sum, const SweepMotion& motion, const RegistrationOptions& options) const {
    const Eigen::Matrix3d by_planes = sum.A[0].bottomRightCorner<3, 3>();
    const bool level = level_ && up_.dot(by_planes * up_) < options.level_ratio * sum.weight;
    return WithPrior(sum, HeldDirections(sum, options.degenerate_ratio), motion, level ? *level_ : free_, options);
  }

 private:
  PriorTerm free_;
  std::optional<PriorTerm> level_;
  Eigen::Vector3d up_;
};

}  // namespace

void SweepPrior::MoveTo(const SweepMotion& motion) {
  mean = motion;
  if (!level) return;
  const double height_m = up.dot(level->mean.T_start.translation());
  level->mean = motion;
  for (Eigen::Isometry3d* T : {&level->mean.T_start, &level->mean.T_end}) T->translation() += (height_m - up.dot(T->translation())) * up;
}

PointToPlane EvaluatePointToPlane(const Eigen::Vector3d& q, const Eigen::Vector3d& normal, const Eigen::Vector3d& mean,
                                  const Eigen::Vector3d& center) {
  PointToPlane e;
  e.residual_m = normal.dot(q - mean);
  e.jacobian << (q - center).cross(normal), normal;
  return e;
}

Eigen::Isometry3d Moved(const Eigen::Isometry3d& T, const Vector6d& increment, const Eigen::Vector3d& center) {
  const Eigen::Matrix3d R = ExpSo3(increment.head<3>());
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.linear() = R * T.linear();
  moved.translation() = R * (T.translation() - center) + center + increment.tail<3>();
  return Orthonormalized(moved);
}

RegistrationResult RegisterSweep(std::span<const SweepPoint> points, bool timed, const SurfelMap& map, const SweepPrior& prior,
                                 const RegistrationOptions& options) {
  RegistrationResult result;
  result.motion = prior.mean;
  const Priors priors(prior);
  const double final_kernel_m = kInlierSigmas * options.range_sigma_m;
  double kernel_m = std::max(options.initial_kernel_m, final_kernel_m);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const bool coarse = kernel_m > 4 * final_kernel_m;
    const NormalEquations sum =
        Accumulate(points, map, result.motion, kernel_m, options.search_neighbours && coarse, options.range_sigma_m);
    const LinearSystem system = priors.Join(sum, result.motion, options);
    const Vector12d step = system.H.ldlt().solve(-system.g);
    if (!step.allFinite()) return result;
    const Eigen::Vector3d center = result.motion.T_start.translation();
    result.motion.T_start = Moved(result.motion.T_start, step.head<6>(), center);
    result.motion.T_end = Moved(result.motion.T_end, step.head<6>() + step.tail<6>(), center);
    if (!timed) result.motion.T_end = result.motion.T_start;
    const bool small = step.head<3>().norm() + step.segment<3>(6).norm() < kConverged_rad &&
                       step.segment<3>(3).norm() + step.tail<3>().norm() < kConverged_m;
    if (small && kernel_m <= final_kernel_m) break;
    kernel_m = std::max(final_kernel_m, 0.5 * kernel_m);
  }
  const NormalEquations last = Accumulate(points, map, result.motion, final_kernel_m, false, options.range_sigma_m);
  result.covariance = priors.Join(last, result.motion, options).H.ldlt().solve(Matrix12d::Identity());
  const Matrix6d held = HeldDirections(last, options.degenerate_ratio);
  result.information = held.transpose() * last.A[0] * held / options.points_per_independent;
  result.num_held = static_cast<int>(std::lround(held.trace()));
  result.num_inliers = last.num_inliers;
  result.inlier_ratio = last.num_matched > 0 ? static_cast<double>(last.num_inliers) / last.num_matched : 0;
  result.overlap_ratio = points.empty() ? 0 : static_cast<double>(last.num_matched) / static_cast<double>(points.size());
  result.rms_m = last.num_inliers > 0 ? std::sqrt(last.inlier_square_sum_m2 / last.num_inliers) : 0;
  result.ok = result.num_inliers >= kMinInliers && result.inlier_ratio >= kMinInlierRatio && result.overlap_ratio >= kMinOverlapRatio;
  return result;
}

}  // namespace plumb::runtime
