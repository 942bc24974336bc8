#include "tests/support/synthetic_sgraph.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schema/polygon.h"
#include "runtime/coupling/wall_frame.h"
#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::test {
namespace {

using runtime::MapSurface;
using runtime::SurfaceKind;

constexpr double kSensorHeight_m = 1.0, kStep_m = 0.5;

Eigen::Isometry3d UprightPose(const Eigen::Vector2d& at, double yaw_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << at, kSensorHeight_m;
  return T;
}

std::vector<Eigen::Isometry3d> Path() {
  const std::vector<Eigen::Vector2d> corners{{1.5, 1.0},  {3.8, 1.0}, {3.8, 2.75}, {6.2, 2.75}, {6.2, 1.2},
                                             {8.0, 1.2},  {8.0, 4.8}, {6.2, 4.8},  {6.2, 2.75}, {2.45, 2.75},
                                             {2.45, 4.8}, {1.0, 4.8}, {4.0, 4.8},  {2.45, 4.8}, {2.45, 1.5}};
  std::vector<Eigen::Isometry3d> poses;
  for (size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d leg = corners[i + 1] - corners[i];
    const int steps = static_cast<int>(std::ceil(leg.norm() / kStep_m));
    for (int k = 0; k < steps; ++k) poses.push_back(UprightPose(corners[i] + leg * k / steps, std::atan2(leg.y(), leg.x())));
  }
  return poses;
}

// A point of the plan on a wall's face, where the built wall has it.
struct BuiltFace {
  runtime::WallFrame frame;
  runtime::WallDeviation deviation;
  Eigen::Vector3d normal;   // built
  double half_thickness_error_m;
  Eigen::Vector3d At(const Eigen::Vector3d& planned) const {
    return frame.pivot + Eigen::AngleAxisd(deviation.yaw_rad, Eigen::Vector3d::UnitZ()) * (planned - frame.pivot) +
           deviation.offset_m * frame.normal + half_thickness_error_m * normal;
  }
};

void SetGeometry(const runtime::SGraph& map, MapSurface& s, const std::vector<Eigen::Vector3d>& points) {
  runtime::PlaneStats all;
  for (const auto& p : points) all.Add(p);
  const Eigen::Matrix3d scatter = all.C.topLeftCorner<3, 3>() / all.count() - all.centroid() * all.centroid().transpose();
  Eigen::Vector3d n = runtime::EigenOf(scatter).vectors.col(0);
  if (n.dot(map.keyframes[s.observations.front().keyframe].T_map_kf.translation() - all.centroid()) < 0) n = -n;
  s.plane = {n, -n.dot(all.centroid())};
  s.num_points = all.count();
  if (s.kind != SurfaceKind::kWall) return;
  const Eigen::Vector2d along = Eigen::Vector2d(n.y(), -n.x()).normalized(), c = all.centroid().head<2>();  // free space to its left
  double lo = 1e9, hi = -1e9;
  s.z_min_m = 1e9, s.z_max_m = -1e9;
  for (const auto& p : points) {
    lo = std::min(lo, along.dot(p.head<2>() - c));
    hi = std::max(hi, along.dot(p.head<2>() - c));
    s.z_min_m = std::min(s.z_min_m, p.z());
    s.z_max_m = std::max(s.z_max_m, p.z());
  }
  s.start = c + lo * along;
  s.end = c + hi * along;
  s.area_m2 = (hi - lo) * (s.z_max_m - s.z_min_m);
  FillCells(s);
}

// Adds one map surface; `sample` returns a seen point in the plan frame, views are the keyframes that see it.
template <class Sample>
void AddSurface(Drive& drive, SurfaceKind kind, SurfaceId built, const std::vector<size_t>& views, int points_per_view, Sample sample) {
  if (views.empty()) return;
  MapSurface s;
  s.id = static_cast<uint32_t>(drive.map.surfaces.size());
  s.kind = kind;
  std::vector<Eigen::Vector3d> points;
  for (size_t k : views) {
    runtime::Observation o;
    o.keyframe = static_cast<uint32_t>(k);
    for (int i = 0; i < points_per_view; ++i) {
      const Eigen::Vector3d p = drive.T_plan_kf[k].inverse() * sample(k);
      o.stats.Add(p);
      points.push_back(drive.map.keyframes[k].T_map_kf * p);
    }
    s.observations.push_back(o);
  }
  SetGeometry(drive.map, s, points);
  drive.map.surfaces.push_back(s);
  drive.built.push_back(built);
}

void AddKeyframes(Drive& drive, const DriveOptions& options, Random& random) {
  Eigen::Isometry3d T_odom = Eigen::Isometry3d::Identity();
  for (size_t k = 0; k < drive.T_plan_kf.size(); ++k) {
    if (k > 0) {
      Eigen::Isometry3d step = drive.T_plan_kf[k - 1].inverse() * drive.T_plan_kf[k];
      step.translation() +=
          Eigen::Vector3d(random.Normal(options.drift_m), random.Normal(options.drift_m), random.Normal(0.3 * options.drift_m));
      const auto tilt = [&] { return random.Normal(0.2 * options.drift_rad); };
      step.rotate(Eigen::AngleAxisd(random.Normal(options.drift_rad), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(tilt(), Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(tilt(), Eigen::Vector3d::UnitY()));
      T_odom = T_odom * step;
    }
    runtime::Keyframe kf;
    kf.id = static_cast<uint32_t>(k);
    kf.stamp_s = static_cast<double>(k);
    kf.T_odom_kf = kf.T_map_kf = T_odom;
    drive.map.keyframes.push_back(kf);
  }
}

std::vector<size_t> KeyframesIn(const Drive& drive, const Room& room) {
  std::vector<size_t> out;
  for (size_t k = 0; k < drive.T_plan_kf.size(); ++k) {
    if (Contains(room, drive.T_plan_kf[k].translation().head<2>())) out.push_back(k);
  }
  return out;
}

}  // namespace

uint64_t Random::Next() {  // splitmix64
  uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
double Random::Uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(Next() >> 11) * 0x1.0p-53; }
double Random::Normal(double sigma) {
  const double u = Uniform(1e-12, 1.0), v = Uniform(0.0, 2 * std::numbers::pi);
  return sigma * std::sqrt(-2 * std::log(u)) * std::cos(v);
}

void FillCells(MapSurface& s) {
  constexpr double kCell_m = 0.1;
  s.cells.clear();
  for (double u = 0.5 * kCell_m; u < s.length_m(); u += kCell_m) {
    for (double z = s.z_min_m + 0.5 * kCell_m; z < s.z_max_m; z += kCell_m)
      s.cells.emplace_back(static_cast<float>(u), static_cast<float>(z));
  }
}

Drive DriveThroughHouse(const AGraph& house, const DriveOptions& options) {
  Drive drive;
  Random random(options.seed);
  drive.T_plan_kf = Path();
  drive.T_plan_map = drive.T_plan_kf.front();
  AddKeyframes(drive, options, random);
  const std::vector<runtime::WallFrame> frames = runtime::WallFrames(house);
  for (const Room& room : house.rooms) {
    const std::vector<size_t> views = KeyframesIn(drive, room);
    for (SurfaceId id : room.surfaces) {
      const Surface& s = house.surfaces[id.index()];
      BuiltFace face{frames[s.wall.index()], {}, s.normal, 0};
      if (s.wall.index() < options.thickness_errors_m.size())
        face.half_thickness_error_m = 0.5 * options.thickness_errors_m[s.wall.index()];
      if (s.wall.index() < options.deviations.size()) face.deviation = options.deviations[s.wall.index()];
      face.normal = Eigen::AngleAxisd(face.deviation.yaw_rad, Eigen::Vector3d::UnitZ()) * s.normal;
      std::vector<size_t> in_front = views;  // a keyframe in a doorway does not see the wall it stands in
      const Eigen::Vector3d on_face = face.At({s.midpoint().x(), s.midpoint().y(), 1});
      std::erase_if(in_front, [&](size_t k) { return face.normal.dot(drive.T_plan_kf[k].translation() - on_face) < 0.3; });
      AddSurface(drive, SurfaceKind::kWall, id, in_front, options.points_per_view, [&](size_t) {
        const Eigen::Vector2d xy = s.start + random.Uniform(0.05, 0.95) * (s.end - s.start);
        return Eigen::Vector3d(face.At({xy.x(), xy.y(), random.Uniform(0.3, 1.9)}) +
                               (options.range_bias_m + random.Normal(options.noise_m)) * face.normal);
      });
    }
    if (!options.floors) continue;
    AddSurface(drive, SurfaceKind::kFloor, SurfaceId(), views, options.points_per_view, [&](size_t k) {
      const Eigen::Vector3d at = drive.T_plan_kf[k].translation();
      const double angle = random.Uniform(0, 2 * std::numbers::pi), radius = random.Uniform(0.5, 1.5);
      return Eigen::Vector3d(at.x() + radius * std::cos(angle), at.y() + radius * std::sin(angle),
                             room.floor_z_m + random.Normal(options.noise_m));
    });
  }
  return drive;
}

void AddPatch(Drive& drive, const Eigen::Vector2d& start, const Eigen::Vector2d& end, double z_min_m, double z_max_m, double range_m,
              uint64_t seed) {
  Random random(seed);
  const Eigen::Vector2d along = (end - start).normalized(), normal(-along.y(), along.x());
  std::vector<size_t> views;
  for (size_t k = 0; k < drive.T_plan_kf.size(); ++k) {
    const Eigen::Vector2d to = drive.T_plan_kf[k].translation().head<2>() - 0.5 * (start + end);
    if (to.norm() < range_m && normal.dot(to) > 0.3) views.push_back(k);
  }
  AddSurface(drive, SurfaceKind::kWall, SurfaceId(), views, 100, [&](size_t) {
    const Eigen::Vector2d p = start + random.Uniform(0, 1) * (end - start) + random.Normal(0.02) * normal;
    return Eigen::Vector3d(p.x(), p.y(), random.Uniform(z_min_m, z_max_m));
  });
}

Eigen::Isometry3d Disturbed(const Eigen::Isometry3d& T_plan_map, double dx_m, double dy_m, double dyaw_rad) {
  return Eigen::Translation3d(dx_m, dy_m, 0) * T_plan_map * Eigen::AngleAxisd(dyaw_rad, Eigen::Vector3d::UnitZ());
}

}  // namespace plumb::test
