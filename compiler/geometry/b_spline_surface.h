// B-spline surfaces, rational or not, and the parameters of points on them. Metres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "compiler/geometry/b_spline.h"

namespace plumb::compiler {

struct BSplineSurface {
  std::vector<BSpline> columns;  // along u, one for each control point along v: all of one degree and with the same knots
  BSpline across;                // along v: its degree and knots; its points are only counted

  // O(degree^3 + degree * log points); zero where the weights cancel.
  [[nodiscard]] Eigen::Vector3d At(double u, double v) const;
  [[nodiscard]] bool is_ruled() const { return columns.front().degree == 1 || across.degree == 1; }
};

// Unrolls a surface: the parameters of the nearest point of it, times its size.
class BSplineUnroller {
 public:
  explicit BSplineUnroller(BSplineSurface surface);

  // Of making one and unrolling so many points, at about a nanosecond each; known beforehand, to decline what takes too long.
  [[nodiscard]] static size_t StepsFor(const BSplineSurface& surface, size_t points);

  // O(nodes + evaluations of the surface).
  [[nodiscard]] Eigen::Vector2d Flat(const Eigen::Vector3d& p) const;
  // After how much it comes back to where it began, 0 where it does not.
  [[nodiscard]] Eigen::Vector2d Periods() const;
  // Whether a whole edge of the surface is this one point.
  [[nodiscard]] bool IsPole(const Eigen::Vector3d& p) const;

 private:
  [[nodiscard]] double LengthOver(size_t step, size_t next) const;
  [[nodiscard]] Eigen::Vector2d Refine(const Eigen::Vector3d& p, Eigen::Vector2d at) const;

  BSplineSurface surface_;
  std::vector<double> nodes_u_, nodes_v_;
  std::vector<Eigen::Vector3d> nodes_;  // by u, then v
  Eigen::Vector2d scale_ = Eigen::Vector2d::Ones();
};

}  // namespace plumb::compiler
