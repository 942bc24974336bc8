#include "compiler/geometry/b_spline.h"

#include <algorithm>
#include <array>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// Equal steps over [low, high] for which the middle of each keeps within the tolerance of its chord; a power of two.
int StepsOver(const BSpline& spline, double low, double high, double tolerance_m) {
  constexpr int kMin = 8, kMax = 64;
  for (int steps = kMin; steps < kMax; steps *= 2) {
    double worst_m = 0;
    for (int i = 0; i < steps; ++i) {
      const auto u = [&](double step) { return low + (high - low) * step / steps; };
      const Vector3d start = spline.At(u(i)), chord = spline.At(u(i + 1)) - start, middle = spline.At(u(i + 0.5)) - start;
      const double length2 = chord.squaredNorm();
      worst_m = std::max(worst_m, (middle - (length2 > 0 ? std::clamp(middle.dot(chord) / length2, 0.0, 1.0) : 0.0) * chord).norm());
    }
    if (worst_m <= tolerance_m) return steps;
  }
  return kMax;
}

}  // namespace

size_t BSpline::SpanOf(double u) const {
  const auto begin = knots.begin() + static_cast<std::ptrdiff_t>(degree), end = knots.begin() + static_cast<std::ptrdiff_t>(points.size());
  return degree + static_cast<size_t>(std::upper_bound(begin + 1, end, u) - begin) - 1;
}

Vector4d BSpline::Blend(double u, size_t span, std::span<Vector4d> controls) const {
  for (size_t r = 1; r <= degree; ++r) {
    for (size_t j = degree; j >= r; --j) {
      const double low = knots[j + span - degree], high = knots[j + 1 + span - r];
      const double t = high > low ? (u - low) / (high - low) : 0;
      controls[j] = (1 - t) * controls[j - 1] + t * controls[j];
    }
  }
  return controls[degree];
}

Vector4d BSpline::HomogeneousAt(double u) const {
  const size_t span = SpanOf(u);
  std::array<Vector4d, kMaxSplineDegree + 1> controls;
  std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(span - degree), degree + 1, controls.begin());
  return Blend(u, span, controls);
}

Vector3d BSpline::At(double u) const {
  const Vector4d q = HomogeneousAt(u);
  return q.w() != 0 ? Vector3d(q.head<3>() / q.w()) : Vector3d::Zero();
}

Ring3 BSpline::Sample(double low, double high, double tolerance_m, size_t max_points) const {
  Ring3 out;
  for (size_t span = degree; span < points.size() && out.size() <= max_points; ++span) {
    const double start = std::max(knots[span], low), end = std::min(knots[span + 1], high);
    if (!(end > start)) continue;
    const int steps = StepsOver(*this, start, end, tolerance_m);
    for (int i = out.empty() ? 0 : 1; i <= steps; ++i) out.push_back(At(start + (end - start) * i / steps));
  }
  return out;
}

std::vector<double> ExpandKnots(std::span<const double> knots, std::span<const double> multiplicities, size_t degree, size_t points) {
  std::vector<double> out;
  if (knots.size() != multiplicities.size()) return out;
  for (size_t i = 0; i < knots.size(); ++i) {
    const double count = multiplicities[i];
    if (count < 1 || count > static_cast<double>(degree + 1) || (i > 0 && knots[i] < knots[i - 1])) return {};
    out.insert(out.end(), static_cast<size_t>(count), knots[i]);
  }
  if (out.size() != points + degree + 1) out.clear();
  return out;
}

}  // namespace plumb::compiler
