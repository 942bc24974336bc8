#include "runtime/optimization/joint_optimizer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "runtime/optimization/seen_walls.h"
#include "tests/unit/runtime/optimization/solved_drive.h"

namespace plumb::runtime {
namespace {

using test::Drive;
using test::DriveOptions;

void ExpectPlaceNear(const Solved& s, double max_m, double max_rad) {
  const Eigen::Isometry3d error = s.drive.T_plan_map.inverse() * s.result.T_plan_map;
  EXPECT_LT(error.translation().norm(), max_m);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), max_rad);
}

void ExpectDeviationsNear(const Solved& s, const DriveOptions& options, double max_m, double max_rad) {
  ASSERT_EQ(s.result.walls.size(), kNumWalls);
  for (const WallEstimate& w : s.result.walls) {
    const WallDeviation truth = options.deviations.empty() ? WallDeviation{} : options.deviations[w.wall.index()];
    EXPECT_NEAR(w.deviation.offset_m, truth.offset_m, max_m) << "wall " << w.wall.value;
    EXPECT_NEAR(w.deviation.yaw_rad, truth.yaw_rad, max_rad) << "wall " << w.wall.value;
  }
}

TEST(OptimizeJointly, RecoversPlaceAndDeviationsOverTheirRange) {
  const AGraph house = test::MakeHouse();
  for (const WallDeviation& d :
       {WallDeviation{0.05, 0}, WallDeviation{-0.05, 1 * kDeg}, WallDeviation{0.10, -3 * kDeg}, WallDeviation{-0.20, 5 * kDeg},
        WallDeviation{0.40, 0}, WallDeviation{0.40, 10 * kDeg}, WallDeviation{-0.30, -10 * kDeg}, WallDeviation{0, 4 * kDeg}}) {
    SCOPED_TRACE(testing::Message() << d.offset_m << " m " << d.yaw_rad / kDeg << " deg");
    const DriveOptions options = WithDeviations(7, {{kEast, d}});
    const Solved s = Solve(house, options);
    EXPECT_TRUE(s.result.converged) << s.result.message;
    EXPECT_TRUE(s.result.covariances_exact);
    ExpectPlaceNear(s, 0.01, 0.1 * kDeg);
    ExpectDeviationsNear(s, options, 0.01, 0.3 * kDeg);
    EXPECT_GT(s.result.walls[kEast].p_deviated, 0.9);
  }
}

TEST(OptimizeJointly, FindsNoDeviationInAHouseAsPlanned) {
  const AGraph house = test::MakeHouse();
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Solved s = Solve(house, WithDeviations(seed, {}));
    for (const WallEstimate& w : s.result.walls) EXPECT_LT(w.p_deviated, 0.5) << "seed " << seed << " wall " << w.wall.value;
    ExpectPlaceNear(s, 0.01, 0.1 * kDeg);
  }
}

// A narrow field of view in a small room sees neither floor nor ceiling, and walls are never quite plumb: the height stays where the
// matcher had it.
TEST(OptimizeJointly, HoldsTheHeightWithoutFloorAndCeiling) {
  const AGraph house = test::MakeHouse();
  DriveOptions options;
  options.floors = false;
  options.drift_rad = 0.005;
  const Solved s = SolveDrive(house, test::DriveThroughHouse(house, options), 8);
  EXPECT_NEAR((s.result.T_plan_map.translation() - s.drive.T_plan_map.translation()).z(), 0, 0.03);
}

// Suspended ceilings, beams and lintels come in many pieces; the floor is one.
TEST(OptimizeJointly, ManyLowCeilingsDoNotPushTheFloorDown) {
  const AGraph house = test::MakeHouse();
  constexpr double kLower_m = 0.2;
  test::Drive drive = test::DriveThroughHouse(house);
  const std::vector<MapSurface> surfaces = drive.map.surfaces;
  for (const MapSurface& floor : surfaces) {
    if (floor.kind != SurfaceKind::kFloor) continue;
    const Eigen::Isometry3d up(Eigen::Translation3d(0, 0, house.rooms[0].ceiling_z_m - house.rooms[0].floor_z_m - kLower_m));
    MapSurface ceiling = floor;
    ceiling.kind = SurfaceKind::kCeiling;
    ceiling.plane = floor.plane.Transformed(up);
    for (Observation& o : ceiling.observations) o.stats = o.stats.Transformed(up);
    for (int copy = 0; copy < 3; ++copy) {
      ceiling.id = static_cast<uint32_t>(drive.map.surfaces.size());
      drive.map.surfaces.push_back(ceiling);
      drive.built.emplace_back();
    }
  }
  const Solved s = SolveDrive(house, std::move(drive));
  const auto ceilings = std::count_if(s.matches.begin(), s.matches.end(),
                                      [&](const Match& m) { return s.drive.map.surfaces[m.map_surface].kind == SurfaceKind::kCeiling; });
  ASSERT_GE(ceilings, 9) << "or they could push nothing";
  EXPECT_NEAR((s.result.T_plan_map.translation() - s.drive.T_plan_map.translation()).z(), 0, 0.02);
}

