#include "tests/support/synthetic_map.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/matching/ray_caster.h"
#include "runtime/numerics/symmetric_eigen.h"
#include "tests/support/random.h"

namespace plumb::test {
namespace {

using runtime::SurfaceKind;

constexpr double kGap_m = 0.5, kMinExtent_m = 0.4;
constexpr size_t kMinPoints = 30;

// Points on one plane of one element, map frame.
struct PlaneHits {
  uint32_t element = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // plan frame
  double d_m = 0;
  std::vector<Eigen::Vector3d> points;
};

PlaneHits& PlaneOf(std::vector<PlaneHits>& planes, uint32_t element, const Eigen::Vector3d& normal, const Eigen::Vector3d& at) {
  const auto known = std::find_if(planes.begin(), planes.end(), [&](const PlaneHits& p) {
    return p.element == element && p.normal.dot(normal) > 0.999 && std::abs(p.normal.dot(at) + p.d_m) < 0.01;
  });
  if (known != planes.end()) return *known;
  planes.push_back({element, normal, -normal.dot(at), {}});
  return planes.back();
}

void AddHorizontal(const PlaneHits& hits, runtime::SGraph& map) {
  runtime::MapSurface s;
  s.kind = hits.normal.z() > 0 ? SurfaceKind::kFloor : SurfaceKind::kCeiling;
  double z = 0;
  for (const Eigen::Vector3d& p : hits.points) z += p.z() / static_cast<double>(hits.points.size());
  s.plane.n = hits.normal.z() > 0 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, 0, -1);
  s.plane.d = -s.plane.n.z() * z;
  s.z_min_m = s.z_max_m = z;
  s.num_points = static_cast<double>(hits.points.size());
  s.id = static_cast<uint32_t>(map.surfaces.size());
  map.surfaces.push_back(s);
}

void AddWallPiece(std::vector<Eigen::Vector3d> points, const Eigen::Vector2d& normal, runtime::SGraph& map) {
  if (points.size() < kMinPoints) return;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p.head<2>() / static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p.head<2>() - mean) * (p.head<2>() - mean).transpose();
  Eigen::Vector2d n = runtime::EigenOf(scatter).vectors.col(0);
  if (n.dot(normal) < 0) n = -n;
  if (n.dot(normal) < 0.9) return;
  const Eigen::Vector2d along(n.y(), -n.x());
  runtime::MapSurface s;
  s.plane.n << n, 0;
  s.plane.d = -n.dot(mean);
  double u0 = 1e9, u1 = -1e9;
  s.z_min_m = 1e9;
  s.z_max_m = -1e9;
  for (const Eigen::Vector3d& p : points) {
    const double u = along.dot(p.head<2>() - mean);
    u0 = std::min(u0, u);
    u1 = std::max(u1, u);
    s.z_min_m = std::min(s.z_min_m, p.z());
    s.z_max_m = std::max(s.z_max_m, p.z());
  }
  if (u1 - u0 < kMinExtent_m) return;
  s.start = mean + u0 * along;
  s.end = mean + u1 * along;
  s.num_points = static_cast<double>(points.size());
  s.area_m2 = (u1 - u0) * (s.z_max_m - s.z_min_m);
  s.id = static_cast<uint32_t>(map.surfaces.size());
  map.surfaces.push_back(s);
}

void AddWallPieces(const PlaneHits& hits, const Eigen::Vector2d& normal, runtime::SGraph& map) {
  const Eigen::Vector2d along(normal.y(), -normal.x());
  std::vector<Eigen::Vector3d> sorted = hits.points;
  std::sort(sorted.begin(), sorted.end(),
            [&](const auto& a, const auto& b) { return along.dot(a.template head<2>()) < along.dot(b.template head<2>()); });
  std::vector<Eigen::Vector3d> piece;
  for (const Eigen::Vector3d& p : sorted) {
    if (!piece.empty() && along.dot(p.head<2>() - piece.back().head<2>()) > kGap_m) {
      AddWallPiece(piece, normal, map);
      piece.clear();
    }
    piece.push_back(p);
  }
  AddWallPiece(piece, normal, map);
}

}  // namespace

Eigen::Isometry3d UprightPose(double yaw_deg, double x, double y, double z) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x, y, z;
  return T;
}

runtime::SGraph MakeSyntheticMap(const AGraph& as_built, const SyntheticMapOptions& options) {
  const runtime::RayCaster caster(as_built.mesh);
  const Eigen::Isometry3d T_map_plan = options.T_plan_map.inverse();
  Random random(options.seed);
  runtime::SGraph map;
  std::vector<PlaneHits> planes;
  for (const Eigen::Vector2d& position : options.positions) {
    runtime::Keyframe keyframe;
    keyframe.id = static_cast<uint32_t>(map.keyframes.size());
    keyframe.stamp_s = keyframe.id;
    const Eigen::Isometry3d T_plan_kf = UprightPose(random.Uniform(-180, 180), position.x(), position.y(), options.sensor_height_m);
    keyframe.T_map_kf = keyframe.T_odom_kf = T_map_plan * T_plan_kf;
    for (int ring = 0; ring < options.rings; ++ring) {
      const double elevation = (-15 + 30.0 * ring / (options.rings - 1)) * std::numbers::pi / 180;
      for (int i = 0; i < options.azimuths; ++i) {
        const double azimuth = 2 * std::numbers::pi * i / options.azimuths;
        const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const Eigen::Vector3d direction = T_plan_kf.linear() * beam;
        const runtime::RayHit hit = caster.Cast({(T_plan_kf.translation() - as_built.origin).cast<float>(), direction.cast<float>(),
                                                 static_cast<float>(options.max_range_m)});
        if (!hit.hit()) continue;
        const Eigen::Vector3d on_plan = T_plan_kf.translation() + hit.range_m * direction;
        const Eigen::Vector3d point = (hit.range_m + random.Normal(options.range_sigma_m)) * beam;
        keyframe.points.push_back(point.cast<float>());
        PlaneOf(planes, as_built.mesh.triangles[hit.triangle].element, hit.normal.cast<double>(), on_plan)
            .points.push_back(keyframe.T_map_kf * point);
      }
    }
    map.keyframes.push_back(std::move(keyframe));
  }
  for (const PlaneHits& hits : planes) {
    if (hits.points.size() < kMinPoints) continue;
    if (std::abs(hits.normal.z()) > 0.9) {
      AddHorizontal(hits, map);
    } else {
      AddWallPieces(hits, (T_map_plan.linear() * hits.normal).head<2>().normalized(), map);
    }
  }
  return map;
}

}  // namespace plumb::test
