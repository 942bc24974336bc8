#include "runtime/deviations/wall_presence.h"

#include <gtest/gtest.h>

#include <numbers>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/deviations.h"
#include "tests/unit/runtime/deviations/built_house.h"

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

std::vector<std::string> MissingWalls(const AGraph& plan, const AGraph& as_built) {
  const test::Survey s = test::DriveThrough(plan, as_built);
  const std::vector<WallPresence> presence = JudgePresence(s.map, plan, s.estimate);
  std::vector<std::string> out;
  for (size_t w = 0; w < presence.size(); ++w) {
    if (presence[w].missing) out.push_back(plan.walls[w].guid);
  }
  return out;
}

std::vector<FacePresence> FacesOf(const SGraph& map, const AGraph& plan, const JointResult& estimate, const std::string& guid) {
  return JudgePresence(map, plan, estimate)[test::WallOf(plan, guid)].faces;
}

// About the middle of wall-middle.
Eigen::Isometry2d Motion(double dx_m, double yaw_rad) {
  return Eigen::Translation2d(5 + dx_m, 3) * Eigen::Rotation2Dd(yaw_rad) * Eigen::Translation2d(-5, -3);
}

TEST(JudgePresence, NothingIsMissingFromTheHouseAsPlanned) {
  const AGraph house = test::MakeHouse();
  EXPECT_TRUE(MissingWalls(house, house).empty());
}

TEST(JudgePresence, AWallThatIsSeenThroughIsMissing) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle");
  EXPECT_EQ(MissingWalls(plan, built), std::vector<std::string>{"wall-middle"});
}

TEST(JudgePresence, FurnitureWhereTheWallWouldBeDoesNotStandForIt) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle");
  // Cupboards and a desk whose fronts are 40 cm off the wall's face.
  test::AddThing(built, {5.46, 3.6, 0}, {5.86, 4.8, 1.2});
  test::AddThing(built, {4.2, 0.3, 0}, {4.54, 1.6, 0.9});
  EXPECT_EQ(MissingWalls(plan, built), std::vector<std::string>{"wall-middle"});
}

TEST(JudgePresence, PlannedFurnitureDoesNotStandForTheWallBehindIt) {
  AGraph plan = test::MakeHouse();
  for (const double y : {0.1, 3.7}) test::AddThing(plan, {4.34, y, 0}, {4.94, y + 1.9, 0.75});  // units all along it
  AGraph built = plan;
  EXPECT_TRUE(MissingWalls(plan, built).empty());
  test::TakeOut(built, "wall-middle");
  EXPECT_EQ(MissingWalls(plan, built), std::vector<std::string>{"wall-middle"});
}

TEST(JudgePresence, APlanOfNothingButWallsIsEnough) {
  const AGraph house = test::MakeHouse();
  AGraph plan = house, built = house;
  std::erase_if(plan.mesh.triangles, [&](const Triangle& t) { return plan.elements[t.element].kind != ElementKind::kWall; });
  test::TakeOut(built, "wall-middle");
  EXPECT_EQ(MissingWalls(plan, built), std::vector<std::string>{"wall-middle"});
}

TEST(JudgePresence, AWallThatStandsElsewhereIsNotMissing) {
  const AGraph plan = test::MakeHouse();
  for (const double dx_m : {-0.6, -0.3, 0.3, 0.6}) {
    AGraph built = plan;
    test::Displace(built, "wall-middle", Motion(dx_m, 0));
    EXPECT_TRUE(MissingWalls(plan, built).empty()) << dx_m;
  }
  for (const double yaw_rad : {-15 * kDeg, 15 * kDeg}) {
    AGraph built = plan;
    test::Displace(built, "wall-middle", Motion(0, yaw_rad));
    EXPECT_TRUE(MissingWalls(plan, built).empty()) << yaw_rad;
  }
}

// Seen at an angle, a wall that stands off lets pass what would have met its end: from 1 m before the middle wall, which ends at y = 6.
TEST(JudgePresence, LinesThatAWallStandingOffWouldLetPassDoNotCount) {
  const AGraph plan = test::MakeHouse();
  const auto lines = [&](const Eigen::Vector2f& step) {
    SGraph map;
    for (uint32_t id = 0; id < 4; ++id) {
      Keyframe keyframe;
      keyframe.id = id;
      keyframe.T_map_kf.translation() = Eigen::Vector3d(4.0, 4.9, 1.0);
      for (int i = 0; i < 100; ++i) keyframe.points.push_back({step.x(), step.y(), 0.003f * static_cast<float>(i)});
      map.keyframes.push_back(keyframe);
    }
    double sum = 0;
    for (const FacePresence& face : FacesOf(map, plan, JointResult(), "wall-middle")) sum += face.lines;
    return sum;
  };
  EXPECT_EQ(lines({2.0f, 1.4f}), 0);     // meets it at y = 5.6, and not at all 0.65 m further on
  EXPECT_GT(lines({2.0f, -1.4f}), 300);  // at y = 4.2
}

