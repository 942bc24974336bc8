// Walls in the plane and a laser that scans them, for tests of planar lasers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/odometry/planar/pose2.h"
#include "runtime/sources/recording.h"

namespace plumb::test {

struct PlanarLaserOptions {
  int beams = 361;
  double fov_rad = 3.14159265358979;  // ahead
  double noise_m = 0.01, max_range_m = 30;
};

class PlanarWorld {
 public:
  void AddWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to) { walls_.emplace_back(from, to); }
  void AddBox(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi);

  // What the laser sees at `pose`, all at once, one ring at z = 0. The same seed gives the same noise.
  [[nodiscard]] runtime::Scan Sweep(const runtime::Pose2& pose, double stamp_s, uint64_t seed,
                                    const PlanarLaserOptions& options = {}) const;

 private:
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> walls_;
};

// A room of 8 m x 6 m with furniture, from whose door a corridor leads round a block of 10 m x 8 m and back to it. Origin: the room's
// middle.
[[nodiscard]] PlanarWorld MakeLoopWorld();
// From the room, round the block and back into the room, `step_m` apart and turning by at most 0.35 rad at a time.
[[nodiscard]] std::vector<runtime::Pose2> LoopDrive(double step_m);

}  // namespace plumb::test
