#include "runtime/mapping/keyframe_window.h"

#include <algorithm>
#include <array>
#include <limits>

#include "runtime/odometry/scan_preparation.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kSurfelVoxel_m = 0.4;
constexpr double kSpacing_m = 0.05;           // of the points that surfels are made of
constexpr double kMinMinor_m = 0.07;
constexpr size_t kSlices = 8;                 // of a sweep: within one, at 1 m/s, the sensor moves by 1 cm
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

void KeyframeWindow::Add(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar, bool planar, const Smear& smear,
                         const Eigen::Vector3d& velocity_m_s) {
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
  std::array<std::vector<Eigen::Vector3f>, kSlices> slices;
  for (size_t i = 0; i < prepared.scan.points.size(); ++i) {
    slices[static_cast<size_t>(prepared.Fraction(i) * (kSlices - 0.5))].push_back(T * prepared.scan.points[i]);
  }
  const Eigen::Vector3d moved_m = prepared.sweep_s * (T_odom_kf_.linear().transpose() * velocity_m_s);
  view.points.reserve(prepared.scan.points.size());
  for (size_t k = 0; k < kSlices; ++k) {
    if (slices[k].empty()) continue;
    const Eigen::Vector3d sensor = view.sensor + (static_cast<double>(k) + 0.5) / kSlices * moved_m;
    view.standpoints.push_back({static_cast<uint32_t>(view.points.size()), sensor.cast<float>()});
    view.points.insert(view.points.end(), slices[k].begin(), slices[k].end());
  }
  views_.push_back(std::move(view));
}

ThinnedPoints KeyframeWindow::Thinned() const {
  struct Sight {
    Eigen::Vector3f point;
    const Keyframe::Standpoint* from;
  };
  std::vector<Sight> sights;
  VoxelIndex voxels(16384);
  for (const View& view : views_) {
    const Keyframe::Standpoint *from = view.standpoints.data(), *last = from + view.standpoints.size() - 1;
    for (size_t i = 0; i < view.points.size(); ++i) {
      if (from < last && (from + 1)->first_point == i) ++from;
      const Eigen::Vector3f& p = view.points[i];
      if (voxels.Insert(VoxelKey(p.cast<double>() / options_.keyframe_voxel_m)).second) sights.push_back({p, from});
    }
  }
  const size_t step = sights.size() / static_cast<size_t>(options_.max_keyframe_points) + 1;
  ThinnedPoints out;
  out.points.reserve((sights.size() + step - 1) / step);  // kept for as long as the map: no more than that
  const Keyframe::Standpoint* last = nullptr;
  for (size_t i = 0; i < sights.size(); i += step) {
    if (sights[i].from != last) out.standpoints.push_back({static_cast<uint32_t>(out.points.size()), sights[i].from->sensor});
    last = sights[i].from;
    out.points.push_back(sights[i].point);
  }
  return out;
}

}  // namespace plumb::runtime
