#include "runtime/odometry/leveling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kBand_m = 0.06;           // surfels of one floor lie within this of its plane
constexpr double kSameNormalCos = 0.99;    // 8 degrees
constexpr double kMinFloorCount = 80;      // points
constexpr double kMaxOff_rad = 0.07;       // floors and walls are level and plumb within this
constexpr double kWallSigma_rad = 0.01;    // what surfels of walls are off by, besides their points' noise, ...
constexpr double kPatchSigma_rad = 0.03;   // ... those of floors, which a box's foot leans, ...
constexpr double kLevelSigma_rad = 0.003;  // ... and whole floors
constexpr double kMaxSigma_rad = 0.0087;
constexpr size_t kMaxPaired = 16;  // walls any two of which say which way is up ...
constexpr double kMinCross = 0.3;  // ... if the sine between them is this
constexpr int kRounds = 4;

using Surfels = std::vector<const Surfel*>;
using Votes = std::vector<Eigen::Matrix3d>;  // information V each: a direction g that is up has g.V g squared sigmas

struct Evidence {
  Eigen::Vector3d expected;  // up, roughly
  double max_tilt_rad, noise_m2;
  Surfels floors, ceilings, walls;
};

Evidence EvidenceOf(const SurfelMap& map, const Eigen::Vector3d& expected, double max_tilt_rad) {
  const double sigma_m = map.options().range_sigma_m;
  Evidence out{expected, max_tilt_rad, sigma_m * sigma_m, {}, {}, {}};
  const double candidate_rad = max_tilt_rad + kMaxOff_rad;  // single surfels' normals are off by a few degrees themselves
  for (const Surfel& s : map.surfels()) {
    if (!s.planar) continue;
    const double along = s.normal.dot(expected);
    if (along > std::cos(candidate_rad)) out.floors.push_back(&s);
    if (along < -std::cos(candidate_rad)) out.ceilings.push_back(&s);
    if (std::abs(along) < std::sin(candidate_rad)) out.walls.push_back(&s);
  }
  return out;
}

// That a wall is plumb: its normal, as well as its height tells it.
Eigen::Matrix3d WallVote(const Surfel& wall, const Eigen::Vector3d& up, double noise_m2) {
  const double variance = noise_m2 / up.dot(wall.scatter * up) + kWallSigma_rad * kWallSigma_rad;
  return wall.normal * wall.normal.transpose() / variance;
}

// That a floor or ceiling is level: both axes that lie in it, as well as its extents along them tell it.
Eigen::Matrix3d LevelVote(const Surfel& level, double sigma_rad, double noise_m2) {
  const SymmetricEigen<3> axes = EigenOf(level.scatter);
  Eigen::Matrix3d vote = Eigen::Matrix3d::Zero();
  for (int k = 1; k < 3; ++k) {
    vote += axes.vectors.col(k) * axes.vectors.col(k).transpose() / (noise_m2 / axes.values[k] + sigma_rad * sigma_rad);
  }
  return vote;
}

// Statistics of all surfels that lie on the plane through `mean` with `normal`.
Surfel Supporters(const Surfels& candidates, const Eigen::Vector3d& normal, const Eigen::Vector3d& mean) {
  Surfel sum;
  for (const Surfel* s : candidates) {
    if (s->normal.dot(normal) >= kSameNormalCos && std::abs(normal.dot(s->mean - mean)) <= kBand_m) sum.Add(*s);
  }
  return sum;
}

// The plane with most points among surfels that all face up, or all down, if it is level.
std::optional<Surfel> LargestLevel(const Surfels& candidates, const Eigen::Vector3d& up) {
  std::optional<Surfel> best;
  for (const Surfel* s : candidates) {
    const Surfel support = Supporters(candidates, s->normal, s->mean);
    if (support.count < kMinFloorCount || (best && support.count <= best->count)) continue;
    if (std::abs(EigenOf(support.scatter).vectors.col(0).dot(up)) >= std::cos(kMaxOff_rad)) best = support;
  }
  return best;
}