TEST(JudgePresence, AWallThatIsHalfBuiltIsNotMissing) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle", [](const Eigen::Vector3d& p) { return p.y() > 2.3; });
  EXPECT_TRUE(MissingWalls(plan, built).empty());
}

// Where the next wall was built through its place, what is left of a short one may be too close to that for the cells.
TEST(JudgePresence, AWallOfWhichAPartWasSeenInItsPlaceIsNotMissing) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle");
  test::Survey s = test::DriveThrough(plan, built);
  const WallId middle(test::WallOf(plan, "wall-middle"));
  WallEstimate part;
  part.wall = middle;
  part.reference = WallFrames(plan)[middle.index()].reference;
  part.observed_m2 = 0.3;
  part.span_m = part.seen_m = 0.4 * plan.surfaces[part.reference.index()].length_m();
  std::erase_if(s.estimate.walls, [&](const WallEstimate& w) { return w.wall == middle; });
  s.estimate.walls.push_back(part);
  EXPECT_FALSE(JudgePresence(s.map, plan, s.estimate)[middle.index()].missing);
  s.estimate.walls.back().deviation.offset_m = 0.2;  // a thing that stands elsewhere
  EXPECT_TRUE(JudgePresence(s.map, plan, s.estimate)[middle.index()].missing);
  s.estimate.walls.back().deviation.offset_m = 0;
  s.estimate.walls.back().span_m = plan.surfaces[part.reference.index()].length_m();  // a strip at either end
  s.estimate.walls.back().seen_m = 0.2;
  EXPECT_TRUE(JudgePresence(s.map, plan, s.estimate)[middle.index()].missing);
}

TEST(JudgePresence, APlanarLaserJudgesNoWall) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle");
  test::Survey s = test::DriveThrough(plan, built);
  s.map.planar = true;
  for (const WallPresence& wall : JudgePresence(s.map, plan, s.estimate)) EXPECT_FALSE(wall.missing);
}

TEST(JudgePresence, CountsWhatWasSeenFromWhereTheSensorWas) {
  // A keyframe that drove through the doorway: its points seen beyond it were seen from beyond it, and passed no wall.
  const AGraph plan = test::MakeHouse();
  JointResult estimate;
  SGraph map;
  for (uint32_t id = 0; id < 4; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.T_map_kf.translation() = Eigen::Vector3d(3.0, 2.75, 1.0);
    keyframe.standpoints = {{0, Eigen::Vector3f(3.5f, 0, 0)}};  // in room C
    for (int i = 0; i < 3000; ++i) keyframe.points.push_back(Eigen::Vector3f(5.5f, -2.5f + 0.0018f * static_cast<float>(i), 0));
    map.keyframes.push_back(keyframe);
  }
  for (const FacePresence& face : FacesOf(map, plan, estimate, "wall-middle")) EXPECT_EQ(face.lines, 0);
  for (Keyframe& keyframe : map.keyframes) keyframe.standpoints.clear();
  double lines = 0;
  for (const FacePresence& face : FacesOf(map, plan, estimate, "wall-middle")) lines += face.lines;
  EXPECT_GT(lines, 1000);
}

TEST(AssessDeviations, AMissingWallHasNoDeviationAndItsRoomsDoNotMoveWithIt) {
  const AGraph plan = test::MakeHouse();
  AGraph built = plan;
  test::TakeOut(built, "wall-middle");
  const test::Survey s = test::DriveThrough(plan, built);
  WallChanges changes;
  changes.presence = JudgePresence(s.map, plan, s.estimate);
  const DeviationReport report = AssessDeviations(plan, s.estimate, {}, changes);
  size_t missing = 0;
  for (const SurfaceDeviation& d : report.surfaces) {
    if (d.status != SurfaceStatus::kMissing) continue;
    ++missing;
    EXPECT_EQ(plan.walls[plan.surfaces[d.surface.index()].wall.index()].guid, "wall-middle");
    EXPECT_EQ(d.translation_m, 0);
    EXPECT_GT(d.observed_m2, 0.5);
  }
  EXPECT_EQ(missing, 3u);  // A, B and C see it
  EXPECT_NE(report.gauge.find("0 of 5 seen walls deviate, 1 is missing."), std::string::npos) << report.gauge;
  EXPECT_NE(DeviationsToJson(plan, report).find("\"status\": \"missing\""), std::string::npos);
}

TEST(PresenceOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(PresenceOptions{}.Check(), "");
  PresenceOptions options;
  options.min_open_ratio = 0;
  EXPECT_EQ(options.Check(), "PresenceOptions.min_open_ratio = 0; must be in (0, 1]");
}

}  // namespace
}  // namespace plumb::runtime
