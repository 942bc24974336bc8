#include "runtime/matching/start_hint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/matching/matcher.h"
#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::ErrorOf;
using test::OnTour;
using test::UprightPose;
using Verdict = MatchResult::Verdict;

// Two rooms of 20 m2, alike under a half turn.
AGraph Twin() { return test::MakeGridPlan({0, 5, 10}, {0, 4}, {{true, 1, 0, 0.5}}); }
const test::Tour kTwinTour = {{2.5, 2}, {1.5, 2.5}, {7, 2}, {8, 1.5}};

StartHint Near(double x_m, double y_m, double sigma_m) {
  StartHint hint;
  hint.near_m = Eigen::Vector2d(x_m, y_m);
  hint.near_sigma_m = sigma_m;
  return hint;
}

StartHint InRoom(size_t room) {
  StartHint hint;
  hint.rooms = {RoomId(room)};
  return hint;
}

size_t RoomOf(const AGraph& plan, const Eigen::Vector2d& p) {
  return p.x() < 5 ? (plan.rooms[0].center.x() < 5 ? 0 : 1) : (plan.rooms[0].center.x() < 5 ? 1 : 0);
}

TEST(LogPrior, IsZeroWithoutAHint) { EXPECT_EQ(LogPrior(Twin(), StartHint(), {2.5, 2, 0.6}), 0); }

TEST(LogPrior, IsTheRoomsShareOfTheArea) {
  const AGraph twin = Twin();
  const StartHint hint = InRoom(RoomOf(twin, {2.5, 2}));
  double area_m2 = 0;
  for (const Room& room : twin.rooms) area_m2 += room.area_m2;
  const double density = area_m2 / twin.rooms[hint.rooms[0].index()].area_m2;
  EXPECT_NEAR(LogPrior(twin, hint, {2.5, 2, 0.6}), std::log(hint.trust * density + 1 - hint.trust), 1e-12);
  EXPECT_NEAR(LogPrior(twin, hint, {5.3, 2, 0.6}), LogPrior(twin, hint, {2.5, 2, 0.6}), 1e-12) << "in the doorway";
  EXPECT_NEAR(LogPrior(twin, hint, {7.5, 2, 0.6}), std::log(1 - hint.trust), 1e-9);
  EXPECT_NEAR(LogPrior(twin, hint, {2.5, 2, 5.6}), std::log(1 - hint.trust), 1e-9) << "a storey above";
}

TEST(LogPrior, IsAGaussianWithATailThatNeverEnds) {
  const AGraph twin = Twin();
  const StartHint hint = Near(2.5, 2, 1);
  EXPECT_GT(LogPrior(twin, hint, {2.5, 2, 0.6}), 1.5);
  EXPECT_NEAR(LogPrior(twin, hint, {2.5, 2, 0.6}) - LogPrior(twin, hint, {3.5, 2, 0.6}), 0.5, 1e-2);
  EXPECT_NEAR(LogPrior(twin, hint, {2.5, 200, 0.6}), std::log(1 - hint.trust), 1e-9);
}

TEST(StartHint, CheckNamesTheField) {
  EXPECT_TRUE(StartHint().Check().empty());
  EXPECT_EQ(Near(0, 0, 0).Check(), "StartHint.near_sigma_m = 0; must be from 0.1 to 1000");
  EXPECT_NE(Near(std::nan(""), 0, 1).Check().find("near_m"), std::string::npos);
  StartHint sure = InRoom(0);
  sure.trust = 1;
  EXPECT_EQ(sure.Check(), "StartHint.trust = 1; must be in (0, 1)");
}

TEST(Matcher, TellsTwinsApartByAHint) {
  const AGraph twin = Twin();
  const Eigen::Isometry3d truth = UprightPose(-40, 1, 2, 0);
  const SGraph map = MakeSyntheticMap(twin, OnTour(kTwinTour, truth));
  for (const StartHint& hint : {InRoom(RoomOf(twin, {2.5, 2})), Near(2.5, 2, 1)}) {
    const MatchResult result = Matcher(twin).Match(map, hint);
    ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
    EXPECT_LT(ErrorOf(result.hypotheses[0].T_plan_map, truth, {5, 2}).xy_m, 0.05);
  }
}

TEST(Matcher, OverrulesAWrongHint) {
  const AGraph house = test::MakeHouse();
  const Eigen::Isometry3d truth = UprightPose(25, 1, 2, 0);
  const Eigen::Vector2d far_off(100, 100);
  const MatchResult result =
      Matcher(house).Match(MakeSyntheticMap(house, OnTour(test::kWholeHouse, truth)), Near(far_off.x(), far_off.y(), 1));
  ASSERT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  EXPECT_LT(ErrorOf(result.hypotheses[0].T_plan_map, truth, test::kWholeHouse.front()).xy_m, 0.05);
}

}  // namespace
}  // namespace plumb::runtime
