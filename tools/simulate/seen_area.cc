#include "tools/simulate/seen_area.h"

#include <cmath>

namespace plumb::tools {
namespace {

constexpr double kSeenCell_m = 0.1;
constexpr uint8_t kMinReturns = 3;

// Sixteen bits each for the place along the surface and up, which reach 3 km.
uint64_t KeyOf(const SurfaceHit& hit) {
  const auto bits = [](double at_m) { return static_cast<uint64_t>(static_cast<uint16_t>(std::lround(std::floor(at_m / kSeenCell_m)))); };
  return uint64_t{hit.surface.value} << 32 | bits(hit.along_m) << 16 | bits(hit.up_m);
}

}  // namespace

void SeenArea::Add(const std::vector<SurfaceHit>& hits) {
  for (const SurfaceHit& hit : hits) {
    if (!hit.surface.valid()) continue;
    uint8_t& returns = returns_[KeyOf(hit)];
    if (returns < kMinReturns) ++returns;
  }
}

std::vector<double> SeenArea::PerSurface_m2(size_t num_surfaces) const {
  std::vector<size_t> cells(num_surfaces, 0);
  for (const auto& [key, returns] : returns_) {
    if (returns >= kMinReturns) ++cells[key >> 32];
  }
  std::vector<double> areas_m2;
  for (const size_t count : cells) areas_m2.push_back(static_cast<double>(count) * kSeenCell_m * kSeenCell_m);
  return areas_m2;
}

}  // namespace plumb::tools