TEST(OptimizeJointly, DeviatedWallsDoNotDragThePlace) {
  const AGraph house = test::MakeHouse();
  test::Random random(99);
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const HouseWall along_x = std::array{kEast, kWest, kMiddle}[seed % 3], along_y = std::array{kSouth, kNorth, kAcross}[seed / 3 % 3];
    const auto deviation = [&] {
      const double sign = random.Uniform(-1, 1) < 0 ? -1 : 1;
      return WallDeviation{sign * random.Uniform(0.07, 0.40), random.Uniform(-5, 5) * kDeg};
    };
    const DriveOptions options = WithDeviations(seed, {{along_x, deviation()}, {along_y, deviation()}});
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", walls " << along_x << " " << along_y);
    const Solved s = Solve(house, options);
    ExpectPlaceNear(s, 0.01, 0.15 * kDeg);  // two of six walls turned by less than 1 deg are partly taken for tolerance
    ExpectDeviationsNear(s, options, 0.01, 0.3 * kDeg);
    for (const WallEstimate& w : s.result.walls) {
      const bool deviates = w.wall.index() == along_x || w.wall.index() == along_y;
      EXPECT_EQ(w.p_deviated > 0.5, deviates) << "wall " << w.wall.value << " p " << w.p_deviated;
    }
  }
}

TEST(OptimizeJointly, RangeBiasIsNotPutIntoWalls) {
  const AGraph house = test::MakeHouse();
  DriveOptions options = WithDeviations(3, {{kNorth, {0.15, 2 * kDeg}}});
  options.range_bias_m = 0.015;
  const Solved s = Solve(house, options);
  EXPECT_NEAR(s.result.range_bias_m, 0.015, 0.003);
  ExpectDeviationsNear(s, options, 0.01, 0.3 * kDeg);
  for (const WallEstimate& w : s.result.walls) EXPECT_LT(std::abs(w.thickness_error_m), 0.005);
}

TEST(OptimizeJointly, BothFacesOfAWallShareOneDeviationAndGiveItsThickness) {
  const AGraph house = test::MakeHouse();
  DriveOptions options = WithDeviations(5, {{kMiddle, {0.12, 1 * kDeg}}});
  options.thickness_errors_m.assign(kNumWalls, 0);
  options.thickness_errors_m[kMiddle] = 0.02;
  const Solved s = Solve(house, options);
  const WallEstimate& middle = s.result.walls[kMiddle];
  EXPECT_EQ(middle.seen.size(), 3u);  // A, B and C
  EXPECT_NEAR(middle.deviation.offset_m, 0.12, 0.01);
  EXPECT_NEAR(middle.deviation.yaw_rad, 1 * kDeg, 0.3 * kDeg);
  // Not all of it: bias and tolerance of the others explain a part just as well.
  for (const WallEstimate& w : s.result.walls)
    EXPECT_GE(middle.thickness_error_m, w.thickness_error_m + (w.wall == middle.wall ? 0 : 0.003));
  EXPECT_GT(middle.thickness_error_m, 0.005);
  EXPECT_LT(middle.thickness_error_m, 0.022);
}

// The plan parts C's east side into two faces; what was seen of it is one patch.
TEST(OptimizeJointly, WhatWasSeenOfASideIsCountedForEachOfItsFaces) {
  const AGraph house = test::MakeHouse();
  const Solved whole = Solve(house, {});
  AGraph parted = house;
  const Surface side = house.surfaces[9];
  parted.surfaces[9].end = side.start + (side.end - side.start) / 3;
  parted.surfaces.push_back(side);
  parted.surfaces.back().start = parted.surfaces[9].end;
  const Solved divided = SolveDrive(parted, test::DriveThroughHouse(house, {}));
  const WallEstimate &a = whole.result.walls[kEast], &b = divided.result.walls[kEast];
  ASSERT_EQ(a.seen.size(), 1u);
  ASSERT_EQ(b.seen.size(), 2u);
  EXPECT_NEAR(b.observed_m2, a.observed_m2, 1e-6);
  EXPECT_NEAR(b.seen[0].observed_m2 / b.observed_m2, 1.0 / 3, 0.05);
  EXPECT_NEAR(b.seen[1].num_points / b.num_points, 2.0 / 3, 0.05);
}

