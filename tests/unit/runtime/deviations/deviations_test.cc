#include "runtime/deviations/deviations.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/coupling/wall_frame.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;
enum HouseWall : size_t { kSouth, kEast, kNorth, kWest, kMiddle, kAcross, kNumWalls };

DeviationReport Assess(const AGraph& house, const test::DriveOptions& options) {
  test::Drive drive = test::DriveThroughHouse(house, options);
  Eigen::Isometry3d T = test::Disturbed(drive.T_plan_map, -0.03, 0.05, -0.5 * kDeg);
  JointResult result;
  for (int i = 0; i < 2; ++i) {
    result = OptimizeJointly(drive.map, house, MatchSurfaces(drive.map, house, T, result.Deviations(house.walls.size())), T);
    T = result.T_plan_map;
    for (size_t k = 0; k < result.T_map_kf.size(); ++k) drive.map.keyframes[k].T_map_kf = result.T_map_kf[k];
  }
  return AssessDeviations(house, result);
}

test::DriveOptions Drive(uint64_t seed) {
  test::DriveOptions options;
  options.seed = seed;
  options.deviations.assign(kNumWalls, {});
  return options;
}

TEST(AssessDeviations, NoFalsePositivesOverSeeds) {
  const AGraph house = test::MakeHouse();
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const DeviationReport report = Assess(house, Drive(seed));
    ASSERT_EQ(report.surfaces.size(), house.surfaces.size());
    for (const SurfaceDeviation& d : report.surfaces)
      EXPECT_EQ(d.status, SurfaceStatus::kAsPlanned) << "seed " << seed << " surface " << d.surface.value;
    for (const RoomDeviation& d : report.rooms) EXPECT_EQ(d.status, SurfaceStatus::kAsPlanned);
  }
}

TEST(AssessDeviations, FindsTwoDeviatedWallsOfSixAndNoOther) {
  const AGraph house = test::MakeHouse();
  test::Random random(17);
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    test::DriveOptions options = Drive(seed);
    const HouseWall first = std::array{kEast, kWest, kMiddle}[seed % 3], second = std::array{kSouth, kNorth, kAcross}[seed / 3 % 3];
    for (HouseWall w : {first, second}) {
      options.deviations[w] = {(random.Uniform(-1, 1) < 0 ? -1 : 1) * random.Uniform(0.05, 0.40), random.Uniform(-5, 5) * kDeg};
    }
    const DeviationReport report = Assess(house, options);
    for (const SurfaceDeviation& d : report.surfaces) {
      const size_t wall = house.surfaces[d.surface.index()].wall.index();
      const bool deviates = wall == first || wall == second;
      EXPECT_EQ(d.status, deviates ? SurfaceStatus::kDeviated : SurfaceStatus::kAsPlanned)
          << "seed " << seed << " wall " << wall << ": " << options.deviations[wall].offset_m << " m, found " << d.translation_m << " p "
          << d.p_deviated;
      EXPECT_NEAR(d.rotation_rad, options.deviations[wall].yaw_rad, 0.3 * kDeg);
    }
  }
}

TEST(AssessDeviations, FacesCarryTheWallsMotionAlongTheirOwnNormals) {
  const AGraph house = test::MakeHouse();
  test::DriveOptions options = Drive(3);
  options.deviations[kMiddle] = {0.2, 0};
  const DeviationReport report = Assess(house, options);
  const double sign = house.surfaces[WallFrames(house)[kMiddle].reference.index()].normal.x();  // world direction of +offset
  for (size_t i = 0; i < house.surfaces.size(); ++i) {
    if (house.surfaces[i].wall != WallId(kMiddle)) continue;
    EXPECT_EQ(report.surfaces[i].status, SurfaceStatus::kDeviated);
    EXPECT_NEAR(report.surfaces[i].translation_m, 0.2 * sign * house.surfaces[i].normal.x(), 0.01);
    EXPECT_GT(report.surfaces[i].sigma_translation_m, 0.0005);
    EXPECT_GT(report.surfaces[i].observed_m2, 1);
  }
  // Rooms A and C share it: one grows by what the other loses.
  EXPECT_NEAR(report.rooms[0].translation_m.x(), 0.1 * sign, 0.02);
  EXPECT_NEAR(report.rooms[2].translation_m.x(), 0.1 * sign, 0.02);
}

