#include "tools/simulate/wall_geometry.h"

#include <gtest/gtest.h>

#include "runtime/matching/ray_caster.h"
#include "tests/support/house.h"

namespace plumb::tools {
namespace {

constexpr size_t kSouth = 0, kEast = 1, kWest = 3, kMiddle = 4, kAcross = 5;

std::vector<Eigen::Isometry2d> Still(const AGraph& plan) { return {plan.walls.size(), Eigen::Isometry2d::Identity()}; }

Eigen::Isometry2d Motion(const Eigen::Vector2d& pivot, const Eigen::Vector2d& shift, double yaw_rad) {
  return Eigen::Translation2d(pivot + shift) * Eigen::Rotation2Dd(yaw_rad) * Eigen::Translation2d(-pivot);
}

// Share of rays from the middles of the rooms that leave the house.
double Leaks(const AGraph& house, const Mesh& mesh) {
  const runtime::RayCaster caster(mesh);
  int rays = 0, lost = 0;
  for (const Room& room : house.rooms) {
    for (int i = 0; i < 3600; ++i) {
      for (const float z : {-0.5f, -0.3f, -0.1f, 0.0f, 0.1f, 0.3f, 0.6f}) {
        const float a = static_cast<float>(i) * 0.1f * 3.14159265f / 180;
        runtime::Ray ray;
        ray.origin = (room.center + Eigen::Vector3d(0, 0, 1.2)).cast<float>();
        ray.direction = Eigen::Vector3f(std::cos(a), std::sin(a), z).normalized();
        ++rays;
        if (!caster.Cast(ray).hit()) ++lost;
      }
    }
  }
  return static_cast<double>(lost) / rays;
}

// Largest distance of the wall's vertices from the lines of its faces and its cross faces (gaps), after undoing its motion: 0 if all
// long faces are still plane and parallel to where they were.
double WorstOffset(const AGraph& plan, const Mesh& built, size_t wall, const Eigen::Isometry2d& motion) {
  const Rectangle footprint = FindWallBodies(plan)[wall].footprint;
  double worst = 0;
  for (size_t i = 0; i < plan.mesh.triangles.size(); ++i) {
    const Triangle &was = plan.mesh.triangles[i], &is = built.triangles[i];
    if (plan.elements[was.element].wall != WallId(wall) || !IsWallBody(plan.elements[was.element])) continue;
    const uint32_t from[] = {was.a, was.b, was.c}, to[] = {is.a, is.b, is.c};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d planned = plan.mesh.vertices[from[k]].cast<double>().head<2>();
      const Eigen::Vector2d undone = motion.inverse() * built.vertices[to[k]].cast<double>().head<2>();
      worst = std::max(worst, std::abs((undone - planned).dot(footprint.across())));
      EXPECT_EQ(plan.mesh.vertices[from[k]].z(), built.vertices[to[k]].z());
    }
  }
  return worst;
}

TEST(WallBodies, FollowFromTheTriangles) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallBody> bodies = FindWallBodies(house);
  EXPECT_TRUE(bodies[kMiddle].footprint.center.isApprox(Eigen::Vector2d(5, 3), 1e-6));
  EXPECT_NEAR(bodies[kMiddle].footprint.half_length_m, 3, 1e-6);
  EXPECT_NEAR(bodies[kMiddle].footprint.half_width_m, 0.06, 1e-6);
  EXPECT_NEAR(bodies[kMiddle].z_max_m, 2.6, 1e-6);
  EXPECT_TRUE(Meet(bodies[kMiddle], bodies[kAcross]));
  EXPECT_TRUE(Meet(bodies[kMiddle], bodies[kSouth]));
  EXPECT_FALSE(Meet(bodies[kMiddle], bodies[kWest]));
}

