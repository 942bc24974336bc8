// A small house as an A-Graph made by hand, for tests that need a plan but no compiler.
//
//   y=6 +-----------------+-----------+
//       |   B (5.0x2.4)   |           |     outer walls 0.30 m, inner walls 0.12 m; inner size 9.0 m x 6.0 m, 2.6 m high
//       +------D1---------+           |     rooms: A south-west, B north-west, C east
//       |                 D2    C     |     D1: A-B, D2: A-C, D3: A-outside (west wall, closed leaf)
//   D3  |   A             |           |     no rotational symmetry
//   y=0 +-----------------+-----------+
//       x=0              5.0        9.0
#pragma once

#include "schema/agraph.h"

namespace plumb::test {

[[nodiscard]] AGraph MakeHouse();

// Adds an axis-aligned box [lo, hi] (plan frame) to the graph's mesh as `element`.
void AddBox(AGraph& graph, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi, uint32_t element);

}  // namespace plumb::test
