// A drive through MakeHouse() as an S-Graph with known truth: keyframes, views as plane statistics of sampled points, drifting odometry.
// Data association is given (each map surface is one built surface); poses in the map are odometry's.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::test {

// Same numbers on every platform.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  double Uniform(double lo, double hi);
  double Normal(double sigma);

 private:
  uint64_t Next();
  uint64_t state_;
};

struct DriveOptions {
  uint64_t seed = 1;
  std::vector<runtime::WallDeviation> deviations;  // per plan wall, as built; empty: as planned
  double noise_m = 0.02;
  double range_bias_m = 0;        // every point this far inside the free space
  std::vector<double> thickness_errors_m;          // per plan wall; empty: none
  int points_per_view = 300;
  double drift_m = 0.003, drift_rad = 0.0005;  // per keyframe step
  bool floors = true;
};

struct Drive {
  runtime::SGraph map;
  std::vector<SurfaceId> built;               // per map surface: the plan surface it is; none for floors
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();  // true
  std::vector<Eigen::Isometry3d> T_plan_kf;   // true
};

[[nodiscard]] Drive DriveThroughHouse(const AGraph& house, const DriveOptions& options = {});

// Adds a flat thing between two points (free space to the left of start -> end), seen from all keyframes in front of it within `range_m`.
void AddPatch(Drive& drive, const Eigen::Vector2d& start, const Eigen::Vector2d& end, double z_min_m, double z_max_m, double range_m,
              uint64_t seed);

// Cells all over a wall's extent, as if every part of it had been seen.
void FillCells(runtime::MapSurface& surface);

// The true place of the map, moved by this much about the start: what a matcher's fix may look like.
[[nodiscard]] Eigen::Isometry3d Disturbed(const Eigen::Isometry3d& T_plan_map, double dx_m, double dy_m, double dyaw_rad);

}  // namespace plumb::test
