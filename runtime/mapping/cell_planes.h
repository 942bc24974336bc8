// Planes through points that were gathered in cells along a rough plane.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Two directions along a plane, in the order (along, across). Walls: along is horizontal and has the free space on its left, across is
// upwards; floors and ceilings: along is close to the frame's x axis. `up` is away from gravity.
struct PlaneAxes {
  Eigen::Vector3d along, across;
};
[[nodiscard]] PlaneAxes AxesOf(const Plane& plane, SurfaceKind kind, const Eigen::Vector3d& up);

inline constexpr double kCell_m = 0.1;  // of occupancy on surfaces

// Of the points in a cell that were given to a plane.
struct CellStats : PlaneStats {
  double contested = 0;  // number of them that may be another plane's as well
};

// The planes that cells' points form, largest first: each is the plane that cells' means agree on best within their noise, fitted to all
// points of these cells (total least squares). A single point does not tell a door leaf from the wall 5 cm before it, the mean of a cell's
// points does. `normal` and `axes` of the rough plane; `sigma_m` of the points about a plane. Leaves out what is too small. O(cells) per
// plane.
[[nodiscard]] std::vector<Segment> SplitCells(const std::vector<CellStats>& cells, SurfaceKind kind, const Eigen::Vector3d& normal,
                                              const PlaneAxes& axes, double sigma_m, const MapperOptions& options);

}  // namespace plumb::runtime
