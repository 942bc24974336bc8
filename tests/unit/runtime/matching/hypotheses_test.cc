#include "runtime/matching/hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::OnTour;
using test::UprightPose;

TEST(YawPeaks, HoldTheTrueYawAndTheQuarterTurns) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const MatcherOptions options;
  for (double yaw_deg : {-171.3, -90.2, 12.6, 44.9, 133.7}) {
    const MapView view = ViewMap(MakeSyntheticMap(house, OnTour(test::kFromA, UprightPose(yaw_deg, 1, 2, 0))), options);
    const std::vector<double> peaks = YawPeaks(plan, view, options);
    EXPECT_EQ(peaks.size(), 4u);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double yaw_rad = (yaw_deg + 90.0 * quarter) * std::numbers::pi / 180;
      EXPECT_TRUE(std::any_of(peaks.begin(), peaks.end(), [&](double p) { return std::abs(WrapAngle(p - yaw_rad)) < 0.009; })) << yaw_deg;
    }
  }
}

TEST(ProposePoses, HoldThePoseEvenIfWallsDeviate) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  AGraph built = house;
  test::DeviateWall(built, WallId(0), 0.35, 0.05);
  test::DeviateWall(built, WallId(5), -0.2, 0.2);
  const MatcherOptions options;
  for (const test::Tour& tour : {test::kFromA, test::kFromB, test::kFromC}) {
    const MapView view = ViewMap(MakeSyntheticMap(built, OnTour(tour, UprightPose(0, 0, 0, 0))), options);
    const std::vector<Proposal> proposals = ProposePoses(plan, view, options);
    EXPECT_LE(static_cast<int>(proposals.size()), options.max_hypotheses);
    EXPECT_TRUE(std::is_sorted(proposals.begin(), proposals.end(), [](const auto& a, const auto& b) { return a.votes > b.votes; }));
    EXPECT_TRUE(std::any_of(proposals.begin(), proposals.end(), [&](const Proposal& p) {
      return std::abs(p.pose.yaw_rad) < 0.05 && (p.pose.t_m - view.center_m).norm() < 0.4;
    }));
  }
}

TEST(ProposePoses, PutTheMapsFloorOntoTheLevel) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const MapView view = ViewMap(MakeSyntheticMap(house, OnTour(test::kFromA, UprightPose(0, 0, 0, 1.7))), MatcherOptions());
  ASSERT_EQ(plan.levels().size(), 1u);
  EXPECT_NEAR(HeightOnLevel(view, plan.levels()[0]), 1.7, 0.01);
}

}  // namespace
}  // namespace plumb::runtime
