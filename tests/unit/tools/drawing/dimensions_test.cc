#include "tools/drawing/dimensions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

// The house turned about the plan's zero.
AGraph Turned(double yaw_rad) {
  AGraph g = test::MakeHouse();
  const Eigen::Rotation2Dd R(yaw_rad);
  for (Surface& s : g.surfaces) {
    s.start = R * s.start;
    s.end = R * s.end;
    s.normal.head<2>() = R * s.normal.head<2>().eval();
  }
  for (Doorway& d : g.doorways) {
    d.position.head<2>() = R * d.position.head<2>().eval();
    d.yaw_rad += yaw_rad;
  }
  return g;
}

TEST(MainDirection, IsThatOfMostWallsUpToQuarterTurns) {
  for (const double deg : {0.0, 10.0, 24.0, 44.0, -44.0, 60.0, 90.0, 135.0, 200.0}) {
    const double yaw_rad = deg * std::numbers::pi / 180;
    const double found_rad = MainDirection(Turned(yaw_rad), StoreyId(0));
    EXPECT_NEAR(std::remainder(found_rad - yaw_rad, std::numbers::pi / 2), 0, 1e-9) << deg;
    EXPECT_LE(std::abs(found_rad), std::numbers::pi / 4 + 1e-9) << deg;
  }
  EXPECT_EQ(MainDirection(AGraph{}, StoreyId(0)), 0);
}

TEST(Dimensions, MeasureTheBuildingAndItsOpenings) {
  for (const double yaw_rad : {0.0, 0.4}) {
    const auto chains = DimensionsOf(Turned(yaw_rad), StoreyId(0));
    // Over all on two sides; D3 is the only opening, in the west wall from 1.2 to 2.1.
    ASSERT_EQ(chains.size(), 3u);
    std::vector<double> overall;
    for (const DimensionChain& c : chains) {
      if (c.row == 1) overall.push_back(c.stops_m.back() - c.stops_m.front());
    }
    ASSERT_EQ(overall.size(), 2u);
    EXPECT_NEAR(overall[0], 9.6, 1e-9);
    EXPECT_NEAR(overall[1], 6.6, 1e-9);
    const DimensionChain& west = chains[1];
    ASSERT_EQ(west.stops_m.size(), 4u);
    EXPECT_NEAR(west.stops_m[1] - west.stops_m[0], 1.5, 1e-9);
    EXPECT_NEAR(west.stops_m[2] - west.stops_m[1], 0.9, 1e-9);
    EXPECT_NEAR(west.stops_m[3] - west.stops_m[2], 4.2, 1e-9);
  }
}

TEST(Dimensions, OfTwoOpeningsBehindEachOtherTheForemostIsMeasured) {
  AGraph g = test::MakeHouse();
  const WallId shed = test::AddWall(g, "shed", {-3, 1}, {-2.8, 3});
  test::AddSurface(g, shed, RoomId(), {-3, 1}, {-3, 3});
  Window w;
  w.storey = StoreyId(0);
  w.wall = shed;
  w.position = {-2.9, 2, 1};
  w.width_m = 1;
  g.windows.push_back(w);
  const auto chains = DimensionsOf(g, StoreyId(0));
  const DimensionChain& west = chains[1];
  ASSERT_EQ(west.stops_m.size(), 4u);
  EXPECT_NEAR(west.stops_m[1], 1.5, 1e-9);
  EXPECT_NEAR(west.stops_m[2], 2.5, 1e-9);
}

TEST(Dimensions, PassOverPostsThatStandByThemselves) {
  AGraph g = test::MakeHouse();
  const auto add_post = [&g](double x, double size_m) {
    const WallId post = test::AddWall(g, "post", {x, 2}, {x + size_m, 2});
    test::AddSurface(g, post, RoomId(), {x, 2}, {x + size_m, 2});
  };
  add_post(-5, 0.9);
  EXPECT_NEAR(OuterRectangleOf(g, StoreyId(0)).size.sizes().x(), 9.6, 1e-9);
  EXPECT_NEAR(DimensionsOf(g, StoreyId(0))[1].outward_m, 0.3, 1e-9) << "along the house";
  add_post(-4.1, 0.9);  // one of 1.8 m with the other
  EXPECT_NEAR(OuterRectangleOf(g, StoreyId(0)).size.sizes().x(), 14.3, 1e-9);
  g.surfaces.erase(g.surfaces.begin(), g.surfaces.end() - 1);
  EXPECT_NEAR(OuterRectangleOf(g, StoreyId(0)).size.sizes().x(), 0.9, 1e-9) << "where there is nothing else";
}

TEST(Dimensions, AreWrittenInMetres) {
  const AGraph house = test::MakeHouse();
  const Sheet sheet({-1, -1}, {10, 7}, 2);
  const std::string svg = DrawDimensions(house, StoreyId(0), sheet);
  for (const char* text : {">9.60<", ">6.60<", ">1.50<", ">0.90<", ">4.20<"}) EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_TRUE(DrawDimensions(AGraph{}, StoreyId(0), sheet).empty());
}

}  // namespace
}  // namespace plumb::tools
