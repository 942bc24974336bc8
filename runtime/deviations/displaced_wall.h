// Whether a wall that is not where it is planned may stand displaced: at each offset and turn that a wall may be built with, is what was
// seen there seen through?
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/face_grid.h"
#include "runtime/deviations/sights.h"
#include "runtime/deviations/wall_presence.h"

namespace plumb::runtime {

class DisplacedWall {
 public:
  // `faces` of one wall that has a reference, with no lines counted yet.
  DisplacedWall(const WallFrame& frame, std::vector<FaceGrid> faces, const PresenceOptions& options);

  // A line of sight; `stops`: what was seen at its end is no other wall and nothing else that the plan has. O(places * faces) near the
  // wall, O(1) elsewhere.
  void Count(const Sight& sight, bool stops);

  // Is there a place in which most of what was seen of it stops lines? Then the wall may stand there. A place that was not seen, as one
  // inside the next wall or behind the robot, says nothing.
  [[nodiscard]] bool MayStand() const;

 private:
  const PresenceOptions options_;
  const Eigen::Vector2d pivot_;
  double reach_m_ = 0;                         // from the planned plane, of all places
  double radius_m_ = 0;                        // from the pivot
  std::vector<Panel> planned_;                 // per face
  std::vector<std::vector<FaceGrid>> places_;  // per place its faces
};

}  // namespace plumb::runtime
