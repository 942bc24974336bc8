#include "runtime/mapping/plane_view.h"

#include <algorithm>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {

PlaneMoments ComputeMoments(const PlaneStats& stats) {
  PlaneMoments m;
  m.count = stats.count();
  if (m.count <= 0) return m;
  m.center = stats.centroid();
  const Eigen::Matrix3d scatter = stats.C.topLeftCorner<3, 3>() / m.count - m.center * m.center.transpose();
  // Semidefinite up to rounding: the solver takes it as it is, negative zeros are cut.
  const SymmetricEigen<3> eigen = EigenOf(scatter);
  m.normal = eigen.vectors.col(0);
  m.v = eigen.vectors.col(1);
  m.u = eigen.vectors.col(2);
  m.var_normal = std::max(0.0, eigen.values[0]);
  m.var_v = std::max(0.0, eigen.values[1]);
  m.var_u = std::max(0.0, eigen.values[2]);
  return m;
}

PlaneView::PlaneView(const PlaneStats& stats, const ViewNoise& noise, size_t num_views) {
  const PlaneMoments m = ComputeMoments(stats);
  if (m.count <= 0) return;
  center = m.center;
  u = m.u;
  v = m.v;
  // A surface rougher than the sensor tells less.
  const double point_variance = std::max(noise.point_sigma_m * noise.point_sigma_m, m.var_normal) * noise.correlation / m.count;
  weight_center = 1.0 / std::sqrt(point_variance + noise.floor_m * noise.floor_m + noise.smear.OffsetVariance_m2(m.normal, center));
  const auto direction_weight = [&](double variance, const Eigen::Vector3d& axis) {
    if (variance <= 0) return 0.0;
    const double edge_rad = noise.edge_m2 / (2 * variance);
    return 1.0 / std::sqrt(point_variance / variance + noise.floor_rad * noise.floor_rad + noise.smear.TurnVariance_rad2(axis) +
                           static_cast<double>(num_views) * edge_rad * edge_rad);
  };
  weight_u = direction_weight(m.var_u, v);
  weight_v = direction_weight(m.var_v, u);
}

}  // namespace plumb::runtime
