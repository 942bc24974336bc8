#include "runtime/matching/wall_pairs.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kMaxTurn_rad = 0.35;
constexpr double kPairOffsetSigma_m = 0.15, kPairTurnSigma_rad = 0.1;
constexpr double kMinOverlap_m = 0.3, kMinOverlapRatio = 0.3;
constexpr double kCoplanar_m = 0.03;

// A map wall, placed in the plan.
class WallInPlan {
 public:
  WallInPlan(const MapWall& wall, const PlanarPose& pose) : wall_(wall) {
    const Eigen::Matrix2d R = pose.rotation();
    normal_ = R * wall.normal;
    start_ = R * wall.start + pose.t_m;
    end_ = R * wall.end + pose.t_m;
    z_min_m_ = wall.z_min_m + pose.z_m;
    z_max_m_ = wall.z_max_m + pose.z_m;
  }

  // The part of it that lies along a face, and how well: overlapped metres, less for what is off or turned. Zero: not that face.
  [[nodiscard]] double Along(const PlanFace& face, WallPair& pair) const {
    if (face.normal.dot(normal_) < kMinCosine || z_max_m_ < face.z_min_m || z_min_m_ > face.z_max_m) return 0;
    const double rs = face.normal.dot(start_) + face.d_m, re = face.normal.dot(end_) + face.d_m;
    if (std::min(rs, re) > kMaxPairOffset_m || std::max(rs, re) < -kMaxPairOffset_m) return 0;
    const double us = face.along.dot(start_ - face.start), ue = face.along.dot(end_ - face.start);
    const double lo = std::max(us, 0.0), hi = std::min(ue, face.length_m);
    if (hi - lo < std::max(kMinOverlap_m, kMinOverlapRatio * std::min(wall_.length_m, face.length_m))) return 0;
    const double a = (lo - us) / (ue - us), b = (hi - us) / (ue - us);  // along the map wall
    const double offset_m = rs + 0.5 * (a + b) * (re - rs);
    if (std::abs(offset_m) > kMaxPairOffset_m) return 0;
    pair.p = wall_.start + a * (wall_.end - wall_.start);
    pair.q = wall_.start + b * (wall_.end - wall_.start);
    pair.overlap_m = hi - lo;
    const double offset = offset_m / kPairOffsetSigma_m, turn = Cross(normal_, face.normal) / kPairTurnSigma_rad;
    return pair.overlap_m * std::exp(-0.5 * (offset * offset + turn * turn));
  }

  [[nodiscard]] const Eigen::Vector2d& start() const { return start_; }
  [[nodiscard]] const Eigen::Vector2d& end() const { return end_; }

  // Along the map wall, 0 at its start and 1 at its end.
  [[nodiscard]] double Position(const Eigen::Vector2d& on_wall) const { return wall_.along.dot(on_wall - wall_.start) / wall_.length_m; }

 private:
  static inline const double kMinCosine = std::cos(kMaxTurn_rad);
  const MapWall& wall_;
  Eigen::Vector2d normal_, start_, end_;
  double z_min_m_ = 0, z_max_m_ = 0;
};

// A wall that runs past several rooms has a face in each; its map wall may be one piece. Adds the faces in the plane of the last pair's
// that take a part of the map wall not taken yet.
void AppendCoplanar(const PlanIndex& plan, const WallInPlan& wall, const std::vector<uint32_t>& near, std::vector<WallPair>& pairs) {
  const size_t first = pairs.size() - 1, best = pairs[first].face;
  for (uint32_t k : near) {
    if (k == best || !AreCoplanar(plan.faces()[best], plan.faces()[k])) continue;
    WallPair pair;
    if (wall.Along(plan.faces()[k], pair) <= 0) continue;
    const double p = wall.Position(pair.p), q = wall.Position(pair.q);
    const bool taken = std::any_of(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), [&](const WallPair& other) {
      return std::min(q, wall.Position(other.q)) - std::max(p, wall.Position(other.p)) > 0.1 * (q - p);
    });
    if (taken) continue;
    pair.wall = pairs[first].wall;
    pair.face = k;
    pairs.push_back(pair);
  }
}

}  // namespace

bool AreCoplanar(const PlanFace& a, const PlanFace& b) {
  return a.normal.dot(b.normal) > 0.9998 && std::abs(a.normal.dot(0.5 * (b.start + b.end)) + a.d_m) < kCoplanar_m;
}

std::vector<WallPair> PairWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& pose) {
  std::vector<WallPair> pairs;
  std::vector<uint32_t> near;
  for (size_t i = 0; i < map.walls.size(); ++i) {
    const WallInPlan wall(map.walls[i], pose);
    plan.FacesNear(wall.start(), wall.end(), kMaxPairOffset_m, near);
    WallPair best;
    double best_score = 0;
    for (uint32_t k : near) {
      WallPair pair;
      const double score = wall.Along(plan.faces()[k], pair);
      if (score <= best_score) continue;
      best_score = score;
      best = pair;
      best.face = k;
    }
    if (best_score <= 0) continue;
    best.wall = i;
    pairs.push_back(best);
    AppendCoplanar(plan, wall, near, pairs);
  }
  return pairs;
}

}  // namespace plumb::runtime
