// Ways through the plan: straight lines inside rooms, from one doorway or open boundary to the next.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "schema/agraph.h"

namespace plumb::runtime {

// Just inside a room, behind the doorway or open boundary by which it was entered.
struct WalkStop {
  RoomId room;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // plan frame, on the floor
  double distance_m = 0;                                 // from the start along the way
  int before = -1;                                       // the stop before it, as index; -1: none
};

// Where shortest ways of at most `max_m` from `start` (plan frame) lead on its storey, nearest first, at most `max_stops`. Only rooms are
// entered, whether their door has a leaf or not. Inside rooms that are not convex, ways are longer than this says. Deterministic.
[[nodiscard]] std::vector<WalkStop> WalksFrom(const AGraph& plan, const Eigen::Vector3d& start, double max_m, size_t max_stops);

}  // namespace plumb::runtime
