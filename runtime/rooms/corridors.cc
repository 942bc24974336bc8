#include "runtime/rooms/corridors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace plumb::runtime {
namespace {

constexpr double kFacingCos = -0.996;
constexpr double kMinWidth_m = 0.6, kMaxWidth_m = 5.0, kMinLengthToWidth = 2.0;
constexpr double kStep_m = 0.1;

// A surface as one piece, across its openings.
std::vector<WallPiece> SidesOf(const FreeSpace& space, const Outline& outline) {
  std::map<uint32_t, WallPiece> sides;
  for (const WallPiece& wall : space.walls) {
    if (!std::binary_search(outline.surfaces.begin(), outline.surfaces.end(), wall.surface)) continue;
    const auto [at, added] = sides.emplace(wall.surface, wall);
    if (!added) at->second.end = wall.end;  // pieces follow each other from the surface's start to its end
  }
  std::vector<WallPiece> out;
  for (const auto& [id, side] : sides) out.push_back(side);
  return out;
}

// The longest stretch of the centre line that lies in the region's free space.
std::optional<MapCorridor> Between(const WallPiece& a, const WallPiece& b, const FreeSpace& space, const Regions& regions, int32_t region) {
  if (a.normal().dot(b.normal()) > kFacingCos) return std::nullopt;
  MapCorridor corridor;
  corridor.surface_a = a.surface;
  corridor.surface_b = b.surface;
  corridor.width_m = a.normal().dot(0.5 * (b.start + b.end) - a.start);
  if (corridor.width_m < kMinWidth_m || corridor.width_m > kMaxWidth_m) return std::nullopt;
  const double low = std::max(0.0, a.along().dot(b.end - a.start)), high = std::min(a.length_m(), a.along().dot(b.start - a.start));
  const Eigen::Vector2d middle = a.start + 0.5 * corridor.width_m * a.normal();
  double best_m = 0, from = low;
  for (double at = low; at <= high; at += kStep_m) {
    const Eigen::Vector2d p = middle + at * a.along();
    if (regions.label[space.grid.CellAt(p)] != region) {
      from = at + kStep_m;
      continue;
    }
    if (at - from <= best_m) continue;
    best_m = at - from;
    corridor.start = middle + from * a.along();
    corridor.end = p;
  }
  if (best_m < kMinLengthToWidth * corridor.width_m) return std::nullopt;
  return corridor;
}

bool LiesIn(const MapCorridor& c, const MapCorridor& longer) {
  const Eigen::Vector2d along = (longer.end - longer.start).normalized(), step = 0.5 * (c.start + c.end) - longer.start;
  const double at = along.dot(step), off = std::abs(along.x() * step.y() - along.y() * step.x());
  return off < 0.5 * longer.width_m && at > 0 && at < (longer.end - longer.start).norm();
}

}  // namespace

std::vector<MapCorridor> FindCorridors(const FreeSpace& space, const Regions& regions, int32_t region, const Outline& outline) {
  const std::vector<WallPiece> sides = SidesOf(space, outline);
  std::vector<MapCorridor> found;
  for (size_t i = 0; i < sides.size(); ++i) {
    for (size_t k = i + 1; k < sides.size(); ++k) {
      if (const std::optional<MapCorridor> corridor = Between(sides[i], sides[k], space, regions, region)) found.push_back(*corridor);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const MapCorridor& a, const MapCorridor& b) { return (a.end - a.start).norm() > (b.end - b.start).norm(); });
  std::vector<MapCorridor> corridors;
  for (const MapCorridor& c : found) {
    if (std::none_of(corridors.begin(), corridors.end(), [&](const MapCorridor& longer) { return LiesIn(c, longer); }))
      corridors.push_back(c);
  }
  return corridors;
}

}  // namespace plumb::runtime