TEST(MoveWalls, KeepsAHouseWhoseWallsStay) {
  const AGraph house = test::MakeHouse();
  const Mesh mesh = MoveWalls(house, FindWallBodies(house), Still(house));
  ASSERT_EQ(mesh.triangles.size(), house.mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    EXPECT_EQ(mesh.vertices[mesh.triangles[i].a], house.mesh.vertices[house.mesh.triangles[i].a]);
    EXPECT_EQ(mesh.triangles[i].element, house.mesh.triangles[i].element);
  }
}

TEST(MoveWalls, LengthensTheWallsThatMeetAMovedOne) {
  const AGraph house = test::MakeHouse();
  std::vector<Eigen::Isometry2d> motions = Still(house);
  motions[kEast] = Motion({9, 3}, {0.35, 0}, 0);
  AGraph built = house;
  built.mesh = MoveWalls(house, FindWallBodies(house), motions);
  // The south wall now ends at the outer face of the east wall, 0.35 m farther; its faces are where they were.
  const WallBody south = FindWallBodies(built)[kSouth];
  EXPECT_NEAR(south.footprint.center.x() + south.footprint.half_length_m, 9.3 + 0.35, 1e-5);
  EXPECT_NEAR(south.footprint.center.x() - south.footprint.half_length_m, -0.3, 1e-5);
  EXPECT_NEAR(south.footprint.half_width_m, 0.15, 1e-5);
  EXPECT_EQ(Leaks(house, built.mesh), 0);
}

TEST(MoveWalls, MovesWhatAWallHosts) {
  const AGraph house = test::MakeHouse();
  std::vector<Eigen::Isometry2d> motions = Still(house);
  motions[kWest] = Motion({0, 3}, {-0.2, 0}, 0.05);
  const Mesh built = MoveWalls(house, FindWallBodies(house), motions);
  int checked = 0;
  for (size_t i = 0; i < house.mesh.triangles.size(); ++i) {
    if (house.elements[house.mesh.triangles[i].element].guid != "leaf-D3") continue;
    const Eigen::Vector2d planned = house.mesh.vertices[house.mesh.triangles[i].a].cast<double>().head<2>();
    EXPECT_TRUE(built.vertices[built.triangles[i].a].cast<double>().head<2>().isApprox(motions[kWest] * planned, 1e-5));
    ++checked;
  }
  EXPECT_EQ(checked, 12);
}

TEST(MoveWalls, KeepsFacesPlaneAndJointsClosed) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallBody> bodies = FindWallBodies(house);
  for (size_t wall = 0; wall < house.walls.size(); ++wall) {
    for (const double shift_m : {-0.35, 0.35}) {
      for (const double yaw_rad : {-0.087, 0.0, 0.087}) {
        std::vector<Eigen::Isometry2d> motions = Still(house);
        motions[wall] = Motion(bodies[wall].footprint.center, shift_m * bodies[wall].footprint.across(), yaw_rad);
        const Mesh built = MoveWalls(house, bodies, motions);
        for (size_t w = 0; w < house.walls.size(); ++w) EXPECT_LT(WorstOffset(house, built, w, motions[w]), 1e-5) << wall << " " << w;
        EXPECT_LT(Leaks(house, built), 0.0005) << house.walls[wall].name << " by " << shift_m << " m, " << yaw_rad << " rad";
      }
    }
  }
}

TEST(MoveWalls, ClosesTheCornerOfTwoMovedWalls) {
  const AGraph house = test::MakeHouse();
  std::vector<Eigen::Isometry2d> motions = Still(house);
  motions[kSouth] = Motion({4.5, 0}, {0, -0.3}, 0.02);
  motions[kEast] = Motion({9, 3}, {0.3, 0}, -0.03);
  const Mesh built = MoveWalls(house, FindWallBodies(house), motions);
  for (const size_t w : {kSouth, kEast}) EXPECT_LT(WorstOffset(house, built, w, motions[w]), 1e-5);
  EXPECT_LT(Leaks(house, built), 0.0005);
}

}  // namespace
}  // namespace plumb::tools
