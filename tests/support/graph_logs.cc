#include "tests/support/graph_logs.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

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
