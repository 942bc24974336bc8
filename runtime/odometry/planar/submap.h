// A few scans around a place, to register others to.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "runtime/odometry/planar/correlative_search.h"
#include "runtime/odometry/planar/line_map.h"
#include "runtime/odometry/planar/planar_registration.h"

namespace plumb::runtime {

struct PlacedScan {
  const PlanarScan* scan = nullptr;
  Pose2 pose;
};

inline constexpr double kSearchRange_m = 25.0;  // points further off say little more

// Scans' points within kSearchRange_m of `center`, for the search. O(points + cells).
[[nodiscard]] LikelihoodGrid GridOf(std::span<const PlacedScan> scans, const Eigen::Vector2d& center);
// All scans' lines. O(points).
[[nodiscard]] LineMap LinesOf(std::span<const PlacedScan> scans, double sigma_m);
// A scan's points for the search.
[[nodiscard]] std::vector<Eigen::Vector2d> SearchPoints(const PlanarScan& scan);

}  // namespace plumb::runtime
