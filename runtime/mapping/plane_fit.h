// Total least squares planes from their points' statistics.
#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/mapping/sgraph.h"
#include "runtime/numerics/symmetric_eigen.h"

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
  const SymmetricEigen<3> eigen = EigenOf(covariance);
  fit.plane.n = eigen.vectors.col(0);
  if (fit.plane.n.dot(towards) < 0) fit.plane.n = -fit.plane.n;
  fit.plane.d = -fit.plane.n.dot(fit.centroid);
  fit.rms_m = std::sqrt(std::max(0.0, eigen.values[0]));
  return fit;
}

}  // namespace plumb::runtime
