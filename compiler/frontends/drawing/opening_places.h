// Openings by place. Private to openings.cc.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "compiler/frontends/drawing/openings.h"

namespace plumb::compiler {

// Openings by the squares of the plan that their boxes meet: the ones close to another are found without a look at all.
class OpeningPlaces {
 public:
  void Add(const DrawnOpening& o, uint32_t number) {
    ForEachCell(o, [&](const Cell& cell) { numbers_[cell].push_back(number); });
  }
  // Some more than once.
  template <class Visit>
  void ForEachNear(const DrawnOpening& o, const Visit& visit) const {
    ForEachCell(o, [&](const Cell& cell) {
      if (const auto found = numbers_.find(cell); found != numbers_.end()) std::for_each(found->second.begin(), found->second.end(), visit);
    });
  }

 private:
  using Cell = std::pair<int64_t, int64_t>;
  static constexpr double kCell_m = 4;

  template <class Visit>
  static void ForEachCell(const DrawnOpening& o, const Visit& visit) {
    const Eigen::Vector2d low = o.from.cwiseMin(o.to).array() - 0.5 * o.depth_m, high = o.from.cwiseMax(o.to).array() + 0.5 * o.depth_m;
    const auto cell = [](double at_m) { return static_cast<int64_t>(std::floor(at_m / kCell_m)); };
    for (int64_t x = cell(low.x()); x <= cell(high.x()); ++x) {
      for (int64_t y = cell(low.y()); y <= cell(high.y()); ++y) visit(Cell(x, y));
    }
  }

  std::map<Cell, std::vector<uint32_t>> numbers_;
};

}  // namespace plumb::compiler
