#include "runtime/matching/map_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumb::runtime {
namespace {

struct Face {
  double x0_m = 0, x1_m = 4, y_m = 0, spread_m = 0.03;
  bool faces_up = true;  // normal along +y, else -y
};

// A wall along x seen from the first keyframe, its points as far to either side as their spread.
void Add(const Face& face, SGraph& map) {
  MapSurface s;
  s.id = static_cast<uint32_t>(map.surfaces.size());
  s.plane.n = {0, face.faces_up ? 1.0 : -1.0, 0};
  s.plane.d = -s.plane.n.y() * face.y_m;
  PlaneStats stats;
  for (double x_m = face.x0_m; x_m <= face.x1_m + 1e-9; x_m += 0.05) {
    for (double z_m : {0.2, 0.7, 1.2}) {
      for (double side : {-1.0, 1.0}) stats.Add({x_m, face.y_m + side * face.spread_m, z_m});
    }
  }
  s.observations.push_back({0, stats});
  s.num_points = stats.count();
  s.start = {face.faces_up ? face.x0_m : face.x1_m, face.y_m};
  s.end = {face.faces_up ? face.x1_m : face.x0_m, face.y_m};
  s.z_min_m = 0.2;
  s.z_max_m = 1.2;
  s.area_m2 = face.x1_m - face.x0_m;
  map.surfaces.push_back(s);
}

std::vector<MapWall> WallsOf(const std::vector<Face>& faces) {
  SGraph map;
  map.keyframes.emplace_back();
  for (const Face& face : faces) Add(face, map);
  return UprightWalls(map);
}

TEST(UprightWalls, JoinPiecesApartByLessThanTheirPointsSpread) {
  const std::vector<MapWall> walls = WallsOf({{0, 4, 0, 0.03}, {2, 5, 0.05, 0.03}});
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_NEAR(walls[0].length_m, 5, 0.01);
  EXPECT_NEAR(walls[0].start.x(), 0, 0.01);
  EXPECT_GT(walls[0].normal.y(), 0.999);
  EXPECT_GT(walls[0].spread_m, 0.03);
  EXPECT_GT(walls[0].end.y(), 0.02);
  EXPECT_LT(walls[0].end.y(), 0.06);
}

TEST(UprightWalls, KeepWhatPreciseRangesTellApart) { EXPECT_EQ(WallsOf({{0, 4, 0, 0.01}, {2, 5, 0.05, 0.01}}).size(), 2u); }

TEST(UprightWalls, OfAPlanarLaserSayNothingOfTheirSpread) {
  SGraph map;
  map.planar = true;
  map.keyframes.emplace_back();
  Add({0, 4, 0, 0.03}, map);
  Add({2, 5, 0.02, 0.03}, map);
  const std::vector<MapWall> walls = UprightWalls(map);
  ASSERT_EQ(walls.size(), 2u);
  for (const MapWall& wall : walls) EXPECT_EQ(wall.spread_m, 0);
  EXPECT_NEAR(SigmaOfWalls(walls), 0.02, 1e-3);
}

TEST(UprightWalls, KeepBothFacesOfAThinWallAndPiecesBesideEachOther) {
  EXPECT_EQ(WallsOf({{0, 4, 0, 0.03, true}, {0, 4, 0.05, 0.03, false}}).size(), 2u);
  EXPECT_EQ(WallsOf({{0, 4, 0, 0.03}, {3.5, 7, 0.02, 0.03}}).size(), 2u);
}

TEST(UprightWalls, AreTheSurfacesWhereNothingIsDouble) {
  const std::vector<MapWall> walls = WallsOf({{0, 4, 0, 0.02}});
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].start, Eigen::Vector2d(0, 0));
  EXPECT_EQ(walls[0].end, Eigen::Vector2d(4, 0));
  EXPECT_NEAR(walls[0].spread_m, 0.02, 1e-9);
}

TEST(SigmaOfWalls, IsTheSpreadOfMostLengthAndWhatBuildersAreOff) {
  EXPECT_NEAR(SigmaOfWalls({}), 0.02, 1e-4);
  const std::vector<MapWall> walls = WallsOf({{0, 4, 0, 0.03}, {0, 3, 5, 0.03}, {0, 1, 10, 0.2}, {0, 1, 12, 0.001}});
  EXPECT_NEAR(SigmaOfWalls(walls), std::hypot(0.01, 0.03), 1e-9);
}

}  // namespace
}  // namespace plumb::runtime
