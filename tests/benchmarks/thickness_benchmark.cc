// How thick the walls of a real building come out in the map that is made without its plan, beside the same scans laid by reference poses.
//   thickness_benchmark REC POSES.tum
// POSES: the lidar's, in any frame; scans that they do not cover are left out. One row for each wall of the map of 2 m or more, in the
// order of its points: the points of all scans that lie within 15 cm of it, and their robust sigma (1.4826 times the median distance) about
// the plane that fits them best, by our poses (odometry, mapping, polish) and by the reference's. The last row: the wall that has the
// middle point of all.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mapping/mapper.h"
#include "runtime/mapping/plane_fit.h"
#include "runtime/odometry/odometry.h"
#include "runtime/optimization/map_polish.h"
#include "runtime/sources/recording.h"

namespace {

using namespace plumb;
using namespace plumb::runtime;

constexpr double kMinLength_m = 2.0, kBand_m = 0.15, kTrim = 3.0;
constexpr size_t kMinPoints = 500;
constexpr int kRefits = 5;

struct PlacedScan {
  size_t keyframe = 0;
  Eigen::Isometry3d T_odom_lidar, T_reference_lidar;
  std::vector<Eigen::Vector3f> points;
};

struct WallPoints {
  std::vector<Eigen::Vector3d> ours, reference;
};

// Robust sigma about the plane of those points that are within kTrim of it. They are not many where a wall is not plane.
double Thickness_m(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& towards) {
  PlaneStats stats;
  for (const Eigen::Vector3d& p : points) stats.Add(p);
  double sigma_m = 0;
  for (int i = 0; i < kRefits; ++i) {
    const Plane plane = FitPlane(stats, towards).plane;
    std::vector<double> distances_m;
    for (const Eigen::Vector3d& p : points) distances_m.push_back(std::abs(plane.SignedDistance(p)));
    const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
    std::nth_element(distances_m.begin(), middle, distances_m.end());
    sigma_m = 1.4826 * *middle;
    stats = {};
    for (const Eigen::Vector3d& p : points) {
      if (std::abs(plane.SignedDistance(p)) <= kTrim * sigma_m) stats.Add(p);
    }
  }
  return sigma_m;
}

bool Drive(const Recording& recording, const Trajectory& reference, Mapper& mapper, std::vector<PlacedScan>& scans) {
  Odometry odometry;
  for (size_t i = 0; i < recording.size(); ++i) {
    const auto scan = recording.Read(i);
    if (!scan) continue;
    const OdometryResult r = odometry.Register(*scan, std::nullopt);
    if (!r.ok) continue;
    mapper.AddScan(r.deskewed, r.T_odom_lidar, std::nullopt, !scan->time_s.empty());
    const size_t keyframes = mapper.graph().keyframes.size();
    // As far apart as a recording's scans may be.
    if (const auto at = InterpolatePose(reference, scan->stamp_s, 2.0))
      scans.push_back({keyframes > 0 ? keyframes - 1 : 0, r.T_odom_lidar, *at, r.deskewed.points});
  }
  mapper.Flush();
  if (const PolishResult polished = PolishMap(mapper.graph()); polished.usable) {
    for (size_t i = 0; i < polished.T_map_kf.size(); ++i) mapper.mutable_graph().keyframes[i].T_map_kf = polished.T_map_kf[i];
    mapper.OnPosesChanged(true);
  }
  return !scans.empty() && !mapper.graph().keyframes.empty();
}

WallPoints PointsOn(const MapSurface& wall, const std::vector<Keyframe>& keyframes, const std::vector<PlacedScan>& scans) {
  WallPoints out;
  const Eigen::Vector2d along = (wall.end - wall.start).normalized();
  for (const PlacedScan& scan : scans) {
    const Keyframe& keyframe = keyframes[scan.keyframe];
    const Eigen::Isometry3d T_map_lidar = keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * scan.T_odom_lidar;
    if (wall.plane.SignedDistance(T_map_lidar.translation()) <= 0) continue;
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = T_map_lidar * point.cast<double>();
      const double at_m = along.dot(p.head<2>() - wall.start);
      if (std::abs(wall.plane.SignedDistance(p)) > kBand_m || at_m < 0 || at_m > wall.length_m() || p.z() < wall.z_min_m ||
          p.z() > wall.z_max_m)
        continue;
      out.ours.push_back(p);
      out.reference.emplace_back(scan.T_reference_lidar * point.cast<double>());
    }
  }
  return out;
}

struct Row {
  size_t points = 0;
  double length_m = 0, ours_m = 0, reference_m = 0;
  void Print(const std::string& name) const {
    fmt::print("{:<8} {:>9} {:>9.1f} {:>9.2f} {:>13.2f}\n", name, points, length_m, 100 * ours_m, 100 * reference_m);
  }
};

// The value of the row that has the middle point.
double MiddleOf(std::vector<Row> rows, double Row::*value) {
  std::sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return a.*value < b.*value; });
  size_t all = 0, so_far = 0;
  for (const Row& row : rows) all += row.points;
  for (const Row& row : rows) {
    so_far += row.points;
    if (2 * so_far >= all) return row.*value;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: thickness_benchmark REC POSES.tum\n");
    return 2;
  }
  const auto recording = Recording::Open(argv[1]);
  const auto reference = ReadTum(argv[2]);
  Mapper mapper;
  std::vector<PlacedScan> scans;
  if (!recording || !reference || !Drive(*recording, *reference, mapper, scans)) {
    fmt::print(stderr, "no scans with poses in `{}` and `{}`\n", argv[1], argv[2]);
    return 2;
  }
  std::vector<Row> rows;
  for (const MapSurface& wall : mapper.graph().surfaces) {
    if (wall.kind != SurfaceKind::kWall || wall.observations.size() < 2 || wall.length_m() < kMinLength_m) continue;
    const WallPoints points = PointsOn(wall, mapper.graph().keyframes, scans);
    if (points.ours.size() < kMinPoints) continue;
    rows.push_back(
        {points.ours.size(), wall.length_m(), Thickness_m(points.ours, wall.plane.n), Thickness_m(points.reference, wall.plane.n)});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.points > b.points; });
  fmt::print("{:<8} {:>9} {:>9} {:>9} {:>13}\n", "wall", "points", "long m", "ours cm", "reference cm");
  for (size_t i = 0; i < rows.size(); ++i) rows[i].Print(std::to_string(i + 1));
  Row middle{0, 0, MiddleOf(rows, &Row::ours_m), MiddleOf(rows, &Row::reference_m)};
  for (const Row& row : rows) {
    middle.points += row.points;
    middle.length_m += row.length_m;
  }
  middle.Print("all");
}
