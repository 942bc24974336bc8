#include "compiler/geometry/polyline.h"

#include <algorithm>
#include <limits>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

constexpr double kSamePoint_m = 1e-6;

// A place on a polyline: the side that begins with this point, and the share of it.
struct PlaceOnLine {
  size_t side = 0;
  double share = 0;
  [[nodiscard]] double value() const { return static_cast<double>(side) + share; }
};

PlaceOnLine NearestOn(const Ring3& line, const Vector3d& p) {
  PlaceOnLine out;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector3d side = line[i + 1] - line[i];
    const double length2 = side.squaredNorm();
    const double share = length2 > 0 ? std::clamp((p - line[i]).dot(side) / length2, 0.0, 1.0) : 0;
    const double off_m2 = (line[i] + share * side - p).squaredNorm();
    if (off_m2 >= least_m2) continue;
    least_m2 = off_m2;
    out = {i, share};
  }
  return out;
}

// Corners of the line between two places on it.
void AppendBetween(const Ring3& line, const PlaceOnLine& a, const PlaceOnLine& b, Ring3& out) {
  constexpr double kAtCorner = 1e-6;  // share of a side
  for (size_t i = a.side; i <= b.side + 1 && i < line.size(); ++i) {
    const auto at = static_cast<double>(i);
    if (at > a.value() + kAtCorner && at < b.value() - kAtCorner) out.push_back(line[i]);
  }
}

}  // namespace

Ring3 PartOfPolyline(Ring3 line, const Vector3d& start, const Vector3d& end, bool forward) {
  const bool closed = (line.front() - line.back()).norm() <= kSamePoint_m;
  if (!closed) forward = NearestOn(line, start).value() <= NearestOn(line, end).value();
  if (!forward) std::reverse(line.begin(), line.end());
  const PlaceOnLine a = NearestOn(line, start), b = NearestOn(line, end);
  Ring3 out = {start};
  if (a.value() < b.value() && (start - end).norm() > kSamePoint_m) {
    AppendBetween(line, a, b, out);
  } else if (closed) {
    AppendBetween(line, a, {line.size() - 2, 1}, out);
    out.push_back(line.back());
    AppendBetween(line, {0, 0}, b, out);
  }
  out.push_back(end);
  return out;
}

}  // namespace plumb::compiler
