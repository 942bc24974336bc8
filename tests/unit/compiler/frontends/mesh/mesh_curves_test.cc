#include "compiler/frontends/mesh/mesh_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

struct Facets {
  std::vector<FaceDirection> directions;
  std::vector<WallPiece> pieces;
};

// Flat walls whose inner sides are chords of a circle about zero, each as the box between its two faces.
Facets AroundACircle(double radius_m, double thickness_m, double step_rad, int count) {
  Facets out;
  for (int i = 0; i < count; ++i) {
    const double middle = (i + 0.5) * step_rad;
    FaceDirection d;
    d.across = {std::cos(middle), std::sin(middle)};
    d.along = {d.across.y(), -d.across.x()};  // across = along turned by +90 degrees: round the circle clockwise
    WallPiece piece;
    piece.direction = out.directions.size();
    piece.c0_m = radius_m * std::cos(0.5 * step_rad);
    piece.c1_m = piece.c0_m + thickness_m;
    const double half_m = radius_m * std::sin(0.5 * step_rad);
    piece.span = {-half_m, half_m};
    piece.z1_m = 2.5;
    out.directions.push_back(d);
    out.pieces.push_back(piece);
  }
  return out;
}

TEST(FindCurves, FacetsOfAnArcAreOneCurveWithoutGaps) {
  const Facets f = AroundACircle(5, 0.3, std::numbers::pi / 36, 18);
  const WallCurves curves = FindCurves(f.directions, f.pieces);
  for (size_t i = 0; i < f.pieces.size(); ++i) EXPECT_EQ(curves.first[i], 0u);
  for (size_t i = 0; i + 1 < f.pieces.size(); ++i) {
    // The start of a piece is the end of the next one on the way back.
    EXPECT_LT((curves.corners[i][0] - curves.corners[i + 1][1]).norm(), 1e-9) << i;
    EXPECT_LT((curves.corners[i][3] - curves.corners[i + 1][2]).norm(), 1e-9) << i;
    EXPECT_NEAR(curves.corners[i][0].norm(), 5, 1e-9);
    EXPECT_NEAR(curves.corners[i][3].norm(), 5 + 0.3 / std::cos(std::numbers::pi / 72), 1e-9);
  }
}

TEST(FindCurves, ATowerOfFlatWallsIsNone) {
  const Facets f = AroundACircle(2, 0.3, std::numbers::pi / 6, 12);
  const WallCurves curves = FindCurves(f.directions, f.pieces);
  for (size_t i = 0; i < f.pieces.size(); ++i) EXPECT_EQ(curves.first[i], i);
}

TEST(FindCurves, ThreeFacetsAreNone) {
  const Facets f = AroundACircle(5, 0.3, std::numbers::pi / 36, 3);
  const WallCurves curves = FindCurves(f.directions, f.pieces);
  for (size_t i = 0; i < f.pieces.size(); ++i) EXPECT_EQ(curves.first[i], i);
}

TEST(FindCurves, TheLastFacetEndsAtTheWallThatItMeetsAskew) {
  Facets f = AroundACircle(5, 0.3, std::numbers::pi / 36, 18);
  // Below: a wall whose upper face is y = 0.
  FaceDirection level;
  WallPiece flank;
  flank.direction = f.directions.size();
  flank.c0_m = -0.2;
  flank.c1_m = 0;
  flank.span = {0, 8};
  flank.z1_m = 2.5;
  f.directions.push_back(level);
  f.pieces.push_back(flank);
  const WallCurves curves = FindCurves(f.directions, f.pieces);
  EXPECT_LT((curves.corners[0][1] - Vector2d(5, 0)).norm(), 1e-9);
  EXPECT_NEAR(curves.corners[0][2].y(), 0, 1e-9);
  EXPECT_NEAR(curves.corners[0][2].x(), 5 + 0.3 / std::cos(std::numbers::pi / 72), 1e-9);
  EXPECT_EQ(curves.first[18], 18u);
}

TEST(FindCurves, WallsOfAnotherThicknessDoNotGoOn) {
  Facets f = AroundACircle(5, 0.3, std::numbers::pi / 36, 18);
  for (size_t i = 9; i < 18; ++i) f.pieces[i].c1_m += 0.2;
  const WallCurves curves = FindCurves(f.directions, f.pieces);
  for (size_t i = 0; i < 18; ++i) EXPECT_EQ(curves.first[i], i < 9 ? 0u : 9u);
}

}  // namespace
}  // namespace plumb::compiler
