#include "tools/simulate/missing_floors.h"

#include <gtest/gtest.h>

#include "runtime/matching/ray_caster.h"
#include "tests/support/house.h"
#include "tests/support/plans.h"

namespace plumb::tools {
namespace {

constexpr double kSlope = 0.3;

// A grid plan without its slab.
AGraph WallsOnly() {
  AGraph plan = test::MakeGridPlan({0, 4, 9}, {0, 5}, {{true, 1, 0}});
  std::erase_if(plan.mesh.triangles, [&](const Triangle& t) { return plan.elements[t.element].kind == ElementKind::kSlab; });
  return plan;
}

// The height that a ray straight up or down from 1 m over (x, y) meets; 1000 for none.
double Seen(const AGraph& house, double x, double y, float direction) {
  runtime::Ray ray;
  ray.origin = (Eigen::Vector3d(x, y, 1) - house.origin).cast<float>();
  ray.direction = {0, 0, direction};
  const runtime::RayHit hit = runtime::RayCaster(house.mesh).Cast(ray);
  return hit.hit() ? 1 + direction * hit.range_m : 1000;
}

TEST(MissingFloors, AreAddedToAPlanOfWallsWithCeilingsAndPassages) {
  const AGraph plan = WallsOnly();
  EXPECT_EQ(Seen(plan, 2, 2, -1), 1000);
  const Rectangle passage{{4, 2.5}, {0, 1}, 0.45, 0.1};
  const AGraph house = WithFloorsAndCeilings(plan, StoreyId(0), {passage});
  for (const double x : {0.2, 2.0, 3.8, 4.2, 8.8}) {
    EXPECT_NEAR(Seen(house, x, 0.2, -1), house.rooms[0].floor_z_m, 1e-5) << x;
    EXPECT_NEAR(Seen(house, x, 4.8, 1), house.rooms[0].ceiling_z_m, 1e-5) << x;
  }
  EXPECT_NEAR(Seen(house, 4, 2.5, -1), 0, 1e-5);
  EXPECT_EQ(Seen(house, -3, 2, -1), 1000);
}

TEST(MissingFloors, FollowSlantedOutlinesAndLeaveHolesOpen) {
  AGraph plan = WallsOnly();
  plan.rooms.resize(1);
  plan.rooms[0].polygon = {{0, 0}, {4, 0}, {4 + 4 * kSlope, 4}, {4 * kSlope, 4}};
  plan.rooms[0].holes = {{{1.5, 1}, {1.5, 3}, {3, 2}}};
  plan.mesh = {};
  const AGraph house = WithFloorsAndCeilings(plan, StoreyId(0), {});
  EXPECT_NEAR(Seen(house, 0.05 + 3 * kSlope, 3, -1), 0, 1e-5);
  EXPECT_EQ(Seen(house, 3 * kSlope - 0.05, 3, -1), 1000);
  EXPECT_NEAR(Seen(house, 3.95 + 3 * kSlope, 3, -1), 0, 1e-5);
  EXPECT_EQ(Seen(house, 1.7, 2, -1), 1000);   // in the hole
  EXPECT_NEAR(Seen(house, 2.7, 2.5, -1), 0, 1e-5);  // right of its slanted edge
  double area_m2 = 0;
  for (const Triangle& t : house.mesh.triangles) {
    const auto& v = house.mesh.vertices;
    const float twice = (v[t.b] - v[t.a]).cross(v[t.c] - v[t.a]).z();
    EXPECT_EQ(twice > 0, v[t.a].z() < 1) << "floors are seen from above, ceilings from below";
    area_m2 += 0.5 * std::abs(twice);
  }
  EXPECT_NEAR(area_m2, 2 * (16 - 1.5), 1e-4);
}

TEST(MissingFloors, AreNotAddedToAHouseThatHasThem) {
  AGraph plan = test::MakeHouse();
  const size_t before = plan.mesh.triangles.size();
  EXPECT_EQ(WithFloorsAndCeilings(plan, StoreyId(0), {}).mesh.triangles.size(), before);
}

}  // namespace
}  // namespace plumb::tools
