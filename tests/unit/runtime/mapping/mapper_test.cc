#include "runtime/mapping/mapper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

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

Mapper MapHouse(const AGraph& house, int rounds, Eigen::Isometry3d* T_plan_map) {
  test::SyntheticLidarOptions options;
  options.azimuths = 900;
  const test::SyntheticLidar lidar(house, options);
  const test::Drive drive = test::HouseDrive(rounds);
  Odometry odometry;
  Mapper mapper;
  for (double t = 0; t + kPeriod_s < drive.duration_s(); t += kPeriod_s) {
    const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s); }, t), std::nullopt);
    if (t == 0) *T_plan_map = drive.At(0) * r.T_odom_lidar.inverse();
    mapper.AddScan(r.deskewed, r.T_odom_lidar);
  }
  mapper.Flush();
  return mapper;
}

// The drive takes seconds to simulate: once for all tests.
const Mapped& House() {
  static const Mapped kMapped = [] {
    Mapped mapped;
    mapped.graph = MapHouse(test::MakeHouse(), 1, &mapped.T_plan_map).graph();
    return mapped;
  }();
  return kMapped;
}

// Map surfaces of kind wall that lie on a plan surface: same facing, within 0.15 m, overlapping by more than half.
std::vector<const MapSurface*> OnPlan(const Mapped& mapped, const Surface& planned) {
  std::vector<const MapSurface*> on;
  for (const MapSurface& s : mapped.graph.surfaces) {
    if (s.observations.empty() || s.kind != SurfaceKind::kWall) continue;
    const Plane plane = s.plane.Transformed(mapped.T_plan_map);
    if (plane.n.dot(planned.normal) < 0.97) continue;
    const Eigen::Vector3d start = mapped.T_plan_map * Eigen::Vector3d(s.start.x(), s.start.y(), s.z_min_m);
    const Eigen::Vector3d end = mapped.T_plan_map * Eigen::Vector3d(s.end.x(), s.end.y(), s.z_min_m);
    const Eigen::Vector3d middle = 0.5 * (start + end);
    if (std::abs(planned.normal.dot(middle) + planned.d_m) > 0.15) continue;
    const Eigen::Vector2d along = (planned.end - planned.start).normalized();
    const double u = along.dot(middle.head<2>() - planned.start);
    if (u > 0 && u < planned.length_m()) on.push_back(&s);
  }
  return on;
}

TEST(Mapper, PRINT) {
  const Mapped& mapped = House();
  const AGraph house = test::MakeHouse();
  std::printf("%zu keyframes, %zu points in the middle one\n", mapped.graph.keyframes.size(), mapped.graph.keyframes[mapped.graph.keyframes.size() / 2].points.size());
  for (const MapSurface& s : mapped.graph.surfaces) {
    if (s.observations.empty()) continue;
    const Plane plane = s.plane.Transformed(mapped.T_plan_map);
    const Eigen::Vector3d a = mapped.T_plan_map * Eigen::Vector3d(s.start.x(), s.start.y(), s.z_min_m), b = mapped.T_plan_map * Eigen::Vector3d(s.end.x(), s.end.y(), s.z_max_m);
    std::printf("%3u kind %d n %.3f %.3f %.3f  (%.2f %.2f)-(%.2f %.2f) z %.2f..%.2f area %.2f obs %zu pts %.0f", s.id, static_cast<int>(s.kind), plane.n.x(), plane.n.y(), plane.n.z(), a.x(), a.y(), b.x(), b.y(), a.z(), b.z(), s.area_m2, s.observations.size(), s.num_points);
    for (size_t k = 0; k < house.surfaces.size(); ++k) {
      const std::vector<const MapSurface*> on = OnPlan(mapped, house.surfaces[k]);
      if (std::find(on.begin(), on.end(), &s) == on.end()) continue;
      const Eigen::Vector3d m(0.5 * (a.x() + b.x()), 0.5 * (a.y() + b.y()), 0.5*(a.z()+b.z()));
      const Eigen::Vector3d m_on = m - plane.SignedDistance(m) * plane.n;
      std::printf(" | plan %zu off %.4f yaw %.3f", k, house.surfaces[k].normal.dot(m_on) + house.surfaces[k].d_m, 57.3 * std::atan2(house.surfaces[k].normal.cross(plane.n).z(), house.surfaces[k].normal.dot(plane.n)));
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace plumb::runtime
