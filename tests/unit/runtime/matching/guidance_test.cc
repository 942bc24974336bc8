#include "runtime/matching/guidance.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

// Rooms in a row, doors so that half turns about the middle of the row take doors onto doors.
AGraph Row(const std::vector<double>& xs) {
  std::vector<test::GridDoor> doors;
  for (size_t line = 1; line + 1 < xs.size(); ++line) doors.push_back({true, line, 0, 2 * line < xs.size() ? 0.3 : 0.7});
  return test::MakeGridPlan(xs, {0, 4}, doors);
}

// A robot at `at` that looks along +x, and a half turn about `middle_m` as its other place.
struct Scene {
  SGraph map;
  MatchResult match;
  Eigen::Isometry3d T_map_lidar = Eigen::Isometry3d::Identity();

  Scene(const Eigen::Vector2d& at, const Eigen::Vector2d& middle_m, double lead_nats = 2) {
    T_map_lidar.translation() << at, 0.6;
    Keyframe keyframe;
    keyframe.T_map_kf = T_map_lidar;
    map.keyframes.push_back(keyframe);
    match.verdict = MatchResult::Verdict::kAmbiguous;
    match.hypotheses.resize(2);
    match.hypotheses[0].log_likelihood = 50;
    match.hypotheses[1].log_likelihood = 50 - lead_nats;
    match.hypotheses[1].T_plan_map = test::UprightPose(180, 2 * middle_m.x(), 2 * middle_m.y(), 0);
  }

  [[nodiscard]] std::optional<Guidance> Guided(const AGraph& plan) const {
    return Guide(PlanIndex(plan), map, match, T_map_lidar, MatcherOptions());
  }
};

TEST(Guidance, SendsTheRobotIntoTheRoomThatDiffers) {
  const AGraph plan = Row({0, 6, 10, 14});
  const auto guidance = Scene({8.5, 2.8}, {8, 2}).Guided(plan);
  ASSERT_TRUE(guidance && guidance->goal);
  const Goal& goal = *guidance->goal;
  EXPECT_EQ(guidance->rivals, 1);
  EXPECT_EQ(goal.rivals_split, 1);
  EXPECT_EQ(goal.rooms, (std::vector{RoomId(2), RoomId(0)}));
  EXPECT_NEAR(goal.distance_m, 2.0, 1e-6);
  EXPECT_NEAR(goal.bearing_rad, 0, 1e-6);
  EXPECT_GT(goal.expected_nats, 10);
}

TEST(Guidance, GoesPastRoomsThatLookAlike) {
  const AGraph plan = Row({0, 6.5, 10, 14, 17.5, 21});
  const auto guidance = Scene({12, 2.8}, {12, 2}).Guided(plan);
  ASSERT_TRUE(guidance && guidance->goal);
  EXPECT_EQ(guidance->goal->rooms, (std::vector{RoomId(4), RoomId(0)}));
  EXPECT_NEAR(guidance->goal->distance_m, 6.0, 0.2);
  EXPECT_NEAR(guidance->goal->bearing_rad, 0, 0.05);
}

TEST(Guidance, SaysThatNothingTellsTwinsApart) {
  const auto guidance = Scene({12, 2}, {12, 2}).Guided(Row({0, 6, 10, 14, 18, 24}));
  ASSERT_TRUE(guidance);
  EXPECT_EQ(guidance->rivals, 1);
  EXPECT_FALSE(guidance->goal);
}

TEST(Guidance, LeavesOutWhatTheMapHasSeen) {
  const AGraph plan = Row({0, 6, 10, 14});
  Scene scene({8.5, 2.8}, {8, 2});
  scene.map.keyframes.push_back(scene.map.keyframes.front());
  scene.map.keyframes.back().T_map_kf.translation() << 11, 2.8, 0.6;
  const auto guidance = scene.Guided(plan);
  ASSERT_TRUE(guidance && guidance->goal);
  EXPECT_EQ(guidance->goal->rooms, (std::vector{RoomId(0), RoomId(2)}));
}

TEST(Guidance, TurnsWithTheRobot) {
  const AGraph plan = Row({0, 6, 10, 14});
  Scene scene({8.5, 2.8}, {8, 2});
  scene.T_map_lidar.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto guidance = scene.Guided(plan);
  ASSERT_TRUE(guidance && guidance->goal);
  EXPECT_NEAR(guidance->goal->bearing_rad, -std::numbers::pi / 2, 1e-6);
}

TEST(Guidance, IsSilentWithoutRivals) {
  const AGraph plan = Row({0, 6, 10, 14});
  EXPECT_FALSE(Scene({8.5, 2.8}, {8, 2}, 15).Guided(plan));
  Scene found({8.5, 2.8}, {8, 2});
  found.match.verdict = MatchResult::Verdict::kUnique;
  EXPECT_FALSE(found.Guided(plan));
}

TEST(Guidance, RefusesUnusableOptions) {
  EXPECT_EQ(GuidanceOptions().Check(), "");
  GuidanceOptions options;
  options.seen_ratio = 0;
  EXPECT_NE(options.Check(), "");
}

}  // namespace
}  // namespace plumb::runtime
