// Rooms of a map made by the runtime itself, on a simulated drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "runtime/rooms/rooms.h"
#include "runtime/rooms/sgraph_json.h"
#include "tests/support/house.h"
#include "tests/support/room_overlap.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

using Eigen::Vector2d;
using Json = nlohmann::json;

// The S-Graph of a drive through the house with its upper layers, in the plan's frame.
const Json& MappedHouse() {
  static const Json kMapped = [] {
    test::SyntheticLidarOptions lidar_options;
    lidar_options.azimuths = 900;
    const test::SyntheticLidar lidar(test::MakeHouse(), lidar_options);
    const test::Drive drive = test::HouseDrive();
    Odometry odometry;
    Mapper mapper;
    Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
    for (double t = 0; t + 0.1 < drive.duration_s(); t += 0.1) {
      const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s); }, t), std::nullopt);
      if (t == 0) T_plan_map = drive.At(0) * r.T_odom_lidar.inverse();
      mapper.AddScan(r.deskewed, r.T_odom_lidar);
    }
    mapper.Flush();
    return Json::parse(SGraphToJson(mapper.graph(), DeriveUpperLayers(mapper.graph()), T_plan_map));
  }();
  return kMapped;
}

TEST(DeriveUpperLayers, FindsTheRoomsOfTheHouse) {
  const AGraph house = test::MakeHouse();
  const Json& rooms = MappedHouse().at("rooms");
  EXPECT_EQ(rooms.size(), house.rooms.size());
  for (const Room& planned : house.rooms) {
    EXPECT_GT(test::BestOverlap(planned.polygon, rooms), 0.93) << planned.name;
  }
  for (const Json& room : rooms) {
    EXPECT_TRUE(room.at("closed").get<bool>());
    EXPECT_TRUE(room.at("visited").get<bool>());
    EXPECT_GE(room.at("surfaces").size(), 4u);
  }
  EXPECT_TRUE(MappedHouse().at("corridors").empty());
}

TEST(DeriveUpperLayers, FindsTheDoorwaysThatAreOpen) {
  const AGraph house = test::MakeHouse();
  const Json& doorways = MappedHouse().at("doorways");
  ASSERT_EQ(doorways.size(), 2u);  // D3 is shut
  for (size_t i = 0; i < 2; ++i) {
    const Doorway& planned = house.doorways[i];
    const auto is_near = [&](const Json& d) {
      const Vector2d at = test::PointOf(d.at("position"));
      return (at - planned.position.head<2>()).norm() < 0.1 && std::abs(d.at("width_m").get<double>() - planned.width_m) < 0.1;
    };
    EXPECT_TRUE(std::any_of(doorways.begin(), doorways.end(), is_near)) << planned.name << doorways;
  }
}

TEST(DeriveUpperLayers, KnowsTheFloorAndTheCeiling) {
  const Json& floors = MappedHouse().at("floors");
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_NEAR(floors[0].at("floor_z_m").get<double>(), 0, 0.03);
  EXPECT_NEAR(floors[0].at("ceiling_z_m").get<double>(), test::kHouseHeight_m, 0.03);
  EXPECT_EQ(floors[0].at("keyframes").size(), MappedHouse().at("keyframes").size());
}

TEST(DeriveUpperLayers, OfNothingIsNothing) {
  const UpperLayers layers = DeriveUpperLayers({});
  EXPECT_TRUE(layers.floors.empty());
  EXPECT_TRUE(layers.rooms.empty());
}

TEST(RoomOptions, SayWhatIsWrong) {
  EXPECT_EQ(RoomOptions().Check(), "");
  RoomOptions options;
  options.band_high_m = 0.1;
  EXPECT_EQ(options.Check(), "RoomOptions.band_high_m = 0.1; must be > band_low_m");
}

}  // namespace
}  // namespace plumb::runtime
