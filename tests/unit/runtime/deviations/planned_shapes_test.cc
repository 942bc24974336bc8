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

// The wall was built farther off, so that what stands behind its planned face is seen: 10 cm behind that, from 3.4 to 5.9 m along it.
TEST(MatchesOnOtherShapes, TellsAThingBehindThePlannedFaceOfAWallThatMovedAway) {
  AGraph plan = test::MakeHouse();
  const size_t middle = test::WallOf(plan, "wall-middle");
  Match match;
  double face_x = 0;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    if (plan.surfaces[i].wall.index() != middle || plan.surfaces[i].normal.x() < 0.9) continue;
    match.plan_surface = SurfaceId(i);
    face_x = plan.surfaces[i].start.x();
  }
  ASSERT_TRUE(match.plan_surface.valid());
  SGraph map;
  MapSurface& seen = map.surfaces.emplace_back();
  const double x = face_x - 0.1;
  seen.plane = {Eigen::Vector3d::UnitX(), -x};
  seen.start = {x, 5.9};
  seen.end = {x, 3.4};
  for (float along = 0.05f; along < 2.5f; along += 0.1f) {
    for (float z = 0.3f; z < 1.8f; z += 0.1f) seen.cells.emplace_back(along, z);
  }
  const auto on_other_shape = [&]() -> bool { return MatchesOnOtherShapes(map, plan, {match}, JointResult()).front(); };
  EXPECT_FALSE(on_other_shape());
  test::AddThing(plan, {x - 0.4, 3.3, 0}, {x, 5.95, 2});
  EXPECT_TRUE(on_other_shape());
}

}  // namespace
}  // namespace plumb::runtime
