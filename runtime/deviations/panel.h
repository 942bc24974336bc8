// Upright flat pieces of the building, and which of them a line of sight may meet.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/deviations/sights.h"

namespace plumb::runtime {

// Plan frame. `u` runs from `start` along the panel, `w` from its middle plane along `normal`.
struct Panel {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), along = Eigen::Vector2d::UnitX(), normal = Eigen::Vector2d::UnitY();
  double length_m = 0, z_min_m = 0, z_max_m = 0;

  [[nodiscard]] double U(const Eigen::Vector2d& p) const { return along.dot(p - start); }
  [[nodiscard]] double W(const Eigen::Vector2d& p) const { return normal.dot(p - start); }
  // Is the point within the panel's extent, as seen along its normal?
  [[nodiscard]] bool Covers(double u, double z, double margin_m) const {
    return u > -margin_m && u < length_m + margin_m && z > z_min_m - margin_m && z < z_max_m + margin_m;
  }
};

// How a line of sight meets a panel's plane. Distances from the plane count from the sensor's side: + before it, - behind it.
struct Meeting {
  double from_m = 0, to_m = 0;  // of the sensor and of what was seen
  double u = 0, z = 0;          // where the line, drawn on if need be, goes through the plane
  double u_per_m = 0;           // how far it moves along the panel for each metre that it comes nearer
  double sight_m = 0;           // from the sensor to there
  double incidence = 0;         // sine of the angle between line and plane
};

// False for lines that run along the panel or away from it.
[[nodiscard]] bool Meet(const Panel& panel, const Sight& sight, Meeting* meeting);

// Finds the panels that a line passes close by. A grid over the plane: O(cells crossed).
class PanelGrid {
 public:
  // Panels and what lies up to reach_m from them.
  PanelGrid(const std::vector<Panel>& panels, double reach_m);

  // Of those near the line from `a` to `b`, each once; in an order that depends on the line alone.
  void Near(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::vector<uint32_t>& out);

 private:
  [[nodiscard]] Eigen::Vector2i CellOf(const Eigen::Vector2d& p) const;  // clamped to the grid

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double cell_m_ = 1;
  Eigen::Vector2i size_ = Eigen::Vector2i::Ones();
  std::vector<std::vector<uint32_t>> cells_;
  std::vector<uint32_t> seen_;  // per panel: the number of the query that found it last
  uint32_t query_ = 0;
};

}  // namespace plumb::runtime
