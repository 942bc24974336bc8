#include "compiler/emit/emit.h"

#include <gtest/gtest.h>

#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

TEST(EmitMesh, SharesVerticesWithinAnElement) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Wall("a", {0, 0}, {1, 0}, 0.2);
  b.Wall("b", {1, 0}, {2, 0}, 0.2);
  AppendSolid(b.plan.elements[1].body, b.plan.elements[0].body);  // shares four corners
  AGraph graph;
  EmitMesh(b.plan, graph);
  EXPECT_EQ(graph.mesh.vertices.size(), 12u + 8u);
  ASSERT_EQ(graph.mesh.triangles.size(), 36u);
  EXPECT_EQ(graph.mesh.triangles.front().element, 0u);
  EXPECT_EQ(graph.mesh.triangles.back().element, 1u);
}

TEST(EmitMesh, MovesTheOriginOfFarPlans) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Wall("a", {500000, 5400000}, {500001, 5400000}, 0.2);
  b.plan.origin = {1, 2, 3};
  AGraph graph;
  EmitMesh(b.plan, graph);
  for (const auto& v : graph.mesh.vertices) EXPECT_LT(v.norm(), 10);
  const Eigen::Vector3d first = graph.mesh.vertices[0].cast<double>() + graph.origin;
  EXPECT_NEAR((first - Eigen::Vector3d(500001, 5399999.9 + 2, 3)).norm(), 0, 1e-3);
}

TEST(MoveToPlanFrame, MovesEveryPlaceAndKeepsPlanes) {
  PlanIr plan;
  plan.origin = {100, 200, 10};
  AGraph graph;
  graph.storeys.push_back({"", "", 1, 3});
  Surface s;
  s.normal = {0, 1, 0};
  s.d_m = -2;
  s.start = {0, 2};
  s.end = {5, 2};
  s.arc = Arc{{1, 1}, 1, 0, 1};
  graph.surfaces.push_back(s);
  Room r;
  r.polygon = {{0, 0}, {1, 0}, {1, 1}};
  r.holes = {{{0.1, 0.1}, {0.1, 0.2}, {0.2, 0.1}}};
  graph.rooms.push_back(r);
  graph.doorways.emplace_back();
  graph.windows.emplace_back();
  graph.columns.push_back({"", "", StoreyId(0), {{0, 0}}, 0, 1});
  graph.walls.emplace_back();
  graph.open_boundaries.emplace_back();
  MoveToPlanFrame(plan, graph);
  const Surface& moved = graph.surfaces[0];
  EXPECT_NEAR(moved.normal.head<2>().dot(moved.start) + moved.d_m, 0, 1e-9);
  EXPECT_EQ(moved.arc->center, Eigen::Vector2d(101, 201));
  EXPECT_EQ(moved.z_min_m, 10);
  EXPECT_EQ(graph.storeys[0].elevation_m, 11);
  EXPECT_EQ(graph.rooms[0].polygon[2], Eigen::Vector2d(101, 201));
  EXPECT_EQ(graph.rooms[0].holes[0][0], Eigen::Vector2d(100.1, 200.1));
  EXPECT_EQ(graph.rooms[0].center, plan.origin);
  EXPECT_EQ(graph.doorways[0].position, plan.origin);
  EXPECT_EQ(graph.windows[0].position, plan.origin);
  EXPECT_EQ(graph.columns[0].z_max_m, 11);
  EXPECT_EQ(graph.open_boundaries[0].end, Eigen::Vector2d(100, 200));
  EXPECT_EQ(graph.walls[0].axis_start, Eigen::Vector2d(100, 200));
}

TEST(EmitProvenance, RecordsSourceToolAndDiagnostics) {
  PlanIr plan;
  plan.source_path = "a.ifc";
  plan.source_sha256 = std::string(64, 'f');
  DiagnosticSink sink;
  sink.Emit(DiagnosticKind::kRoomTooLow, {}, "x");
  AGraph graph;
  EmitProvenance(plan, {{"snap_radius_m", "0.002"}}, sink, graph);
  EXPECT_EQ(graph.source_path, "a.ifc");
  EXPECT_FALSE(graph.tool_version.empty());
  ASSERT_EQ(graph.diagnostics.size(), 1u);
  EXPECT_EQ(graph.diagnostics[0].code, "PL7002");
}

}  // namespace
}  // namespace plumb::compiler
