// Reader for the graph logs of the diS-Graphs authors (data/graphs): room_data files, graph.g2o and ground_truth.json. Rectangular rooms of
// four planes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace plumb::test {

struct LoggedRoom {
  int id = -1;
  std::array<int, 4> plane_ids{};              // x1, x2, y1, y2; normals point into the room
  std::array<Eigen::Vector3d, 4> lines;        // [nx, ny, d], n . x + d = 0 in the ground plane, n of unit length
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // as logged
};

// A plane of graph.g2o, in a room or not.
struct LoggedPlane {
  int id = -1;
  Eigen::Vector3d line = Eigen::Vector3d::UnitX();  // as LoggedRoom::lines
  bool fixed = false;  // of the plan, which the logs of a map repeat; else seen
};

struct LoggedTruth {
  std::vector<std::array<int, 2>> rooms;       // [plan id, map id]
  std::vector<std::array<int, 2>> planes, deviated_planes;
};

// All rooms below `folder` (000000/room_data, ...), in the order of their folders; empty if there are none.
[[nodiscard]] std::vector<LoggedRoom> ReadLoggedRooms(const std::string& folder);
// By id; empty if there is no such file.
[[nodiscard]] std::vector<LoggedPlane> ReadLoggedPlanes(const std::string& g2o_path);
[[nodiscard]] LoggedTruth ReadLoggedTruth(const std::string& path);

}  // namespace plumb::test
