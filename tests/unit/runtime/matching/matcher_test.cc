#include "runtime/matching/matcher.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::ErrorOf;
using test::OnTour;
using test::UprightPose;
using Verdict = MatchResult::Verdict;

class MatcherFromRoom : public testing::TestWithParam<test::Tour> {};

TEST_P(MatcherFromRoom, RecoversThePoseAtEveryHeading) {
  const AGraph house = test::MakeHouse();
  const Matcher matcher(house);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Isometry3d truth = UprightPose(45.0 * i + 7, 3.0 * i - 10, 5 - 2.0 * i, 0.4 * i);
    const MatchResult result = matcher.Match(MakeSyntheticMap(house, OnTour(GetParam(), truth, 100 + i)));
    ASSERT_EQ(result.verdict, Verdict::kUnique) << "heading " << i << ": " << result.reason;
    EXPECT_TRUE(result.reason.empty());
    const Hypothesis& best = result.hypotheses.front();
    const test::PoseError error = ErrorOf(best.T_plan_map, truth, GetParam().front());
    EXPECT_LT(error.xy_m, 0.05);
    EXPECT_LT(error.z_m, 0.02);
    EXPECT_LT(test::Degrees(error.yaw_rad), 0.5);
    EXPECT_LT(error.xy_m, 4 * best.sigma_xy_m);
    EXPECT_GT(best.probability, 0.999);
    EXPECT_EQ(best.storey, StoreyId(0));
  }
}

INSTANTIATE_TEST_SUITE_P(House, MatcherFromRoom, testing::Values(test::kFromA, test::kFromB, test::kFromC));

TEST(Matcher, ToleratesOneWall30CmOff) {
  const AGraph house = test::MakeHouse();
  const Matcher matcher(house);
  for (uint32_t wall = 0; wall < house.walls.size(); ++wall) {
    for (double offset_m : {0.3, -0.3}) {
      AGraph built = house;
      test::DeviateWall(built, WallId(wall), offset_m, 0.03);
      const Eigen::Isometry3d truth = UprightPose(60.0 * wall, 2, -3, 0);
      const MatchResult result = matcher.Match(MakeSyntheticMap(built, OnTour(test::kWholeHouse, truth, wall)));
      ASSERT_EQ(result.verdict, Verdict::kUnique) << "wall " << wall << ", " << offset_m << " m: " << result.reason;
      const test::PoseError error = ErrorOf(result.hypotheses.front().T_plan_map, truth, {4, 3});
      EXPECT_LT(error.xy_m, 0.10) << "wall " << wall;
      EXPECT_LT(test::Degrees(error.yaw_rad), 0.5) << "wall " << wall;
    }
  }
}

TEST(Matcher, ToleratesFurnitureThatIsInNoPlan) {
  const AGraph house = test::MakeHouse();
  AGraph built = house;
  const uint32_t boxes = test::AddElement(built, "boxes", ElementKind::kFurniture);
  test::AddBox(built, {0.3, 2.4, 0}, {1.7, 3.4, 1.9}, boxes);
  test::AddBox(built, {3.2, 0, 0}, {4.7, 0.6, 2.0}, boxes);
  test::AddBox(built, {8.2, 2.2, 0}, {8.9, 3.8, 0.8}, boxes);
  test::AddBox(built, {6.3, 5.4, 0}, {7.4, 5.9, 1.4}, boxes);
  test::AddBox(built, {0.1, 5.6, 0}, {0.9, 5.9, 2.0}, boxes);
  const Eigen::Isometry3d truth = UprightPose(-130, 4, 4, 1);
  const MatchResult result = Matcher(house).Match(MakeSyntheticMap(built, OnTour(test::kWholeHouse, truth)));
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  EXPECT_LT(ErrorOf(result.hypotheses.front().T_plan_map, truth, {4, 3}).xy_m, 0.05);
}

TEST(Matcher, ToleratesPlannedFurnitureAndLeavesThatAreNotThere) {
  AGraph plan = test::MakeHouse();
  const AGraph built = plan;
  test::AddBox(plan, {0.3, 2.4, 0}, {1.7, 3.4, 1.9}, test::AddElement(plan, "wardrobe", ElementKind::kFurniture));
  test::AddBox(plan, {6.5, 5.0, 0}, {8.4, 6.0, 2.0}, test::AddElement(plan, "bed", ElementKind::kFurniture));
  test::AddBox(plan, {4.98, 2.3, 0}, {5.02, 3.2, 2.1}, test::AddElement(plan, "leaf", ElementKind::kDoor, WallId(4), DoorwayId(1)));
  const Eigen::Isometry3d truth = UprightPose(20, 0, 0, 0);
  const MatchResult result = Matcher(plan).Match(MakeSyntheticMap(built, OnTour(test::kWholeHouse, truth)));
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  EXPECT_LT(ErrorOf(result.hypotheses.front().T_plan_map, truth, {4, 3}).xy_m, 0.05);
}

