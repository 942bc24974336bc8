// Curves of DXF as steps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "schema/agraph.h"

namespace plumb::compiler {

// From start to end of the arc, both included; steps that stay within `chord_share` of the radius.
void AppendArc(const Arc& arc, double chord_share, std::vector<Eigen::Vector2d>& points);
// The arc from `a` to `b` of a polyline's side; `bulge` is the tangent of a quarter of its angle, not 0.
[[nodiscard]] Arc ArcOfBulge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double bulge);

struct EllipseArc {
  Eigen::Vector2d center = Eigen::Vector2d::Zero(), major = Eigen::Vector2d::UnitX();
  double ratio = 1, start_rad = 0, sweep_rad = 0;
};
void AppendEllipse(const EllipseArc& ellipse, double chord_share, std::vector<Eigen::Vector2d>& points);

struct SplineCurve {
  unsigned degree = 3;
  bool closed = false;
  std::vector<double> knots, weights;
  std::vector<Eigen::Vector2d> control, fit;
};
// Empty: knots and points do not belong together. Without control points the fit points are joined.
[[nodiscard]] std::vector<Eigen::Vector2d> SplinePoints(const SplineCurve& spline);

}  // namespace plumb::compiler
