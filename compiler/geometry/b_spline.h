// B-spline curves, rational or not. Metres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {

inline constexpr size_t kMaxSplineDegree = 16;

struct BSpline {
  size_t degree = 0;                    // at most kMaxSplineDegree
  std::vector<Eigen::Vector4d> points;  // control points, homogeneous: weight times position, weight
  std::vector<double> knots;            // not falling; points.size() + degree + 1 of them

  [[nodiscard]] double first() const { return knots.front(); }
  [[nodiscard]] double last() const { return knots.back(); }
  // De Boor's algorithm; zero where the weights cancel. O(degree^2 + log points).
  [[nodiscard]] Eigen::Vector3d At(double u) const;
  [[nodiscard]] Eigen::Vector4d HomogeneousAt(double u) const;
  // Number of the span between knots that holds `u`; the first or last one beyond the ends. Control points span - degree to span rule it.
  [[nodiscard]] size_t SpanOf(double u) const;
  // The curve at `u` in a span with these degree + 1 control points instead of its own; they are overwritten.
  [[nodiscard]] Eigen::Vector4d Blend(double u, size_t span, std::span<Eigen::Vector4d> controls) const;
  // From parameter `low` to `high` in the spans between knots, each in so many equal steps (64 at most) that chords keep within
  // `tolerance_m` of the curve. Ends early once there are over `max_points`.
  [[nodiscard]] Ring3 Sample(double low, double high, double tolerance_m, size_t max_points) const;
};

// Repeats each knot as often as `multiplicities` says. Empty if they do not make the knots of a curve of `degree` and so many points.
[[nodiscard]] std::vector<double> ExpandKnots(std::span<const double> knots, std::span<const double> multiplicities, size_t degree,
                                              size_t points);

}  // namespace plumb::compiler
