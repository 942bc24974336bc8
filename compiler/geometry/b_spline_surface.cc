#include "compiler/geometry/b_spline_surface.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kSeam_m = 1e-4;  // what ends where it began
constexpr int kMaxRefinements = 10;
constexpr size_t kEvaluationsInRefinement = 3;

// Steps along u and v from node to node: enough that the nearest node leads to the nearest point, but few in all.
std::array<size_t, 2> NodeSteps(const BSplineSurface& surface) {
  constexpr size_t kInSpan = 4, kLeast = 8, kMostNodes = 1024;
  const auto wanted = [&](size_t degree, size_t points) {
    return degree == 1 ? points - 1 : std::max(kLeast, kInSpan * (points - degree));
  };
  std::array<size_t, 2> steps = {wanted(surface.columns.front().degree, surface.columns.front().points.size()),
                                 wanted(surface.across.degree, surface.columns.size())};
  while ((steps[0] + 1) * (steps[1] + 1) > kMostNodes) {
    size_t& more = steps[0] > steps[1] ? steps[0] : steps[1];
    more = (more + 1) / 2;
  }
  return steps;
}

std::vector<double> NodesOf(const BSpline& spline, size_t steps) {
  const double low = spline.knots[spline.degree], high = spline.knots[spline.knots.size() - spline.degree - 1];
  std::vector<double> out;
  for (size_t i = 0; i <= steps; ++i) out.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(steps));
  return out;
}

}  // namespace

Vector3d BSplineSurface::At(double u, double v) const {
  const size_t span = across.SpanOf(v), first = span - across.degree;
  std::array<Vector4d, kMaxSplineDegree + 1> row;
  for (size_t j = 0; j <= across.degree; ++j) row[j] = columns[first + j].HomogeneousAt(u);
  const Vector4d q = across.Blend(v, span, row);
  return q.w() != 0 ? Vector3d(q.head<3>() / q.w()) : Vector3d::Zero();
}

BSplineUnroller::BSplineUnroller(BSplineSurface surface) : surface_(std::move(surface)) {
  const auto [steps_u, steps_v] = NodeSteps(surface_);
  nodes_u_ = NodesOf(surface_.columns.front(), steps_u);
  nodes_v_ = NodesOf(surface_.across, steps_v);
  for (const double u : nodes_u_) {
    for (const double v : nodes_v_) nodes_.push_back(surface_.At(u, v));
  }
  scale_ = {LengthOver(nodes_v_.size(), 1) / (nodes_u_.back() - nodes_u_.front()),
            LengthOver(1, nodes_v_.size()) / (nodes_v_.back() - nodes_v_.front())};
}

size_t BSplineUnroller::StepsFor(const BSplineSurface& surface, size_t points) {
  constexpr size_t kOverhead = 8;  // of blending one curve, in blends of two points
  const auto blends = [](size_t degree) { return degree * (degree + 1) / 2 + kOverhead; };
  const size_t evaluation = (surface.across.degree + 1) * blends(surface.columns.front().degree) + blends(surface.across.degree);
  const auto [steps_u, steps_v] = NodeSteps(surface);
  const size_t nodes = (steps_u + 1) * (steps_v + 1);
  return nodes * evaluation + points * (nodes + kMaxRefinements * kEvaluationsInRefinement * evaluation);
}

Vector2d BSplineUnroller::Flat(const Vector3d& p) const {
  const auto nearest = std::min_element(
      nodes_.begin(), nodes_.end(), [&](const Vector3d& a, const Vector3d& b) { return (a - p).squaredNorm() < (b - p).squaredNorm(); });
  const auto node = static_cast<size_t>(nearest - nodes_.begin());
  return Refine(p, {nodes_u_[node / nodes_v_.size()], nodes_v_[node % nodes_v_.size()]}).cwiseProduct(scale_);
}

Vector2d BSplineUnroller::Periods() const {
  Vector2d range(nodes_u_.back() - nodes_u_.front(), nodes_v_.back() - nodes_v_.front());
  const size_t n = nodes_v_.size();
  for (size_t k = 0; k < n; ++k) {
    if ((nodes_[k] - nodes_[nodes_.size() - n + k]).norm() > kSeam_m) range.x() = 0;
  }
  for (size_t k = 0; k < nodes_.size(); k += n) {
    if ((nodes_[k] - nodes_[k + n - 1]).norm() > kSeam_m) range.y() = 0;
  }
  return range.cwiseProduct(scale_);
}

bool BSplineUnroller::IsPole(const Vector3d& p) const {
  const size_t n = nodes_v_.size(), last = nodes_.size() - n;
  const auto all_here = [&](size_t first, size_t step, size_t count) {
    for (size_t k = 0; k < count; ++k) {
      if ((nodes_[first + k * step] - p).norm() > kSeam_m) return false;
    }
    return true;
  };
  return all_here(0, 1, n) || all_here(last, 1, n) || all_here(0, n, nodes_u_.size()) || all_here(n - 1, n, nodes_u_.size());
}

// Of the longest line of nodes with this distance from one to the next in `nodes_`, lines beginning `next` apart.
double BSplineUnroller::LengthOver(size_t step, size_t next) const {
  const size_t in_line = (step == 1 ? nodes_v_ : nodes_u_).size(), lines = nodes_.size() / in_line;
  double out = 0;
  for (size_t line = 0; line < lines; ++line) {
    double length_m = 0;
    for (size_t k = 1; k < in_line; ++k) length_m += (nodes_[line * next + k * step] - nodes_[line * next + (k - 1) * step]).norm();
    out = std::max(out, length_m);
  }
  return out;
}

// Gauss-Newton from the nearest node.
Vector2d BSplineUnroller::Refine(const Vector3d& p, Vector2d at) const {
  constexpr double kDifference = 1e-6, kDone = 1e-9;  // shares of the range
  const Vector2d low(nodes_u_.front(), nodes_v_.front()), high(nodes_u_.back(), nodes_v_.back()), range = high - low;
  for (int step = 0; step < kMaxRefinements; ++step) {
    const Vector3d here = surface_.At(at.x(), at.y());
    Eigen::Matrix<double, 3, 2> J;
    for (int k = 0; k < 2; ++k) {
      Vector2d beside = at;
      const double sign = at[k] + kDifference * range[k] > high[k] ? -1 : 1;
      beside[k] += sign * kDifference * range[k];
      J.col(k) = (surface_.At(beside.x(), beside.y()) - here) / (sign * kDifference);
    }
    const Eigen::Matrix2d H = J.transpose() * J;
    if (!(std::abs(H.determinant()) > 1e-12 * H.squaredNorm())) break;
    const Vector2d before = at;
    at = (at + (H.inverse() * J.transpose() * (p - here)).cwiseProduct(range)).cwiseMax(low).cwiseMin(high);
    if (((at - before).cwiseQuotient(range)).norm() < kDone) break;
  }
  return at;
}

}  // namespace plumb::compiler
