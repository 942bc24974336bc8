// Pairwise geometric consistency: do two correspondences between plan and map agree with one rigid motion? (runtime/METHOD.md, "Matching
// by graphs"; Lusk, Fathian, How: CLIPPER, ICRA 2021.) In the ground plane: only rotations about z are possible.
#pragma once

#include <Eigen/Core>
#include <string>

namespace plumb::runtime {

// What two pairs of points may differ by: exp(-c^2 / 2 sigma^2) of the difference c of their distances, 0 from epsilon on.
struct PointConsistency {
  double sigma_m = 0.5, epsilon_m = 0.2;
  [[nodiscard]] std::string Check() const;
};

// The same for points with normals, whose angles count, too.
struct WallConsistency {
  double sigma_m = 0.5, epsilon_m = 0.1;
  double sigma_rad = 0.05, epsilon_rad = 0.1;
  [[nodiscard]] std::string Check() const;
};

// A wall about some origin: the foot of the perpendicular from there, and the normal into the free space.
struct WallPoint {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero(), normal = Eigen::Vector2d::UnitX();
};

// The wall n . x + d = 0 about `origin`.
[[nodiscard]] WallPoint AboutOrigin(const Eigen::Vector2d& normal, double d_m, const Eigen::Vector2d& origin);

// Affinity in [0, 1] of the correspondences plan_i ~ map_i and plan_j ~ map_j. Symmetric in i and j.
[[nodiscard]] double PointAffinity(const Eigen::Vector2d& plan_i, const Eigen::Vector2d& plan_j, const Eigen::Vector2d& map_i,
                                   const Eigen::Vector2d& map_j, const PointConsistency& bounds);

// Distances and unsigned angles are the same in a mirror image. Normals point into the free space, so the angle from one to the other has a
// sign, and so has the way from one wall to the other along a normal: correspondences that differ in either get 0.
[[nodiscard]] double WallAffinity(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j,
                                  const WallConsistency& bounds);

// The same when the origins in plan and map may be decimetres apart, as the centres of a room are of which a wall has moved: between walls
// that are not parallel no distance is known then, only the angle.
[[nodiscard]] double WallAffinityUpToShift(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j,
                                           const WallConsistency& bounds);

}  // namespace plumb::runtime
