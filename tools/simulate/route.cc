#include "tools/simulate/route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace plumb::tools {
namespace {

constexpr double kComfort_m = 0.45;      // clearance that a robot likes to keep
constexpr double kNarrowPenalty = 4;     // how much dearer a metre is without any of it

double CostFactor(double clearance_m) { return 1 + kNarrowPenalty * std::max(0.0, 1 - clearance_m / kComfort_m); }

std::vector<size_t> FindCells(const FreeSpace& space, size_t from, size_t to, double radius_m) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  struct Entry {
    double estimate;
    size_t index;
    bool operator>(const Entry& o) const { return estimate != o.estimate ? estimate > o.estimate : index > o.index; }
  };
  std::vector<double> cost(space.size(), kInf);
  std::vector<size_t> parent(space.size(), space.size());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const Eigen::Vector2d goal = space.Center(space.At(to));
  const auto to_go = [&](size_t i) { return (space.Center(space.At(i)) - goal).norm(); };
  cost[from] = 0;
  open.push({to_go(from), from});
  while (!open.empty()) {
    const auto [estimate, index] = open.top();
    open.pop();
    if (index == to) break;
    if (estimate > cost[index] + to_go(index) + 1e-9) continue;
    const Cell c = space.At(index);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell n{c.x + dx, c.y + dy};
        if ((dx == 0 && dy == 0) || n.x < 0 || n.y < 0 || n.x >= space.width() || n.y >= space.height()) continue;
        const size_t next = space.Index(n);
        if (space.clearance_m(next) < radius_m) continue;
        const double step_m = kCell_m * (dx != 0 && dy != 0 ? std::numbers::sqrt2 : 1);
        const double new_cost = cost[index] + step_m * CostFactor(space.clearance_m(next));
        if (new_cost >= cost[next] - 1e-12) continue;
        cost[next] = new_cost;
        parent[next] = index;
        open.push({new_cost + to_go(next), next});
      }
    }
  }
  if (from != to && parent[to] == space.size()) return {};
  std::vector<size_t> cells = {to};
  while (cells.back() != from) cells.push_back(parent[cells.back()]);
  std::reverse(cells.begin(), cells.end());
  return cells;
}

}  // namespace

double ClearanceAlong(const FreeSpace& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const int steps = static_cast<int>(std::ceil((b - a).norm() / (kCell_m / 2))) + 1;
  double clearance_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) clearance_m = std::min(clearance_m, space.ClearanceAt(a + (b - a) * (static_cast<double>(i) / steps)));
  return clearance_m;
}

Polyline FindRoute(const FreeSpace& space, size_t from, size_t to, double radius_m) {
  const std::vector<size_t> cells = FindCells(space, from, to, radius_m);
  Polyline route;
  for (size_t at = 0; at < cells.size();) {
    const Eigen::Vector2d here = space.Center(space.At(cells[at]));
    route.push_back(here);
    // As far on as a straight line is no tighter than the way around.
    double tightest_m = std::min(kComfort_m, space.clearance_m(cells[at]));
    size_t next = at + 1;
    for (size_t k = at + 1; k < cells.size(); ++k) {
      tightest_m = std::min(tightest_m, space.clearance_m(cells[k]));
      if (ClearanceAlong(space, here, space.Center(space.At(cells[k]))) >= tightest_m) next = k;
    }
    at = next;
  }
  return route;
}

}  // namespace plumb::tools