// Of the house's east wall alone.
JointResult EstimateOfEastWall(const AGraph& house, const WallDeviation& deviation, const Eigen::Matrix2d& evidence, double observed_m2) {
  JointResult estimate;
  estimate.covariances_exact = true;
  WallEstimate w;
  w.wall = WallId(kEast);
  w.reference = WallFrames(house)[kEast].reference;
  w.deviation = deviation;
  w.cov_all = Eigen::Matrix4d::Identity() * 1e-6;
  w.cov = w.cov_all.topLeftCorner<2, 2>();
  w.evidence = {{deviation.offset_m, deviation.yaw_rad}, evidence};
  w.p_deviated = deviation.offset_m == 0 ? 0 : 1;
  w.observed_m2 = observed_m2;
  w.span_m = 1;
  estimate.walls.push_back(w);
  return estimate;
}

TEST(AssessDeviations, HardlySeenWallsAreUnobserved) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {0.3, 0}, Eigen::Matrix2d::Identity() * 1e-6, 0.2);
  const DeviationReport report = AssessDeviations(house, estimate);
  for (const SurfaceDeviation& d : report.surfaces) EXPECT_EQ(d.status, SurfaceStatus::kUnobserved);
  estimate.walls[0].observed_m2 = 3;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kDeviated);
  estimate.walls[0].evidence.measured = {0.015, 0};
  estimate.walls[0].deviation = {0.015, 0};  // certain, but below what counts
  estimate.walls[0].p_deviated = 0.1;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kAsPlanned);
}

TEST(AssessDeviations, ASmallFaceAtAnAngleIsABoxAndNoWall) {
  const AGraph house = test::MakeHouse();
  const auto status = [&house](double yaw_rad, double observed_m2) {
    const JointResult estimate = EstimateOfEastWall(house, {0.03, yaw_rad}, Eigen::Matrix2d::Identity() * 1e-6, observed_m2);
    return AssessDeviations(house, estimate).surfaces[9].status;
  };
  EXPECT_EQ(status(0.2, 0.7), SurfaceStatus::kUnobserved);
  EXPECT_EQ(status(-0.2, 0.7), SurfaceStatus::kUnobserved);
  EXPECT_EQ(status(0.05, 0.7), SurfaceStatus::kDeviated);
  EXPECT_EQ(status(0.2, 1.2), SurfaceStatus::kDeviated);
}

TEST(AssessDeviations, WhatStandsBehindThePlannedFaceIsNoBoxInFrontOfIt) {
  const AGraph house = test::MakeHouse();
  const double front = MakeFace(WallFrames(house)[kEast], house.surfaces[9]).side();
  const auto status = [&](double offset_m) {
    JointResult estimate = EstimateOfEastWall(house, {front * offset_m, 0.2}, Eigen::Matrix2d::Identity() * 1e-6, 0.7);
    estimate.walls[0].seen = {{SurfaceId(9), 100, 0.7}};
    return AssessDeviations(house, estimate).surfaces[9].status;
  };
  EXPECT_EQ(status(0.1), SurfaceStatus::kUnobserved);
  EXPECT_EQ(status(-0.1), SurfaceStatus::kDeviated);
  EXPECT_EQ(status(-0.005), SurfaceStatus::kUnobserved);  // within the tolerance
}

TEST(AssessDeviations, ADoorwayInAWallThatIsABoxIsNotJudged) {
  AGraph house = test::MakeHouse();
  house.doorways[0].wall = WallId(kEast);
  WallChanges changes;
  changes.doorways = {{.doorway = DoorwayId(0), .status = DoorwayStatus::kDeviated, .width_deviation_m = 0.1, .p_deviated = 1}};
  const auto status = [&](double observed_m2) {
    const JointResult estimate = EstimateOfEastWall(house, {0.03, 0.2}, Eigen::Matrix2d::Identity() * 1e-6, observed_m2);
    return AssessDeviations(house, estimate, {}, changes).doorways[0].status;
  };
  EXPECT_EQ(status(0.7), DoorwayStatus::kUnobserved);
  EXPECT_EQ(status(1.2), DoorwayStatus::kDeviated);
}

// Of the east wall, known as well as can be, of which so much was seen.
SurfaceStatus StatusOfEastWall(const WallDeviation& deviation, double observed_m2, double span_m) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, deviation, Eigen::Matrix2d::Identity() * 1e-6, observed_m2);
  estimate.walls[0].span_m = span_m;
  return AssessDeviations(house, estimate).surfaces[9].status;
}

