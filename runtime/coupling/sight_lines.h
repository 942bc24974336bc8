// Lines of sight, from keyframes to the points seen from there. Nothing is seen through a wall: what many lines pass is the front of
// something in the room, or a pane.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/coupling/wall_openings.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// A wall's face as it would be if built in the vertical plane through `point` with the horizontal unit normal `normal` (into the free
// space): upright, as long and as high as `planned`.
struct SupposedFace {
  Eigen::Vector2d point, normal;
  const Surface* planned;
  const std::vector<WallOpening>* openings;  // of its wall
};

class SightLines {
 public:
  // An even sample of each keyframe's points, in the plan frame. O(keyframes).
  SightLines(const SGraph& map, const Eigen::Isometry3d& T_plan_map);

  struct Count {
    size_t ended = 0, passed = 0;  // lines that end on the face, and that go on beyond
  };
  // Lines that meet the face from its free side, away from its edges and openings. O(lines).
  [[nodiscard]] Count Meeting(const SupposedFace& face) const;

 private:
  struct Line {
    Eigen::Vector3f from, to;
  };
  Eigen::Vector3d origin_ =
      Eigen::Vector3d::Zero();  // of the lines, plan frame: single precision is too coarse at a georeferenced plan's coordinates
  std::vector<Line> lines_;
  double vertical_edge_m_ = 0;  // this close to the face's top and bottom a line may pass it
};

}  // namespace plumb::runtime
