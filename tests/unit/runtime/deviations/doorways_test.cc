#include "runtime/deviations/doorways.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/deviations/built_house.h"

namespace plumb::runtime {
namespace {

std::vector<DoorwayDeviation> Judged(const AGraph& plan, const AGraph& built) {
  const test::Survey s = test::DriveThrough(plan, built);
  return JudgeDoorways(s.map, plan, s.estimate, {});
}

// A slab of `from_m` to `to_m` along the wall that a doorway of it lies in, as thick as the wall.
void WallUp(AGraph& house, size_t doorway, double from_m, double to_m) {
  const Doorway& d = house.doorways[doorway];
  const Eigen::Vector2d through(std::abs(std::cos(d.yaw_rad)), std::abs(std::sin(d.yaw_rad))), along(through.y(), through.x());
  const double half_m = 0.5 * house.walls[d.wall.index()].thickness_m;
  const Eigen::Vector2d at = d.position.head<2>(), lo = at + from_m * along - half_m * through, hi = at + to_m * along + half_m * through;
  test::AddBox(house, {lo.x(), lo.y(), 0}, {hi.x(), hi.y(), d.height_m}, test::AddElement(house, "infill", ElementKind::kWall, d.wall));
}

TEST(JudgeDoorways, NothingIsOffInTheHouseAsPlanned) {
  const AGraph house = test::MakeHouse();
  const auto doorways = Judged(house, house);
  ASSERT_EQ(doorways.size(), house.doorways.size());
  size_t as_planned = 0;
  for (const DoorwayDeviation& d : doorways) {
    EXPECT_TRUE(d.status == DoorwayStatus::kAsPlanned || d.status == DoorwayStatus::kUnobserved) << d.doorway.value << ' ' << d.shift_m;
    as_planned += d.status == DoorwayStatus::kAsPlanned;
  }
  EXPECT_GE(as_planned, 2u);
}

TEST(JudgeDoorways, AJambThatStandsInTheOpeningNarrowsAndShiftsIt) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  WallUp(built, 0, 0.25, 0.45);  // of 0.9 m
  const DoorwayDeviation d = Judged(plan, built)[0];
  ASSERT_EQ(d.status, DoorwayStatus::kDeviated);
  EXPECT_NEAR(d.width_deviation_m, -0.2, 0.015);
  EXPECT_NEAR(std::abs(d.shift_m), 0.1, 0.015);
}

TEST(JudgeDoorways, AWallWithoutItsDoorwayIsWalledUp) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  WallUp(built, 1, -0.45, 0.45);
  EXPECT_EQ(Judged(plan, built)[1].status, DoorwayStatus::kMissing);
}

TEST(JudgeDoorways, WithoutCovariancesNothingIsJudged) {
  const AGraph house = test::MakeHouse();
  for (const DoorwayDeviation& d : JudgeDoorways({}, house, {}, {})) EXPECT_EQ(d.status, DoorwayStatus::kUnobserved);
}

}  // namespace
}  // namespace plumb::runtime