TEST(AssessDeviations, FewViewsAlongMoreThanABoxAreOfAWall) {
  EXPECT_EQ(StatusOfEastWall({0.03, 0.2}, 0.7, 1.2), SurfaceStatus::kUnobserved);
  EXPECT_EQ(StatusOfEastWall({0.03, 0.2}, 0.7, 2.5), SurfaceStatus::kDeviated);
}

TEST(AssessDeviations, AFaceFartherOffThanItIsLongIsNotKnownAgain) {
  EXPECT_EQ(StatusOfEastWall({0.4, 0}, 0.8, 0.35), SurfaceStatus::kUnobserved);
  EXPECT_EQ(StatusOfEastWall({0.4, 0}, 0.8, 0.5), SurfaceStatus::kDeviated);
}

// Seen at an end alone, 4 m from the middle: off by 10 cm there, and by who knows how much in the middle.
TEST(AssessDeviations, AWallThatIsPlainlyOffWhereItWasSeenDeviates) {
  const AGraph house = test::MakeHouse();
  const auto status = [&house](double off_m) {
    constexpr double kArm_m = 4, kSigma_m = 0.01, kSigma_rad = 0.05;
    Eigen::Matrix2d evidence;  // of the middle, given the end
    evidence << kSigma_m * kSigma_m + kArm_m * kArm_m * kSigma_rad * kSigma_rad, -kArm_m * kSigma_rad * kSigma_rad,
        -kArm_m * kSigma_rad * kSigma_rad, kSigma_rad * kSigma_rad;
    return AssessDeviations(house, EstimateOfEastWall(house, {off_m, 0}, evidence, 2)).surfaces[9].status;
  };
  EXPECT_EQ(status(0.1), SurfaceStatus::kDeviated);
  EXPECT_EQ(status(0.02), SurfaceStatus::kUnobserved);
}

TEST(AssessDeviations, AWallThatMoreLikelyDeviatesIsNotAsPlanned) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {0.015, 0}, Eigen::Matrix2d::Identity() * 1e-6, 3);
  estimate.walls[0].p_deviated = 0.7;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kUnobserved);
  estimate.walls[0].p_deviated = 0.3;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kAsPlanned);
}

TEST(AssessDeviations, AWallThatOneInTwentyTimesStandsAsPlannedIsNotReported) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {0.03, 0}, Eigen::Matrix2d::Identity() * 1e-6, 3);
  estimate.walls[0].p_deviated = 0.95;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kUnobserved);
  estimate.walls[0].p_deviated = 0.98;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kDeviated);
}

TEST(AssessDeviations, WhatCouldNotHaveBeenFoundIsUnobservedAndNotAsPlanned) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {}, Eigen::Vector2d(0.01 * 0.01, 1e-6).asDiagonal(), 30);
  const SurfaceDeviation sharp = AssessDeviations(house, estimate).surfaces[9];
  EXPECT_EQ(sharp.status, SurfaceStatus::kAsPlanned);
  EXPECT_NEAR(sharp.mdb_m, std::sqrt(17.1) * std::hypot(0.01, 0.005), 1e-3);
  estimate.walls[0].evidence.covariance(0, 0) = 0.08 * 0.08;  // the tight prior holds it at zero all the same
  const SurfaceDeviation blurred = AssessDeviations(house, estimate).surfaces[9];
  EXPECT_EQ(blurred.status, SurfaceStatus::kUnobserved);
  EXPECT_NEAR(blurred.mdb_m, 0.33, 0.01);
  estimate.walls[0].evidence.covariance(0, 0) = 0.01 * 0.01;  // sharp, but the plan may as well lie 0.3 m further on
  estimate.walls[0].place_sigma_m = 0.2;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kUnobserved);
}

TEST(AssessDeviations, WhatTheDataLeaveFarOffIsUnobservedHoweverUnlikelyBeforehand) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {}, Eigen::Vector2d(0.026 * 0.026, 1e-6).asDiagonal(), 60);
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kAsPlanned);
  estimate.walls[0].evidence.measured = {-0.055, 0};
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kUnobserved);
}

TEST(AssessDeviations, ATurnThatTheDataShowAndThePriorDoubtsIsNotAsPlanned) {
  const AGraph house = test::MakeHouse();
  JointResult estimate = EstimateOfEastWall(house, {}, Eigen::Vector2d(0.01 * 0.01, std::pow(0.1 * kDeg, 2)).asDiagonal(), 30);
  estimate.walls[0].deviation.yaw_rad = estimate.walls[0].evidence.measured.y() = 0.9 * kDeg;
  estimate.walls[0].p_deviated = 0.9;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kUnobserved);
  estimate.walls[0].p_deviated = 0.99;
  EXPECT_EQ(AssessDeviations(house, estimate).surfaces[9].status, SurfaceStatus::kDeviated);
}

