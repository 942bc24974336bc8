// What the plan has besides walls: furniture, columns, stairs. Seen where it is planned, it stands for no wall.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/deviations/sights.h"
#include "runtime/matching/ray_caster.h"
#include "schema/agraph.h"

namespace plumb::runtime {

class PlannedThings {
 public:
  explicit PlannedThings(const AGraph& plan);

  // Does the line of sight end on one?
  [[nodiscard]] bool IsOneAt(const Sight& sight) const;

 private:
  const Eigen::Vector3d origin_;
  const RayCaster caster_;
};

}  // namespace plumb::runtime
