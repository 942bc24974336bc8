#include "compiler/geometry/circle.h"

#include <Eigen/LU>
#include <cmath>

namespace plumb::compiler {

std::optional<Circle> FitCircle(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double square = 0;
  for (const auto& p : points) {
    const Eigen::Vector2d q = p - mean;
    a += q * q.transpose();
    b += 0.5 * q.squaredNorm() * q;
    square += q.squaredNorm();
  }
  if (!(a.determinant() > 1e-9 * square * square)) return std::nullopt;
  const Eigen::Vector2d c = a.inverse() * b;
  return Circle{mean + c, std::sqrt(c.squaredNorm() + square / static_cast<double>(points.size()))};
}

}  // namespace plumb::compiler
