// How much of each plan surface the lidar saw.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tools/simulate/surface_counter.h"

namespace plumb::tools {

class SeenArea {
 public:
  // Returns with a surface; others count for nothing.
  void Add(const std::vector<SurfaceHit>& hits);
  // Per plan surface: of its cells of 10 cm x 10 cm, as planned, those that at least three returns came from.
  [[nodiscard]] std::vector<double> PerSurface_m2(size_t num_surfaces) const;

 private:
  std::unordered_map<uint64_t, uint8_t> returns_;  // by surface and cell, no more than are needed
};

}  // namespace plumb::tools
