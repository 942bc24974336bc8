#include "runtime/odometry/planar/planar_registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kInlierSigmas = 3.0;
constexpr double kConverged_m = 2e-4, kConverged_rad = 1e-4;
constexpr int kMinInliers = 20;
constexpr double kMinInlierRatio = 0.6;     // of the points that fell on a line
constexpr double kMinOverlap = 0.2;         // points that fell on a line, of all: through a door most of what is seen is new
constexpr double kNormalNoiseMargin = 5;    // information that is not this many times what the normals' noise makes up is none
constexpr double kDegenerateRatio = 3e-4;   // nor if it is less than this share of all
constexpr double kStartSigma_m = 0.03, kStartSigma_rad = 0.02;  // of the start: the search's grid
constexpr double kExact = 1e-6;             // sigma of what is not estimated
constexpr double kFreedom = 3.0;            // of the prior's t distribution

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Sum {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weight = 0, weighted_radius2_m2 = 0, weighted_normal_variance = 0;  // weights in 1 / m^2
  int num_normals = 0, num_matched = 0, num_inliers = 0;
  double inlier_square_sum_m2 = 0;
};

Eigen::Vector2d Corrected(const PlanarPoint& point, const Pose2& correction) {
  return point.p + point.s * (correction.t_m + correction.yaw_rad * Perpendicular(point.p));
}

Sum Accumulate(const PlanarScan& scan, const LineMap& map, const Pose2& pose, const Pose2& correction, double kernel_m, double sigma_m) {
  Sum sum;
  const Eigen::Matrix2d R = pose.Rotation();
  for (const PlanarPoint& point : scan) {
    if (!point.has_normal()) continue;
    ++sum.num_normals;
    const Eigen::Vector2d q = R * Corrected(point, correction) + pose.t_m;
    const LineSurfel* line = map.Nearest(q, R * point.normal, pose.t_m);
    if (line == nullptr) continue;
    ++sum.num_matched;
    const PointToLine e = EvaluatePointToLine(pose, correction, point, line->normal, line->mean);
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
  const SymmetricEigen<3> eigen = EigenOf(Eigen::Matrix3d(scale.asDiagonal() * sum.H.topLeftCorner<3, 3>() * scale.asDiagonal()));
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

PointToLine EvaluatePointToLine(const Pose2& pose, const Pose2& correction, const PlanarPoint& point, const Eigen::Vector2d& normal,
                                const Eigen::Vector2d& mean) {
  const Eigen::Matrix2d R = pose.Rotation();
  const Eigen::Vector2d turned = R * Corrected(point, correction), n_scan = R.transpose() * normal;
  PointToLine e;
  e.residual_m = normal.dot(turned + pose.t_m - mean);
  e.jacobian << normal, normal.dot(Perpendicular(turned)), point.s * n_scan, point.s * n_scan.dot(Perpendicular(point.p));
  return e;
}

PlanarRegistration RegisterPlanar(const PlanarScan& scan, const LineMap& map, const Pose2& start, const PlanarPrior& prior,
                                  const PlanarRegistrationOptions& options) {
  PlanarRegistration result;
  result.pose = start;
  const double share = 1 / options.points_per_independent;
  const double sweep_m = std::max(options.sweep_sigma_m, kExact), sweep_rad = std::max(options.sweep_sigma_rad, kExact);
  Vector6d held;
  held << kStartSigma_m, kStartSigma_m, kStartSigma_rad, sweep_m, sweep_m, sweep_rad;
  held = held.array().square().inverse();
  // Points' information on what is held by lines; a sweep's motion is known well enough beforehand.
  const auto information = [&](const Sum& sum) {
    Matrix6d P = Matrix6d::Identity();
    P.topLeftCorner<3, 3>() = HeldDirections(sum);
    return std::pair{Matrix6d(share * P.transpose() * sum.H * P), Vector6d(share * P.transpose() * sum.g)};
  };
  const double final_kernel_m = kInlierSigmas * options.sigma_m;
  double kernel_m = std::max(options.initial_kernel_m, final_kernel_m);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const auto [H, g] = information(Accumulate(scan, map, result.pose, result.sweep_correction, kernel_m, options.sigma_m));
    Vector6d off;
    off << Difference(result.pose, start), result.sweep_correction.t_m, result.sweep_correction.yaw_rad;
    const Vector6d step = (H + Matrix6d(held.asDiagonal())).ldlt().solve(-(g + held.cwiseProduct(off)));
    if (!step.allFinite()) return result;
    result.pose = {result.pose.t_m + step.head<2>(), WrapYaw(result.pose.yaw_rad + step[2])};
    result.sweep_correction = {result.sweep_correction.t_m + step.segment<2>(3), result.sweep_correction.yaw_rad + step[5]};
    if (kernel_m <= final_kernel_m && step.head<2>().norm() < kConverged_m && std::abs(step[2]) < kConverged_rad) break;
    kernel_m = std::max(final_kernel_m, 0.5 * kernel_m);
  }
  const Sum last = Accumulate(scan, map, result.pose, result.sweep_correction, final_kernel_m, options.sigma_m);
  Matrix6d H = information(last).first;
  H.bottomRightCorner<3, 3>().diagonal() += held.tail<3>();
  // What the pose's information is, the sweep's motion being unknown: the Schur complement.
  const Eigen::Matrix3d coupling = H.topRightCorner<3, 3>();
  result.information = H.topLeftCorner<3, 3>() - coupling * H.bottomRightCorner<3, 3>().ldlt().solve(coupling.transpose());
  const Eigen::Matrix3d with_prior = result.information + Eigen::Matrix3d(PriorInformation(result.pose, prior).asDiagonal());
  result.covariance = with_prior.ldlt().solve(Eigen::Matrix3d::Identity());
  result.num_inliers = last.num_inliers;
  result.inlier_share = last.num_normals > 0 ? static_cast<double>(last.num_inliers) / last.num_normals : 0;
  result.rms_m = last.num_inliers > 0 ? std::sqrt(last.inlier_square_sum_m2 / last.num_inliers) : 0;
  result.ok = result.num_inliers >= kMinInliers && result.num_inliers >= kMinInlierRatio * last.num_matched &&
              last.num_matched >= kMinOverlap * last.num_normals;
  return result;
}

}  // namespace plumb::runtime
