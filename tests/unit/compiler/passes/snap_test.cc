#include "compiler/passes/snap.h"

#include <gtest/gtest.h>

#include "compiler/passes/floor_outlines.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

// The outline of a rectangle, `turned` around to run clockwise.
void Append(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi, uint32_t footprint, bool turned, SnapGraph& graph) {
  const auto first = static_cast<uint32_t>(graph.vertices.size());
  graph.vertices.insert(graph.vertices.end(), {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}});
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t a = first + i, b = first + (i + 1) % 4;
    graph.segments.push_back(turned ? SnapSegment{b, a, footprint} : SnapSegment{a, b, footprint});
  }
}

// Each footprint's outline comes to each vertex as often as it leaves it.
void ExpectClosed(const SnapGraph& graph, uint32_t footprints) {
  std::vector<std::vector<int>> net(footprints, std::vector<int>(graph.vertices.size(), 0));
  for (const SnapSegment& s : graph.segments) {
    --net[s.footprint][s.from];
    ++net[s.footprint][s.to];
  }
  for (const auto& of_footprint : net) {
    for (const int n : of_footprint) EXPECT_EQ(n, 0);
  }
}

TEST(Snap, CrossingOutlinesMeetInVertices) {
  SnapGraph graph;
  Append({0, 1}, {3, 2}, 0, false, graph);
  Append({1, 0}, {2, 3}, 1, false, graph);
  const SnapGraph snapped = Snap(graph, 0.002);
  EXPECT_EQ(snapped.vertices.size(), 12u);
  EXPECT_EQ(snapped.segments.size(), 16u);
  ExpectClosed(snapped, 2);
}

TEST(Snap, SaysThatSegmentsMeetInVerticesOnly) {
  SnapGraph graph;
  Append({0, 1}, {3, 2}, 0, false, graph);
  Append({1, 0}, {2, 3}, 1, true, graph);
  Append({3, 1}, {5, 2}, 2, false, graph);  // beside the first: along one of its sides
  EXPECT_TRUE(Snap(graph, 0.002).is_planar);
}

TEST(Snap, SaysWhatItLeavesToExactArithmetic) {
  const SnapGraph outlines = OutlinesOf(FloorOf(Tangle()));
  const SnapGraph snapped = Snap(outlines, kTangleRadius_m);
  EXPECT_FALSE(snapped.is_planar);
  ExpectClosed(snapped, 3);
  EXPECT_TRUE(Snap(outlines, 0.002).is_planar) << "the radius makes the three crossings one vertex";
}

TEST(Snap, SegmentsOverEachOtherAreSplitAlikeWhicheverWayTheyRun) {
  SnapGraph graph;
  Append({0, 0}, {10, 1}, 0, false, graph);
  Append({0, 0}, {10, 1}, 1, true, graph);
  Append({2, 1.001}, {4, 3}, 2, false, graph);  // its two lower corners lie within the radius of the upper side
  const SnapGraph snapped = Snap(graph, 0.002);
  EXPECT_EQ(snapped.vertices.size(), 8u);
  EXPECT_EQ(snapped.segments.size(), 6u + 6u + 4u);
  ExpectClosed(snapped, 3);
}

TEST(Snap, ThousandsOfWallsInOnePlaceAreSnappedAsOne) {
  constexpr uint32_t kWalls = 20000;
  SnapGraph graph;
  for (uint32_t w = 0; w < kWalls; ++w) Append({0, 0}, {10, 0.2}, w, w % 2 == 1, graph);
  Append({4, -1}, {5, 1}, kWalls, false, graph);  // crosses them all
  const SnapGraph snapped = Snap(graph, 0.002);
  EXPECT_EQ(snapped.vertices.size(), 12u);
  EXPECT_EQ(snapped.segments.size(), 8u * kWalls + 8u);
}

}  // namespace
}  // namespace plumb::compiler
