// A spinning LiDAR in a graph's mesh, for tests: VLP-16 by default, with range noise and motion during the sweep.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "runtime/matching/ray_caster.h"
#include "runtime/sources/recording.h"
#include "schema/agraph.h"

namespace plumb::test {

struct SyntheticLidarOptions {
  int rings = 16, azimuths = 1800;
  double half_fov_rad = 0.2617993877991494;  // 15 degrees
  double period_s = 0.1;
  double noise_m = 0.02;
  double max_range_m = 100;
  bool with_time = true;
  uint64_t seed = 1;
};

using PoseAt = std::function<Eigen::Isometry3d(double)>;  // T_plan_lidar at a time

class SyntheticLidar {
 public:
  explicit SyntheticLidar(const AGraph& graph, const SyntheticLidarOptions& options = {});
  // The sweep that starts at stamp_s. The same stamp gives the same noise.
  [[nodiscard]] runtime::Scan Sweep(const PoseAt& pose_at, double stamp_s) const;

 private:
  SyntheticLidarOptions options_;
  Eigen::Vector3d origin_;
  runtime::RayCaster caster_;
};

// A drive along a polyline at constant height: turns on the spot towards each leg, then drives it, each from rest to rest with the given
// top speed. Starts at the first point, in the first leg's direction.
class Drive {
 public:
  Drive(const std::vector<Eigen::Vector2d>& points, double height_m, double speed_mps = 0.8, double turn_radps = 1.0);
  [[nodiscard]] Eigen::Isometry3d At(double t_s) const;
  [[nodiscard]] double duration_s() const { return legs_.empty() ? 0 : legs_.back().end_s; }
  [[nodiscard]] double length_m() const;

 private:
  struct Leg {
    double start_s, end_s;
    Eigen::Vector2d from, to;
    double yaw_from_rad, yaw_to_rad;
  };
  double height_m_;
  std::vector<Leg> legs_;
};

// Through all three rooms of MakeHouse() by the doors D1 and D2, `rounds` times, 21 m each, and back to the start.
[[nodiscard]] Drive HouseDrive(int rounds = 1, double height_m = 0.8);

}  // namespace plumb::test
