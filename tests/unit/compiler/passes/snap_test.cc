#include "compiler/passes/snap.h"

#include <gtest/gtest.h>

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
  // A fan of lines through one place, each round closer to each other than the radius allows, but not closer than vertices.
  SnapGraph graph;
  for (uint32_t i = 0; i < 40; ++i) {
    const double y = 0.003 * i;
    const auto first = static_cast<uint32_t>(graph.vertices.size());
    graph.vertices.insert(graph.vertices.end(), {{-5, y}, {5, 0.117 - y}});
    graph.segments.push_back({first, first + 1, i});
  }
  const SnapGraph snapped = Snap(graph, 0.002);
  for (size_t i = 0; snapped.is_planar && i < snapped.segments.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const SnapSegment &s = snapped.segments[i], &r = snapped.segments[k];
      if (s.from == r.from || s.from == r.to || s.to == r.from || s.to == r.to) continue;
      const auto side = [&](uint32_t p, const SnapSegment& of) {
        const Eigen::Vector2d d = snapped.vertices[of.to] - snapped.vertices[of.from], w = snapped.vertices[p] - snapped.vertices[of.from];
        return d.x() * w.y() - d.y() * w.x() > 0;
      };
      EXPECT_FALSE(side(s.from, r) != side(s.to, r) && side(r.from, s) != side(r.to, s)) << i << " crosses " << k;
    }
  }
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
