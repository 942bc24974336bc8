#include "runtime/deviations/room_deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/house.h"

namespace plumb::runtime {
namespace {

std::vector<SurfaceDeviation> AllAsPlanned(const AGraph& plan) {
  std::vector<SurfaceDeviation> out(plan.surfaces.size());
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].surface = SurfaceId(i);
    out[i].status = SurfaceStatus::kAsPlanned;
    out[i].sigma_translation_m = 0.005;
    out[i].sigma_rotation_rad = 0.002;
  }
  return out;
}

TEST(RoomDeviation, IsHalfTheSumOfOppositeWalls) {
  const AGraph house = test::MakeHouse();
  auto surfaces = AllAsPlanned(house);
  // C: east (normal -x) moved out by 0.2, i.e. -0.2 along its normal: the room's centre moves by +0.1 in x.
  surfaces[9].translation_m = -0.2;
  surfaces[9].status = SurfaceStatus::kDeviated;
  const RoomDeviation room = DeviationOfRoom(house, RoomId(2), surfaces, {});
  EXPECT_EQ(room.status, SurfaceStatus::kDeviated);
  EXPECT_NEAR(room.translation_m.x(), 0.1, 1e-3);
  EXPECT_NEAR(room.translation_m.y(), 0, 1e-3);
  EXPECT_NEAR(room.rotation_rad, 0, 1e-3);
  EXPECT_NEAR(room.sigma_m, 0.005 / std::sqrt(2.0), 0.001);
}

TEST(RoomDeviation, RecoversARigidMotion) {
  const AGraph house = test::MakeHouse();
  auto surfaces = AllAsPlanned(house);
  const Eigen::Vector2d t(0.07, -0.04);
  const double yaw = 0.02;
  const Room& room = house.rooms[1];
  for (SurfaceId id : room.surfaces) {
    const Surface& s = house.surfaces[id.index()];
    const Eigen::Vector2d arm = s.midpoint() - room.center.head<2>();
    surfaces[id.index()].translation_m = s.normal.head<2>().dot(t + yaw * Eigen::Vector2d(-arm.y(), arm.x()));
    surfaces[id.index()].rotation_rad = yaw;
    surfaces[id.index()].status = SurfaceStatus::kDeviated;
  }
  const RoomDeviation d = DeviationOfRoom(house, RoomId(1), surfaces, {});
  EXPECT_NEAR(d.translation_m.x(), t.x(), 1e-3);
  EXPECT_NEAR(d.translation_m.y(), t.y(), 1e-3);
  EXPECT_NEAR(d.rotation_rad, yaw, 1e-3);
}

TEST(RoomDeviation, IsUnobservedWithoutTwoDirections) {
  const AGraph house = test::MakeHouse();
  auto surfaces = AllAsPlanned(house);
  for (SurfaceId id : house.rooms[2].surfaces) {
    if (std::abs(house.surfaces[id.index()].normal.y()) > 0.5) surfaces[id.index()].status = SurfaceStatus::kUnobserved;
  }
  EXPECT_EQ(DeviationOfRoom(house, RoomId(2), surfaces, {}).status, SurfaceStatus::kUnobserved);
  EXPECT_EQ(DeviationOfRoom(house, RoomId(0), surfaces, {}).status, SurfaceStatus::kAsPlanned);
}

}  // namespace
}  // namespace plumb::runtime
