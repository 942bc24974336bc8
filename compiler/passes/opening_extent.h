// How an opening lies in the outline of its wall, seen from above. Metres, plan frame; all linear in the outline's points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

// Direction of the side nearest to `p`; none without sides.
[[nodiscard]] std::optional<Eigen::Vector2d> SideNextTo(const std::vector<Ring>& rings, const Eigen::Vector2d& p);

// `extent`, whose x is along the unit vector `along`, without what lies past the wall's ends: there it takes nothing. As it is, if it
// does not meet the wall at all.
[[nodiscard]] Eigen::AlignedBox2d WithinWall(const Eigen::AlignedBox2d& extent, const Eigen::Vector2d& along,
                                             const std::vector<Ring>& rings);

// From where to where the line at + t * across runs inside the rings: the interval nearest to t = 0; none if it misses them.
[[nodiscard]] std::optional<std::pair<double, double>> SolidInterval(const std::vector<Ring>& rings, const Eigen::Vector2d& at,
                                                                     const Eigen::Vector2d& across);

}  // namespace plumb::compiler
