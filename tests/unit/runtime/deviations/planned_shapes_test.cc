#include "runtime/deviations/planned_shapes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "runtime/deviations/deviations.h"
#include "tests/unit/runtime/deviations/built_house.h"

namespace plumb::runtime {
namespace {

std::vector<bool> Shapes(const AGraph& plan, const AGraph& as_built) {
  const test::Survey s = test::DriveThrough(plan, as_built);
  return ShapesAsPlanned(s.map, plan, s.matches, s.estimate);
}

// The house, one of whose walls has its faces `offset_m` off its triangles.
AGraph WithFacesOff(const std::string& guid, double offset_m) {
  AGraph plan = test::MakeHouse();
  for (Surface& s : plan.surfaces) {
    if (s.wall.index() != test::WallOf(plan, guid)) continue;
    const Eigen::Vector2d shift(offset_m, 0);
    s.start += shift;
    s.end += shift;
    s.d_m -= s.normal.head<2>().dot(shift);
  }
  return plan;
}

TEST(ShapesAsPlanned, HoldsForAllWallsOfTheHouseAsPlanned) {
  const AGraph house = test::MakeHouse();
  const std::vector<bool> shapes = Shapes(house, house);
  for (size_t w = 0; w < house.walls.size(); ++w) EXPECT_TRUE(shapes[w]) << house.walls[w].guid;
}

TEST(ShapesAsPlanned, DoesNotHoldForAWallThatWasMovedOrTurned) {
  const AGraph house = test::MakeHouse();
  const size_t middle = test::WallOf(house, "wall-middle");
  for (const auto& [offset_m, turn_deg] : {std::pair{0.04, 0.0}, std::pair{0.0, 2.0}, std::pair{-0.2, 1.0}}) {
    AGraph built = house;
    test::Displace(built, "wall-middle",
                   Eigen::Translation2d(Eigen::Vector2d(5, 2.75) + Eigen::Vector2d(offset_m, 0)) *
                       Eigen::Rotation2Dd(turn_deg * std::numbers::pi / 180) * Eigen::Translation2d(Eigen::Vector2d(-5, -2.75)));
    EXPECT_FALSE(Shapes(house, built)[middle]) << offset_m << " m, " << turn_deg << " deg";
  }
}

TEST(ShapesAsPlanned, KeepsAWallWhoseFacesAreOffItsTrianglesFromBeingCalledDeviated) {
  const AGraph plan = WithFacesOff("wall-middle", 0.06);
  const test::Survey s = test::DriveThrough(plan, test::MakeHouse());
  WallChanges changes;
  const auto status = [&] {
    for (const SurfaceDeviation& d : AssessDeviations(plan, s.estimate, {}, changes).surfaces) {
      if (plan.surfaces[d.surface.index()].wall.index() == test::WallOf(plan, "wall-middle") && d.observed_m2 > 1) return d.status;
    }
    return SurfaceStatus::kMissing;
  };
  ASSERT_EQ(status(), SurfaceStatus::kDeviated);
  changes.shape_as_planned = ShapesAsPlanned(s.map, plan, s.matches, s.estimate);
  EXPECT_EQ(status(), SurfaceStatus::kUnobserved);
}

}  // namespace
}  // namespace plumb::runtime
