#include "compiler/frontends/mesh/mesh_curve_gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "compiler/frontends/mesh/mesh_plan.h"
#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;

struct Outcome {
  PlanIr plan;
  size_t walls = 0, gaps_said = 0;
};

Outcome Compile(const MeshScene& scene) {
  DiagnosticSink sink;
  Outcome out;
  out.plan = MakePlan(scene, {}, sink);
  for (const PlanElement& e : out.plan.elements) out.walls += e.kind == ElementKind::kWall ? 1 : 0;
  for (const Diagnostic& d : sink.all()) out.gaps_said += d.kind == DiagnosticKind::kMeshGapClosed ? 1 : 0;
  return out;
}

// Sides, inner radius, angle at which the doorway begins, its width on the middle line.
class RingWithAGap : public testing::TestWithParam<std::tuple<int, double, double, double>> {};

TEST_P(RingWithAGap, HasOneDoorwayFromJambToJamb) {
  const auto [sides, inner_m, start_rad, width_m] = GetParam();
  const double middle_m = inner_m + 0.1, sweep_rad = 2 * std::asin(0.5 * width_m / middle_m);
  MeshScene scene;
  test::AddRingPart(inner_m, 0.2, 2.7, sides, start_rad + sweep_rad, start_rad + 2 * kPi, scene);
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.gaps_said, 1u);
  ASSERT_EQ(found.plan.openings.size(), 1u);
  const PlanOpening& doorway = found.plan.openings[0];
  EXPECT_EQ(doorway.filling, kNoIndex);
  EXPECT_NEAR(doorway.width_m.value_or(0), width_m, 0.08);  // what is left of a facet at a jamb is no wall if it is shorter than 5 cm
  const double at_rad = start_rad + 0.5 * sweep_rad;
  const Vector2d middle = Bounds(doorway.body).center().head<2>();
  EXPECT_LT((middle - middle_m * Vector2d(std::cos(at_rad), std::sin(at_rad))).norm(), 0.06 + middle_m * (1 - std::cos(0.5 * sweep_rad)));
  EXPECT_NEAR(Bounds(doorway.body).min().z(), 0, 1e-6);
  EXPECT_NEAR(Bounds(doorway.body).max().z(), 2.7, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Facets, RingWithAGap,
                         testing::Combine(testing::Values(20, 28, 36, 72, 120), testing::Values(2.0, 5.0), testing::Values(0.0, 0.06, 0.7),
                                          testing::Values(0.9, 2.0)));

TEST(CloseGapsInCurves, ARingMayHaveTwo) {
  MeshScene scene;
  test::AddRingPart(4, 0.2, 2.7, 60, 0.25, 2, scene);
  test::AddRingPart(4, 0.2, 2.7, 60, 2.3, 2 * kPi, scene);
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.plan.openings.size(), 2u);
  EXPECT_EQ(found.gaps_said, 2u);
}

TEST(CloseGapsInCurves, AFacetBetweenTwoDoorwaysIsAPier) {
  MeshScene scene;
  test::AddRingPart(4, 0.2, 2.7, 60, 0.25, 0.25 + 2 * kPi / 60, scene);
  test::AddRingPart(4, 0.2, 2.7, 60, 0.6, 2 * kPi, scene);
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.plan.openings.size(), 2u);
}

TEST(CloseGapsInCurves, WiderGapsStayOpen) {
  MeshScene scene;
  test::AddRingPart(4, 0.2, 2.7, 60, 1.2, 2 * kPi, scene);  // 4.9 m
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.plan.openings.size(), 0u);
}

TEST(CloseGapsInCurves, AnArcIsNoRingWithADoorway) {
  MeshScene scene;
  test::AddRingPart(0.4, 0.1, 2.7, 48, 0, 1, scene);
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.plan.openings.size(), 0u);
}

TEST(CloseGapsInCurves, TheEndOfAStraightWallIsNoneOfACurve) {
  MeshScene scene;
  test::AddRingPart(4, 0.2, 2.7, 60, 0.25, kPi, scene);
  test::AddBox("wall", {4, -3, 0}, {4.2, 0, 2.7}, scene);  // goes on as the circle does, but straight
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.plan.openings.size(), 0u);
}

TEST(CloseGapsInCurves, WhatStandsInAGapKeepsItOpen) {
  MeshScene scene;
  test::AddRingPart(4, 0.2, 2.7, 60, 0.5, 2 * kPi, scene);
  const Vector2d at = 4.1 * Vector2d(std::cos(0.25), std::sin(0.25));
  test::AddBox("wall", {at.x() - 1.5, at.y() - 0.1, 0}, {at.x() + 1.5, at.y() + 0.1, 2.7}, scene);
  const Outcome found = Compile(scene);
  EXPECT_EQ(found.gaps_said, 0u);
}

}  // namespace
}  // namespace plumb::compiler
