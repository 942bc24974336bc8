// The matcher on the graph logs of the diS-Graphs authors: buildings SE1 and SE2, plans with walls moved by known amounts, maps of two
// rooms and of all. Skipped where the data are absent.
#include "tests/support/author_logs.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <numbers>
#include <set>

#include "runtime/matching/graph/graph_matcher.h"

namespace plumb::runtime {
namespace {

const std::string kData = std::string(PLUMB_SOURCE_DIR) + "/../shared/data/graphs/";

using Pairs = std::set<std::array<int, 2>>;

GraphWall ToWall(int id, const Eigen::Vector3d& line) {
  GraphWall wall;
  wall.id = static_cast<uint32_t>(id);
  wall.normal = line.head<2>();
  wall.d_m = line.z();
  return wall;
}

size_t IndexOf(MatchGraph& graph, int id, const Eigen::Vector3d& line) {
  const auto at =
      std::find_if(graph.walls.begin(), graph.walls.end(), [&](const GraphWall& w) { return w.id == static_cast<uint32_t>(id); });
  if (at != graph.walls.end()) return static_cast<size_t>(at - graph.walls.begin());
  graph.walls.push_back(ToWall(id, line));
  return graph.walls.size() - 1;
}

// `fixed`: of plans; planes of maps are not.
MatchGraph ReadGraph(const std::string& folder, bool fixed) {
  MatchGraph graph;
  for (const test::LoggedRoom& logged : test::ReadLoggedRooms(folder)) {
    GraphRoom room;
    room.id = static_cast<uint32_t>(logged.id);
    std::vector<GraphWall> walls;
    for (size_t i = 0; i < 4; ++i) {
      walls.push_back(ToWall(logged.plane_ids[i], logged.lines[i]));
      room.walls.push_back(IndexOf(graph, logged.plane_ids[i], logged.lines[i]));
    }
    const auto center = FourWallCenter(walls);
    if (!center) continue;
    room.center = *center;
    graph.rooms.push_back(room);
  }
  for (const test::LoggedPlane& plane : test::ReadLoggedPlanes(folder + "graph.g2o")) {
    if (plane.fixed == fixed) IndexOf(graph, plane.id, plane.line);
  }
  return graph;
}

MatchGraph Turned(MatchGraph graph, double yaw_rad) {
  const Eigen::Rotation2Dd R(yaw_rad);
  for (GraphWall& w : graph.walls) w.normal = R * w.normal;
  for (GraphRoom& r : graph.rooms) r.center = R * r.center;
  return graph;
}

MatchGraph Mirrored(MatchGraph graph) {
  for (GraphWall& w : graph.walls) w.normal.x() = -w.normal.x();
  for (GraphRoom& r : graph.rooms) r.center.x() = -r.center.x();
  return graph;
}

struct Figures {
  Pairs rooms, planes, deviated;
};

Figures Of(const GraphMatch& match) {
  Figures out;
  for (const RoomMatch& r : match.rooms) out.rooms.insert({static_cast<int>(r.plan_room), static_cast<int>(r.map_room)});
  for (const WallMatch& w : match.walls) {
    if (w.orphan) continue;
    (w.deviated ? out.deviated : out.planes).insert({static_cast<int>(w.plan_wall), static_cast<int>(w.map_wall)});
  }
  return out;
}

Figures Of(const test::LoggedTruth& truth) {
  return {Pairs(truth.rooms.begin(), truth.rooms.end()), Pairs(truth.planes.begin(), truth.planes.end()),
          Pairs(truth.deviated_planes.begin(), truth.deviated_planes.end())};
}

std::string Text(const Pairs& pairs) {
  std::string out;
  for (const auto& [a, s] : pairs) out += " " + std::to_string(a) + "-" + std::to_string(s);
  return out;
}

struct Case {
  std::string building, plan, map;
  Pairs not_found = {};      // of the truth's walls: those that lie far off in the logs
  bool other_gauge = false;  // more walls say what was moved is where it was than say what was not moved is
};

void PrintTo(const Case& c, std::ostream* os) { *os << c.building << c.plan << c.map; }

class AuthorLogs : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const std::string root = kData + GetParam().building;
    if (!std::filesystem::exists(root)) GTEST_SKIP() << "no graph logs at " << root;
    plan_ = ReadGraph(root + "/A-Graphs/" + GetParam().plan + "/", true);
    map_ = ReadGraph(root + "/S-Graphs/" + GetParam().map + "/", false);
    truth_ = Of(test::ReadLoggedTruth(root + "/A-Graphs/" + GetParam().plan + "/ground_truth.json"));
  }

