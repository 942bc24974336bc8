#include "tests/support/author_logs.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

namespace plumb::test {

std::vector<LoggedRoom> ReadLoggedRooms(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (std::filesystem::exists(entry.path() / "room_data")) files.push_back(entry.path() / "room_data");
  }
  std::sort(files.begin(), files.end());
  const std::array<std::string, 4> names{"plane_x1", "plane_x2", "plane_y1", "plane_y2"};
  std::vector<LoggedRoom> rooms;
  for (const auto& file : files) {
    LoggedRoom room;
    std::ifstream in(file);
    for (std::string word; in >> word;) {
      if (word == "id") in >> room.id;
      if (word == "room_node") {
        Eigen::Matrix<double, 2, 4> top;  // of the pose
        for (int row = 0; row < 2; ++row) for (int column = 0; column < 4; ++column) in >> top(row, column);
        room.center = top.col(3);
      }
      for (size_t i = 0; i < 4; ++i) {
        if (word == names[i] + "_id") in >> room.plane_ids[i];
        if (word != names[i] + "_node") continue;
        Eigen::Vector4d p;
        for (double& x : p) in >> x;
        room.lines[i] = Eigen::Vector3d(p.x(), p.y(), p.w()) / p.head<2>().norm();
      }
    }
    rooms.push_back(room);
  }
  return rooms;
}

std::vector<LoggedPlane> ReadLoggedPlanes(const std::string& g2o_path) {
  std::ifstream in(g2o_path);
  std::map<int, LoggedPlane> planes;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    int id = -1;
    words >> kind >> id;
    if (kind == "FIX" && planes.contains(id)) planes[id].fixed = true;
    if (kind != "VERTEX_PLANE") continue;
    Eigen::Vector4d p;
    for (double& x : p) words >> x;
    planes[id] = {id, Eigen::Vector3d(p.x(), p.y(), p.w()) / p.head<2>().norm(), false};
  }
  std::vector<LoggedPlane> out;
  for (const auto& [id, plane] : planes) out.push_back(plane);
  return out;
}

LoggedTruth ReadLoggedTruth(const std::string& path) {
  std::ifstream in(path);
  const auto json = nlohmann::json::parse(in);
  LoggedTruth truth;
  const auto pairs = [&](const char* group, const char* kind) {
    std::vector<std::array<int, 2>> out = json.at(group).at(kind).get<std::vector<std::array<int, 2>>>();
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  truth.rooms = pairs("not_deviated", "Finite Room");
  truth.planes = pairs("not_deviated", "Plane");
  truth.deviated_planes = pairs("deviated", "Plane");
  return truth;
}

}  // namespace plumb::test
