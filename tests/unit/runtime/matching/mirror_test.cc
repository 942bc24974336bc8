#include "runtime/matching/mirror.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

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

// A map that lies on those faces of the plan that keep(face), in the plan's own frame.
WallFit SeenFrom(const PlanIndex& plan, const std::function<bool(const PlanFace&)>& keep) {
  WallFit fit;
  for (size_t k = 0; k < plan.faces().size(); ++k) {
    const PlanFace& face = plan.faces()[k];
    if (keep(face)) fit.pairs.push_back({0, k, face.start, face.end, face.length_m});
  }
  return fit;
}

bool Any(const PlanFace& /*face*/) { return true; }

TEST(IsOwnMirrorImage, KnowsSymmetricPlansByWallsAndDoors) {
  // x -> 10 - x is a symmetry of the first; the map's frame is the plan's, so the mirror image's pose is 10 m back along x, turned by none.
  PlanarPose mirrored;
  mirrored.t_m = {-10, 0};
  const auto own = [&](const std::vector<test::GridDoor>& doors, std::vector<double> xs) {
    const AGraph plan = test::MakeGridPlan(xs, {0, 4, 7}, doors);
    const PlanIndex index(plan);
    return IsOwnMirrorImage(index, SeenFrom(index, Any), mirrored);
  };
  EXPECT_TRUE(own({{true, 1, 0, 0.3}, {false, 1, 0, 0.4}, {false, 1, 1, 0.6}}, {0, 5, 10}));
  EXPECT_FALSE(own({{true, 1, 0, 0.3}, {false, 1, 0, 0.4}}, {0, 5, 10}));
  EXPECT_FALSE(own({{true, 1, 0, 0.3}}, {0, 4, 10}));
}

TEST(IsOwnMirrorImage, IsFalseForTheHouse) {
  const AGraph house = test::MakeHouse();
  PlanarPose mirrored;
  mirrored.t_m = {-9, 0};
  const PlanIndex index(house);
  EXPECT_FALSE(IsOwnMirrorImage(index, SeenFrom(index, Any), mirrored));
}

// Five rows of rooms that mirror, and a sixth whose walls stand elsewhere: a detail of the building, which only matters where it is seen.
TEST(IsOwnMirrorImage, LeavesOutWhatTheMapHasNotSeen) {
  const std::vector<double> rows{0, 4, 8, 12, 16, 20, 24};
  const AGraph symmetric = test::MakeGridPlan({0, 5, 10}, rows, {});
  AGraph detail = symmetric;
  for (Surface& s : detail.surfaces) {  // the top row's walls between the rooms, 1.5 m aside
    if (std::min(s.start.y(), s.end.y()) < 19.5 || std::abs(s.normal.x()) < 0.5 || std::abs(s.start.x() - 5) > 1) continue;
    s.start.x() += 1.5;
    s.end.x() += 1.5;
    s.d_m = -s.normal.head<2>().dot(s.start);
  }
  PlanarPose mirrored;
  mirrored.t_m = {-10, 0};
  const PlanIndex index(detail);
  EXPECT_TRUE(IsOwnMirrorImage(index, SeenFrom(index, [](const PlanFace& f) { return std::max(f.start.y(), f.end.y()) < 19; }), mirrored));
  EXPECT_FALSE(IsOwnMirrorImage(index, SeenFrom(index, [](const PlanFace& f) { return std::max(f.start.y(), f.end.y()) > 19; }), mirrored));
}

// One symmetric room does not make a symmetric building.
TEST(IsOwnMirrorImage, IsFalseWhereOnlyTheRoomSeenIsSymmetric) {
  const AGraph plan = test::MakeGridPlan({0, 6, 9, 11, 18}, {0, 4, 7, 12}, {});
  PlanarPose mirrored;
  mirrored.t_m = {-6, 0};
  const PlanIndex index(plan);
  EXPECT_FALSE(IsOwnMirrorImage(
      index,
      SeenFrom(index, [](const PlanFace& f) { return std::max(f.start.x(), f.end.x()) < 6 && std::max(f.start.y(), f.end.y()) < 4; }),
      mirrored));
}

}  // namespace
}  // namespace plumb::runtime
