#include "compiler/passes/wall_arcs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

constexpr double kRadius_m = 4, kThickness_m = 0.2;

// A ring from outer to inner circle about `center`, in facets.
Ring RoundWall(const Eigen::Vector2d& center, double from_rad, double to_rad, int facets) {
  Ring out;
  const auto add = [&](double radius, int i) {
    const double a = from_rad + (to_rad - from_rad) * i / facets;
    out.emplace_back(center.x() + radius * std::cos(a), center.y() + radius * std::sin(a));
  };
  for (int i = 0; i <= facets; ++i) add(kRadius_m + kThickness_m, i);
  for (int i = facets; i >= 0; --i) add(kRadius_m, i);
  return out;
}

// A half-round room: a straight wall below, a round one above.
AGraph HalfRound(int facets) {
  test::PlanBuilder builder;
  builder.On(builder.Storey("Ground", 0));
  builder.Wall("straight", {-4.2, -0.1}, {4.2, -0.1}, kThickness_m);
  builder.Prismatic(ElementKind::kWall, "round", RoundWall({0, 0}, 0, std::numbers::pi, facets), 0, 2.5);
  return Build(builder.plan).graph;
}

std::vector<const Surface*> OfRound(const AGraph& graph) {
  std::vector<const Surface*> out;
  for (const Surface& s : graph.surfaces) {
    if (graph.walls[s.wall.index()].guid == "round" && s.room.valid()) out.push_back(&s);
  }
  return out;
}

TEST(FindWallArcs, FacetsOfAnArcAreOneSurface) {
  const AGraph graph = HalfRound(36);
  const auto surfaces = OfRound(graph);
  ASSERT_EQ(surfaces.size(), 1u);
  ASSERT_TRUE(surfaces[0]->arc);
  EXPECT_NEAR(surfaces[0]->arc->radius_m, kRadius_m, 1e-3);
  EXPECT_NEAR(surfaces[0]->arc->center.norm(), 0, 1e-3);
  EXPECT_NEAR(surfaces[0]->arc->sweep_rad, std::numbers::pi, 1e-3);  // the room inside on the left
  EXPECT_NEAR((surfaces[0]->start - Eigen::Vector2d(4, 0)).norm(), 0, 1e-3);
}

TEST(FindWallArcs, TheAxisIsTheChordOfTheMiddleAndTheThicknessThatBetweenTheArcs) {
  const AGraph graph = HalfRound(36);
  const Wall* wall = FindWall(graph, "round");
  ASSERT_NE(wall, nullptr);
  EXPECT_NEAR(wall->thickness_m, kThickness_m, 1e-3);
  EXPECT_NEAR((wall->axis_end - wall->axis_start).norm(), 2 * (kRadius_m + 0.5 * kThickness_m), 2e-3);
}

// Eight flat walls stand up to 8 cm before the circle through their corners: a flat wall is what a sensor sees.
TEST(FindWallArcs, FacetsThatStandFarFromTheArcAreFlat) {
  const AGraph graph = HalfRound(8);
  const auto surfaces = OfRound(graph);
  EXPECT_EQ(surfaces.size(), 8u);
  for (const Surface* s : surfaces) EXPECT_FALSE(s->arc);
}

// The ends of its flat side lie on the circle, too.
TEST(FindWallArcs, TheFlatSideOfAHalfRoundPierIsFlat) {
  Ring half;
  for (int i = 0; i <= 36; ++i) half.emplace_back(2 + 0.8 * std::cos(std::numbers::pi * i / 36), 0.8 * std::sin(std::numbers::pi * i / 36));
  test::PlanBuilder builder;
  builder.On(builder.Storey("Ground", 0));
  builder.Prismatic(ElementKind::kWall, "round", half, 0, 2.5);
  builder.Wall("south", {-2, -3.1}, {6, -3.1}, kThickness_m);
  builder.Wall("north", {-2, 3.1}, {6, 3.1}, kThickness_m);
  builder.Wall("west", {-2, -3}, {-2, 3}, kThickness_m);
  builder.Wall("east", {6, -3}, {6, 3}, kThickness_m);
  const AGraph graph = Build(builder.plan).graph;
  size_t arcs = 0, flat = 0;
  for (const Surface* s : OfRound(graph)) {
    arcs += s->arc.has_value();
    if (s->arc) continue;
    ++flat;
    EXPECT_NEAR(s->length_m(), 1.6, 1e-3);
    EXPECT_NEAR(s->normal.y(), -1, 1e-9);
  }
  EXPECT_EQ(arcs, 1u);
  EXPECT_EQ(flat, 1u);
}

TEST(FindWallArcs, AFullCircleIsTwoHalves) {
  test::PlanBuilder builder;
  builder.On(builder.Storey("Ground", 0));
  Ring outer = RoundWall({3, 2}, 0, 2 * std::numbers::pi, 72);
  builder.Prismatic(ElementKind::kWall, "round", outer, 0, 2.5);
  const AGraph graph = Build(builder.plan).graph;
  const auto surfaces = OfRound(graph);
  ASSERT_EQ(surfaces.size(), 2u);
  double sweep_rad = 0;
  for (const Surface* s : surfaces) {
    ASSERT_TRUE(s->arc);
    EXPECT_NEAR((s->arc->center - Eigen::Vector2d(3, 2)).norm(), 0, 1e-3);
    sweep_rad += s->arc->sweep_rad;
  }
  EXPECT_NEAR(sweep_rad, 2 * std::numbers::pi, 1e-3);
}

TEST(FindWallArcs, AStraightWallTangentToAnArcStaysStraight) {
  // An arc of 90 degrees that goes on straight for 3 m, as one wall.
  Ring ring = RoundWall({0, 0}, 0, std::numbers::pi / 2, 18);
  ring.insert(ring.begin() + 19, {{-3, 4.2}, {-3, 4.0}});
  test::PlanBuilder builder;
  builder.On(builder.Storey("Ground", 0));
  builder.Prismatic(ElementKind::kWall, "round", ring, 0, 2.5);
  builder.Wall("west", {-3.1, 4.2}, {-3.1, -0.2}, kThickness_m);
  builder.Wall("south", {-3.2, -0.1}, {4.2, -0.1}, kThickness_m);
  const AGraph graph = Build(builder.plan).graph;
  const auto surfaces = OfRound(graph);
  ASSERT_EQ(surfaces.size(), 2u);
  const bool first_is_arc = surfaces[0]->arc.has_value();
  EXPECT_NE(first_is_arc, surfaces[1]->arc.has_value());
  const Surface& straight = *surfaces[first_is_arc ? 1 : 0];
  EXPECT_NEAR(straight.length_m(), 3.0, 1e-3);
  EXPECT_NEAR(straight.normal.y(), -1, 1e-9);
  EXPECT_NEAR(surfaces[first_is_arc ? 0 : 1]->arc->sweep_rad, std::numbers::pi / 2, 1e-3);
}

TEST(WallArcOptions, NamesTheFieldThatIsWrong) {
  WallArcOptions options;
  EXPECT_EQ(options.Check(), "");
  options.min_turn_rad = 1;
  EXPECT_NE(options.Check().find("min_turn_rad"), std::string::npos);
  options = {};
  options.min_facets = 2;
  EXPECT_NE(options.Check().find("min_facets"), std::string::npos);
}

}  // namespace
}  // namespace plumb::compiler
