#include "runtime/coupling/wall_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/house.h"

namespace plumb::runtime {
namespace {

TEST(WallFrames, ReferIsTheLongestSurfaceOfEveryWall) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallFrame> frames = WallFrames(house);
  ASSERT_EQ(frames.size(), house.walls.size());
  for (size_t w = 0; w < frames.size(); ++w) {
    ASSERT_TRUE(frames[w].valid());
    const Surface& reference = house.surfaces[frames[w].reference.index()];
    EXPECT_EQ(reference.wall, WallId(w));
    for (const Surface& s : house.surfaces) {
      if (s.wall != WallId(w)) continue;
      EXPECT_LE(s.length_m(), reference.length_m() + 1e-3);
    }
    EXPECT_NEAR(frames[w].pivot.z(), 1.3, 1e-9);
  }
}

TEST(WallFrames, CurvedWallsHaveNone) {
  AGraph house = test::MakeHouse();
  for (Surface& s : house.surfaces) s.arc = Arc{};
  for (const WallFrame& f : WallFrames(house)) EXPECT_FALSE(f.valid());
}

// The plane that BuiltPlane gives is that of the face's points moved as one body.
TEST(BuiltPlane, ContainsTheFacesMovedPoints) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallFrame> frames = WallFrames(house);
  const double wall[4] = {0.23, 0.1, 0.02, 0.03};
  for (const Surface& s : house.surfaces) {
    const WallFrame& frame = frames[s.wall.index()];
    ASSERT_TRUE(IsFace(frame, s));
    Plane built;
    BuiltPlane(MakeFace(frame, s), wall, &built.n, &built.d);
    EXPECT_NEAR(built.n.norm(), 1, 1e-12);
    const Eigen::Vector3d axis = frame.normal.cross(Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(wall[kWallYaw], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(wall[kWallTilt], axis)).toRotationMatrix();
    for (const Eigen::Vector2d& end : {s.start, s.end}) {
      for (double z : {s.z_min_m, s.z_max_m}) {
        const Eigen::Vector3d moved =
            frame.pivot + turn * (Eigen::Vector3d(end.x(), end.y(), z) - frame.pivot) + wall[kWallOffset] * frame.normal;
        EXPECT_NEAR(built.SignedDistance(moved), -0.5 * wall[kWallThickness], 1e-9);  // the face itself lies half the error further out
      }
    }
  }
}

TEST(CompareToPlan, ReadsBackOffsetYawAndTiltOfTheReference) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallFrame> frames = WallFrames(house);
  for (const WallFrame& frame : frames) {
    const double wall[4] = {-0.3, -0.15, 0.01, 0};
    const Face face = MakeFace(frame, house.surfaces[frame.reference.index()]);
    Plane built;
    BuiltPlane(face, wall, &built.n, &built.d);
    const FaceDeviation d = CompareToPlan(face, built);
    EXPECT_NEAR(d.offset_m, -0.3, 1e-9);  // the pivot moves along the planned normal
    EXPECT_NEAR(d.yaw_rad, -0.15, 1e-9);
    EXPECT_NEAR(d.tilt_rad, 0.01, 1e-9);
  }
}

TEST(CompareToPlan, OppositeFacesSeeOppositeOffsetsAndTheSameYaw) {
  const AGraph house = test::MakeHouse();
  const std::vector<WallFrame> frames = WallFrames(house);
  const WallFrame& middle = frames[4];
  const double wall[4] = {0.1, 0.05, 0, 0};
  for (const Surface& s : house.surfaces) {
    if (s.wall != WallId(4)) continue;
    const Face face = MakeFace(middle, s);
    Plane built;
    BuiltPlane(face, wall, &built.n, &built.d);
    const FaceDeviation d = CompareToPlan(face, built);
    // Along the wall the offset changes by the yaw times the distance from the pivot.
    const double along = Eigen::Vector3d::UnitZ().cross(face.point - face.pivot).dot(face.normal);
    EXPECT_NEAR(d.offset_m, face.side() * 0.1 + 0.05 * along, 0.003);
    EXPECT_NEAR(d.yaw_rad, 0.05, 1e-9);
  }
}

}  // namespace
}  // namespace plumb::runtime
