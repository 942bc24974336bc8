#include "compiler/passes/alias_forecast.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/passes/alias_text.h"
#include "schema/agraph_writer.h"
#include "tests/support/house.h"
#include "tests/support/plans.h"

namespace plumb::compiler {
namespace {

AGraph Forecasted(AGraph graph, const AliasOptions& options = {}) {
  ForecastAliases(options, graph);
  for (const Alias& a : graph.aliases) {
    EXPECT_EQ(a.rooms.size(), a.twins.size());
    for (size_t i = 0; i < a.rooms.size(); ++i) {
      const Eigen::Vector3d moved = Eigen::AngleAxisd(a.yaw_rad, Eigen::Vector3d::UnitZ()) * graph.rooms[a.rooms[i].index()].center + a.translation;
      EXPECT_LT((moved - graph.rooms[a.twins[i].index()].center).norm(), 0.01) << "room " << i;
    }
  }
  return graph;
}

// One row of rooms 5 m deep, doors between them at `ratio` of the depth; nothing leads outside.
AGraph Row(const std::vector<double>& xs, const std::vector<test::GridDoor>& doors) { return test::MakeGridPlan(xs, {0, 5}, doors); }

// Two flats of two rooms each, back to back. The doors are the only thing that tells the second from a copy that is turned or mirrored.
AGraph TwoFlats(double first_ratio, double second_ratio) {
  return Row({0, 4, 6.5, 9, 13}, {{true, 1, 0, first_ratio}, {true, 3, 0, second_ratio}});
}

AGraph RowHouses() { return Row({0, 4, 6.5, 10.5, 13, 17, 19.5}, {{true, 1, 0, 0.3}, {true, 3, 0, 0.3}, {true, 5, 0, 0.3}}); }

// `plan` and the same `height_m` above it.
AGraph WithSecondStorey(AGraph plan, double height_m) {
  const AGraph below = plan;
  plan.storeys.push_back({"storey-1", "First floor", height_m, below.storeys[0].height_m});
  const auto lifted = [](RoomId room, size_t rooms) { return room.valid() ? RoomId(room.index() + rooms) : room; };
  for (Room r : below.rooms) {
    r.storey = StoreyId(1);
    r.center.z() += height_m;
    r.floor_z_m += height_m;
    r.ceiling_z_m += height_m;
    r.name = "upper " + r.name;
    plan.rooms.push_back(r);
  }
  for (Doorway d : below.doorways) {
    d.storey = StoreyId(1);
    d.position.z() += height_m;
    d.room_a = lifted(d.room_a, below.rooms.size());
    d.room_b = lifted(d.room_b, below.rooms.size());
    plan.doorways.push_back(d);
  }
  const uint32_t vertices = static_cast<uint32_t>(below.mesh.vertices.size());
  for (const Eigen::Vector3f& v : below.mesh.vertices) plan.mesh.vertices.emplace_back(v.x(), v.y(), v.z() + static_cast<float>(height_m));
  for (const Triangle& t : below.mesh.triangles) plan.mesh.triangles.push_back({t.a + vertices, t.b + vertices, t.c + vertices, t.element});
  return plan;
}

// What the forecast looks at, after Rz(yaw), with the plan's zero `offset` away.
AGraph Moved(AGraph plan, double yaw_rad, const Eigen::Vector3d& offset) {
  const Eigen::Rotation2Dd turn(yaw_rad);
  plan.origin = offset;
  for (Eigen::Vector3f& v : plan.mesh.vertices) v.head<2>() = turn.cast<float>() * v.head<2>();
  for (Room& r : plan.rooms) {
    for (Eigen::Vector2d& p : r.polygon) p = turn * p + offset.head<2>();
    r.center.head<2>() = turn * r.center.head<2>();
    r.center += offset;
    r.floor_z_m += offset.z();
    r.ceiling_z_m += offset.z();
  }
  for (Doorway& d : plan.doorways) {
    d.position.head<2>() = turn * d.position.head<2>();
    d.position += offset;
  }
  return plan;
}

// A pillar of 0.3 m by 0.3 m, or a thing like it.
void Place(AGraph& graph, const std::string& guid, ElementKind kind, const Eigen::Vector2d& at) {
  const uint32_t element = test::AddElement(graph, guid, kind);
  graph.elements[element].name = guid;
  test::AddBox(graph, {at.x() - 0.15, at.y() - 0.15, 0}, {at.x() + 0.15, at.y() + 0.15, test::kHouseHeight_m}, element);
}

std::vector<size_t> Indices(const std::vector<RoomId>& rooms) {
  std::vector<size_t> out;
  for (RoomId r : rooms) out.push_back(r.index());
  return out;
}

TEST(AliasForecast, FindsTheHalfTurnOfTwoFlats) {
  const AGraph g = Forecasted(TwoFlats(0.3, 0.7));
  ASSERT_EQ(g.aliases.size(), 1u);
  const Alias& a = g.aliases[0];
  EXPECT_NEAR(std::abs(a.yaw_rad), std::numbers::pi, 1e-6);
  EXPECT_NEAR((a.translation - Eigen::Vector3d(13, 5, 0)).norm(), 0, 1e-3);
  EXPECT_EQ(Indices(a.rooms), (std::vector<size_t>{0, 1, 2, 3}));
  EXPECT_EQ(Indices(a.twins), (std::vector<size_t>{3, 2, 1, 0}));
  EXPECT_TRUE(a.closed);
  EXPECT_GT(a.overlap_ratio, 0.99);
  // Inner perimeters of two rooms 3.8 by 4.8 m and two 2.3 by 4.8 m, less the doors.
  EXPECT_NEAR(a.section_length_m, 2 * (17.2 + 14.2 - 1.8), 1.0);
  EXPECT_TRUE(a.differences.empty());
  EXPECT_EQ(g.look_alikes.size(), 2u);
}

TEST(AliasForecast, IsTheSameOnAnyNumberOfThreads) {
  std::vector<double> xs = {0};
  std::vector<test::GridDoor> doors;
  for (size_t i = 0; i < 120; ++i) {
    xs.push_back(xs.back() + (i % 3 == 0 ? 4 : 2.5));
    if (i % 3 == 1) doors.push_back({true, i, 0, 0.3});
  }
  const AGraph plan = test::MakeGridPlan(xs, {0, 5, 9, 13, 17}, doors);
  ASSERT_GT(plan.mesh.triangles.size(), 4u * 512u) << "all of them are cut in one go";
  const auto forecast = [&plan](size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    AliasOptions options;
    options.sections.min_parallel = 1;
    return WriteAGraph(Forecasted(plan, options));
  };
  const auto alone = forecast(1);
  for (const size_t threads : {2, 3, 8}) EXPECT_EQ(forecast(threads), alone) << threads;
  EXPECT_EQ(WriteAGraph(Forecasted(plan)), alone) << "jobs too few for threads";
}

TEST(AliasForecast, AMirrorImageIsNoAlias) {
  const AGraph g = Forecasted(TwoFlats(0.3, 0.3));
  EXPECT_TRUE(g.aliases.empty());
  EXPECT_TRUE(g.look_alikes.empty());
}

TEST(AliasForecast, AnAsymmetricHouseHasNone) {
  const AGraph g = Forecasted(test::MakeHouse());
  EXPECT_TRUE(g.aliases.empty());
  EXPECT_TRUE(g.look_alikes.empty());
}

TEST(AliasForecast, FindsEachStepAlongARowOfHouses) {
  const AGraph g = Forecasted(RowHouses());
  ASSERT_EQ(g.aliases.size(), 2u);
  for (const Alias& a : g.aliases) {
    EXPECT_NEAR(a.yaw_rad, 0, 1e-9);
    EXPECT_TRUE(a.closed);
  }
  EXPECT_NEAR(std::abs(g.aliases[0].translation.x()), 6.5, 1e-3);
  EXPECT_EQ(Indices(g.aliases[0].rooms), (std::vector<size_t>{0, 1, 2, 3}));
  EXPECT_EQ(Indices(g.aliases[0].twins), (std::vector<size_t>{2, 3, 4, 5}));
  EXPECT_NEAR(std::abs(g.aliases[1].translation.x()), 13, 1e-3);
  EXPECT_EQ(g.aliases[1].rooms.size(), 2u);
  ASSERT_EQ(g.look_alikes.size(), 2u);
  EXPECT_EQ(Indices(g.look_alikes[0].rooms), (std::vector<size_t>{0, 2, 4}));
}

TEST(AliasForecast, FindsIdenticalStoreys) {
  const AGraph g = Forecasted(WithSecondStorey(TwoFlats(0.3, 0.4), 2.9));
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_NEAR((g.aliases[0].translation - Eigen::Vector3d(0, 0, 2.9)).norm(), 0, 1e-6);
  EXPECT_EQ(g.aliases[0].from_storey, StoreyId(0));
  EXPECT_EQ(g.aliases[0].to_storey, StoreyId(1));
  EXPECT_EQ(g.aliases[0].rooms.size(), 4u);
}

TEST(AliasForecast, RoomsOfAnotherHeightDiffer) {
  AGraph plan = WithSecondStorey(TwoFlats(0.3, 0.4), 2.9);
  for (size_t r = 4; r < plan.rooms.size(); ++r) plan.rooms[r].ceiling_z_m += 0.3;
  EXPECT_TRUE(Forecasted(plan).aliases.empty());
}

TEST(AliasForecast, AFlatThatLeadsToACorridorIsAPartialAlias) {
  // Two flats of two rooms under a corridor of five parts, whose east end has no counterpart.
  const AGraph g = Forecasted(test::MakeGridPlan({0, 4, 6.5, 10.5, 13, 18}, {0, 5, 7},
                                                 {{true, 1, 0, 0.3}, {true, 3, 0, 0.3}, {false, 1, 1, 0.5}, {false, 1, 3, 0.5},
                                                  {true, 1, 1, 0.5}, {true, 2, 1, 0.5}, {true, 3, 1, 0.5}, {true, 4, 1, 0.5}}));
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_FALSE(g.aliases[0].closed);
  EXPECT_EQ(Indices(g.aliases[0].rooms), (std::vector<size_t>{0, 1, 6}));
  EXPECT_EQ(Indices(g.aliases[0].twins), (std::vector<size_t>{2, 3, 8}));
  const std::vector<Diagnostic> found = DescribeAliases(g);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, DiagnosticKind::kPartialAlias);
  EXPECT_NE(found[0].message.find("`0-0` on `2-0`, `1-0` on `3-0` and `1-1` on `3-1`"), std::string::npos) << found[0].message;
  EXPECT_NE(found[0].hint.find("`4-1`"), std::string::npos) << found[0].hint;
}

TEST(AliasForecast, AHallThatFallsOnItselfIsAnAlias) {
  const AGraph g = Forecasted(Row({0, 9}, {}));
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_NEAR(std::abs(g.aliases[0].yaw_rad), std::numbers::pi, 1e-6);
  EXPECT_EQ(g.aliases[0].rooms, g.aliases[0].twins);
  EXPECT_NE(DescribeAliases(g)[0].message.find("`0-0` on itself"), std::string::npos);
}

TEST(AliasForecast, AShaftThatFallsOnItselfIsNone) {
  EXPECT_TRUE(Forecasted(Row({0, 4, 6.5, 9}, {{true, 1, 0, 0.3}})).aliases.empty());
}

TEST(AliasForecast, NamesWhatDiffers) {
  AGraph plan = TwoFlats(0.3, 0.7);
  Place(plan, "pillar", ElementKind::kColumn, {2, 2.5});
  const AGraph g = Forecasted(plan);
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_LT(g.aliases[0].overlap_ratio, 0.99);
  ASSERT_EQ(g.aliases[0].differences.size(), 1u);
  EXPECT_EQ(g.elements[g.aliases[0].differences[0].index()].name, "pillar");
  EXPECT_NE(DescribeAliases(g)[0].hint.find("`pillar`"), std::string::npos);
}

TEST(AliasForecast, ManyDifferencesMakeAnotherRoom) {
  AGraph plan = TwoFlats(0.3, 0.7);
  for (double y : {1.0, 2.0, 3.0, 4.0}) Place(plan, "pillar", ElementKind::kColumn, {2, y});
  EXPECT_TRUE(Forecasted(plan).aliases.empty());
}

TEST(AliasForecast, FurnitureDoesNotCount) {
  AGraph plan = TwoFlats(0.3, 0.7);
  for (double y : {1.0, 2.0, 3.0, 4.0}) Place(plan, "shelf", ElementKind::kFurniture, {2, y});
  const AGraph g = Forecasted(plan);
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_TRUE(g.aliases[0].differences.empty());
}

TEST(AliasForecast, IsTheSameInAPlanThatIsTurnedAndFarFromItsZero) {
  const AGraph g = Forecasted(Moved(TwoFlats(0.3, 0.7), 0.42, {731'000, -9'100'000, 410}));
  ASSERT_EQ(g.aliases.size(), 1u);
  EXPECT_EQ(Indices(g.aliases[0].twins), (std::vector<size_t>{3, 2, 1, 0}));
  EXPECT_GT(g.aliases[0].overlap_ratio, 0.99);
}

TEST(AliasForecast, StaysWithinItsLimits) {
  std::vector<double> xs = {0};
  std::vector<test::GridDoor> doors;
  for (size_t i = 0; i < 40; ++i) {
    xs.push_back(xs.back() + 3);
    xs.push_back(xs.back() + 4);
    doors.push_back({true, 2 * i + 1, 0, 0.3});
  }
  AliasOptions options;
  options.max_aliases = 5;
  options.max_votes = 100;
  const AGraph g = Forecasted(Row(xs, doors), options);
  EXPECT_EQ(g.aliases.size(), 5u);
  EXPECT_EQ(g.aliases[0].rooms.size(), 78u);  // the shortest step takes along the most
  EXPECT_EQ(g.look_alikes[0].rooms.size(), 40u);
}

TEST(AliasForecast, APlanWithoutRoomsOrTrianglesHasNone) {
  EXPECT_TRUE(Forecasted(AGraph()).aliases.empty());
  AGraph plan = TwoFlats(0.3, 0.7);
  plan.mesh = {};
  EXPECT_TRUE(Forecasted(plan).aliases.empty());
}

TEST(AliasOptions, RefuseNonsense) {
  EXPECT_EQ(AliasOptions().Check(), "");
  AliasOptions options;
  options.min_overlap_ratio = 1.5;
  EXPECT_NE(options.Check().find("min_overlap_ratio"), std::string::npos);
  options = {};
  options.sections.heights_m.clear();
  EXPECT_NE(options.Check().find("heights_m"), std::string::npos);
  options = {};
  options.twins.tolerance_m = 0;
  EXPECT_NE(options.Check().find("TwinOptions.tolerance_m"), std::string::npos);
}

}  // namespace
}  // namespace plumb::compiler
