#include "tools/simulate/tour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/house.h"
#include "tools/simulate/as_built.h"

namespace plumb::tools {
namespace {

struct Scene {
  AsBuilt built;
  FreeSpace space;
  Reach reach;

  explicit Scene(const AGraph& plan, uint64_t seed = 1, int deviate = 0)
      : built(*BuildWithDeviations(plan, StoreyId(0), Options(seed, deviate))), space(built.house, StoreyId(0), built.passages),
        reach(FindReach(built.house, StoreyId(0), space)) {}

  static SimulateOptions Options(uint64_t seed, int deviate) {
    SimulateOptions options;
    options.seed = seed;
    options.deviate = deviate;
    return options;
  }
  [[nodiscard]] Expected<Tour> Plan(uint64_t seed, const TourOptions& options = {}) const {
    Random random(seed, static_cast<uint64_t>(RandomStream::kTour));
    return PlanTour(built.house, space, reach, options, random);
  }
};

double YawOf(const Eigen::Isometry3d& T) { return std::atan2(T.linear()(1, 0), T.linear()(0, 0)); }

TEST(FreeSpace, KnowsRoomsObstaclesAndDoorways) {
  const Scene scene(test::MakeHouse());
  const auto index = [&](double x, double y) { return scene.space.Index(scene.space.CellAt({x, y})); };
  EXPECT_EQ(scene.space.room(index(2, 1)), 0);
  EXPECT_EQ(scene.space.room(index(2, 5)), 1);
  EXPECT_EQ(scene.space.room(index(7, 3)), 2);
  EXPECT_EQ(scene.space.room(index(5, 2.75)), FreeSpace::kPassage);
  EXPECT_EQ(scene.space.clearance_m(index(5, 1)), 0);       // in the middle wall
  EXPECT_EQ(scene.space.clearance_m(index(-1, 3)), 0);      // outside
  EXPECT_LT(scene.space.clearance_m(index(8.4, 0.2)), 0.03);  // the chimney's side
  EXPECT_NEAR(scene.space.clearance_m(index(2, 1)), 1.0, 0.1);
  EXPECT_NEAR(scene.space.clearance_m(index(5, 2.75)), 0.45, 0.1);
}

TEST(FreeSpace, HasNoPlaceWhereTheFloorIsMissing) {
  AGraph house = test::MakeHouse();
  // A pit in room C instead of the slab: the slab's triangles go, new ones leave x in [6, 7], y in [2, 4] open.
  const auto is_slab = [&](const Triangle& t) { return house.elements[t.element].guid == "slab"; };
  const uint32_t slab = std::find_if(house.mesh.triangles.begin(), house.mesh.triangles.end(), is_slab)->element;
  std::erase_if(house.mesh.triangles, is_slab);
  test::AddBox(house, {-0.3, -0.3, -0.2}, {6, 6.3, 0}, slab);
  test::AddBox(house, {7, -0.3, -0.2}, {9.3, 6.3, 0}, slab);
  test::AddBox(house, {6, -0.3, -0.2}, {7, 2, 0}, slab);
  test::AddBox(house, {6, 4, -0.2}, {7, 6.3, 0}, slab);
  const Scene scene(house);
  EXPECT_EQ(scene.space.ClearanceAt({6.5, 3}), 0);
  EXPECT_GT(scene.space.ClearanceAt({6.5, 5}), 0.5);
}

TEST(Reach, ShrinksTheRobotToTheNarrowestDoorway) {
  EXPECT_EQ(Scene(test::MakeHouse()).reach.robot_radius_m, 0.25);
  AGraph house = test::MakeHouse();
  Element post;
  post.kind = ElementKind::kColumn;
  house.elements.push_back(post);
  test::AddBox(house, {4.94, 2.30, 0}, {5.06, 2.75, 2.1}, static_cast<uint32_t>(house.elements.size() - 1));  // leaves 0.45 m of D2
  const Scene scene(house);
  EXPECT_EQ(scene.reach.reachable(), 3u);
  EXPECT_LT(scene.reach.robot_radius_m, 0.22);
  EXPECT_GE(scene.reach.robot_radius_m, 0.12);
}

TEST(PlanTour, VisitsEveryRoomClearOfObstacles) {
  const AGraph house = test::MakeHouse();
  std::set<uint32_t> starts;
  std::set<int> quadrants;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Scene scene(house, seed, 2);
    const Expected<Tour> tour = scene.Plan(seed);
    ASSERT_TRUE(tour) << tour.error().message;
    EXPECT_EQ(tour->visited.size(), 3u);
    EXPECT_TRUE(tour->not_visited.empty());
    EXPECT_GE(tour->drive.duration_s(), 120);
    starts.insert(tour->start_room.value);
    quadrants.insert(static_cast<int>(std::floor(YawOf(tour->drive.PoseAt(0)) / (std::numbers::pi / 2))));
    for (double t = 0; t < tour->drive.duration_s(); t += 0.05) {
      const Eigen::Vector2d p = tour->drive.PoseAt(t).translation().head<2>();
      ASSERT_GT(scene.space.ClearanceAt(p), scene.reach.robot_radius_m - 0.04) << "seed " << seed << " at " << t << " s";
    }
  }
  EXPECT_EQ(starts.size(), 3u);
  EXPECT_GE(quadrants.size(), 3u);
}

TEST(PlanTour, MovesAsARobotCan) {
  const Scene scene(test::MakeHouse());
  const Expected<Tour> tour = scene.Plan(3);
  ASSERT_TRUE(tour);
  const double step_s = 0.02;
  double last_speed = 0, fastest = 0;
  for (double t = 0; t < tour->drive.duration_s(); t += step_s) {
    const Eigen::Isometry3d a = tour->drive.PoseAt(t), b = tour->drive.PoseAt(t + step_s);
    const double speed = (b.translation() - a.translation()).norm() / step_s;
    const double rate = std::abs(std::remainder(YawOf(b) - YawOf(a), 2 * std::numbers::pi)) / step_s;
    ASSERT_LT(speed, 0.51) << t;
    ASSERT_LT(std::abs(speed - last_speed) / step_s, 1.5) << t;
    ASSERT_LT(rate, std::numbers::pi / 3) << t;
    ASSERT_LT(std::acos(std::min(1.0, b.linear()(2, 2))), 0.0072) << t;
    ASSERT_EQ(b.translation().z(), 0.6);
    last_speed = speed;
    fastest = std::max(fastest, speed);
  }
  EXPECT_GT(fastest, 0.45);
}

TEST(PlanTour, StopsAtTheLongestDuration) {
  const Scene scene(test::MakeHouse());
  TourOptions options;
  options.min_duration_s = 5;
  options.max_duration_s = 10;
  const Expected<Tour> tour = scene.Plan(1, options);
  ASSERT_TRUE(tour);
  EXPECT_NEAR(tour->drive.duration_s(), 10, 0.02);
  EXPECT_EQ(tour->visited.size() + tour->not_visited.size(), 3u);
}

TEST(PlanTour, NamesRoomsThatItCannotReach) {
  AGraph house = test::MakeHouse();
  Element shelf;
  shelf.kind = ElementKind::kFurniture;
  house.elements.push_back(shelf);
  test::AddBox(house, {1.8, 3.3, 0}, {3.1, 3.7, 2}, static_cast<uint32_t>(house.elements.size() - 1));  // before D1
  const Scene scene(house);
  const Expected<Tour> tour = scene.Plan(1);
  ASSERT_TRUE(tour);
  ASSERT_EQ(tour->not_visited.size(), 1u);
  EXPECT_EQ(house.rooms[tour->not_visited[0].index()].name, "B");
  test::AddBox(house, {4.8, 2.2, 0}, {5.2, 3.3, 2}, static_cast<uint32_t>(house.elements.size() - 1));  // before D2
  const Expected<Tour> none = Scene(house).Plan(1);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kPlanUnsuitable);
}

}  // namespace
}  // namespace plumb::tools
