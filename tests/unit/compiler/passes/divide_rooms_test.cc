#include "compiler/passes/divide_rooms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

// TwoRooms with other spaces.
class DivideRoomsTest : public testing::Test {
 protected:
  void SetUp() override {
    builder_.plan = test::TwoRooms();
    builder_.plan.spaces.clear();
    builder_.On(0);
  }
  void Space(const std::string& name, const Eigen::Vector2d& lo, const Eigen::Vector2d& hi) {
    builder_.Space(name, test::Rectangle(lo, hi));
  }

  test::PlanBuilder builder_;
};

TEST_F(DivideRoomsTest, TwoSpacesOfOneFaceBecomeRoomsThatMeetInTheOpen) {
  Space("Dining", {0, 0}, {3.2, 4});
  Space("Cooking", {3.2, 0}, {4.9, 4});
  const AGraph graph = Build(builder_.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 3u);
  const Room *dining = FindRoom(graph, "Dining"), *cooking = FindRoom(graph, "Cooking");
  ASSERT_TRUE(dining != nullptr && cooking != nullptr);
  EXPECT_NEAR(dining->area_m2, 12.8, 1e-6);
  EXPECT_NEAR(cooking->area_m2, 6.8, 1e-6);
  EXPECT_EQ(dining->surfaces.size(), 3u);  // none along the open side
  ASSERT_EQ(graph.open_boundaries.size(), 1u);
  const OpenBoundary& open = graph.open_boundaries[0];
  EXPECT_NEAR(open.start.x(), 3.2, 1e-9);
  EXPECT_NEAR((open.end - open.start).norm(), 4, 1e-9);
  // room_a on the left.
  const Eigen::Vector2d along = open.end - open.start, to_a = graph.rooms[open.room_a.index()].center.head<2>() - open.start;
  EXPECT_GT(along.x() * to_a.y() - along.y() * to_a.x(), 0);
}

TEST_F(DivideRoomsTest, StripsBesideTheSpacesGoToANeighbour) {
  Space("Dining", {0.05, 0.05}, {3.1, 3.95});  // drawn to the plaster, 0.2 m apart
  Space("Cooking", {3.3, 0.05}, {4.85, 3.95});
  const AGraph graph = Build(builder_.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 3u);
  const Room *dining = FindRoom(graph, "Dining"), *cooking = FindRoom(graph, "Cooking");
  ASSERT_TRUE(dining != nullptr && cooking != nullptr);
  EXPECT_NEAR(dining->area_m2 + cooking->area_m2, 4.9 * 4, 1e-6);
  EXPECT_NEAR(dining->area_m2, 3.2 * 4, 0.5);
  EXPECT_EQ(dining->surfaces.size(), 3u);
  EXPECT_EQ(cooking->surfaces.size(), 3u);
  EXPECT_TRUE(graph.open_boundaries.size() >= 1u);
}

TEST_F(DivideRoomsTest, SpacesToTheMiddleOfWallsDoNotCutTheRoomNextDoor) {
  Space("Dining", {-0.15, -0.15}, {3.2, 4.15});
  Space("Cooking", {3.2, -0.15}, {5.05, 4.15});
  Space("East", {5.0, -0.15}, {8.15, 4.15});
  const AGraph graph = Build(builder_.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 3u);
  ASSERT_TRUE(FindRoom(graph, "East") != nullptr);
  EXPECT_NEAR(FindRoom(graph, "East")->area_m2, 2.9 * 4, 1e-6);
  EXPECT_EQ(FindRoom(graph, "East")->surfaces.size(), 4u);
  EXPECT_EQ(graph.open_boundaries.size(), 1u);
}

TEST_F(DivideRoomsTest, ZonesOfSeveralSpacesDivideNothing) {
  Space("Flat", {0, 0}, {4.9, 4});
  Space("Dining", {0, 0}, {3.2, 4});
  Space("Cooking", {3.2, 0}, {4.9, 4});
  const AGraph graph = Build(builder_.plan).graph;
  EXPECT_EQ(graph.rooms.size(), 3u);
  EXPECT_NE(FindRoom(graph, "Dining"), nullptr);
  EXPECT_EQ(FindRoom(graph, "Flat"), nullptr);
}

TEST_F(DivideRoomsTest, ASpaceThatNoWallBoundsDividesNothing) {
  Space("Corner", {0, 0}, {2, 2});
  Space("Bar", {2.5, 1}, {4, 3});
  const AGraph graph = Build(builder_.plan).graph;
  EXPECT_EQ(graph.rooms.size(), 3u);
  EXPECT_NE(FindRoom(graph, "Corner"), nullptr);
  EXPECT_EQ(FindRoom(graph, "Bar"), nullptr);
  for (const Room& r : graph.rooms) EXPECT_FALSE(r.surfaces.empty()) << r.name;
}

TEST_F(DivideRoomsTest, OpenPlansAreKeptIfSoChosen) {
  Space("Dining", {0, 0}, {3.2, 4});
  Space("Cooking", {3.2, 0}, {4.9, 4});
  PassOptions options;
  options.division.divide = false;
  const AGraph graph = Build(builder_.plan, options).graph;
  EXPECT_EQ(graph.rooms.size(), 2u);
  EXPECT_TRUE(graph.open_boundaries.empty());
}

TEST_F(DivideRoomsTest, OneSpaceAloneDividesNothing) {
  Space("Corner", {0, 0}, {2, 2});
  const AGraph graph = Build(builder_.plan).graph;
  EXPECT_EQ(graph.rooms.size(), 2u);
  EXPECT_TRUE(graph.open_boundaries.empty());
}

}  // namespace
}  // namespace plumb::compiler