TEST(DeviationsToJson, HasTheAgreedForm) {
  const AGraph house = test::MakeHouse();
  test::DriveOptions options = Drive(3);
  options.deviations[kEast] = {0.2, 3 * kDeg};
  const DeviationReport report = Assess(house, options);
  const std::string text = DeviationsToJson(house, report);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["gauge"], report.gauge);
  ASSERT_EQ(json["surfaces"].size(), house.surfaces.size());
  const auto& east = json["surfaces"][9];
  EXPECT_EQ(east["id"], 9);
  EXPECT_EQ(east["wall_guid"], "wall-east");
  EXPECT_EQ(east["wall_id"], house.surfaces[9].wall.value);
  EXPECT_EQ(east["storey"], "Ground floor");
  EXPECT_EQ(east["status"], "deviated");
  EXPECT_TRUE(east["unjudged"].is_null());
  EXPECT_NEAR(east["rotation_deg"], 3, 0.3);
  EXPECT_NEAR(std::abs(east["translation_m"].get<double>()), 0.2, 0.01);
  for (const char* key :
       {"normal", "sigma_translation_m", "sigma_rotation_deg", "tilt_deg", "p_deviated", "mdb_m", "observed_m2", "points"})
    EXPECT_TRUE(east.contains(key));
  ASSERT_EQ(json["rooms"].size(), 3u);
  for (const char* key : {"id", "name", "guid", "translation_m", "rotation_deg", "sigma_m", "status"})
    EXPECT_TRUE(json["rooms"][2].contains(key));
  EXPECT_TRUE(json["unplanned"].empty());
  EXPECT_EQ(DeviationsToJson(house, Assess(house, options)), text);
}

TEST(DeviationOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(DeviationOptions{}.Check(), "");
  DeviationOptions options;
  options.false_discovery_rate = 0;
  EXPECT_EQ(options.Check(), "DeviationOptions.false_discovery_rate = 0; must be in (0, 1)");
}

// What a wall that was seen is not judged for is said of each of its faces, and in all.
TEST(AssessDeviations, SaysWhyAWallIsNotJudged) {
  const AGraph house = test::MakeHouse();
  const auto assess = [&house](const JointResult& estimate, const WallChanges& changes = {}) {
    return AssessDeviations(house, estimate, {}, changes);
  };
  const Eigen::Matrix2d sharp = Eigen::Matrix2d::Identity() * 1e-6;
  JointResult estimate = EstimateOfEastWall(house, {0.03, 0}, sharp, 3);
  const DeviationReport judged = assess(estimate);
  EXPECT_EQ(judged.surfaces[9].unjudged, Unjudged::kNone);
  EXPECT_EQ(judged.unjudged, "");
  for (const SurfaceDeviation& d : judged.surfaces) {
    if (house.surfaces[d.surface.index()].wall != WallId(kEast)) {
      EXPECT_EQ(d.unjudged, Unjudged::kNotSeen) << d.surface.value;
    }
  }
  EXPECT_EQ(assess(EstimateOfEastWall(house, {0.3, 0}, sharp, 0.2)).surfaces[9].unjudged, Unjudged::kSeenTooLittle);
  EXPECT_EQ(assess(EstimateOfEastWall(house, {0.03, 0.2}, sharp, 0.7)).surfaces[9].unjudged, Unjudged::kMayBeFurniture);
  const DeviationReport blurred = assess(EstimateOfEastWall(house, {}, Eigen::Vector2d(0.0064, 1e-6).asDiagonal(), 30));
  EXPECT_EQ(blurred.surfaces[9].unjudged, Unjudged::kUncertain);
  EXPECT_EQ(blurred.unjudged, "Seen and not judged: 1 that may be 10 cm off by what was seen.");
  estimate.walls[0].p_deviated = 0.8;
  EXPECT_EQ(assess(estimate).surfaces[9].unjudged, Unjudged::kUndecided);
  estimate.walls[0].p_deviated = 1;
  WallChanges changes;
  changes.on_other_shape.assign(house.walls.size(), true);
  EXPECT_EQ(assess(estimate, changes).surfaces[9].unjudged, Unjudged::kOtherShape);
  estimate.covariances_exact = false;
  EXPECT_EQ(assess(estimate).surfaces[9].unjudged, Unjudged::kNoCovariance);
}

}  // namespace
}  // namespace plumb::runtime
