#include "runtime/odometry/leveling.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace plumb::runtime {
namespace {

constexpr double kBand_m = 0.06;              // surfels of one floor lie within this of its plane
constexpr double kSameNormalCos = 0.99;       // 8 degrees
constexpr double kMinFloorCount = 80;         // points
constexpr double kMinFloorSpread_m = 0.5;     // standard deviation along the narrow side
constexpr double kMinWallCount = 200;
constexpr double kMinSecondWallRatio = 0.05;  // share of walls across the main direction
constexpr int kRounds = 4;

// Points of all surfels that lie on the plane through `mean` with `normal`.
Surfel Supporters(const std::vector<const Surfel*>& candidates, const Eigen::Vector3d& normal, const Eigen::Vector3d& mean) {
  Surfel sum;
  for (const Surfel* s : candidates) {
    if (std::abs(s->normal.dot(normal)) >= kSameNormalCos && std::abs(normal.dot(s->mean - mean)) <= kBand_m) sum.Add(*s);
  }
  return sum;
}

std::optional<Eigen::Vector3d> UpFromFloor(const std::vector<const Surfel*>& horizontal) {
  Surfel best;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  for (const Surfel* s : horizontal) {
    const Surfel support = Supporters(horizontal, s->normal, s->mean);
    if (support.count > best.count) {
      best = support;
      normal = s->normal;
    }
  }
  if (best.count < kMinFloorCount) return std::nullopt;
  double spread_m = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(best.scatter / best.count);
    normal = eigen.eigenvectors().col(0);
    spread_m = std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
    const Surfel support = Supporters(horizontal, normal, best.mean);
    if (support.count < kMinFloorCount) break;
    best = support;
  }
  if (spread_m < kMinFloorSpread_m) return std::nullopt;
  return normal.z() < 0 ? Eigen::Vector3d(-normal) : normal;
}

std::optional<Eigen::Vector3d> UpFromWalls(const std::vector<const Surfel*>& vertical, double max_tilt_rad) {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double off_rad = max_tilt_rad;
  for (int round = 0; round < kRounds; ++round, off_rad = std::max(0.5 * off_rad, 0.035)) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double count = 0;
    for (const Surfel* s : vertical) {
      if (std::abs(s->normal.dot(up)) > std::sin(off_rad)) continue;
      sum += s->count * s->normal * s->normal.transpose();
      count += s->count;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
    if (count < kMinWallCount || eigen.eigenvalues()[1] < kMinSecondWallRatio * count) return std::nullopt;
    up = eigen.eigenvectors().col(0);
    if (up.z() < 0) up = -up;
  }
  return up;
}

}  // namespace

std::optional<Eigen::Vector3d> FindUp(const SurfelMap& map, double max_tilt_rad) {
  std::vector<const Surfel*> horizontal, vertical;
  // Single surfels' normals are off by a few degrees themselves.
  const double candidate_rad = max_tilt_rad + 0.07;
  for (const Surfel& s : map.surfels()) {
    if (!s.planar) continue;
    if (std::abs(s.normal.z()) > std::cos(candidate_rad)) horizontal.push_back(&s);
    if (std::abs(s.normal.z()) < std::sin(candidate_rad)) vertical.push_back(&s);
  }
  std::optional<Eigen::Vector3d> up = UpFromFloor(horizontal);
  if (!up) up = UpFromWalls(vertical, max_tilt_rad);
  if (up && up->z() < std::cos(max_tilt_rad)) return std::nullopt;
  return up;
}

Eigen::Matrix3d LevelingRotation(const Eigen::Vector3d& up) {
  const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double yaw_rad = std::atan2(R(1, 0), R(0, 0));
  return Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
}

}  // namespace plumb::runtime
