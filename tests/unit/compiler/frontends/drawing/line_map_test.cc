#include "compiler/frontends/drawing/line_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

std::vector<MapLine> Box(double x0, double y0, double x1, double y1) {
  const Vector2d a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
  return {{a, b, 0}, {b, c, 1}, {c, d, 2}, {d, a, 3}};
}

std::vector<MapLine> operator+(std::vector<MapLine> a, const std::vector<MapLine>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

LineMap Map(const std::vector<MapLine>& lines) { return *LineMap::Build(lines, 1e-3, 1000); }

TEST(LineMap, CrossingLinesDivideABoxIntoFourFaces) {
  const LineMap map = Map(Box(0, 0, 4, 2) + std::vector<MapLine>{{{2, 0}, {2, 2}, 4}, {{0, 1}, {4, 1}, 5}});
  ASSERT_EQ(map.num_faces(), 5u);
  for (uint32_t f = 1; f < 5; ++f) EXPECT_NEAR(map.AreaOf(f), 2.0, 1e-9);
  EXPECT_NE(map.FaceAt({1, 0.5}), map.FaceAt({3, 0.5}));
  EXPECT_EQ(map.FaceAt({5, 0.5}), 0u);
}

TEST(LineMap, BoxWithinABoxIsAHoleOfItsFace) {
  const LineMap map = Map(Box(0, 0, 4, 4) + Box(1, 1, 2, 2));
  ASSERT_EQ(map.num_faces(), 3u);
  const uint32_t ring = map.FaceAt({3, 3});
  EXPECT_NEAR(map.AreaOf(ring), 15.0, 1e-9);
  EXPECT_EQ(map.LoopsOf(ring).size(), 2u);
  EXPECT_NEAR(map.AreaOf(map.FaceAt({1.5, 1.5})), 1.0, 1e-9);
}

TEST(LineMap, WhatLiesAroundALeftmostCornerWithALineFromItIsTheOutside) {
  // The line's two ends are off the level by as little as rounding, either way.
  for (const double off : {-1e-15, 0.0, 1e-15}) {
    const Vector2d west(-4, off), east(4, 0), north(0, 4), south(0, -4);
    const LineMap map =
        Map({{west, south, 0}, {south, east, 1}, {east, north, 2}, {north, west, 3}, {west, {-3, 0}, 4}, {{-3, 0}, east, 5}});
    ASSERT_EQ(map.num_faces(), 3u);
    for (uint32_t f = 1; f < 3; ++f) {
      EXPECT_EQ(map.LoopsOf(f).size(), 1u) << off;
      EXPECT_NEAR(map.AreaOf(f), 16, 1e-9) << off;
    }
  }
}

TEST(LineMap, WhatLiesLevelWithACornerBesideItIsOutsideThatCorner) {
  // Its ray to the left meets the corner's two lines in one point, whichever of them was drawn first.
  const std::vector<MapLine> corner = {{{0, -0.01}, {3, 0}, 0}, {{3, 0}, {3, -1}, 1}, {{3, -1}, {0, -0.01}, 2}};
  for (const bool turned : {false, true}) {
    const std::vector<MapLine> first = turned ? std::vector<MapLine>{corner[1], corner[0], corner[2]} : corner;
    const LineMap map = Map(first + Box(4, -1, 5, 0));
    ASSERT_EQ(map.num_faces(), 3u);
    EXPECT_EQ(map.LoopsOf(map.FaceAt({2.5, -0.5})).size(), 1u);
    EXPECT_EQ(map.LoopsOf(0).size(), 2u);
    EXPECT_EQ(map.FaceAt({3.5, 0}), 0u);
  }
}

TEST(LineMap, EndsThatMissByLessThanThePenMeet) {
  const LineMap map = Map({{{0, 0}, {4, 0.0005}, 0}, {{4.0005, 0}, {4, 4}, 1}, {{4, 4}, {0, 4}, 2}, {{0, 4}, {0.0004, 0.0003}, 3}});
  EXPECT_EQ(map.num_faces(), 2u);
}

TEST(LineMap, LinesOverEachOtherAreOne) {
  const LineMap map = Map({{{0, 0}, {3, 0}, 7}, {{1, 0}, {2, 0}, 8}, {{1, 0}, {4, 0}, 9}});
  EXPECT_EQ(map.edges().size(), 4u);
}

TEST(LineMap, RayHitsTheNearestLineFromItsSide) {
  const LineMap map = Map({{{1, -1}, {1, 1}, 0}, {{2, -1}, {2, 1}, 1}});
  const auto all = [](uint32_t) { return true; };
  const auto hit = map.Cast({0, 0.25}, {1, 0}, 5, all);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t_m, 1.0, 1e-12);
  EXPECT_TRUE(hit->on_left);
  EXPECT_FALSE(map.Cast({0, 0.25}, {1, 0}, 0.9, all));
  EXPECT_FALSE(map.Cast({3, 0.25}, {-1, 0}, 5, all)->on_left);
}

TEST(LineMap, TooManyCrossingsGiveNone) {
  std::vector<MapLine> lines;
  for (int i = 0; i < 40; ++i) {
    lines.push_back({{double(i), -1}, {double(i), 50}, 0});
    lines.push_back({{-1, double(i)}, {50, double(i)}, 0});
  }
  EXPECT_FALSE(LineMap::Build(lines, 1e-3, 1000));
  EXPECT_TRUE(LineMap::Build(lines, 1e-3, 100000));
}

}  // namespace
}  // namespace plumb::compiler
