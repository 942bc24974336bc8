// The walls that are known to stand, where they were built.
#pragma once

#include <vector>

#include "runtime/deviations/panel.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

class StandingWalls {
 public:
  // Of `estimate` the faces of walls of which at least `min_observed_m2` was seen.
  StandingWalls(const AGraph& plan, const JointResult& estimate, double min_observed_m2);

  // The walls on whose built faces the point lies, each as often as faces of it are near.
  void At(const Eigen::Vector3d& p, std::vector<WallId>& out);

  // Does the line go through a wall that stands, away from its doorways? That is no line of sight but one that was mirrored, or went
  // through a pane.
  [[nodiscard]] bool InTheWay(const Sight& sight);

 private:
  const AGraph& plan_;
  std::vector<std::vector<const Doorway*>> doorways_;  // per wall
  std::vector<WallId> walls_;  // per panel; before them, as it is filled with them
  std::vector<Panel> panels_;
  PanelGrid grid_;
  std::vector<uint32_t> near_;
};

}  // namespace plumb::runtime
