// A doorway where its wall was built: the frame that its jambs are looked for in.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "runtime/matching/ray_caster.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// One side of an opening, as planned.
struct PlannedJamb {
  double u_m = 0;        // of the clear opening's side
  double step_m = 0;     // that a frame stands into the opening beyond the wall's end
  double outward_m = 0;  // of plain wall beside the opening, 0.5 m at most
};

// u: along the built wall, + to the left of who passes from room_a to room_b; w: across it, + into room_b; both from where the planned
// middle of the opening would be had the wall moved along its own normal and turned about the middle of its longest surface.
struct BuiltDoorway {
  DoorwayId doorway;
  WallId wall;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero(), along = Eigen::Vector2d::UnitY(), across = Eigen::Vector2d::UnitX();
  double w_a_m = 0, w_b_m = 0;      // of the built faces towards room_a and room_b
  double z_min_m = 0, z_max_m = 0;  // of the opening, less thresholds and what is fixed to lintels
  PlannedJamb right, left;          // at lower and at higher u

  [[nodiscard]] double U(const Eigen::Vector2d& p) const { return along.dot(p - origin); }
  [[nodiscard]] double W(const Eigen::Vector2d& p) const { return across.dot(p - origin); }
};

// Where doorways are planned in their walls: what the plan alone says. O(surfaces + triangles of doors).
class PlannedDoorways {
 public:
  explicit PlannedDoorways(const AGraph& plan);

  // None: its wall is curved, has no face there, or ends at the opening.
  [[nodiscard]] std::optional<BuiltDoorway> Built(DoorwayId doorway, const WallEstimate& wall) const;

 private:
  [[nodiscard]] PlannedJamb JambOf(const Doorway& doorway, double side, double w_a_m, double w_b_m) const;
  [[nodiscard]] double PlainWallBeside(DoorwayId doorway, double side) const;

  const AGraph& plan_;
  const RayCaster fixed_;  // what does not move with the leaves
};

}  // namespace plumb::runtime