// The plan has one part of C's east side in a storey half a floor higher, or in one above.
TEST(OptimizeJointly, WhatWasSeenOfASideIsCountedAtItsHeight) {
  const AGraph house = test::MakeHouse();
  const Solved s = Solve(house, {});
  const auto num_seen = [&](double higher_m) {
    AGraph parted = house;
    parted.surfaces[9].end = house.surfaces[9].midpoint();
    Surface other = house.surfaces[9];
    other.start = house.surfaces[9].midpoint();
    other.z_min_m += higher_m;
    other.z_max_m += higher_m;
    other.storey = StoreyId(house.surfaces[9].storey.index() + 1);
    parted.surfaces.push_back(other);
    std::vector<WallEstimate> walls = s.result.walls;
    walls[kEast].seen.clear();
    CountSeen(s.drive.map, parted, WallFrames(parted), s.matches, s.result.T_plan_map, walls);
    EXPECT_EQ(walls[kEast].span_m > 0.8 * house.surfaces[9].length_m(), walls[kEast].seen.size() > 1);
    return walls[kEast].seen.size();
  };
  EXPECT_EQ(num_seen(0.6), 2u);
  EXPECT_EQ(num_seen(2.2), 1u);
}

// The middle of what was seen of it left out: it still reaches from end to end.
TEST(OptimizeJointly, WhatWasSeenAlongAWallIsLessThanItsSpanWhereThereAreGaps) {
  const AGraph house = test::MakeHouse();
  Solved s = Solve(house, {});
  const double length_m = house.surfaces[9].length_m();
  EXPECT_GT(s.result.walls[kEast].seen_m, 0.8 * length_m);
  for (MapSurface& patch : s.drive.map.surfaces) {
    const auto length = static_cast<float>(patch.length_m());
    patch.cells.clear();
    for (float u = 0.05f; u < length; u += 0.1f) {
      if (std::abs(u - 0.5f * length) > 0.3f * length) patch.cells.emplace_back(u, 1.0f);
    }
  }
  CountSeen(s.drive.map, house, WallFrames(house), s.matches, s.result.T_plan_map, s.result.walls);
  EXPECT_GT(s.result.walls[kEast].span_m, 0.8 * length_m);
  EXPECT_LT(s.result.walls[kEast].seen_m, 0.5 * length_m);
}

TEST(OptimizeJointly, TheSpanOfAWallEndsWithItsFace) {
  AGraph house = test::MakeHouse();
  Solved s = Solve(house, {});
  const double span_m = s.result.walls[kEast].span_m, length_m = house.surfaces[9].length_m();
  EXPECT_LE(span_m, length_m + 1e-6);
  EXPECT_GT(span_m, 0.8 * length_m);
  for (MapSurface& patch : s.drive.map.surfaces) {  // each goes on by a metre at either end, along other walls
    const Eigen::Vector2d on = (patch.end - patch.start).normalized();
    patch.start -= on;
    patch.end += on;
  }
  const JointResult longer = OptimizeJointly(s.drive.map, house, s.matches, s.result.T_plan_map);
  EXPECT_NEAR(longer.walls[kEast].span_m, length_m, 0.05);
  EXPECT_LE(longer.walls[kEast].seen_m, length_m + 0.1);
}

// Each patch has a square metre and two beyond either end as well.
TEST(OptimizeJointly, WhatGoesOnBeyondAWallIsNotCountedAsSeenOfIt) {
  const AGraph house = test::MakeHouse();
  Solved s = Solve(house, {});
  const WallEstimate before = s.result.walls[kEast];
  for (MapSurface& patch : s.drive.map.surfaces) {
    if (patch.kind != SurfaceKind::kWall) continue;
    const Eigen::Vector2d on = 2 * (patch.end - patch.start).normalized();
    const auto length_m = static_cast<float>(patch.length_m());
    patch.start -= on;
    patch.end += on;
    for (Eigen::Vector2f& cell : patch.cells) cell.x() += 2;
    const size_t num = patch.cells.size();
    for (float z = 0.05f; z < 2; z += 0.1f) {
      for (float x = 0.05f; x < 1; x += 0.1f) {
        patch.cells.emplace_back(x, z);
        patch.cells.emplace_back(length_m + 3 + x, z);
      }
    }
    const double more = static_cast<double>(patch.cells.size()) / static_cast<double>(num);
    patch.area_m2 *= more;
    patch.num_points *= more;
  }
  const WallEstimate after = OptimizeJointly(s.drive.map, house, s.matches, s.result.T_plan_map).walls[kEast];
  EXPECT_NEAR(after.observed_m2, before.observed_m2, 0.05 * before.observed_m2);
  EXPECT_NEAR(after.num_points, before.num_points, 0.05 * before.num_points);
}

