// What holds for the passes on any plan: the order of the source and the place of the building change nothing but coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "compiler/emit/emit.h"
#include "compiler/passes/build_agraph.h"
#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"
#include "schema/agraph_writer.h"
#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

double Uniform(std::mt19937_64& random, double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random() >> 11) * 0x1p-53; }

// A random apartment: a grid of rooms behind outer walls, butt joints with gaps up to max_gap_m, doors in most inner walls, some columns.
PlanIr Apartment(uint64_t seed, double max_gap_m = 0.001) {
  std::mt19937_64 random(seed);
  test::PlanBuilder b;
  b.Storey("Ground", 0);
  const int columns = 2 + static_cast<int>(random() % 3), rows = 1 + static_cast<int>(random() % 3);
  std::vector<double> x = {0}, y = {0};
  for (int i = 0; i < columns; ++i) x.push_back(x.back() + Uniform(random, 2.5, 6));
  for (int i = 0; i < rows; ++i) y.push_back(y.back() + Uniform(random, 2.5, 6));
  const auto gap = [&] { return Uniform(random, 0, max_gap_m); };
  const double t = 0.3, h = 0.06;
  const uint32_t south = b.Wall("south", {-t, -t / 2}, {x.back() + t, -t / 2}, t);
  b.Wall("north", {-t, y.back() + t / 2}, {x.back() + t, y.back() + t / 2}, t);
  b.Wall("west", {-t / 2, gap()}, {-t / 2, y.back() - gap()}, t);
  b.Wall("east", {x.back() + t / 2, gap()}, {x.back() + t / 2, y.back() - gap()}, t);
  b.Door("entrance", south, t + x[1] / 2);
  for (int r = 1; r < rows; ++r) b.Wall(std::string("row ").append(std::to_string(r)), {gap(), y[r]}, {x.back() - gap(), y[r]}, 2 * h);
  for (int c = 1; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) {
      std::string name = std::to_string(c);
      name.append("-").append(std::to_string(r));
      const double lo = y[r] + (r > 0 ? h : 0) + gap(), hi = y[r + 1] - (r + 1 < rows ? h : 0) - gap();
      const uint32_t wall = b.Wall(name, {x[c], lo}, {x[c], hi}, 2 * h);
      b.Door(std::string("door ").append(name), wall, Uniform(random, 0.7, hi - lo - 0.7));
    }
  }
  b.Prismatic(ElementKind::kColumn, "column", test::Rectangle({1, 1}, {1.3, 1.4}), 0, 2.5);
  return b.plan;
}

AGraph Build(PlanIr plan) {
  PassOptions options;
  options.verify = true;
  DiagnosticSink sink;
  std::optional<Built> built = BuildAGraph(plan, options, sink);
  EXPECT_TRUE(built.has_value());
  if (!built) return {};
  EmitMesh(plan, built->graph);
  return std::move(built->graph);
}

// What a graph says apart from coordinates and ids.
std::string Describe(const AGraph& graph) {
  const auto room_name = [&](RoomId id) {
    if (!id.valid()) return std::string("outside");
    // Rooms have no name of their own here: the walls around them and their size tell them apart.
    std::vector<std::string> walls;
    for (SurfaceId s : graph.rooms[id.index()].surfaces) walls.push_back(graph.walls[graph.surfaces[s.index()].wall.index()].guid);
    std::sort(walls.begin(), walls.end());
    std::string out = std::to_string(std::lround(100 * graph.rooms[id.index()].area_m2 / 2));
    for (const auto& w : walls) out += " " + w;
    return out;
  };
  std::vector<std::string> lines;
  for (size_t r = 0; r < graph.rooms.size(); ++r) {
    const Room& room = graph.rooms[r];
    lines.push_back("room " + room_name(RoomId(r)) + " corners " + std::to_string(room.polygon.size()) + " holes " +
                    std::to_string(room.holes.size()));
  }
  for (const Doorway& d : graph.doorways) {
    std::vector<std::string> sides = {room_name(d.room_a), room_name(d.room_b)};
    std::sort(sides.begin(), sides.end());
    lines.push_back("doorway " + d.guid + " in " + graph.walls[d.wall.index()].guid + ": " + sides[0] + " / " + sides[1]);
  }
  for (const Surface& s : graph.surfaces) {
    lines.push_back("surface of " + graph.walls[s.wall.index()].guid + " in " + room_name(s.room) + " cm " +
                    std::to_string(std::lround(20 * s.length_m())));
  }
  for (const Wall& w : graph.walls) {
    lines.push_back("wall " + w.guid + " mm " + std::to_string(std::lround(100 * w.thickness_m)) + (w.external ? " external" : ""));
  }
  std::sort(lines.begin(), lines.end());
  std::string out;
  for (const auto& line : lines) out += line + "\n";
  return out;
}

class OnApartments : public testing::TestWithParam<uint64_t> {};

TEST_P(OnApartments, TheOrderOfTheSourceDoesNotMatter) {
  const PlanIr plan = Apartment(GetParam());
  const std::string expected = Describe(Build(plan));
  for (uint64_t seed = 1; seed <= 3; ++seed) EXPECT_EQ(Describe(Build(test::Shuffled(plan, seed))), expected);
}

