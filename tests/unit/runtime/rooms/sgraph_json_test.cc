#include "runtime/rooms/sgraph_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace plumb::runtime {
namespace {

using Json = nlohmann::json;

SGraph OneWall() {
  SGraph graph;
  Keyframe keyframe;
  keyframe.id = 0;
  keyframe.stamp_s = 12.5;
  keyframe.T_map_kf.translation() = Eigen::Vector3d(1, 2, 0.5);
  graph.keyframes.push_back(keyframe);
  MapSurface wall;
  wall.id = 3;
  wall.plane = {Eigen::Vector3d(0, -1, 0), 4};  // y = 4, seen from below
  wall.start = {5, 4};
  wall.end = {1, 4};
  wall.z_min_m = 0.1;
  wall.z_max_m = 2.4;
  wall.area_m2 = 8.2;
  wall.num_points = 1234;
  wall.observations = {{0, {}}, {0, {}}};
  graph.surfaces.push_back(wall);
  MapSurface merged;  // into another one
  merged.id = 4;
  graph.surfaces.push_back(merged);
  return graph;
}

UpperLayers OneRoom() {
  UpperLayers layers;
  layers.floors.push_back({0, 0.5, 0.1, std::nullopt, {0}});
  MapRoom room;
  room.polygon = {{0, 0}, {4, 0}, {4, 4}};
  room.area_m2 = 8;
  room.center = {2, 1};
  room.surfaces = {3};
  room.doorways = {0};
  layers.rooms.push_back(room);
  layers.doorways.push_back({0, 0, {2, 0}, 0, 0.9, 0, std::nullopt});
  layers.corridors.push_back({0, 0, 3, 5, {0, 1}, {4, 1}, 2});
  return layers;
}

TEST(SGraphToJson, ListsTheUpperLayersInThePlanFrame) {
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  T_plan_map.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn to the left
  T_plan_map.translation() = Eigen::Vector3d(10, 20, 3);
  const Json json = Json::parse(SGraphToJson(OneWall(), OneRoom(), T_plan_map));
  EXPECT_EQ(json.at("floors")[0].at("floor_z_m"), 3.1);
  EXPECT_TRUE(json.at("floors")[0].at("ceiling_z_m").is_null());
  const Json& room = json.at("rooms")[0];
  EXPECT_EQ(room.at("polygon"), (std::vector<std::vector<double>>{{10, 20}, {10, 24}, {6, 24}}));
  EXPECT_EQ(room.at("surfaces"), std::vector<int>{3});
  const Json& doorway = json.at("doorways")[0];
  EXPECT_EQ(doorway.at("position"), (std::vector<double>{10, 22}));
  EXPECT_EQ(doorway.at("yaw_rad"), 1.5708);
  EXPECT_EQ(doorway.at("rooms")[0], 0);
  EXPECT_TRUE(doorway.at("rooms")[1].is_null());
  EXPECT_EQ(json.at("corridors")[0].at("centre_line"), (std::vector<std::vector<double>>{{9, 20}, {9, 24}}));
}

TEST(SGraphToJson, ListsKeyframesAndTheSurfacesThatWereSeen) {
  const Json json = Json::parse(SGraphToJson(OneWall(), OneRoom(), std::nullopt));
  EXPECT_EQ(json.at("version"), 1);
  EXPECT_EQ(json.at("frame"), "map");
  ASSERT_EQ(json.at("keyframes").size(), 1u);
  EXPECT_EQ(json.at("keyframes")[0].at("t"), 12.5);
  EXPECT_EQ(json.at("keyframes")[0].at("position"), (std::vector<double>{1, 2, 0.5}));
  EXPECT_EQ(json.at("keyframes")[0].at("orientation"), (std::vector<double>{0, 0, 0, 1}));
  ASSERT_EQ(json.at("surfaces").size(), 1u);
  const Json& wall = json.at("surfaces")[0];
  EXPECT_EQ(wall.at("id"), 3);
  EXPECT_EQ(wall.at("kind"), "wall");
  EXPECT_EQ(wall.at("d_m"), 4);
  EXPECT_EQ(wall.at("segment"), (std::vector<std::vector<double>>{{5, 4}, {1, 4}}));
  EXPECT_EQ(wall.at("points"), 1234);
  EXPECT_EQ(wall.at("keyframes"), std::vector<int>{0});
}

TEST(SGraphToJson, IsInThePlanFrameWhereTheMapLiesInAPlan) {
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  T_plan_map.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn to the left
  T_plan_map.translation() = Eigen::Vector3d(10, 20, 3);
  const Json json = Json::parse(SGraphToJson(OneWall(), OneRoom(), T_plan_map));
  EXPECT_EQ(json.at("frame"), "plan");
  EXPECT_EQ(json.at("keyframes")[0].at("position"), (std::vector<double>{8, 21, 3.5}));
  const Json& wall = json.at("surfaces")[0];
  EXPECT_EQ(wall.at("normal"), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(wall.at("d_m"), -6);  // x = 6
  EXPECT_EQ(wall.at("segment"), (std::vector<std::vector<double>>{{6, 25}, {6, 21}}));
  EXPECT_EQ(wall.at("z_min_m"), 3.1);
  EXPECT_EQ(wall.at("z_max_m"), 5.4);
}

TEST(SGraphToJson, OfNothingIsStillAnObject) {
  const Json json = Json::parse(SGraphToJson({}, {}, std::nullopt));
  EXPECT_TRUE(json.at("keyframes").empty());
  EXPECT_TRUE(json.at("surfaces").empty());
}

}  // namespace
}  // namespace plumb::runtime