// It meets the next wall as much later, but not by metres.
TEST(OptimizeJointly, AWallThatIsOffMayBeAsMuchLonger) {
  const AGraph house = test::MakeHouse();
  const Solved s = Solve(house, {});
  const auto seen_m2 = [&](double shorter_m, double offset_m) {
    AGraph shorter = house;
    Surface& face = shorter.surfaces[9];
    face.end += shorter_m * (face.start - face.end).normalized();
    std::vector<WallEstimate> walls = s.result.walls;
    for (WallEstimate& wall : walls) wall.observed_m2 = 0;
    walls[kEast].deviation = {offset_m, 0};
    CountSeen(s.drive.map, shorter, WallFrames(shorter), s.matches, s.result.T_plan_map, walls);
    return walls[kEast].observed_m2;
  };
  EXPECT_LT(seen_m2(1.5, 0), 0.85 * s.result.walls[kEast].observed_m2);
  EXPECT_LT(seen_m2(1.5, 0), seen_m2(1.5, 0.5));
  EXPECT_NEAR(seen_m2(0.5, -0.6), s.result.walls[kEast].observed_m2, 0.01);
  EXPECT_EQ(seen_m2(1.5, -1.6), seen_m2(1.5, 0.6));
}

TEST(OptimizeJointly, APatchThatGoesOnBeyondItsFaceTellsLessOfItsTurn) {
  const AGraph house = test::MakeHouse();
  Solved s = Solve(house, {});
  const double all = s.result.walls[kEast].evidence.covariance(1, 1);
  for (Match& m : s.matches) {
    if (m.plan_surface.valid() && house.surfaces[m.plan_surface.index()].wall == WallId(kEast)) m.beside_ratio = 0.2;
  }
  const JointResult partly = OptimizeJointly(s.drive.map, house, s.matches, s.result.T_plan_map);
  EXPECT_GT(partly.walls[kEast].evidence.covariance(1, 1), 4 * all);
  EXPECT_NEAR(partly.walls[kNorth].evidence.covariance(1, 1), s.result.walls[kNorth].evidence.covariance(1, 1),
              0.3 * s.result.walls[kNorth].evidence.covariance(1, 1));
}

TEST(OptimizeJointly, CorrectsDriftOfTheMap) {
  const AGraph house = test::MakeHouse();
  DriveOptions options = WithDeviations(11, {{kWest, {0.1, 0}}});
  options.drift_m = 0.006;
  options.drift_rad = 0.001;
  const Drive before = test::DriveThroughHouse(house, options);
  const Solved s = SolveDrive(house, before);
  double worst_before = 0, worst = 0;
  for (size_t k = 0; k < s.drive.T_plan_kf.size(); ++k) {
    const Eigen::Vector3d truth = s.drive.T_plan_kf[k].translation();
    worst = std::max(worst, (s.result.T_plan_map * s.result.T_map_kf[k].translation() - truth).norm());
    worst_before = std::max(worst_before, (before.T_plan_map * before.map.keyframes[k].T_map_kf.translation() - truth).norm());
  }
  EXPECT_LT(worst, 0.015);
  EXPECT_GT(worst_before, 2 * worst);
}

TEST(OptimizeJointly, CupboardInFrontOfAWallIsNoDeviation) {
  const AGraph house = test::MakeHouse();
  const DriveOptions options = WithDeviations(2, {});
  Drive drive = test::DriveThroughHouse(house, options);
  // In room C, 0.4 m before the east wall; and a shelf in A before the north one.
  test::AddPatch(drive, {8.6, 1.5}, {8.6, 4.5}, 0.3, 1.6, 4.0, 1);
  test::AddPatch(drive, {2.0, 3.15}, {0.5, 3.15}, 0.3, 1.5, 3.0, 2);
  const size_t cupboard = drive.map.surfaces.size() - 2;
  const Solved s = SolveDrive(house, drive);
  for (const Match& m : s.matches) EXPECT_LT(m.map_surface, cupboard);
  for (const WallEstimate& w : s.result.walls) EXPECT_LT(w.p_deviated, 0.5) << w.wall.value;
  ExpectDeviationsNear(s, options, 0.01, 0.3 * kDeg);
}

}  // namespace
}  // namespace plumb::runtime
