// How far the cells of a grid are from the nearest marked one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::runtime {

// Squared distances between centres, in cells; infinity if nothing is marked. `marked` is a grid row by row, `width` cells each. Exact up
// to 4000 cells, then to single precision. O(cells) (Felzenszwalb and Huttenlocher 2012).
[[nodiscard]] std::vector<float> SquaredCellDistances(const std::vector<uint8_t>& marked, size_t width);

}  // namespace plumb::runtime
