// What drawn swings say of a door's leaves. In the door's own frame: x along its width, y across it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "schema/agraph.h"

namespace plumb::compiler {

// DoorLeaf in that frame.
struct FramedLeaf {
  LeafOperation operation = LeafOperation::kUnknown;
  int at_x = 0;        // the jamb: -1 at low x, +1 at high x, 0 unknown
  int opens_to_y = 0;  // -1 or +1; 0 unknown
  double width_m = 0;  // 0: unknown
};

// A leaf that hangs at `hinge` and whose free end moves between two points, one of which closes the door. None: no leaf of a door
// `door_width_m` wide (0: unknown) moves so.
[[nodiscard]] std::optional<FramedLeaf> LeafOfSwing(const Eigen::Vector2d& hinge, const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                                                    double door_width_m);

// Of all swings in one door, one leaf for each jamb, low x first: the widest. One that swings to both sides is double-acting. Empty if the
// leaves are too wide for the door together.
[[nodiscard]] std::vector<FramedLeaf> OnePerJamb(std::span<const FramedLeaf> swings, double door_width_m);

}  // namespace plumb::compiler
