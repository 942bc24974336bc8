// Short lines ("surfels") on a square grid: what planar scans are registered to.
//
// A cell may hold several lines, told apart by the direction they face: the two walls of a corner or the two faces of a thin wall never
// mix.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "runtime/odometry/planar/planar_scan.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {

struct LineSurfel {
  // Statistics of the points.
  double count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), normal_sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d outer = Eigen::Matrix2d::Zero();
  uint32_t next = VoxelIndex::kNone;  // in the cell

  // The line, if `fitted`.
  bool fitted = false;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero(), normal = Eigen::Vector2d::UnitX();  // the normal towards where it was seen from
  double var_across_m2 = 0, var_along_m2 = 0;

  // Of the line's direction.
  [[nodiscard]] double NormalVariance(double sigma_m) const { return std::max(var_across_m2, sigma_m * sigma_m) / (count * var_along_m2); }
  // Of the signed distance of a point of the same line at p: its noise, and how well the line is known there.
  [[nodiscard]] double DistanceVariance(const Eigen::Vector2d& p, double sigma_m) const;
};

class LineMap {
 public:
  explicit LineMap(double sigma_m) : sigma_m_(sigma_m) {}

  // Adds a scan taken at `pose`; points without a normal are left out. O(points).
  void Insert(const PlanarScan& scan, const Pose2& pose);
  // Fits the lines; to be called after the last Insert(). O(lines).
  void Fit();

  // The line that a point at p with `normal` most likely lies on, seen from `sensor`. Null: none within about a cell.
  [[nodiscard]] const LineSurfel* Nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal, const Eigen::Vector2d& sensor) const;

 private:
  double sigma_m_;
  VoxelIndex index_;
  std::vector<uint32_t> first_;  // of each cell
  std::vector<LineSurfel> lines_;
};

}  // namespace plumb::runtime