TEST_P(OnApartments, ARigidMotionChangesCoordinatesOnly) {
  const PlanIr plan = Apartment(GetParam());
  const AGraph original = Build(plan);
  for (const double yaw : {24.0, 45.0, 90.0, 137.0}) {
    const AGraph moved = Build(test::Moved(plan, yaw * std::numbers::pi / 180, {1234.567, -89.01, 3.21}));
    ASSERT_EQ(moved.rooms.size(), original.rooms.size()) << yaw;
    ASSERT_EQ(moved.surfaces.size(), original.surfaces.size()) << yaw;
    ASSERT_EQ(moved.doorways.size(), original.doorways.size()) << yaw;
    const Eigen::Rotation2Dd rotation(yaw * std::numbers::pi / 180);
    const auto image = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d { return rotation * p + Eigen::Vector2d(1234.567, -89.01); };
    for (const Room& r : original.rooms) {
      const auto same = [&](const Room& m) {
        return (m.center.head<2>() - image(r.center.head<2>())).norm() < 0.002 && std::abs(m.area_m2 - r.area_m2) < 0.02;
      };
      EXPECT_EQ(std::count_if(moved.rooms.begin(), moved.rooms.end(), same), 1) << yaw;
    }
    for (const Surface& s : original.surfaces) {
      const auto same = [&](const Surface& m) {
        return (m.start - image(s.start)).norm() < 0.003 && (m.end - image(s.end)).norm() < 0.003;
      };
      EXPECT_EQ(std::count_if(moved.surfaces.begin(), moved.surfaces.end(), same), 1) << yaw;
    }
    for (size_t i = 0; i < original.doorways.size(); ++i) {
      const Doorway &a = original.doorways[i], &b = moved.doorways[i];
      EXPECT_LT((b.position.head<2>() - image(a.position.head<2>())).norm(), 0.002);
      EXPECT_EQ(a.room_b.valid(), b.room_b.valid());
    }
  }
}

TEST_P(OnApartments, DoorwaysJoinTwoRoomsOrARoomAndTheOutside) {
  const AGraph graph = Build(Apartment(GetParam()));
  EXPECT_FALSE(graph.doorways.empty());
  for (const Doorway& d : graph.doorways) {
    EXPECT_TRUE(d.room_a.valid());
    EXPECT_NE(d.room_a, d.room_b);
    EXPECT_EQ(d.room_b.valid(), d.guid != "entrance");
  }
}

TEST_P(OnApartments, SurfacesLieOnTheirRoomsAndCoverThem) {
  const AGraph graph = Build(Apartment(GetParam()));
  for (const Room& r : graph.rooms) {
    double covered = 0, perimeter = 0;
    const std::vector<Ring> outer = {r.polygon};
    for (SurfaceId id : r.surfaces) {
      const Surface& s = graph.surfaces[id.index()];
      EXPECT_LT(DistanceToRings(s.start, outer), 0.002);
      EXPECT_LT(DistanceToRings(s.end, outer), 0.002);
      covered += s.length_m();
    }
    for (size_t i = 0; i < r.polygon.size(); ++i) perimeter += (r.polygon[(i + 1) % r.polygon.size()] - r.polygon[i]).norm();
    EXPECT_NEAR(covered, perimeter, 0.01);
  }
}

TEST_P(OnApartments, RoomsAndWallsFillTheEnclosedArea) {
  PlanIr plan = Apartment(GetParam());
  DiagnosticSink sink;
  const std::optional<Built> built = BuildAGraph(plan, {}, sink);
  ASSERT_TRUE(built.has_value());
  const Floor& floor = built->floors.floors[0];
  std::vector<Ring> solid;
  for (const Footprint& f : floor.footprints) solid.insert(solid.end(), f.rings.begin(), f.rings.end());
  double rooms = 0, enclosed = 0;
  for (const Room& r : built->graph.rooms) rooms += r.area_m2;
  for (const Ring& ring : FaceRings(floor, floor.faces[0])) enclosed -= SignedArea(ring);
  EXPECT_NEAR(rooms + RegionArea(solid), enclosed, 0.05);  // 1 mm gaps along the walls
  EXPECT_GT(rooms, 0.5 * enclosed);
}

TEST_P(OnApartments, TheSameInputGivesTheSameBytes) {
  const PlanIr plan = Apartment(GetParam());
  EXPECT_EQ(WriteAGraph(Build(plan)), WriteAGraph(Build(plan)));
}

TEST_P(OnApartments, WallsThatDoNotQuiteMeetBoundTheSameRooms) {
  const AGraph close = Build(Apartment(GetParam())), apart = Build(Apartment(GetParam(), 0.15));
  ASSERT_EQ(apart.rooms.size(), close.rooms.size());
  for (const Room& r : close.rooms) {
    const auto same = [&](const Room& a) {
      return (a.center - r.center).norm() < 0.01 && std::abs(a.area_m2 - r.area_m2) < 0.02 && a.surfaces.size() == r.surfaces.size();
    };
    EXPECT_EQ(std::count_if(apart.rooms.begin(), apart.rooms.end(), same), 1);
  }
  for (const Doorway& d : apart.doorways) EXPECT_NE(d.room_a, d.room_b);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OnApartments, testing::Range<uint64_t>(1, 9));

}  // namespace
}  // namespace plumb::compiler
