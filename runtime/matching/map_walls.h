// The upright surfaces of the map as segments in the plane, each wall once.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

struct MapWall {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX(), along = Eigen::Vector2d::UnitY();
  double length_m = 0, z_min_m = 0, z_max_m = 0;
  double spread_m = 0;  // rms distance of its points from its plane; 0: not known, as in maps of planar lasers
};

// Map frame, at least 0.4 m long. Rough ranges break one wall into surfaces one before the other, apart by less than their points spread:
// those become one wall, so that none is counted twice. O(surfaces^2 + observations). Deterministic.
[[nodiscard]] std::vector<MapWall> UprightWalls(const SGraph& map);

// One sigma of how far a wall that stands as planned is off its plan in this map: by what its points spread (weighted median over the
// walls' lengths) and by what builders are off (runtime/METHOD.md, matching). 2 cm if the walls' spread is not known.
[[nodiscard]] double SigmaOfWalls(std::span<const MapWall> walls);

}  // namespace plumb::runtime
