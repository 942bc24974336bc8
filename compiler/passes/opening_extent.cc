#include "compiler/passes/opening_extent.h"

#include <algorithm>
#include <limits>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kTouch_m = 1e-4;  // between parts of a wall that lie beside each other, as facets of a curve

}  // namespace

std::optional<Eigen::Vector2d> SideNextTo(const std::vector<Ring>& rings, const Eigen::Vector2d& p) {
  double best_m = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Vector2d> best;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double distance = DistanceToSegment(p, a, b);
      if (distance >= best_m - 1e-6) continue;
      best_m = distance;
      best = (b - a).normalized();
    }
  }
  return best;
}

Eigen::AlignedBox2d WithinWall(const Eigen::AlignedBox2d& extent, const Eigen::Vector2d& along, const std::vector<Ring>& rings) {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const Ring& ring : rings) {
    for (const Eigen::Vector2d& p : ring) {
      from = std::min(from, along.dot(p));
      to = std::max(to, along.dot(p));
    }
  }
  from = std::max(from, extent.min().x());
  to = std::min(to, extent.max().x());
  if (!(from < to)) return extent;
  return {Eigen::Vector2d(from, extent.min().y()), Eigen::Vector2d(to, extent.max().y())};
}

std::optional<std::pair<double, double>> SolidInterval(const std::vector<Ring>& rings, const Eigen::Vector2d& at,
                                                       const Eigen::Vector2d& across) {
  std::vector<std::pair<double, int>> crossings;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d p = ring[i] - at, q = ring[(i + 1) % ring.size()] - at;
      const double sp = Cross(across, p), sq = Cross(across, q);
      if ((sp <= 0) == (sq <= 0)) continue;
      crossings.emplace_back(across.dot(p + (q - p) * (sp / (sp - sq))), sp > 0 ? 1 : -1);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::optional<std::pair<double, double>> best;
  int winding = 0;
  double begin = 0;
  const auto distance = [](const std::pair<double, double>& i) { return std::max({0.0, i.first, -i.second}); };
  for (size_t i = 0; i < crossings.size(); ++i) {
    const auto& [t, step] = crossings[i];
    if (winding == 0 && (i == 0 || t > crossings[i - 1].first + kTouch_m)) begin = t;
    winding += step;
    if (winding != 0) continue;
    // Goes on in the next part of the wall.
    if (best && best->first == begin) best->second = t;
    if (!best || distance({begin, t}) < distance(*best)) best = {begin, t};
  }
  return best;
}

}  // namespace plumb::compiler
