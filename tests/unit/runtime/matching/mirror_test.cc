#include "runtime/matching/mirror.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

TEST(MirrorImage, TwiceIsThePlanAgain) {
  const AGraph house = test::MakeHouse();
  const AGraph twice = MirrorImage(MirrorImage(house));
  ASSERT_EQ(twice.surfaces.size(), house.surfaces.size());
  for (size_t i = 0; i < house.surfaces.size(); ++i) {
    EXPECT_EQ(twice.surfaces[i].start, house.surfaces[i].start);
    EXPECT_EQ(twice.surfaces[i].normal, house.surfaces[i].normal);
    EXPECT_NEAR(twice.surfaces[i].d_m, house.surfaces[i].d_m, 1e-9);
  }
}

TEST(MirrorImage, KeepsNormalsTowardsTheFreeSpace) {
  const AGraph image = MirrorImage(test::MakeHouse());
  for (const Surface& s : image.surfaces) {
    const Eigen::Vector2d along = (s.end - s.start).normalized();
    EXPECT_NEAR(s.normal.x(), -along.y(), 1e-9);
    EXPECT_NEAR(s.normal.y(), along.x(), 1e-9);
    EXPECT_NEAR(s.normal.head<2>().dot(s.midpoint()) + s.d_m, 0, 1e-9);
  }
}

// The mirror image is met by the mirrored ray, at the same range and the mirrored normal.
TEST(PlanIndex, OfAMirrorImageSharesTheTriangles) {
  const AGraph house = test::MakeHouse(), image = MirrorImage(house);
  const PlanIndex plan(house), mirrored(image, plan);
  const Eigen::Vector3f from(2.0f, 1.5f, 1.0f);
  for (int i = 0; i < 36; ++i) {
    const float angle = 0.17f * static_cast<float>(i) + 0.05f;
    const Eigen::Vector3f along(std::cos(angle), std::sin(angle), 0.0f), flip(-1, 1, 1);
    const PlanHit hit = plan.Cast({from, along, 50.0f});
    const PlanHit seen = mirrored.Cast({flip.cwiseProduct(from), flip.cwiseProduct(along), 50.0f});
    ASSERT_TRUE(hit.first.hit());
    EXPECT_EQ(seen.first.range_m, hit.first.range_m);
    EXPECT_EQ(seen.first.triangle, hit.first.triangle);
    EXPECT_EQ(seen.first.normal, flip.cwiseProduct(hit.first.normal));
    EXPECT_EQ(seen.soft, hit.soft);
  }
}

TEST(IsOwnMirrorImage, KnowsSymmetricPlansByWallsAndDoors) {
  // x -> 10 - x is a symmetry of the first; the map's frame is the plan's, so the mirror image's pose is 10 m back along x, turned by none.
  PlanarPose identity, mirrored;
  mirrored.t_m = {-10, 0};
  const auto own = [&](const std::vector<test::GridDoor>& doors, std::vector<double> xs) {
    const AGraph plan = test::MakeGridPlan(xs, {0, 4, 7}, doors);
    return IsOwnMirrorImage(PlanIndex(plan), identity, mirrored);
  };
  EXPECT_TRUE(own({{true, 1, 0, 0.3}, {false, 1, 0, 0.4}, {false, 1, 1, 0.6}}, {0, 5, 10}));
  EXPECT_FALSE(own({{true, 1, 0, 0.3}, {false, 1, 0, 0.4}}, {0, 5, 10}));
  EXPECT_FALSE(own({{true, 1, 0, 0.3}}, {0, 4, 10}));
}

TEST(IsOwnMirrorImage, IsFalseForTheHouse) {
  const AGraph house = test::MakeHouse();
  PlanarPose mirrored;
  mirrored.t_m = {-9, 0};
  EXPECT_FALSE(IsOwnMirrorImage(PlanIndex(house), PlanarPose(), mirrored));
}

}  // namespace
}  // namespace plumb::runtime
