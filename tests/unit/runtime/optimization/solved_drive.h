// A drive through the house, matched to its plan and solved.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "runtime/optimization/joint_optimizer.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {

inline constexpr double kDeg = std::numbers::pi / 180;
enum HouseWall : size_t { kSouth, kEast, kNorth, kWest, kMiddle, kAcross, kNumWalls };

struct Solved {
  test::Drive drive;
  JointResult result;
  std::vector<Match> matches;
};

// As the localizer does: match, solve, write back, repeat.
inline Solved SolveDrive(const AGraph& house, test::Drive drive, int turns = 2) {
  Solved s{std::move(drive), {}, {}};
  Eigen::Isometry3d T = test::Disturbed(s.drive.T_plan_map, 0.05, -0.04, 0.7 * kDeg);
  std::vector<WallDeviation> known;
  for (int i = 0; i < turns; ++i) {
    s.matches = MatchSurfaces(s.drive.map, house, T, known);
    s.result = OptimizeJointly(s.drive.map, house, s.matches, T);
    T = s.result.T_plan_map;
    known = s.result.Deviations(house.walls.size());
    for (size_t k = 0; k < s.result.T_map_kf.size(); ++k) s.drive.map.keyframes[k].T_map_kf = s.result.T_map_kf[k];
  }
  return s;
}

inline Solved Solve(const AGraph& house, const test::DriveOptions& options) {
  return SolveDrive(house, test::DriveThroughHouse(house, options));
}

inline test::DriveOptions WithDeviations(uint64_t seed, std::vector<std::pair<HouseWall, WallDeviation>> deviated) {
  test::DriveOptions options;
  options.seed = seed;
  options.deviations.assign(kNumWalls, {});
  for (const auto& [wall, deviation] : deviated) options.deviations[wall] = deviation;
  return options;
}

}  // namespace plumb::runtime
