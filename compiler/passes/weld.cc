#include "compiler/passes/weld.h"

#include <algorithm>
#include <numeric>

#include "compiler/geometry/cell_lists.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
Welded Weld(const std::vector<Eigen::Vector2d>& points, double radius_m) {
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return LexicographicallyLess(points[a], points[b]); });

  Welded out;
  out.index.resize(points.size());
  std::vector<Eigen::Vector2d> seeds, sums;
  std::vector<double> counts;
  CellLists cells(radius_m);
  for (uint32_t i : order) {
    const Eigen::Vector2d& p = points[i];
    uint32_t best = static_cast<uint32_t>(seeds.size());
    double best_distance = radius_m;
    cells.ForEachNear(p, [&](uint32_t c) {
      const double distance = (seeds[c] - p).norm();
      if (distance > best_distance || (distance == best_distance && c > best)) return;
      best = c;
      best_distance = distance;
    });
    if (best == seeds.size()) {
      seeds.push_back(p);
      sums.emplace_back(Eigen::Vector2d::Zero());
      counts.push_back(0);
      cells.Add(p);
    }
    out.index[i] = best;
    sums[best] += p - seeds[best];
    counts[best] += 1;
  }
  for (size_t c = 0; c < seeds.size(); ++c) out.points.push_back(seeds[c] + sums[c] / counts[c]);
  return out;
}

}  // namespace plumb::compiler
