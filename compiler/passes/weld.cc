#include "compiler/passes/weld.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

// Cell of a grid as a key; far apart cells may share one, which costs time only.
uint64_t CellKey(int64_t x, int64_t y) { return static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(y); }

}  // namespace

Welded Weld(const std::vector<Eigen::Vector2d>& points, double radius_m) {
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return LexicographicallyLess(points[a], points[b]); });

  Welded out;
  out.index.resize(points.size());
  std::vector<Eigen::Vector2d> seeds, sums;
  std::vector<double> counts;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells;
  for (uint32_t i : order) {
    const Eigen::Vector2d& p = points[i];
    const auto cx = static_cast<int64_t>(std::floor(p.x() / radius_m)), cy = static_cast<int64_t>(std::floor(p.y() / radius_m));
    uint32_t best = static_cast<uint32_t>(seeds.size());
    double best_distance = radius_m;
    for (int64_t x = cx - 1; x <= cx + 1; ++x) {
      for (int64_t y = cy - 1; y <= cy + 1; ++y) {
        const auto it = cells.find(CellKey(x, y));
        if (it == cells.end()) continue;
        for (uint32_t c : it->second) {
          const double distance = (seeds[c] - p).norm();
          if (distance > best_distance || (distance == best_distance && c > best)) continue;
          best = c;
          best_distance = distance;
        }
      }
    }
    if (best == seeds.size()) {
      seeds.push_back(p);
      sums.emplace_back(Eigen::Vector2d::Zero());
      counts.push_back(0);
      cells[CellKey(cx, cy)].push_back(best);
    }
    out.index[i] = best;
    sums[best] += p - seeds[best];
    counts[best] += 1;
  }
  for (size_t c = 0; c < seeds.size(); ++c) out.points.push_back(seeds[c] + sums[c] / counts[c]);
  return out;
}

}  // namespace plumb::compiler
