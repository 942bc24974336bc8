#include "compiler/frontends/svg/svg_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/frontends/svg/svg_values.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr size_t kMany = 100000;

std::vector<SvgOutline> Outlines(std::string_view data) {
  SvgPathData path = ParseSvgPath(data, kMany);
  EXPECT_FALSE(path.faulty) << data;
  return path.outlines;
}

TEST(SvgScanner, ReadsNumbersThatTouch) {
  EXPECT_EQ(SvgNumbers("1.5.5-3e2+4,-.25 7"), (std::vector<double>{1.5, 0.5, -300, 4, -0.25, 7}));
}

TEST(SvgScanner, TakesNoWordForANumber) {
  EXPECT_TRUE(SvgNumbers("nan").empty());
  EXPECT_TRUE(SvgNumbers("-inf 1").empty());
  EXPECT_EQ(SvgNumbers("1 1e999 2"), std::vector<double>{1});
}

TEST(SvgLength, KnowsUnits) {
  EXPECT_DOUBLE_EQ(*SvgLength("25.4mm", 0), 96);
  EXPECT_DOUBLE_EQ(*SvgLength(" 72pt", 0), 96);
  EXPECT_DOUBLE_EQ(*SvgLength("50%", 300), 150);
  EXPECT_FALSE(SvgLength("auto", 1));
  EXPECT_DOUBLE_EQ(*SvgPhysicalLength_m("210mm"), 0.21);
  EXPECT_FALSE(SvgPhysicalLength_m("800px"));
}

TEST(SvgTransform, AppliesTheLastFirst) {
  const auto T = SvgTransform("translate(10,20) rotate(90) scale(2)");
  ASSERT_TRUE(T);
  EXPECT_LT((*T * Vector2d(1, 0) - Vector2d(10, 22)).norm(), 1e-12);
  const auto about = SvgTransform("rotate(180 5 5), skewX(45) matrix(1 0 0 1 0 0)");
  ASSERT_TRUE(about);
  EXPECT_LT((*about * Vector2d(0, 10) - Vector2d(0, 0)).norm(), 1e-9);
  EXPECT_FALSE(SvgTransform("rotate(90"));
  EXPECT_FALSE(SvgTransform("spin(3)"));
}

TEST(SvgViewport, KeepsTheAspectUnlessTold) {
  const SvgViewBox box{0, 0, 10, 10};
  EXPECT_LT((SvgViewport(box, 40, 20, "") * Vector2d(0, 0) - Vector2d(10, 0)).norm(), 1e-12);
  EXPECT_LT((SvgViewport(box, 40, 20, "none") * Vector2d(10, 10) - Vector2d(40, 20)).norm(), 1e-12);
  EXPECT_LT((SvgViewport(box, 40, 20, "xMinYMid slice") * Vector2d(0, 5) - Vector2d(0, 10)).norm(), 1e-12);
}

TEST(ParseSvgPath, RepeatsCommandsAndTakesFurtherMovesForLines) {
  const auto out = Outlines("M0,0 10,0 10,5H0V2z m20 0l1 1 1-1");
  ASSERT_EQ(out.size(), 2u);
  EXPECT_TRUE(out[0].closed);
  EXPECT_EQ(out[0].points, (std::vector<Vector2d>{{0, 0}, {10, 0}, {10, 5}, {0, 5}, {0, 2}}));
  EXPECT_FALSE(out[1].closed);
  EXPECT_EQ(out[1].points, (std::vector<Vector2d>{{20, 0}, {21, 1}, {22, 0}}));
}

TEST(ParseSvgPath, GoesOnFromTheStartAfterClosing) {
  const auto out = Outlines("M1 1h2v2zL5 5");
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[1].points.front(), Vector2d(1, 1));
}

TEST(ParseSvgPath, ArcsKeepTheirRadius) {
  for (const char* data : {"M10 0A10 10 0 0 1 0 10", "M10 0a10 10 0 01-10 10", "M10 0A10,10,0,0,1,0,10"}) {
    const auto out = Outlines(data);
    ASSERT_EQ(out.size(), 1u) << data;
    EXPECT_GT(out[0].points.size(), 8u);
    for (const auto& p : out[0].points) EXPECT_NEAR(p.norm(), 10, 1e-9) << data;
    EXPECT_LT((out[0].points.back() - Vector2d(0, 10)).norm(), 1e-12);
  }
}

TEST(ParseSvgPath, TakesTheLongArcWhenToldSo) {
  const auto out = Outlines("M10 0A10 10 0 1 0 0 10");
  ASSERT_EQ(out.size(), 1u);
  double lowest = 0;
  for (const auto& p : out[0].points) {
    EXPECT_NEAR(p.norm(), 10, 1e-9);
    lowest = std::min(lowest, p.y());
  }
  EXPECT_NEAR(lowest, -10, 0.1);
}

TEST(ParseSvgPath, EnlargesRadiiThatAreTooShort) {
  const auto out = Outlines("M0 0A1 1 0 0 1 10 0");
  ASSERT_EQ(out.size(), 1u);
  for (const auto& p : out[0].points) EXPECT_NEAR((p - Vector2d(5, 0)).norm(), 5, 1e-9);
}

TEST(ParseSvgPath, SmoothSplinesMirrorTheLastControlPoint) {
  const auto cubic = Outlines("M0 0C0 10 10 10 10 0S20-10 20 0");
  const auto explicit_cubic = Outlines("M0 0C0 10 10 10 10 0C10 -10 20-10 20 0");
  EXPECT_EQ(cubic[0].points, explicit_cubic[0].points);
  const auto quadratic = Outlines("M0 0Q5 10 10 0T20 0"), explicit_quadratic = Outlines("M0 0Q5 10 10 0Q15-10 20 0");
  ASSERT_EQ(quadratic[0].points.size(), explicit_quadratic[0].points.size());
  for (size_t i = 0; i < quadratic[0].points.size(); ++i)
    EXPECT_LT((quadratic[0].points[i] - explicit_quadratic[0].points[i]).norm(), 1e-9);
}

TEST(ParseSvgPath, KeepsWhatStandsBeforeAFault) {
  const SvgPathData cut = ParseSvgPath("M0 0L10 0L10 nan L0 0", kMany);
  EXPECT_TRUE(cut.faulty);
  ASSERT_EQ(cut.outlines.size(), 1u);
  EXPECT_EQ(cut.outlines[0].points.size(), 2u);
  EXPECT_TRUE(ParseSvgPath("L1 1", kMany).faulty);
  EXPECT_TRUE(ParseSvgPath("M0 0 1 1 2 2 3 3", 2).faulty);
  EXPECT_TRUE(ParseSvgPath("", kMany).outlines.empty());
}

TEST(SvgRect, RoundsItsCorners) {
  EXPECT_EQ(SvgRect(0, 0, 4, 2, 0, 0).points.size(), 4u);
  const SvgOutline round = SvgRect(0, 0, 4, 2, 1, 1);
  for (const auto& p : round.points) {
    const Vector2d inner(std::clamp(p.x(), 1.0, 3.0), 1);
    EXPECT_LE((p - inner).norm(), 1 + 1e-9);
  }
}

}  // namespace
}  // namespace plumb::compiler
