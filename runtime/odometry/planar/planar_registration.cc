#include "runtime/odometry/planar/planar_registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kInlierSigmas = 3.0;
constexpr double kConverged_m = 2e-4, kConverged_rad = 1e-4;
constexpr int kMinInliers = 20;
constexpr double kMinInlierShare = 0.35;
constexpr double kNormalNoiseMargin = 5;    // information that is not this many times what the normals' noise makes up is none
constexpr double kDegenerateRatio = 3e-4;   // nor if it is less than this share of all
constexpr double kStartSigma_m = 0.03, kStartSigma_rad = 0.02;  // of the start: the search's grid
constexpr double kFreedom = 3.0;            // of the prior's t distribution

struct Sum {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double weight = 0, weighted_radius2_m2 = 0, weighted_normal_variance = 0;  // weights in 1 / m^2
  int num_normals = 0, num_inliers = 0;
  double inlier_square_sum_m2 = 0;
};

Sum Accumulate(const PlanarScan& scan, const LineMap& map, const Pose2& pose, double kernel_m, double sigma_m) {
  Sum sum;
  const Eigen::Matrix2d R = pose.Rotation();
  for (const PlanarPoint& point : scan) {
    if (!point.has_normal()) continue;
    ++sum.num_normals;
    const Eigen::Vector2d q = R * point.p + pose.t_m;
    const LineSurfel* line = map.Nearest(q, R * point.normal, pose.t_m);
    if (line == nullptr) continue;
    const PointToLine e = EvaluatePointToLine(pose, point.p, line->normal, line->mean);
    const double variance_m2 = line->DistanceVariance(q, sigma_m), r2_m2 = e.residual_m * e.residual_m;
    const double k2_m2 = std::max(kernel_m * kernel_m, kInlierSigmas * kInlierSigmas * variance_m2);
    const double root = k2_m2 / (k2_m2 + r2_m2), weight = root * root / variance_m2;
    sum.H += weight * e.jacobian * e.jacobian.transpose();
    sum.g += weight * e.residual_m * e.jacobian;
    sum.weight += weight;
    sum.weighted_radius2_m2 += weight * point.p.squaredNorm();
    sum.weighted_normal_variance += weight * line->NormalVariance(sigma_m);
    if (r2_m2 > kInlierSigmas * kInlierSigmas * variance_m2) continue;
    ++sum.num_inliers;
    sum.inlier_square_sum_m2 += r2_m2;
  }
  return sum;
}

// Projector onto the directions that the lines hold. Turns count by the distance that points move at the mean radius.
Eigen::Matrix3d HeldDirections(const Sum& sum) {
  if (sum.weight <= 0) return Eigen::Matrix3d::Zero();
  const double radius_m = std::max(0.1, std::sqrt(sum.weighted_radius2_m2 / sum.weight));
  const Eigen::Vector3d scale(1, 1, 1 / radius_m);
  const SymmetricEigen<3> eigen = EigenOf(Eigen::Matrix3d(scale.asDiagonal() * sum.H * scale.asDiagonal()));
  const double least = std::max(kDegenerateRatio * sum.weight, kNormalNoiseMargin * sum.weighted_normal_variance);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d v = eigen.vectors.col(i);
    if (eigen.values[i] >= least) P += v * v.transpose();
  }
  return scale.asDiagonal() * P * scale.cwiseInverse().asDiagonal();
}

Eigen::Vector3d Difference(const Pose2& a, const Pose2& b) {
  Eigen::Vector3d off;
  off << a.t_m - b.t_m, WrapYaw(a.yaw_rad - b.yaw_rad);
  return off;
}

// The prior's t density as a Gaussian that is the wider the further the pose is off: its information.
Eigen::Vector3d PriorInformation(const Pose2& pose, const PlanarPrior& prior) {
  const Eigen::Vector3d off = Difference(pose, prior.mean);
  const double w_m = (kFreedom + 2) / (kFreedom * prior.sigma_m * prior.sigma_m + off.head<2>().squaredNorm());
  const double w_rad = (kFreedom + 1) / (kFreedom * prior.sigma_rad * prior.sigma_rad + off.z() * off.z());
  return {w_m, w_m, w_rad};
}

}  // namespace

PointToLine EvaluatePointToLine(const Pose2& pose, const Eigen::Vector2d& p, const Eigen::Vector2d& normal, const Eigen::Vector2d& mean) {
  const Eigen::Vector2d turned = pose.Rotation() * p;
  PointToLine e;
  e.residual_m = normal.dot(turned + pose.t_m - mean);
  e.jacobian << normal, normal.dot(Perpendicular(turned));
  return e;
}

PlanarRegistration RegisterPlanar(const PlanarScan& scan, const LineMap& map, const Pose2& start, const PlanarPrior& prior,
                                  const PlanarRegistrationOptions& options) {
  PlanarRegistration result;
  result.pose = start;
  const double share = 1 / options.points_per_independent;
  const Eigen::Vector3d held(1 / (kStartSigma_m * kStartSigma_m), 1 / (kStartSigma_m * kStartSigma_m), 1 / (kStartSigma_rad * kStartSigma_rad));
  const double final_kernel_m = kInlierSigmas * options.sigma_m;
  double kernel_m = std::max(options.initial_kernel_m, final_kernel_m);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const Sum sum = Accumulate(scan, map, result.pose, kernel_m, options.sigma_m);
    const Eigen::Matrix3d P = HeldDirections(sum);
    const Eigen::Matrix3d H = share * P.transpose() * sum.H * P + Eigen::Matrix3d(held.asDiagonal());
    const Eigen::Vector3d step = H.ldlt().solve(-(share * P.transpose() * sum.g + held.cwiseProduct(Difference(result.pose, start))));
    if (!step.allFinite()) return result;
    result.pose = {result.pose.t_m + step.head<2>(), WrapYaw(result.pose.yaw_rad + step.z())};
    if (kernel_m <= final_kernel_m && step.head<2>().norm() < kConverged_m && std::abs(step.z()) < kConverged_rad) break;
    kernel_m = std::max(final_kernel_m, 0.5 * kernel_m);
  }
  const Sum last = Accumulate(scan, map, result.pose, final_kernel_m, options.sigma_m);
  const Eigen::Matrix3d P = HeldDirections(last);
  result.information = share * P.transpose() * last.H * P;
  const Eigen::Matrix3d H = result.information + Eigen::Matrix3d(PriorInformation(result.pose, prior).asDiagonal());
  result.covariance = H.ldlt().solve(Eigen::Matrix3d::Identity());
  result.num_inliers = last.num_inliers;
  result.inlier_share = last.num_normals > 0 ? static_cast<double>(last.num_inliers) / last.num_normals : 0;
  result.rms_m = last.num_inliers > 0 ? std::sqrt(last.inlier_square_sum_m2 / last.num_inliers) : 0;
  result.ok = result.num_inliers >= kMinInliers && result.inlier_share >= kMinInlierShare;
  return result;
}

}  // namespace plumb::runtime