TEST(Matcher, FollowsTheMapFrame) {
  const AGraph house = test::MakeHouse();
  const Matcher matcher(house);
  SGraph map = MakeSyntheticMap(house, OnTour(test::kFromA, Eigen::Isometry3d::Identity()));
  const MatchResult before = matcher.Match(map);
  const Eigen::Isometry3d T_new_old = UprightPose(77, 100, -50, 2);
  for (Keyframe& k : map.keyframes) k.T_map_kf = T_new_old * k.T_map_kf;
  for (MapSurface& s : map.surfaces) {
    s.plane = s.plane.Transformed(T_new_old);
    for (Eigen::Vector2d* p : {&s.start, &s.end}) *p = (T_new_old * Eigen::Vector3d(p->x(), p->y(), 0)).head<2>();
    s.z_min_m += 2;
    s.z_max_m += 2;
  }
  const MatchResult after = matcher.Match(map);
  ASSERT_EQ(before.verdict, Verdict::kUnique) << before.reason;
  ASSERT_EQ(after.verdict, Verdict::kUnique) << after.reason;
  const Eigen::Isometry3d moved = after.hypotheses.front().T_plan_map * T_new_old;
  const test::PoseError error = ErrorOf(moved, before.hypotheses.front().T_plan_map, {2.5, 1.7});
  EXPECT_LT(error.xy_m, 0.003);
  EXPECT_LT(error.z_m, 1e-9);
  EXPECT_LT(test::Degrees(error.yaw_rad), 0.03);
  EXPECT_NEAR(after.hypotheses.front().log_likelihood, before.hypotheses.front().log_likelihood, 1.0);
}

TEST(Matcher, GivesTheSameResultTwice) {
  const AGraph house = test::MakeHouse();
  const SGraph map = MakeSyntheticMap(house, OnTour(test::kFromC, UprightPose(200, 1, 2, 0)));
  const MatchResult a = Matcher(house).Match(map), b = Matcher(house).Match(map);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].T_plan_map.matrix(), b.hypotheses[i].T_plan_map.matrix());
    EXPECT_EQ(a.hypotheses[i].log_likelihood, b.hypotheses[i].log_likelihood);
  }
}

TEST(Matcher, ScoresAreOnTheScaleOfTheHypotheses) {
  const AGraph house = test::MakeHouse();
  const Matcher matcher(house);
  const Eigen::Isometry3d truth = UprightPose(33, 5, 6, 0.2);
  const SGraph map = MakeSyntheticMap(house, OnTour(test::kFromA, truth));
  const MatchResult result = matcher.Match(map);
  ASSERT_GE(result.hypotheses.size(), 2u);
  std::vector<Eigen::Isometry3d> poses = {truth, UprightPose(0, 0.5, 0, 0) * truth};
  for (const Hypothesis& h : result.hypotheses) poses.push_back(h.T_plan_map);
  const std::vector<double> scores = matcher.Scores(map, poses);
  ASSERT_EQ(scores.size(), poses.size());
  EXPECT_GT(scores[0], scores[1] + 10);
  for (size_t i = 0; i < result.hypotheses.size(); ++i) EXPECT_NEAR(scores[2 + i], result.hypotheses[i].log_likelihood, 1e-6);
}

TEST(Matcher, RefinesAPoseThatIsALittleOff) {
  const AGraph house = test::MakeHouse();
  const Matcher matcher(house);
  const Eigen::Isometry3d truth = UprightPose(33, 5, 6, 0.2);
  const SGraph map = MakeSyntheticMap(house, OnTour(test::kFromA, truth));
  const Eigen::Isometry3d refined = matcher.Refined(map, UprightPose(2, 0.25, -0.1, 0) * truth);
  const test::PoseError error = ErrorOf(refined, truth, {2.5, 1.7});
  EXPECT_LT(error.xy_m, 0.05);
  EXPECT_LT(test::Degrees(error.yaw_rad), 0.5);
  EXPECT_NEAR(error.z_m, 0, 1e-9);
}

