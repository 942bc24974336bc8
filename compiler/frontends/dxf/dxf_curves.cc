#include "compiler/frontends/dxf/dxf_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

constexpr int kMaxSteps = 256, kStepsPerKnotSpan = 8;
constexpr unsigned kMaxDegree = 15;

int StepsOf(double sweep_rad, double chord_share) {
  const double step = 2 * std::acos(std::clamp(1 - chord_share, 0.0, 1.0));
  return std::clamp(static_cast<int>(std::ceil(std::abs(sweep_rad) / step)), 2, kMaxSteps);
}

// De Boor's algorithm in homogeneous coordinates; `span` is the last knot at or before t.
Eigen::Vector2d PointAt(const SplineCurve& spline, size_t span, double t) {
  std::vector<Eigen::Vector3d> d;
  for (size_t i = span - spline.degree; i <= span; ++i) {
    const double w = spline.weights.empty() ? 1.0 : spline.weights[i];
    d.emplace_back(w * spline.control[i].x(), w * spline.control[i].y(), w);
  }
  for (unsigned r = 1; r <= spline.degree; ++r) {
    for (unsigned j = spline.degree; j >= r; --j) {
      const size_t i = span - spline.degree + j;
      const double low = spline.knots[i], high = spline.knots[i + 1 + spline.degree - r];
      const double alpha = high > low ? (t - low) / (high - low) : 0.0;
      d[j] = (1 - alpha) * d[j - 1] + alpha * d[j];
    }
  }
  const Eigen::Vector3d& p = d[spline.degree];
  return p.z() != 0 ? Eigen::Vector2d(p.head<2>() / p.z()) : Eigen::Vector2d(p.head<2>());
}

}  // namespace

void AppendArc(const Arc& arc, double chord_share, std::vector<Eigen::Vector2d>& points) {
  const int steps = StepsOf(arc.sweep_rad, chord_share);
  for (int i = 0; i <= steps; ++i) {
    const double a = arc.start_rad + arc.sweep_rad * i / steps;
    points.emplace_back(arc.center + arc.radius_m * Eigen::Vector2d(std::cos(a), std::sin(a)));
  }
}

Arc ArcOfBulge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double bulge) {
  const Eigen::Vector2d d = b - a;
  Arc out;
  out.sweep_rad = 4 * std::atan(bulge);
  out.center = 0.5 * (a + b) + (1 - bulge * bulge) / (4 * bulge) * Eigen::Vector2d(-d.y(), d.x());
  out.radius_m = (a - out.center).norm();
  out.start_rad = std::atan2(a.y() - out.center.y(), a.x() - out.center.x());
  return out;
}

void AppendEllipse(const EllipseArc& ellipse, double chord_share, std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d minor = ellipse.ratio * Eigen::Vector2d(-ellipse.major.y(), ellipse.major.x());
  const int steps = StepsOf(ellipse.sweep_rad, chord_share);
  for (int i = 0; i <= steps; ++i) {
    const double a = ellipse.start_rad + ellipse.sweep_rad * i / steps;
    points.emplace_back(ellipse.center + std::cos(a) * ellipse.major + std::sin(a) * minor);
  }
}

std::vector<Eigen::Vector2d> SplinePoints(const SplineCurve& spline) {
  if (spline.control.empty()) return spline.fit;
  const size_t n = spline.control.size(), p = spline.degree;
  if (p < 1 || p > kMaxDegree || n <= p || spline.knots.size() != n + p + 1) return {};
  if (!std::is_sorted(spline.knots.begin(), spline.knots.end()) || (!spline.weights.empty() && spline.weights.size() != n)) return {};
  std::vector<Eigen::Vector2d> out;
  for (size_t span = p; span < n; ++span) {
    const double low = spline.knots[span], high = spline.knots[span + 1];
    if (!(high > low)) continue;
    const int steps = p == 1 ? 1 : kStepsPerKnotSpan;
    for (int i = out.empty() ? 0 : 1; i <= steps; ++i) out.push_back(PointAt(spline, span, low + (high - low) * i / steps));
  }
  return out;
}

}  // namespace plumb::compiler
