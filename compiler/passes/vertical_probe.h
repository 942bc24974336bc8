// Heights of floors and ceilings by vertical rays into the solids of a plan.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "compiler/geometry/box_tree.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

// Holds on to the plan. Rays cost O(log triangles + triangles at that place).
class VerticalProbe {
 public:
  VerticalProbe(const PlanIr& plan, std::initializer_list<ElementKind> kinds);

  // The nearest surface at or above (below) z_m on the vertical through `p`; none if there is none.
  [[nodiscard]] std::optional<double> Above(const Eigen::Vector2d& p, double z_m) const;
  [[nodiscard]] std::optional<double> Below(const Eigen::Vector2d& p, double z_m) const;

 private:
  struct Target {
    const Solid* solid;
    uint32_t triangle;
  };
  template <class Visit>
  void ForEachHit(const Eigen::Vector2d& p, const Visit& visit) const;

  std::vector<Target> targets_;
  BoxTree<2> tree_;  // of the targets, seen from above
};

}  // namespace plumb::compiler