TEST(Matcher, KeepsPlansFarFromTheirOrigin) {
  AGraph house = test::MakeHouse();
  const Eigen::Vector3d far(4e5, 5e6, 300);
  house.origin = far;  // the mesh's vertices are offsets from it
  for (Surface& s : house.surfaces) {
    s.start += far.head<2>();
    s.end += far.head<2>();
    s.d_m -= s.normal.dot(far);
    s.z_min_m += far.z();
    s.z_max_m += far.z();
  }
  for (Room& r : house.rooms) {
    r.floor_z_m += far.z();
    r.ceiling_z_m += far.z();
  }
  for (Doorway& d : house.doorways) d.position += far;
  const Eigen::Isometry3d truth = UprightPose(33, 5, 6, 0.2);
  const MatchResult result = Matcher(house).Match(MakeSyntheticMap(test::MakeHouse(), OnTour(test::kFromA, truth)));
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  Eigen::Isometry3d expected = truth;
  expected.translation() += far;
  EXPECT_LT((result.hypotheses.front().T_plan_map.translation() - expected.translation()).norm(), 0.05);
}

TEST(Matcher, FindsThePoseWithoutAFloor) {
  const AGraph house = test::MakeHouse();
  const Eigen::Isometry3d truth = UprightPose(120, 5, 6, 0.2);
  SGraph map = MakeSyntheticMap(house, OnTour(test::kWholeHouse, truth));
  std::erase_if(map.surfaces, [](const MapSurface& s) { return s.kind != SurfaceKind::kWall; });
  const MatchResult result = Matcher(house).Match(map);
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  const test::PoseError error = ErrorOf(result.hypotheses.front().T_plan_map, truth, {4, 3});
  EXPECT_LT(error.xy_m, 0.05);
  EXPECT_LT(error.z_m, 0.35);  // sensor heights are tried in steps of 0.3 m
}

TEST(Matcher, IsAmbiguousInAHouseThatLooksTheSameTurnedRound) {
  const AGraph twin = test::MakeGridPlan({0, 5, 10}, {0, 4}, {{true, 1, 0, 0.5}});
  const Eigen::Isometry3d truth = UprightPose(-40, 1, 2, 0);
  const MatchResult result = Matcher(twin).Match(MakeSyntheticMap(twin, OnTour({{2.5, 2}, {1.5, 2.5}, {7, 2}, {8, 1.5}}, truth)));
  ASSERT_EQ(result.verdict, Verdict::kAmbiguous) << result.reason;
  ASSERT_GE(result.hypotheses.size(), 2u);
  const Eigen::Isometry3d turned = UprightPose(180, 10, 4, 0) * truth;
  const Hypothesis &a = result.hypotheses[0], &b = result.hypotheses[1];
  EXPECT_NEAR(a.probability + b.probability, 1.0, 1e-3);
  EXPECT_LT(std::min(ErrorOf(a.T_plan_map, truth, {5, 2}).xy_m, ErrorOf(b.T_plan_map, truth, {5, 2}).xy_m), 0.05);
  EXPECT_LT(std::min(ErrorOf(a.T_plan_map, turned, {5, 2}).xy_m, ErrorOf(b.T_plan_map, turned, {5, 2}).xy_m), 0.05);
}

// The same house with a third room behind a door in one of its ends: nothing tells it from its half turn until that end is seen.
TEST(Matcher, IsAmbiguousOnlyUntilWhatBreaksTheSymmetryIsSeen) {
  const AGraph house = test::MakeGridPlan({0, 5, 10, 13}, {0, 4}, {{true, 1, 0, 0.5}, {true, 2, 0, 0.2}});
  const Eigen::Isometry3d truth = UprightPose(-40, 1, 2, 0);
  const auto seen_from = [&](const test::Tour& tour) { return Matcher(house).Match(MakeSyntheticMap(house, OnTour(tour, truth))); };
  EXPECT_NE(seen_from({{2.5, 3.3}, {1.5, 3.4}, {3.5, 3.2}}).verdict, Verdict::kUnique);
  const MatchResult result = seen_from({{2.5, 2}, {1.5, 2.5}, {7, 2}, {8, 1.5}, {9, 1.0}, {11.5, 1.5}});
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  EXPECT_LT(ErrorOf(result.hypotheses.front().T_plan_map, truth, {5, 2}).xy_m, 0.05);
}

// A corridor with an end in sight is known along its length as well.
TEST(Matcher, KnowsACorridorByItsEnd) {
  const AGraph corridor = test::MakeGridPlan({0, 14, 18}, {0, 2}, {{true, 1, 0, 0.3}});
  const Eigen::Isometry3d truth = UprightPose(70, 2, -1, 0);
  const MatchResult result = Matcher(corridor).Match(MakeSyntheticMap(corridor, OnTour({{4, 1}, {8, 1.2}, {12, 0.9}, {16, 1.1}}, truth)));
  ASSERT_FALSE(result.hypotheses.empty()) << result.reason;
  EXPECT_LT(ErrorOf(result.hypotheses.front().T_plan_map, truth, {9, 1}).xy_m, 0.05);
  EXPECT_LT(result.hypotheses.front().sigma_xy_m, 0.1);
}

