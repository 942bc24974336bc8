// The joint estimate on the graph logs of the diS-Graphs authors: simulated building SE1, plans T1 to T5 with walls moved by known amounts,
// map R2 with two rooms. Skipped where the data are absent.
#include "tests/support/author_logs.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/deviations.h"

namespace plumb::runtime {
namespace {

using test::LoggedRoom;

const std::string kData = std::string(PLUMB_SOURCE_DIR) + "/../shared/data/graphs/SE1/";

// Corner of two lines.
Eigen::Vector2d Corner(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix2d n;
  n << a.head<2>().transpose(), b.head<2>().transpose();
  return -n.inverse() * Eigen::Vector2d(a.z(), b.z());
}

// Start and end of side i of a room; free space to the left.
std::pair<Eigen::Vector2d, Eigen::Vector2d> Side(const LoggedRoom& room, size_t i) {
  const size_t other = i < 2 ? 2 : 0;
  const Eigen::Vector2d a = Corner(room.lines[i], room.lines[other]), b = Corner(room.lines[i], room.lines[other + 1]);
  const Eigen::Vector2d along(room.lines[i].y(), -room.lines[i].x());
  return along.dot(b - a) > 0 ? std::pair(a, b) : std::pair(b, a);
}

struct LoggedCase {
  AGraph plan;
  SGraph map;
  std::vector<Match> matches;
  std::map<int, WallId> wall_of_plane;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
};

// The two faces of one wall: opposite, back to back, less than 0.3 m apart.
WallId WallOf(LoggedCase& c, const Eigen::Vector3d& line, int plane_id) {
  if (const auto known = c.wall_of_plane.find(plane_id); known != c.wall_of_plane.end()) return known->second;
  for (const Surface& s : c.plan.surfaces) {
    const double thickness = -(s.d_m + line.z());
    if (s.normal.head<2>().dot(line.head<2>()) < -0.99 && thickness > 0 && thickness < 0.3) return c.wall_of_plane[plane_id] = s.wall;
  }
  Wall wall;
  wall.guid = std::to_string(plane_id);
  c.plan.walls.push_back(wall);
  return c.wall_of_plane[plane_id] = WallId(c.plan.walls.size() - 1);
}

MapSurface SeenSide(const LoggedRoom& room, size_t i) {
  const auto [start, end] = Side(room, i);
  MapSurface s;
  s.plane = {{room.lines[i].x(), room.lines[i].y(), 0}, room.lines[i].z()};
  s.start = start;
  s.end = end;
  s.z_min_m = -0.5;
  s.z_max_m = 0.5;
  s.area_m2 = s.length_m();
  s.num_points = 441;
  Observation o;
  for (int u = 0; u <= 20; ++u) {
    for (int v = 0; v <= 20; ++v) {
      const Eigen::Vector2d p = start + u / 20.0 * (end - start);
      o.stats.Add({p.x(), p.y(), v / 20.0 - 0.5});
    }
  }
  s.observations.push_back(o);
  return s;
}

// Plan rooms and map rooms that belong together, side by side; the start is the shift of the rooms' first corners.
LoggedCase MakeCase(const std::vector<LoggedRoom>& plan_rooms, const std::vector<LoggedRoom>& map_rooms, const test::LoggedTruth& truth) {
  LoggedCase c;
  c.map.keyframes.emplace_back();
  std::map<int, int> plan_of_map;
  for (const auto& list : {truth.planes, truth.deviated_planes}) for (const auto& [a, s] : list) plan_of_map[s] = a;
  const auto find = [](const std::vector<LoggedRoom>& rooms, int id) {
    return *std::find_if(rooms.begin(), rooms.end(), [&](const LoggedRoom& r) { return r.id == id; });
  };
  for (const auto& [plan_id, map_id] : truth.rooms) {
    const LoggedRoom plan_room = find(plan_rooms, plan_id), map_room = find(map_rooms, map_id);
    for (size_t i = 0; i < 4; ++i) {
      const auto at = std::find(plan_room.plane_ids.begin(), plan_room.plane_ids.end(), plan_of_map.at(map_room.plane_ids[i]));
      const auto k = static_cast<size_t>(at - plan_room.plane_ids.begin());
      Surface s;
      s.wall = WallOf(c, plan_room.lines[k], plan_room.plane_ids[k]);
      s.normal = {plan_room.lines[k].x(), plan_room.lines[k].y(), 0};
      s.d_m = plan_room.lines[k].z();
      std::tie(s.start, s.end) = Side(plan_room, k);
      s.z_min_m = -0.5;
      s.z_max_m = 0.5;
      c.plan.surfaces.push_back(s);
      c.map.surfaces.push_back(SeenSide(map_room, i));
      c.matches.push_back({static_cast<uint32_t>(c.map.surfaces.size() - 1), SurfaceId(c.plan.surfaces.size() - 1), RoomId(), 0, 0, {}});
    }
    if (plan_id == truth.rooms.front()[0]) {
      c.T_plan_map.translation().head<2>() = Side(plan_room, 0).first - c.map.surfaces.front().start;
    }
  }
  return c;
}

// Of plan T`number` and map R2; none where there are no logs.
std::optional<LoggedCase> CaseOf(int number) {
  const std::string plan_folder = kData + "A-Graphs/T" + std::to_string(number) + "/";
  if (!std::filesystem::exists(plan_folder)) return std::nullopt;
  return MakeCase(test::ReadLoggedRooms(plan_folder), test::ReadLoggedRooms(kData + "S-Graphs/R2/"),
                  test::ReadLoggedTruth(plan_folder + "ground_truth.json"));
}

// As if nobody knew which faces are of one wall.
void PartFaces(AGraph& plan) {
  plan.walls.clear();
  for (Surface& s : plan.surfaces) {
    s.wall = WallId(plan.walls.size());
    plan.walls.emplace_back();
  }
}

class GraphLogs : public testing::TestWithParam<int> {};

TEST_P(GraphLogs, AllDeviatedWallsAndNoOthers) {
  const std::optional<LoggedCase> logged = CaseOf(GetParam());
  if (!logged) GTEST_SKIP() << "no graph logs at " << kData;
  const LoggedCase& c = *logged;
  const auto built_rooms = test::ReadLoggedRooms(kData + "A-Graphs/T0/"), map_rooms = test::ReadLoggedRooms(kData + "S-Graphs/R2/");
  const test::LoggedTruth truth = test::ReadLoggedTruth(kData + "A-Graphs/T" + std::to_string(GetParam()) + "/ground_truth.json");

  std::map<int, double> built_d;  // plan T0 is the building
  for (const LoggedRoom& r : built_rooms) for (size_t i = 0; i < 4; ++i) built_d[r.plane_ids[i]] = r.lines[i].z();

  const JointResult result = OptimizeJointly(c.map, c.plan, c.matches, c.T_plan_map);
  ASSERT_TRUE(result.converged) << result.message;
  const DeviationReport report = AssessDeviations(c.plan, result);
  size_t k = 0;
  for (const auto& [plan_id, map_id] : truth.rooms) {
    const LoggedRoom& room =
        *std::find_if(map_rooms.begin(), map_rooms.end(), [&, id = map_id](const LoggedRoom& r) { return r.id == id; });
    for (size_t i = 0; i < 4; ++i, ++k) {
      const auto is_deviated = [&](const auto& pair) { return pair[1] == room.plane_ids[i]; };
      const auto deviated = std::find_if(truth.deviated_planes.begin(), truth.deviated_planes.end(), is_deviated);
      const SurfaceDeviation& d = report.surfaces[k];
      SCOPED_TRACE(testing::Message() << "map plane " << room.plane_ids[i] << ": " << d.translation_m << " +- " << d.sigma_translation_m
                                      << " p " << d.p_deviated);
      EXPECT_EQ(d.status, deviated == truth.deviated_planes.end() ? SurfaceStatus::kAsPlanned : SurfaceStatus::kDeviated);
      if (deviated == truth.deviated_planes.end()) continue;
      const int plan_plane = (*deviated)[0];
      EXPECT_NEAR(d.translation_m, c.plan.surfaces[k].d_m - built_d.at(plan_plane), 0.02);
    }
  }
}

// In T5 one wall of 12 cm, of which both faces are seen, and another one are moved along one direction: counted by faces, those that moved
// are as many as those that did not.
TEST(GraphLogsT5, TwoFacesOfOneWallHaveOneVote) {
  std::optional<LoggedCase> logged = CaseOf(5);
  if (!logged) GTEST_SKIP() << "no graph logs at " << kData;
  const auto margin_along_x = [](const LoggedCase& c) {
    const JointResult result = OptimizeJointly(c.map, c.plan, c.matches, c.T_plan_map);
    EXPECT_TRUE(result.converged) << result.message;
    int margin = 0;
    for (const DirectionSupport& d : result.directions) margin = d.axis_rad < 0.1 || d.axis_rad > 3.0 ? d.margin() : margin;
    return std::pair(margin, result.T_plan_map);
  };
  const auto [by_wall, T_by_wall] = margin_along_x(*logged);
  EXPECT_LT(logged->plan.walls.size(), logged->plan.surfaces.size());
  PartFaces(logged->plan);
  const auto [by_face, T_by_face] = margin_along_x(*logged);
  EXPECT_GT(by_wall, by_face);
}

INSTANTIATE_TEST_SUITE_P(SE1, GraphLogs, testing::Range(1, 6));

}  // namespace
}  // namespace plumb::runtime
