#include "runtime/optimization/patch_agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;
const WallId kMiddle(4);

// A drive through the house as planned, where it lies. Both sides of the middle wall were seen.
struct House {
  AGraph plan = test::MakeHouse();
  test::Drive drive = test::DriveThroughHouse(plan);
  std::vector<Match> matches;
  std::vector<Eigen::Isometry3d> T_map_kf;
  std::vector<uint32_t> of_middle;  // map surfaces

  House() {
    for (size_t k = 0; k < drive.T_plan_kf.size(); ++k) T_map_kf.push_back(drive.T_plan_map.inverse() * drive.T_plan_kf[k]);
    for (uint32_t i = 0; i < drive.built.size(); ++i) {
      if (!drive.built[i].valid()) continue;
      matches.push_back({i, drive.built[i], {}, 0, 0, {}});
      if (plan.surfaces[drive.built[i].index()].wall == kMiddle) of_middle.push_back(i);
    }
  }
  // What was seen of a surface, turned about its middle and moved along +x of the plan.
  void Lean(uint32_t surface, double yaw_rad, double x_m) {
    for (Observation& o : drive.map.surfaces[surface].observations) {
      const Eigen::Isometry3d& T = drive.T_plan_kf[o.keyframe];
      const Eigen::Vector3d middle = T * o.stats.centroid();
      const Eigen::Isometry3d moved = Eigen::Translation3d(middle + Eigen::Vector3d(x_m, 0, 0)) *
                                      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-middle);
      o.stats = o.stats.Transformed(T.inverse() * moved * T);
    }
  }
  [[nodiscard]] std::map<WallId, PatchDisagreement> Disagreements(const Eigen::Vector3d& estimate_of_middle) const {
    std::map<WallId, Eigen::Vector3d> estimates;
    for (size_t w = 0; w < plan.walls.size(); ++w) estimates[WallId(w)] = Eigen::Vector3d::Zero();
    estimates[kMiddle] = estimate_of_middle;
    return FindDisagreements(drive.map, plan, WallFrames(plan), matches, T_map_kf, drive.T_plan_map, estimates, 0, JointOptions());
  }
};

TEST(FindDisagreements, WallsSeenAsTheyAreAgreeWithThemselves) { EXPECT_TRUE(House().Disagreements(Eigen::Vector3d::Zero()).empty()); }

TEST(FindDisagreements, AWallThatDeviatesOnAllSidesAgreesWithItself) {
  House house;
  ASSERT_GE(house.of_middle.size(), 2u);
  for (const uint32_t i : house.of_middle) house.Lean(i, 0, 0.05);
  EXPECT_TRUE(house.Disagreements(Eigen::Vector3d::Zero()).empty());
}

TEST(FindDisagreements, AThickerWallAgreesWithItself) {
  constexpr double kThicker_m = 0.08;
  House house;
  ASSERT_GE(house.of_middle.size(), 2u);
  for (const uint32_t i : house.of_middle) {
    const Surface& face = house.plan.surfaces[house.drive.built[i].index()];
    house.Lean(i, 0, 0.5 * kThicker_m * face.normal.x());
  }
  EXPECT_TRUE(house.Disagreements(Eigen::Vector3d(0, 0, kThicker_m)).empty());
  EXPECT_FALSE(house.Disagreements(Eigen::Vector3d::Zero()).empty()) << "were it not told how thick the wall is";
}

TEST(FindDisagreements, APatchThatLeansMakesItsWallUnsure) {
  House house;
  ASSERT_GE(house.of_middle.size(), 2u);
  house.Lean(house.of_middle.front(), 2 * kDeg, 0);
  const uint32_t leaning = house.of_middle.front();
  house.drive.map.surfaces[leaning].area_m2 = 0;  // half of the wall: no odd one
  for (const uint32_t i : house.of_middle)
    if (i != leaning) house.drive.map.surfaces[leaning].area_m2 += house.drive.map.surfaces[i].area_m2;
  const auto found = house.Disagreements(Eigen::Vector3d(0, 2 * kDeg, 0));
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found.begin()->first, kMiddle);
  EXPECT_GT(found.begin()->second.variance_ratio, 4);
  EXPECT_GT(found.begin()->second.mean.y(), 0.2 * kDeg);
  EXPECT_LT(found.begin()->second.mean.y(), 1.8 * kDeg);
}

// A leaf that stands open before its wall, say: the solve still hears it, but it is little of what was seen.
TEST(FindDisagreements, AnOddPatchThatIsLittleOfTheWallDoesNotMakeItUnsure) {
  House house;
  ASSERT_GE(house.of_middle.size(), 2u);
  const uint32_t odd = house.of_middle.front();
  house.Lean(odd, 0, 0.04);
  double others_m2 = 0;
  for (const uint32_t i : house.of_middle) others_m2 += i == odd ? 0 : house.drive.map.surfaces[i].area_m2;

  house.drive.map.surfaces[odd].area_m2 = others_m2;
  const auto much = house.Disagreements(Eigen::Vector3d::Zero());
  ASSERT_EQ(much.size(), 1u);
  EXPECT_GT(much.begin()->second.variance_ratio, 4);

  house.drive.map.surfaces[odd].area_m2 = 0.1 * others_m2;
  const auto little = house.Disagreements(Eigen::Vector3d::Zero());
  ASSERT_EQ(little.size(), 1u);
  ASSERT_EQ(little.begin()->first, kMiddle);
  EXPECT_EQ(little.begin()->second.variance_ratio, 1);
  EXPECT_LT(std::sqrt(little.begin()->second.added(0, 0)), 0.005);
  // Unless the solve has settled on the odd one.
  EXPECT_NEAR(std::sqrt(house.Disagreements(Eigen::Vector3d(0.04, 0, 0)).begin()->second.added(0, 0)), 0.04, 0.005);
}

// An odd thing or two say nothing; half of what was seen may as well be the wall.
TEST(FindDisagreements, WhatTheSolveHasLetGoOfCountsIfItIsMuchOfTheWall) {
  constexpr double kOff_m = 0.4;
  House house;
  ASSERT_GE(house.of_middle.size(), 2u);
  const uint32_t odd = house.of_middle.front();
  house.Lean(odd, 0, kOff_m);
  double others_m2 = 0;
  for (const uint32_t i : house.of_middle) others_m2 += i == odd ? 0 : house.drive.map.surfaces[i].area_m2;

  house.drive.map.surfaces[odd].area_m2 = 0.1 * others_m2;
  EXPECT_TRUE(house.Disagreements(Eigen::Vector3d::Zero()).empty());
  house.drive.map.surfaces[odd].area_m2 = others_m2;
  const auto found = house.Disagreements(Eigen::Vector3d::Zero());
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found.begin()->first, kMiddle);
  EXPECT_EQ(found.begin()->second.variance_ratio, 1);
  EXPECT_NEAR(found.begin()->second.added(0, 0), 0.5 * kOff_m * kOff_m, 0.02);
}

}  // namespace
}  // namespace plumb::runtime
