// Whether two A-Graphs are one plan: rooms, doorways, windows and wall surfaces by place, whatever their order, ids and pieces.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "schema/agraph.h"

namespace plumb::test {

struct SamePlanOptions {
  Eigen::Isometry2d T_reference_other = Eigen::Isometry2d::Identity();  // between the plan frames
  double tolerance_m = 0.01;
  bool names = true;     // of rooms
  bool leaves = true;    // whether doorways have a leaf
  bool swings = false;   // how their leaves open
  bool heights = false;  // of floors and ceilings, which drawings do not have
};

// Differences, one sentence each; none: the same plan. Rooms by center and area, doorways and windows by position and width, doorways also
// by the rooms that they join. Surfaces are compared point by point, since sources divide walls at different places: each point of a side
// or arc has one of the other plan within the tolerance, facing the same way, in the same storey and room. Not compared: heights of walls,
// doors and sills, and how walls are divided.
[[nodiscard]] std::vector<std::string> PlanDifferences(const AGraph& reference, const AGraph& other, const SamePlanOptions& options);

}  // namespace plumb::test
