// Maps of a drive through the house, taken with a lidar and laid over each other by odometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

// The map of a drive through the house, its frame turned into the plan's by the true start.
struct Mapped {
  SGraph graph;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
};

Mapped MapHouse(const AGraph& house) {
  test::SyntheticLidarOptions options;
  options.azimuths = 900;
  const test::SyntheticLidar lidar(house, options);
  const test::Drive drive = test::HouseDrive();
  Odometry odometry;
  Mapper mapper;
  Mapped mapped;
  for (double t = 0; t + kPeriod_s < drive.duration_s(); t += kPeriod_s) {
    const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s); }, t), std::nullopt);
    if (t == 0) mapped.T_plan_map = drive.At(0) * r.T_odom_lidar.inverse();
    mapper.AddScan(r.deskewed, r.T_odom_lidar);
  }
  mapper.Flush();
  mapped.graph = mapper.graph();
  return mapped;
}

// The drive takes seconds to simulate: once for all tests.
const Mapped& House() {
  static const Mapped kMapped = MapHouse(test::MakeHouse());
  return kMapped;
}

// Map surfaces of kind wall that lie on a plan surface: same facing, within 0.15 m, along more than half of it. One map surface may lie on
// two plan surfaces, where a wall passes two rooms.
std::vector<const MapSurface*> OnPlan(const Mapped& mapped, const Surface& planned) {
  std::vector<const MapSurface*> on;
  const Eigen::Vector2d along = (planned.end - planned.start).normalized();
  for (const MapSurface& s : mapped.graph.surfaces) {
    if (s.observations.empty() || s.kind != SurfaceKind::kWall) continue;
    const Plane plane = s.plane.Transformed(mapped.T_plan_map);
    const Eigen::Vector3d midpoint(planned.midpoint().x(), planned.midpoint().y(), 1.0);
    if (plane.n.dot(planned.normal) < 0.97 || std::abs(plane.SignedDistance(midpoint)) > 0.15) continue;
    const Eigen::Vector3d start = mapped.T_plan_map * Eigen::Vector3d(s.start.x(), s.start.y(), s.z_min_m);
    const Eigen::Vector3d end = mapped.T_plan_map * Eigen::Vector3d(s.end.x(), s.end.y(), s.z_min_m);
    const double from = std::max(0.0, along.dot(start.head<2>() - planned.start)),
                 to = std::min(planned.length_m(), along.dot(end.head<2>() - planned.start));
    if (to - from > 0.5 * planned.length_m()) on.push_back(&s);
  }
  return on;
}

// The map surface with most points on a plan surface.
const MapSurface* MainOn(const Mapped& mapped, const Surface& planned) {
  const MapSurface* best = nullptr;
  for (const MapSurface* s : OnPlan(mapped, planned)) {
    if (best == nullptr || s->num_points > best->num_points) best = s;
  }
  return best;
}

TEST(MappedHouse, FindsEveryWallOfTheHouseInItsPlace) {
  const AGraph house = test::MakeHouse();
  for (const Surface& planned : house.surfaces) {
    if (!planned.room.valid()) continue;
    const MapSurface* s = MainOn(House(), planned);
    ASSERT_NE(s, nullptr) << "no map surface on the wall at " << planned.midpoint().transpose();
    const Plane plane = s->plane.Transformed(House().T_plan_map);
    const Eigen::Vector3d midpoint(planned.midpoint().x(), planned.midpoint().y(), 1.0);
    EXPECT_LT(std::abs(plane.SignedDistance(midpoint)), 0.01) << planned.midpoint().transpose();
    const double yaw_rad = std::atan2(planned.normal.cross(plane.n).z(), planned.normal.dot(plane.n));
    EXPECT_LT(std::abs(yaw_rad), 0.3 * std::numbers::pi / 180) << planned.midpoint().transpose();
    EXPECT_GT(s->area_m2, 0.4 * planned.length_m() * 1.0) << planned.midpoint().transpose();
    EXPECT_LT(s->area_m2, 9.3 * 2.8);
  }
}

TEST(MappedHouse, NoWallIsInTheMapTwice) {
  const SGraph& graph = House().graph;
  for (const MapSurface& a : graph.surfaces) {
    for (const MapSurface& b : graph.surfaces) {
      if (a.id >= b.id || a.observations.empty() || b.observations.empty() || a.kind != b.kind || a.kind != SurfaceKind::kWall) continue;
      if (a.plane.n.dot(b.plane.n) < 0.95) continue;
      const Eigen::Vector2d along = (a.end - a.start).normalized();
      const double from = std::max(0.0, along.dot(b.start - a.start)), to = std::min(a.length_m(), along.dot(b.end - a.start));
      const Eigen::Vector3d middle = Eigen::Vector3d(b.start.x() + b.end.x(), b.start.y() + b.end.y(), b.z_min_m + b.z_max_m) / 2;
      EXPECT_FALSE(to - from > 0.3 && std::abs(a.plane.SignedDistance(middle)) < 0.04) << "surfaces " << a.id << " and " << b.id;
    }
  }
}

