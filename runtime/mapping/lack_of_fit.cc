#include "runtime/mapping/lack_of_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::runtime {
namespace {

constexpr double kMinPoints = 6;        // in a strip
constexpr int kMinStrips = 2;           // their four offsets and slopes are one more than the parabola has parameters
constexpr double kMinSpread_m = 0.005;  // of a strip's points along the axis, one sigma: less tells no slope

// Sums over a strip's points of (1, a, d)(1, a, d)': a along the axis, d before the plane.
using Moments = Eigen::Matrix3d;

std::vector<Moments> StripsOf(const std::vector<PlaneStats>& cells, const Plane& plane, const Eigen::Vector3d& axis) {
  double lo_m = std::numeric_limits<double>::infinity(), hi_m = -lo_m;
  for (const PlaneStats& cell : cells) {
    lo_m = std::min(lo_m, axis.dot(cell.centroid()));
    hi_m = std::max(hi_m, axis.dot(cell.centroid()));
  }
  if (!(lo_m <= hi_m)) return {};
  lo_m -= 0.5 * kStrip_m;  // cells of this width, side by side, are each in the middle of a strip
  Eigen::Matrix<double, 3, 4> to;
  to << 0, 0, 0, 1, axis.transpose(), -0.5 * (lo_m + hi_m), plane.n.transpose(), plane.d;
  std::vector<Moments> strips(static_cast<size_t>((hi_m - lo_m) / kStrip_m) + 1, Moments::Zero());
  for (const PlaneStats& cell : cells) {
    strips[static_cast<size_t>((axis.dot(cell.centroid()) - lo_m) / kStrip_m)] += to * cell.C * to.transpose();
  }
  return strips;
}

// Normal equations of the parabola through strips' offsets and slopes, and what is left within the strips.
struct Sums {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares_m2 = 0, within_m2 = 0, points = 0;
  int strips = 0, lines = 0;

  void Add(const Moments& strip) {
    const double n = strip(0, 0), a = strip(0, 1) / n, d = strip(0, 2) / n;
    const double aa = strip(1, 1) - n * a * a, ad = strip(1, 2) - n * a * d, dd = strip(2, 2) - n * d * d;
    const Eigen::Vector3d offset(1, a, a * a), slope(0, 1, 2 * a);
    A += n * offset * offset.transpose();
    b += n * d * offset;
    squares_m2 += n * d * d;
    within_m2 += dd;
    points += n;
    ++strips;
    if (aa < n * kMinSpread_m * kMinSpread_m) return;
    A += aa * slope * slope.transpose();
    b += ad * slope;
    squares_m2 += ad * ad / aa;
    within_m2 -= ad * ad / aa;
    ++lines;
  }
};

}  // namespace

LackOfFit LackOfFitOf(const std::vector<PlaneStats>& cells, const Plane& plane, const Eigen::Vector3d& axis) {
  Sums sums;
  for (const Moments& strip : StripsOf(cells, plane, axis)) {
    if (strip(0, 0) >= kMinPoints) sums.Add(strip);
  }
  const int parameters = sums.strips + sums.lines;
  if (sums.strips < kMinStrips || parameters < 4 || sums.points <= parameters || !(sums.within_m2 > 0)) return {};
  const double misfit_m2 = std::max(0.0, sums.squares_m2 - sums.b.dot(sums.A.ldlt().solve(sums.b)));
  LackOfFit out;
  out.rms_m = std::sqrt(misfit_m2 / sums.points);
  out.ratio = misfit_m2 / (parameters - 3) / (sums.within_m2 / (sums.points - parameters));
  return out;
}

}  // namespace plumb::runtime
