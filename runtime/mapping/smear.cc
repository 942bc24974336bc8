#include "runtime/mapping/smear.h"

#include <Eigen/Geometry>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

Eigen::Matrix3d PositivePart(const Eigen::Matrix3d& m) {
  const SymmetricEigen<3> eigen = EigenOf(m);
  return eigen.vectors * eigen.values.cwiseMax(0.0).asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

void Smear::Cover(const Smear& other) {
  m2 += PositivePart(other.m2 - m2);
  rad2 += PositivePart(other.rad2 - rad2);
}

double Smear::OffsetVariance_m2(const Eigen::Vector3d& n, const Eigen::Vector3d& p) const {
  return n.dot(m2 * n) + TurnVariance_rad2(p.cross(n));  // a turn about w moves p by w x p
}

}  // namespace plumb::runtime