TEST(MappedHouse, SameInputSameMap) {
  const auto map = [] {
    const test::SyntheticLidar lidar(test::MakeHouse());
    const test::Drive drive = test::HouseDrive();
    Mapper mapper;
    for (double t = 0; t < 5; t += 0.5) {
      const Eigen::Isometry3d T = drive.At(t);
      Scan scan = lidar.Sweep([&](double) { return T; }, t);
      scan.time_s.clear();
      mapper.AddScan(scan, T);
    }
    mapper.Flush();
    return mapper.graph();
  };
  const SGraph a = map(), b = map();
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  ASSERT_GT(a.surfaces.size(), 4u);
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    EXPECT_EQ(a.surfaces[i].plane.n, b.surfaces[i].plane.n);
    EXPECT_EQ(a.surfaces[i].plane.d, b.surfaces[i].plane.d);
    EXPECT_EQ(a.surfaces[i].start, b.surfaces[i].start);
    EXPECT_EQ(a.surfaces[i].area_m2, b.surfaces[i].area_m2);
  }
}

TEST(MappedHouse, ThinWallKeepsTwoFaces) {
  const AGraph house = test::MakeHouse();
  const MapSurface* south = MainOn(House(), house.surfaces[2]);  // of room A's north wall
  const MapSurface* north = MainOn(House(), house.surfaces[4]);  // of the same wall, in room B
  ASSERT_NE(south, nullptr);
  ASSERT_NE(north, nullptr);
  EXPECT_LT(south->plane.n.dot(north->plane.n), -0.999);
  const Plane south_plan = south->plane.Transformed(House().T_plan_map), north_plan = north->plane.Transformed(House().T_plan_map);
  const Eigen::Vector3d inside(1.5, 3.5, 1.0);
  EXPECT_LT(south_plan.SignedDistance(inside), 0);
  EXPECT_LT(north_plan.SignedDistance(inside), 0);
  EXPECT_NEAR(-south_plan.SignedDistance(inside) - north_plan.SignedDistance(inside), 0.12, 0.01);
}

TEST(MappedHouse, ExtentsStayWithinTheWall) {
  const AGraph house = test::MakeHouse();
  const Surface& planned = house.surfaces[2];
  const MapSurface* s = MainOn(House(), planned);
  ASSERT_NE(s, nullptr);
  EXPECT_NEAR((House().T_plan_map * Eigen::Vector3d(s->end.x(), s->end.y(), 0)).x(), planned.end.x(), 0.15);
  // Free space on the left.
  const Eigen::Vector2d along = (s->end - s->start).normalized();
  EXPECT_GT(Eigen::Vector2d(-along.y(), along.x()).dot(s->plane.n.head<2>()), 0.999);
  EXPECT_NEAR((House().T_plan_map * Eigen::Vector3d(0, 0, s->z_max_m)).z(), 2.6, 0.15);
}

TEST(MappedHouse, FindsTheFloor) {
  const MapSurface* floor = nullptr;
  for (const MapSurface& s : House().graph.surfaces) {
    if (s.kind == SurfaceKind::kFloor && (floor == nullptr || s.num_points > floor->num_points)) floor = &s;
  }
  ASSERT_NE(floor, nullptr);
  EXPECT_GT(floor->area_m2, 20);
  EXPECT_GT(floor->plane.n.z(), 0.999);
  EXPECT_NEAR((House().T_plan_map * Eigen::Vector3d(0, 0, floor->z_min_m)).z(), 0, 0.03);
}

TEST(MappedHouse, StatisticsReproduceThePlane) {
  const SGraph& graph = House().graph;
  for (const MapSurface& s : graph.surfaces) {
    if (s.observations.empty()) continue;
    PlaneStats sum;
    for (const Observation& o : s.observations) sum.Add(o.stats.Transformed(graph.keyframes[o.keyframe].T_map_kf));
    EXPECT_NEAR(sum.count(), s.num_points, 0.5);
    EXPECT_NEAR(s.plane.SignedDistance(sum.centroid()), 0, 1e-6);
    EXPECT_NEAR(s.plane.n.norm(), 1, 1e-9);
    EXPECT_TRUE(
        std::is_sorted(s.observations.begin(), s.observations.end(), [](const auto& a, const auto& b) { return a.keyframe < b.keyframe; }));
  }
}

}  // namespace
}  // namespace plumb::runtime
