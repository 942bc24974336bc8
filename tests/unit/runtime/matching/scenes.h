// Maps of the house that the matching tests share.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/matching/matcher.h"
#include "tests/support/house.h"
#include "tests/support/plans.h"
#include "tests/support/synthetic_map.h"

namespace plumb::test {

using Tour = std::vector<Eigen::Vector2d>;

// One room and a look into the next: as much as it takes to tell the house from its mirror image.
inline const Tour kFromA{{2.5, 1.7}, {1.5, 1.2}, {3.5, 2.2}, {4.5, 2.75}};
inline const Tour kFromB{{2.5, 4.7}, {1.0, 5.0}, {2.45, 3.8}, {2.45, 3.0}, {3.5, 2.2}};
inline const Tour kFromC{{7.0, 3.0}, {6.0, 1.5}, {7.5, 4.5}, {5.5, 2.75}};
inline const Tour kWholeHouse{{2.5, 1.7}, {1.5, 1.2}, {3.5, 2.2}, {7.0, 3.0}, {6.0, 1.5}, {7.5, 4.5}, {2.5, 4.7}, {1.0, 5.0}};

inline SyntheticMapOptions OnTour(const Tour& tour, const Eigen::Isometry3d& T_plan_map, uint64_t seed = 1) {
  SyntheticMapOptions options;
  options.positions = tour;
  options.T_plan_map = T_plan_map;
  options.seed = seed;
  return options;
}

struct PoseError {
  double xy_m = 0, z_m = 0, yaw_rad = 0;
};

// At `at` (plan frame).
inline PoseError ErrorOf(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth, const Eigen::Vector2d& at) {
  const Eigen::Isometry3d off = estimate * truth.inverse();
  const Eigen::Vector3d p(at.x(), at.y(), 0), moved = off * p - p;
  return {moved.head<2>().norm(), std::abs(moved.z()), std::abs(std::atan2(off.linear()(1, 0), off.linear()(0, 0)))};
}

inline double Degrees(double rad) { return rad * 180 / std::numbers::pi; }

}  // namespace plumb::test
