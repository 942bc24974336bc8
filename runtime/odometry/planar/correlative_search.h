// Exhaustive search for a planar scan's pose on a likelihood grid, by branch and bound.
//
// Olson, "Real-time correlative scan matching", ICRA 2009; the bounds as in Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA
// 2016.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/odometry/planar/pose2.h"

namespace plumb::runtime {

// Where the pose is believed to be: heavy-tailed (Student's t, three degrees of freedom), as wheels slip; equally in all directions.
struct PlanarPrior {
  Pose2 mean;
  double sigma_m = 0.1, sigma_rad = 0.1;
  [[nodiscard]] double LogDensity(double distance2_m2, double turn_rad) const;  // nats, 0 at the mean
};

struct SearchWindow {
  double half_m = 0.5, half_rad = 0.3;  // about the prior's mean: a square, and turns either way
};

struct SearchResult {
  Pose2 pose;
  double share = 0;      // mean likelihood of the points at `pose`, 0 to 1
  double log_score = 0;  // nats
};

class LikelihoodGrid {
 public:
  // `points`: of the map. What lies further than max_range_m beyond `center` is left out. O(points + cells).
  LikelihoodGrid(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& center, double max_range_m);

  // The pose on the search's grid (5 cm, and turns that move the farthest points by as much) with the highest score, exactly: log prior
  // plus the points' log likelihoods. `points` in the sensor's levelled frame. Typically under a millisecond to some milliseconds for a
  // metre and half a radian.
  [[nodiscard]] SearchResult Search(std::span<const Eigen::Vector2d> points, const PlanarPrior& prior, const SearchWindow& window) const;

 private:
  struct Node;
  struct Turned;

  // Of cell (x, y) and those up to 2^level - 1 beyond it in either direction, the highest likelihood.
  [[nodiscard]] uint8_t At(int level, int x, int y) const {
    return x >= 0 && y >= 0 && x < width_ && y < height_ ? levels_[static_cast<size_t>(level)][static_cast<size_t>(y * width_ + x)]
                                                         : uint8_t{0};
  }
  [[nodiscard]] double Score(const Turned& turned, const Node& node, const PlanarPrior& prior) const;

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int width_ = 0, height_ = 0;
  std::vector<std::vector<uint8_t>> levels_;
};

}  // namespace plumb::runtime
