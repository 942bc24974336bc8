#include "runtime/matching/map_walls.h"

#include <algorithm>
#include <cmath>

#include "runtime/mapping/plane_fit.h"

namespace plumb::runtime {
namespace {

constexpr double kMinWallLength_m = 0.4;
constexpr double kMinHeightSeen_m = 0.25;  // area over length: less is a few stray rings on something rough, no wall
constexpr double kMaxTilt = 0.26;          // |n_z| of an upright surface
constexpr double kApartSigmas = 2.0;       // pieces of one wall are apart by this at most, in spreads of both
constexpr double kSameNormal = 0.94;       // cosine of 20 degrees
constexpr double kMinOverlapRatio = 0.5;   // of the shorter piece
constexpr double kBuiltSigma_m = 0.01;     // of a face that was built as planned
constexpr double kTypicalSpread_m = 0.0173;

// A map wall and the points that make it.
struct Piece {
  MapWall wall;
  PlaneStats stats;  // map frame
};

PlaneStats StatsOf(const SGraph& map, const MapSurface& surface) {
  PlaneStats sum;
  for (const Observation& o : surface.observations) sum.Add(o.stats.Transformed(map.keyframes[o.keyframe].T_map_kf));
  return sum;
}

std::vector<Piece> UprightPieces(const SGraph& map) {
  std::vector<Piece> pieces;
  for (const MapSurface& s : map.surfaces) {
    if (s.kind != SurfaceKind::kWall || s.num_points <= 0 || std::abs(s.plane.n.z()) > kMaxTilt) continue;
    MapWall w;
    w.start = s.start;
    w.end = s.end;
    w.length_m = s.length_m();
    if (!(w.length_m >= kMinWallLength_m) || s.area_m2 < kMinHeightSeen_m * w.length_m) continue;
    w.along = (w.end - w.start) / w.length_m;
    w.normal = {-w.along.y(), w.along.x()};
    w.z_min_m = s.z_min_m;
    w.z_max_m = s.z_max_m;
    const PlaneStats stats = StatsOf(map, s);
    // The points of a planar laser lie in one level plane, and fit that best.
    if (!map.planar && stats.count() > 0) w.spread_m = FitPlane(stats, s.plane.n).rms_m;
    pieces.push_back({w, stats});
  }
  return pieces;
}

// One before the other, apart by no more than their points spread.
bool AreOneWall(const MapWall& longer, const MapWall& other) {
  if (longer.spread_m <= 0 || other.spread_m <= 0 || longer.normal.dot(other.normal) < kSameNormal) return false;
  const Eigen::Vector2d p = other.start - longer.start, q = other.end - longer.start;
  const double up = longer.along.dot(p), uq = longer.along.dot(q);
  const double lo = std::max(0.0, std::min(up, uq)), hi = std::min(longer.length_m, std::max(up, uq));
  if (hi - lo < kMinOverlapRatio * std::min(longer.length_m, other.length_m)) return false;
  const double slope = longer.normal.dot(q - p) / (uq - up), at_lo_m = longer.normal.dot(p) + slope * (lo - up);
  const double gate_m = kApartSigmas * std::hypot(longer.spread_m, other.spread_m);
  return std::abs(at_lo_m) <= gate_m && std::abs(at_lo_m + slope * (hi - lo)) <= gate_m;
}

// The wall that the points of both make, as long as both.
void Join(const Piece& other, Piece& piece) {
  piece.stats.Add(other.stats);
  MapWall& wall = piece.wall;
  const PlaneFit fit = FitPlane(piece.stats, {wall.normal.x(), wall.normal.y(), 0});
  const Eigen::Vector2d middle = piece.stats.centroid().head<2>(), ends[] = {wall.start, wall.end, other.wall.start, other.wall.end};
  wall.normal = fit.plane.n.head<2>().normalized();
  wall.along = {wall.normal.y(), -wall.normal.x()};
  double lo = 1e300, hi = -1e300;
  for (const Eigen::Vector2d& end : ends) {
    lo = std::min(lo, wall.along.dot(end - middle));
    hi = std::max(hi, wall.along.dot(end - middle));
  }
  wall.start = middle + lo * wall.along;
  wall.end = middle + hi * wall.along;
  wall.length_m = hi - lo;
  wall.z_min_m = std::min(wall.z_min_m, other.wall.z_min_m);
  wall.z_max_m = std::max(wall.z_max_m, other.wall.z_max_m);
  wall.spread_m = fit.rms_m;
}

}  // namespace

std::vector<MapWall> UprightWalls(const SGraph& map) {
  std::vector<Piece> pieces = UprightPieces(map), kept;
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.wall.length_m > b.wall.length_m; });
  for (const Piece& piece : pieces) {
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Piece& k) { return AreOneWall(k.wall, piece.wall); });
    if (same == kept.end())
      kept.push_back(piece);
    else
      Join(piece, *same);
  }
  std::vector<MapWall> walls;
  for (const Piece& piece : kept) walls.push_back(piece.wall);
  return walls;
}

double SigmaOfWalls(std::span<const MapWall> walls) {
  std::vector<std::pair<double, double>> spreads;  // spread, length
  double total_m = 0;
  for (const MapWall& wall : walls) {
    if (wall.spread_m <= 0) continue;
    spreads.emplace_back(wall.spread_m, wall.length_m);
    total_m += wall.length_m;
  }
  std::sort(spreads.begin(), spreads.end());
  double below_m = 0;
  for (const auto& [spread_m, length_m] : spreads) {
    below_m += length_m;
    if (below_m >= 0.5 * total_m) return std::hypot(kBuiltSigma_m, spread_m);
  }
  return std::hypot(kBuiltSigma_m, kTypicalSpread_m);
}

}  // namespace plumb::runtime
