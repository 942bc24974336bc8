#include "runtime/rooms/doorways.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/rooms/free_span.h"

namespace plumb::runtime {
namespace {

constexpr double kMinThickness_m = 0.02, kMaxThickness_m = 0.8;
constexpr double kStep_m = 0.025;
constexpr double kMaxDepth_m = 0.5;     // of a passage, from its narrowest place either way
constexpr double kStillNarrow_m = 0.1;  // wider than at the narrowest place by less
constexpr double kLookBeyond_m = 0.3;

// Mean direction of the walls beside the span, weighted by length; the span's own where there are none.
Eigen::Vector2d AcrossWalls(const FreeSpan& span, const std::vector<WallPiece>& walls) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const WallPiece& wall : walls) sum += (wall.along().dot(span.across()) < 0 ? -1 : 1) * (wall.end - wall.start);
  return sum.norm() > 0 ? sum.normalized() : span.across();
}

// How far along `passage` from p the middle of the wall is.
std::optional<double> MiddleOfWall(const Eigen::Vector2d& p, const Eigen::Vector2d& passage, const std::vector<WallPiece>& walls) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double before = -kNone, after = kNone;  // the faces next to p
  for (const WallPiece& wall : walls) {
    const Eigen::Vector2d middle = 0.5 * (wall.start + wall.end);
    const double at = passage.dot(middle - p);
    if (wall.normal().dot(passage) < 0 && at > before) before = at;
    if (wall.normal().dot(passage) > 0 && at < after) after = at;
  }
  const double thickness_m = after - before;
  if (!(thickness_m >= kMinThickness_m && thickness_m <= kMaxThickness_m)) return std::nullopt;
  return 0.5 * (before + after);
}

// The same by where the passage is about as narrow as at p.
double MiddleOfPassage(const FreeSpace& space, const Eigen::Vector2d& p, const Eigen::Vector2d& passage, double width_m) {
  const Eigen::Vector2d across(passage.y(), -passage.x());
  double ends_m[2] = {0, 0};
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? -1 : 1;
    for (double at = kStep_m; at <= kMaxDepth_m; at += kStep_m) {
      if (SpanAlong(space, p + sign * at * passage, across, width_m + kStillNarrow_m).width_m() > width_m + kStillNarrow_m) break;
      ends_m[side] = sign * at;
    }
  }
  return 0.5 * (ends_m[0] + ends_m[1]);
}

// Where the walls at one end of the opening begin, from p along `outwards`: the mean of their edges. None if there are no walls.
std::optional<double> EdgeOf(const std::vector<WallPiece>& walls, const Eigen::Vector2d& p, const Eigen::Vector2d& outwards) {
  if (walls.empty()) return std::nullopt;
  double sum_m = 0;
  for (const WallPiece& wall : walls) sum_m += std::min(outwards.dot(wall.start - p), outwards.dot(wall.end - p));
  return sum_m / static_cast<double>(walls.size());
}

bool LeadsTo(const FreeSpace& space, const Regions& regions, const Eigen::Vector2d& p, const Eigen::Vector2d& passage, int32_t region) {
  for (double at = 0; at <= kMaxDepth_m + kLookBeyond_m; at += kStep_m) {
    if (regions.label[space.grid.CellAt(p + at * passage)] == region) return true;
  }
  return false;
}

}  // namespace

std::optional<Opening> MeasureOpening(const FreeSpace& space, const Regions& regions, const Neck& neck, const RoomOptions& options) {
  const FreeSpan narrowest = NarrowestSpan(space, regions.clearance_m, neck.cell, options.passage_width_m);
  const std::vector<WallPiece> at_a = WallsBeside(space, narrowest, false), at_b = WallsBeside(space, narrowest, true);
  std::vector<WallPiece> walls = at_a;
  walls.insert(walls.end(), at_b.begin(), at_b.end());
  const Eigen::Vector2d across = AcrossWalls(narrowest, walls);
  Eigen::Vector2d passage(-across.y(), across.x());
  Eigen::Vector2d p = narrowest.middle();
  p += MiddleOfWall(p, passage, walls).value_or(MiddleOfPassage(space, p, passage, narrowest.width_m())) * passage;
  const double to_a_m = EdgeOf(at_a, p, -across).value_or(-across.dot(narrowest.a - p)),
               to_b_m = EdgeOf(at_b, p, across).value_or(across.dot(narrowest.b - p));
  Opening opening;
  opening.position = p + 0.5 * (to_b_m - to_a_m) * across;
  opening.width_m = to_a_m + to_b_m;
  if (!(opening.width_m >= options.min_doorway_width_m && opening.width_m <= options.passage_width_m)) return std::nullopt;
  if (!LeadsTo(space, regions, p, passage, neck.region_b) || LeadsTo(space, regions, p, -passage, neck.region_b)) passage = -passage;
  opening.yaw_rad = std::atan2(passage.y(), passage.x());
  return opening;
}

}  // namespace plumb::runtime