// Two houses as the storeys of one.
AGraph Tower(AGraph tower, const AGraph& above, double up_m) {
  tower.storeys.push_back({"storey-1", "First floor", up_m, 2.6});
  for (Surface s : above.surfaces) {
    s.storey = StoreyId(1);
    s.z_min_m += up_m;
    s.z_max_m += up_m;
    tower.surfaces.push_back(s);
  }
  for (Room r : above.rooms) {
    r.storey = StoreyId(1);
    r.floor_z_m += up_m;
    r.ceiling_z_m += up_m;
    tower.rooms.push_back(r);
  }
  const auto base = static_cast<uint32_t>(tower.mesh.vertices.size());
  for (Eigen::Vector3f v : above.mesh.vertices) tower.mesh.vertices.push_back(v + Eigen::Vector3f(0, 0, static_cast<float>(up_m)));
  for (Triangle t : above.mesh.triangles) tower.mesh.triangles.push_back({base + t.a, base + t.b, base + t.c, t.element});
  return tower;
}

TEST(Matcher, IsAmbiguousBetweenTwoStoreysThatAreAlike) {
  constexpr double kUp_m = 2.8;
  const AGraph tower = Tower(test::MakeHouse(), test::MakeHouse(), kUp_m);
  const MatchResult result = Matcher(tower).Match(MakeSyntheticMap(test::MakeHouse(), OnTour(test::kWholeHouse, UprightPose(10, 0, 0, 0))));
  ASSERT_EQ(result.verdict, Verdict::kAmbiguous) << result.reason;
  EXPECT_NE(result.hypotheses[0].storey, result.hypotheses[1].storey);
  EXPECT_NEAR(std::abs(result.hypotheses[0].T_plan_map.translation().z() - result.hypotheses[1].T_plan_map.translation().z()), kUp_m, 1e-6);
}

TEST(Matcher, OneWallDoesNotTellStoreysApart) {
  AGraph built = test::MakeHouse(), other = test::MakeHouse();
  test::DeviateWall(other, WallId(4), 0.35, 0);
  const AGraph tower = Tower(test::MakeHouse(), other, 2.8);
  const auto match = [&](const AGraph& below) {
    return Matcher(tower).Match(MakeSyntheticMap(below, OnTour(test::kWholeHouse, UprightPose(10, 0, 0, 0))));
  };
  test::DeviateWall(built, WallId(4), 0.35, 0);  // on the ground floor: now it looks like the first
  const MatchResult result = match(built);
  ASSERT_GE(result.hypotheses.size(), 2u);
  EXPECT_EQ(result.hypotheses[0].storey, StoreyId(1));
  EXPECT_GT(result.hypotheses[0].log_likelihood - result.hypotheses[1].log_likelihood, MatcherOptions().accept_margin_nats);
  EXPECT_NE(result.verdict, Verdict::kUnique);
  EXPECT_NE(result.reason.find("storey"), std::string::npos) << result.reason;
}

TEST(Matcher, NeverIsUniqueBetweenTwoParallelWalls) {
  const AGraph corridor = test::MakeGridPlan({0, 40}, {0, 2}, {});
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    test::SyntheticMapOptions options =
        OnTour({{17, 1}, {20, 1.2}, {23, 0.9}}, UprightPose(30.0 * static_cast<double>(seed), 0, 0, 0), seed);
    options.max_range_m = 8;
    const MatchResult result = Matcher(corridor).Match(MakeSyntheticMap(corridor, options));
    EXPECT_EQ(result.verdict, Verdict::kSearching);
    EXPECT_FALSE(result.reason.empty());
    ASSERT_FALSE(result.hypotheses.empty());
    EXPECT_GT(result.hypotheses.front().sigma_xy_m, 1.0);
  }
}

TEST(Matcher, SearchesWithAnEmptyMapOrPlan) {
  const AGraph house = test::MakeHouse();
  EXPECT_EQ(Matcher(house).Match(SGraph()).verdict, Verdict::kSearching);
  const AGraph nothing;
  const MatchResult result = Matcher(nothing).Match(MakeSyntheticMap(house, OnTour(test::kFromA, UprightPose(0, 0, 0, 0))));
  EXPECT_EQ(result.verdict, Verdict::kSearching);
  EXPECT_EQ(result.reason, "the plan has no walls");
}

TEST(MatcherOptions, NameTheFieldThatIsWrong) {
  EXPECT_EQ(MatcherOptions().Check(), "");
  MatcherOptions options;
  options.vote_cell_m = -1;
  EXPECT_EQ(options.Check(), "MatcherOptions.vote_cell_m = -1; must be in [0.02, 1]");
}

}  // namespace
}  // namespace plumb::runtime
