// The walls of a building as built against those of an S-Graph of it: what the map benchmark scores.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/sources/recording.h"
#include "schema/agraph.h"
#include "tools/simulate/simulate.h"

namespace plumb::benchmarks {

// A wall's face seen from above: from `start` to `end`, free space on the left.
struct WallFace {
  Eigen::Vector2d start, end;
  double z_min_m = 0, z_max_m = 0;
  size_t surface = 0;  // of the map or the plan
  double points = 0;   // of the map: returns from it
  std::vector<uint32_t> bin_scans;  // of the plan: how many scans saw each part of it
  [[nodiscard]] Eigen::Vector2d direction() const { return (end - start).normalized(); }
  [[nodiscard]] double length_m() const { return (end - start).norm(); }
  [[nodiscard]] Eigen::Vector2d normal() const { return {-direction().y(), direction().x()}; }
  [[nodiscard]] double seen_m() const;  // by enough scans
};

// The plan's plane surfaces of the storey that the drive sees, as the simulation built them.
[[nodiscard]] std::vector<WallFace> BuiltFaces(const AGraph& plan, const tools::SimulateSummary& simulated);

// Counts a scan for the parts of the built faces that it saw.
void CountSeen(const runtime::Scan& deskewed, const Eigen::Isometry3d& T_plan_lidar, std::vector<WallFace>& built);

[[nodiscard]] std::vector<WallFace> MappedFaces(const runtime::SGraph& map, const Eigen::Isometry3d& T_plan_map);

struct WallScore {
  int walls = 0, found = 0, twice = 0;
  std::vector<double> offsets_m, turns_deg;  // absolute
};

// Names the walls that are missed or mapped twice on stderr.
[[nodiscard]] WallScore ScoreWalls(const std::vector<WallFace>& built, const std::vector<WallFace>& mapped, const runtime::SGraph& map);

}  // namespace plumb::benchmarks
