// Total least squares planes from their points' statistics.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

struct PlaneFit {
  Plane plane;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double rms_m = 0;
};

// The plane with the least sum of squared distances, its normal on the side of `towards`. Needs at least three points.
[[nodiscard]] inline PlaneFit FitPlane(const PlaneStats& stats, const Eigen::Vector3d& towards) {
  PlaneFit fit;
  fit.centroid = stats.centroid();
  const Eigen::Matrix3d covariance = stats.C.topLeftCorner<3, 3>() / stats.count() - fit.centroid * fit.centroid.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  fit.plane.n = eigen.eigenvectors().col(0);
  if (fit.plane.n.dot(towards) < 0) fit.plane.n = -fit.plane.n;
  fit.plane.d = -fit.plane.n.dot(fit.centroid);
  fit.rms_m = std::sqrt(std::max(0.0, eigen.eigenvalues()[0]));
  return fit;
}

}  // namespace plumb::runtime