  MatchGraph plan_, map_;
  Figures truth_;
};

Pairs operator+(Pairs a, const Pairs& b) {
  a.insert(b.begin(), b.end());
  return a;
}

TEST_P(AuthorLogs, MatchesTheTrueRoomsAndWallsAndTellsThoseThatDeviate) {
  const GraphMatch match = GraphMatcher(plan_).Match(map_);
  const Figures found = Of(match);
  SCOPED_TRACE(Text(found.planes) + ", deviated:" + Text(found.deviated));
  ASSERT_EQ(match.verdict, MatchResult::Verdict::kUnique) << match.reason;
  EXPECT_EQ(found.rooms, truth_.rooms);
  Pairs expected = truth_.planes + truth_.deviated;
  for (const auto& pair : GetParam().not_found) expected.erase(pair);
  EXPECT_EQ(found.planes + found.deviated, expected);
  if (!GetParam().other_gauge) {
    EXPECT_EQ(found.deviated, truth_.deviated);
  }
  EXPECT_NEAR(match.pose.yaw_rad, 0, 0.03);
}

TEST_P(AuthorLogs, MatchesTheSameAtAnyYaw) {
  const GraphMatcher matcher(plan_);
  const Figures level = Of(matcher.Match(map_));
  for (double yaw_rad : {std::numbers::pi / 2, 137 * std::numbers::pi / 180, std::numbers::pi}) {
    const GraphMatch match = matcher.Match(Turned(map_, yaw_rad));
    SCOPED_TRACE(yaw_rad);
    ASSERT_EQ(match.verdict, MatchResult::Verdict::kUnique) << match.reason;
    const Figures found = Of(match);
    EXPECT_EQ(found.rooms, level.rooms);
    EXPECT_EQ(found.planes, level.planes);
    EXPECT_EQ(found.deviated, level.deviated);
    EXPECT_NEAR(WrapAngle(match.pose.yaw_rad + yaw_rad), 0, 0.03);
  }
}

TEST_P(AuthorLogs, DoesNotMatchTheMirrorImage) {
  EXPECT_NE(GraphMatcher(plan_).Match(Mirrored(map_)).verdict, MatchResult::Verdict::kUnique);
}

class AuthorLogsOfWholeBuildings : public AuthorLogs {};

TEST_P(AuthorLogsOfWholeBuildings, ExtendAMatchByTheRoomsThatAreNew) {
  ASSERT_GE(map_.rooms.size(), 3u);
  MatchGraph first_rooms = map_;
  first_rooms.rooms.resize(map_.rooms.size() - 2);
  const GraphMatcher matcher(plan_);
  const GraphMatch first = matcher.Match(first_rooms);
  ASSERT_EQ(first.verdict, MatchResult::Verdict::kUnique) << first.reason;
  ASSERT_EQ(first.rooms.size(), first_rooms.rooms.size());
  const Figures extended = Of(matcher.Extend(map_, first)), whole = Of(matcher.Match(map_));
  EXPECT_EQ(extended.rooms, whole.rooms);
  EXPECT_EQ(extended.planes, whole.planes);
}

// Wall 98 was seen 0.67 m off and turned by 6 degrees.
const Case kSe1WholeBuilding{"SE1", "T0", "RAll", {{1, 98}}};
const Case kSe2WholeBuilding{"SE2", "T0", "RAll", {}, true};

INSTANTIATE_TEST_SUITE_P(All, AuthorLogs,
                         testing::Values(Case{"SE1", "T1", "R2"}, Case{"SE1", "T2", "R2"}, Case{"SE1", "T3", "R2"}, Case{"SE1", "T4", "R2"},
                                         // Two of the four walls of one direction are faces of one wall that was moved.
                                         Case{"SE1", "T5", "R2", {}, true},
                                         kSe1WholeBuilding, kSe2WholeBuilding));
INSTANTIATE_TEST_SUITE_P(All, AuthorLogsOfWholeBuildings, testing::Values(kSe1WholeBuilding, kSe2WholeBuilding));

}  // namespace
}  // namespace plumb::runtime