// What may be up: what a floor or a ceiling faces, what two walls stand along, and what is expected.
std::vector<Eigen::Vector3d> Candidates(const Evidence& seen) {
  std::vector<Eigen::Vector3d> out{seen.expected};
  const auto add = [&](const Eigen::Vector3d& up) {
    const double along = up.dot(seen.expected);
    if (std::abs(along) >= std::cos(seen.max_tilt_rad)) out.push_back(along > 0 ? up : -up);
  };
  for (const Surfels* levels : {&seen.floors, &seen.ceilings}) {
    for (const Surfel* s : *levels) add(EigenOf(Supporters(*levels, s->normal, s->mean).scatter).vectors.col(0));
  }
  Surfels walls = seen.walls;
  const auto known = [&](const Surfel* s) { return WallVote(*s, seen.expected, seen.noise_m2).trace(); };
  std::stable_sort(walls.begin(), walls.end(), [&](const Surfel* a, const Surfel* b) { return known(a) > known(b); });
  walls.resize(std::min(walls.size(), kMaxPaired));
  for (size_t i = 0; i < walls.size(); ++i) {
    for (size_t k = i + 1; k < walls.size(); ++k) {
      const Eigen::Vector3d cross = walls[i]->normal.cross(walls[k]->normal);
      if (cross.norm() >= kMinCross) add(cross.normalized());
    }
  }
  return out;
}

// The candidate that most of what is seen agrees with: a box before a wall leans a metre of it, or of the floor, by ten degrees.
Eigen::Vector3d Consensus(const Evidence& seen) {
  Votes votes;
  for (const Surfel* s : seen.walls) votes.push_back(WallVote(*s, seen.expected, seen.noise_m2));
  for (const Surfels* levels : {&seen.floors, &seen.ceilings}) {
    for (const Surfel* s : *levels) votes.push_back(LevelVote(*s, kPatchSigma_rad, seen.noise_m2));
  }
  Eigen::Vector3d best = seen.expected;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& up : Candidates(seen)) {
    double misfit = 0;  // Cauchy
    for (const Eigen::Matrix3d& vote : votes) misfit += std::log1p(up.dot(vote * up));
    if (misfit >= least) continue;
    least = misfit;
    best = up;
  }
  return best;
}

}  // namespace

std::optional<Eigen::Vector3d> FindUp(const SurfelMap& map, const Eigen::Vector3d& expected, double max_tilt_rad) {
  const Evidence seen = EvidenceOf(map, expected, max_tilt_rad);
  Eigen::Vector3d up = Consensus(seen);
  Votes votes;
  for (const Surfel* s : seen.walls) votes.push_back(WallVote(*s, up, seen.noise_m2));
  for (const Surfels* levels : {&seen.floors, &seen.ceilings}) {
    if (const std::optional<Surfel> level = LargestLevel(*levels, up)) votes.push_back(LevelVote(*level, kLevelSigma_rad, seen.noise_m2));
  }
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d cost = Eigen::Matrix3d::Zero();
    for (const Eigen::Matrix3d& vote : votes) cost += vote / (1 + up.dot(vote * up));  // Cauchy
    const SymmetricEigen<3> eigen = EigenOf(cost);
    if (!(eigen.values[1] >= 1 / (kMaxSigma_rad * kMaxSigma_rad))) return std::nullopt;
    const Eigen::Vector3d axis = eigen.vectors.col(0);
    up = axis.dot(expected) < 0 ? Eigen::Vector3d(-axis) : axis;
  }
  if (up.dot(expected) < std::cos(max_tilt_rad)) return std::nullopt;
  return up;
}

Eigen::Matrix3d LevelingRotation(const Eigen::Vector3d& up) {
  const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();  // upside down, too
  const double yaw_rad = std::atan2(R(1, 0), R(0, 0));
  return Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
}

}  // namespace plumb::runtime
