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
  return LieOnOtherShapes(s.map, plan, s.matches, s.estimate);
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

TEST(LieOnOtherShapes, DoesNotHoldForAWallAsPlannedMovedOrTurned) {
  const AGraph house = test::MakeHouse();
  const size_t middle = test::WallOf(house, "wall-middle");
  for (const auto& [offset_m, turn_deg] : {std::pair{0.0, 0.0}, std::pair{0.03, 0.0}, std::pair{0.0, 1.0}, std::pair{-0.2, 1.0}}) {
    AGraph built = house;
    test::Displace(built, "wall-middle",
                   Eigen::Translation2d(Eigen::Vector2d(5, 2.75) + Eigen::Vector2d(offset_m, 0)) *
                       Eigen::Rotation2Dd(turn_deg * std::numbers::pi / 180) * Eigen::Translation2d(Eigen::Vector2d(-5, -2.75)));
    EXPECT_FALSE(Shapes(house, built)[middle]) << offset_m << " m, " << turn_deg << " deg";
  }
}

TEST(LieOnOtherShapes, KeepsAWallWhoseFacesAreOffItsTrianglesFromBeingCalledDeviated) {
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
  changes.on_other_shape = LieOnOtherShapes(s.map, plan, s.matches, s.estimate);
  EXPECT_EQ(status(), SurfaceStatus::kUnobserved);
}

TEST(MatchesOnOtherShapes, TellsThemFromTheMatchesOfWallsAsPlanned) {
  const AGraph plan = WithFacesOff("wall-middle", 0.06);
  const test::Survey s = test::DriveThrough(plan, test::MakeHouse());
  const std::vector<bool> on_other_shape = MatchesOnOtherShapes(s.map, plan, s.matches, s.estimate);
  ASSERT_EQ(on_other_shape.size(), s.matches.size());
  size_t found = 0;
  for (size_t i = 0; i < s.matches.size(); ++i) {
    if (!on_other_shape[i]) continue;
    ++found;
    EXPECT_EQ(plan.surfaces[s.matches[i].plan_surface.index()].wall.index(), test::WallOf(plan, "wall-middle"));
  }
  EXPECT_GE(found, 2u);  // both of its faces
}

}  // namespace
}  // namespace plumb::runtime
