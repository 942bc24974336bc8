#include "tools/simulate/doorway_changes.h"

#include <gtest/gtest.h>

#include "runtime/matching/ray_caster.h"
#include "tests/support/house.h"

namespace plumb::tools {
namespace {

// From the middle of doorway 0 (A-B, in a wall along x) to the next thing along the wall.
double ToJamb(const AGraph& house, double sign) {
  const runtime::RayCaster caster(house.mesh);
  runtime::Ray ray;
  ray.origin = (house.doorways[0].position + Eigen::Vector3d(0, 0, 1) - house.origin).cast<float>();
  ray.direction = Eigen::Vector3f(static_cast<float>(sign), 0, 0);
  return static_cast<double>(caster.Cast(ray).range_m);
}

TEST(CutDoorway, MovesTheJambsAndLeavesTheRestOfTheWall) {
  AGraph house = test::MakeHouse();
  ASSERT_NEAR(ToJamb(house, 1), 0.45, 1e-4);
  const Doorway& d = house.doorways[0];
  const double left = -std::sin(d.yaw_rad);  // + along x, or against it
  CutDoorway({DoorwayId(0), 0.2, -0.1}, 0.3, house);
  EXPECT_NEAR(ToJamb(house, left), 0.45 + 0.2 - 0.05, 1e-4);
  EXPECT_NEAR(ToJamb(house, -left), 0.45 - 0.2 - 0.05, 1e-4);
}

TEST(ChangeDoorways, FollowsFromTheSeedAndKeepsToTheBounds) {
  const AGraph plan = test::MakeHouse();
  SimulateOptions options;
  options.doorways_ratio = 1;
  const auto change = [&] {
    AGraph house = plan;
    std::vector<Doorway> doorways = plan.doorways;
    return *ChangeDoorways(StoreyId(0), options, FindWallBodies(plan), house, doorways);
  };
  const auto changes = change(), again = change();
  ASSERT_FALSE(changes.empty());
  ASSERT_EQ(changes.size(), again.size());
  for (size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(changes[i].shift_m, again[i].shift_m);
    EXPECT_LE(std::abs(changes[i].shift_m), options.max_doorway_m);
    EXPECT_GE(std::max(std::abs(changes[i].shift_m), std::abs(changes[i].width_deviation_m)), options.min_doorway_m);
  }
}

TEST(ChangeDoorways, RefusesMoreThanThereAre) {
  const AGraph plan = test::MakeHouse();
  SimulateOptions options;
  options.doorways = 50;
  AGraph house = plan;
  std::vector<Doorway> doorways = plan.doorways;
  const auto changes = ChangeDoorways(StoreyId(0), options, FindWallBodies(plan), house, doorways);
  ASSERT_FALSE(changes);
  EXPECT_EQ(changes.error().code, ErrorCode::kPlanUnsuitable);
}

}  // namespace
}  // namespace plumb::tools
