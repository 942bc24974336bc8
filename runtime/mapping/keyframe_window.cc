#include "runtime/mapping/keyframe_window.h"

#include <algorithm>
#include <limits>

#include "runtime/odometry/scan_preparation.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kSurfelVoxel_m = 0.4;
constexpr double kSpacing_m = 0.05;           // of the points that surfels are made of
constexpr double kMinMinor_m = 0.07;
constexpr size_t kMaxWindowPoints = 1500000;  // 18 MB; beyond, further scans only tell where planes are

SurfelMapOptions WindowSurfels(const MapperOptions& options) {
  SurfelMapOptions surfels;
  surfels.voxel_m = kSurfelVoxel_m;
  surfels.range_sigma_m = 2.0 / 3.0 * options.plane_sigma_m;
  surfels.max_rms_m = 0.9 * options.plane_sigma_m;  // of few points; steps of 5 cm inside a surfel exceed it
  surfels.min_minor_m = kMinMinor_m;
  surfels.max_points = std::numeric_limits<double>::infinity();
  return surfels;
}

}  // namespace

KeyframeWindow::KeyframeWindow(const MapperOptions& options, double stamp_s, const Eigen::Isometry3d& T_odom_kf)
    : options_(options), stamp_s_(stamp_s), T_odom_kf_(T_odom_kf), surfels_(WindowSurfels(options)) {}

void KeyframeWindow::Add(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar, bool planar, const Smear& smear) {
  planar_ = planar;
  const PreparedScan prepared = PrepareScan(deskewed, kSpacing_m, options_.min_range_m, options_.max_range_m);
  const Eigen::Isometry3d T_kf_lidar = T_odom_kf_.inverse() * T_odom_lidar;
  smear_.Cover(smear.Rotated(T_kf_lidar.linear()));
  View view;
  view.sensor = T_kf_lidar.translation();
  if (!planar) {
    for (const SweepPoint& point : prepared.points) surfels_.Insert(T_kf_lidar * point.p, view.sensor);
    surfels_.EndScan();
  }
  if (num_points_ + prepared.scan.points.size() > kMaxWindowPoints) return;
  num_points_ += prepared.scan.points.size();
  const Eigen::Isometry3f T = T_kf_lidar.cast<float>();
  view.points.reserve(prepared.scan.points.size());
  for (const Eigen::Vector3f& p : prepared.scan.points) view.points.push_back(T * p);
  views_.push_back(std::move(view));
}

ThinnedPoints KeyframeWindow::Thinned() const {
  struct Sight {
    Eigen::Vector3f point;
    const View* view;
  };
  std::vector<Sight> sights;
  VoxelIndex voxels(16384);
  for (const View& view : views_) {
    for (const Eigen::Vector3f& p : view.points) {
      if (voxels.Insert(VoxelKey(p.cast<double>() / options_.keyframe_voxel_m)).second) sights.push_back({p, &view});
    }
  }
  const size_t step = sights.size() / static_cast<size_t>(options_.max_keyframe_points) + 1;
  ThinnedPoints out;
  out.points.reserve((sights.size() + step - 1) / step);  // kept for as long as the map: no more than that
  const View* last = nullptr;
  for (size_t i = 0; i < sights.size(); i += step) {
    if (sights[i].view != last) out.standpoints.push_back({static_cast<uint32_t>(out.points.size()), sights[i].view->sensor.cast<float>()});
    last = sights[i].view;
    out.points.push_back(sights[i].point);
  }
  return out;
}

}  // namespace plumb::runtime
