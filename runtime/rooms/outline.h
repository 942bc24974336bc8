// The outline of a region as polygons on the walls that bound it.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/rooms/free_space.h"
#include "runtime/rooms/regions.h"
#include "runtime/rooms/rooms.h"

namespace plumb::runtime {

struct Outline {
  Polygon2 polygon;                // counter-clockwise
  std::vector<Polygon2> holes;     // clockwise
  std::vector<uint32_t> surfaces;  // ids, ascending
  double covered_ratio = 0;        // of the length that is no border to another region: by walls
  double longest_unseen_m = 0;     // longest stretch where neither a wall nor a hit was seen, nor another region
};

// Follows the region's cells; what lies along a wall piece (within 15 cm, facing the region) becomes one edge on it, with corners where two
// walls meet; the rest is simplified to 8 cm. Holes smaller than 0.05 m2 are left out. One outline per region, in their order. O(cells +
// border cells * walls near the region).
[[nodiscard]] std::vector<Outline> TraceOutlines(const FreeSpace& space, const Regions& regions);

[[nodiscard]] double SignedArea(const Polygon2& polygon);  // m2, positive if counter-clockwise
[[nodiscard]] Eigen::Vector2d AreaCentroid(const Polygon2& polygon);

}  // namespace plumb::runtime
