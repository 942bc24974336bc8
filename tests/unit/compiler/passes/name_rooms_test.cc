#include "compiler/passes/name_rooms.h"

#include <gtest/gtest.h>

#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

TEST(NameRooms, SpacesThatFitNameAndSayNothing) {
  DiagnosticSink sink;
  Build(test::TwoRooms(), sink);
  EXPECT_TRUE(sink.all().empty());
}

TEST(NameRooms, ADifferentSpaceStillNamesAndIsReported) {
  PlanIr plan = test::TwoRooms();
  plan.spaces[0].body = test::Prism(test::Rectangle({0, 0}, {3.5, 4}), 0, 2.5);
  plan.spaces[0].long_name = "Wohnen";
  DiagnosticSink sink;
  const AGraph graph = Build(plan, sink).graph;
  EXPECT_NE(FindRoom(graph, "West Wohnen"), nullptr);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kRoomDiffersFromSpace), 1u);
}

TEST(NameRooms, RoomsDoNotDependOnSpaces) {
  PlanIr plan = test::TwoRooms();
  plan.spaces.clear();
  DiagnosticSink sink;
  const AGraph graph = Build(plan, sink).graph;
  ASSERT_EQ(graph.rooms.size(), 2u);
  EXPECT_EQ(graph.rooms[0].name, "Ground room 1");
  EXPECT_TRUE(graph.rooms[0].guid.empty());
  EXPECT_TRUE(sink.all().empty());
}

TEST(NameRooms, SpacesThatNoWallDividesAndStraySpacesAreReported) {
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.plan.spaces.erase(b.plan.spaces.begin());
  b.On(0).Space("Dining", test::Rectangle({0, 0}, {3.2, 4}));
  b.Space("Cooking", test::Rectangle({3.2, 0}, {4.9, 4}));
  b.Space("Garden", test::Rectangle({20, 0}, {25, 4}));
  DiagnosticSink sink;
  const AGraph graph = Build(b.plan, sink).graph;
  EXPECT_NE(FindRoom(graph, "Dining"), nullptr);
  EXPECT_NE(FindRoom(graph, "Cooking"), nullptr);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kSpaceWithinRoom), 2u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kSpaceWithoutRoom), 1u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kRoomWithoutSpace), 0u);
}

TEST(NameRooms, ARoomWithoutSpaceIsReported) {
  PlanIr plan = test::TwoRooms();
  plan.spaces.pop_back();
  DiagnosticSink sink;
  const AGraph graph = Build(plan, sink).graph;
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kRoomWithoutSpace), 1u);
  EXPECT_NE(FindRoom(graph, "West"), nullptr);
}

TEST(NameRooms, ASpaceThatIsLargerThanTheRoomOfAnotherIsNoPartOfIt) {
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.On(0).Space("Twice", test::Rectangle({-0.2, -0.2}, {5.1, 4.2}));
  DiagnosticSink sink;
  Build(b.plan, sink);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kSpaceWithinRoom), 0u);
  ASSERT_EQ(CountOf(sink, DiagnosticKind::kRoomDiffersFromSpace), 1u);
  EXPECT_NE(sink.all()[0].message.find("which is that of space `West`"), std::string::npos) << sink.all()[0].message;
}

TEST(NameRooms, ASpaceWithoutSolidIsANote) {
  PlanIr plan = test::TwoRooms();
  plan.spaces[1].body = {};
  DiagnosticSink sink;
  Build(plan, sink);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kSpaceWithoutBody), 1u);
}

}  // namespace
}  // namespace plumb::compiler
