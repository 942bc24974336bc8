// Where the robot was when the map began, as somebody believes: a prior on its place in the plan, never a command.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "schema/agraph.h"

namespace plumb::runtime {

struct StartHint {
  std::optional<Eigen::Vector2d> near_m;  // about here, plan frame, on any storey
  double near_sigma_m = 2;
  std::vector<RoomId> rooms;              // in one of these
  // Probability that the hint holds. What is left is spread over the whole plan: a wrong hint costs the right place ln(1 / (1 - trust))
  // nats, which evidence makes up for, and then still is no more than a late fix.
  double trust = 0.999;
  [[nodiscard]] bool given() const { return near_m.has_value() || !rooms.empty(); }
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// ln of the density of the robot's start at `position_m` (plan frame), relative to "anywhere in the plan's rooms"; 0 without a hint, or in
// a plan without rooms. With both a place and rooms, of their product. Rooms reach half a metre through their walls and doorways.
[[nodiscard]] double LogPrior(const AGraph& plan, const StartHint& hint, const Eigen::Vector3d& position_m);

}  // namespace plumb::runtime
