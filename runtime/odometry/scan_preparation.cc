#include "runtime/odometry/scan_preparation.h"

#include <algorithm>
#include <cmath>

#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kMinSweep_s = 1e-3, kMaxSweep_s = 2.0;  // outside, the times are in other units or broken
constexpr double kShellsPerOctave = 2.0;
constexpr double kSameTime = 0.05;  // of a sweep: what comes by a patch again was seen from elsewhere

// Key of the patch of the sphere: the point is drawn to its range shell along the ray, then put into cubes there.
uint64_t PatchKey(const Eigen::Vector3d& p, double range_m, double spacing_m) {
  const double shell = std::floor(kShellsPerOctave * std::log2(range_m));
  const double shell_range_m = std::exp2(shell / kShellsPerOctave);
  const Eigen::Vector3d on_shell = p * (shell_range_m / (range_m * spacing_m));
  // Shells have cubes of their own: without the shift the outermost of one shell might share one with the next shell's.
  return VoxelKey(on_shell) ^ static_cast<uint64_t>(static_cast<int64_t>(shell)) * 0xd6e8feb86659fd93u;
}

bool UsableTimes(const Scan& scan, double* sweep_s) {
  if (scan.time_s.size() != scan.points.size() || scan.time_s.empty()) return false;
  float last_s = 0;
  for (const float t : scan.time_s) {
    if (t < -1e-3f) return false;  // recordings give the stamp of the first point
    if (std::isfinite(t)) last_s = std::max(last_s, t);
  }
  *sweep_s = last_s;
  return last_s >= kMinSweep_s && last_s <= kMaxSweep_s;
}

void TakeIntoMean(const Eigen::Vector3d& p, double s, double mean_depth_m, SweepPoint* mean) {
  if (std::abs(s - mean->s) > kSameTime || std::abs(p.norm() - mean->p.norm()) > mean_depth_m) return;
  mean->count += 1;
  mean->p += (p - mean->p) / mean->count;
  mean->s += (s - mean->s) / mean->count;
}

}  // namespace

SweepPoses::SweepPoses(const SweepMotion& motion) {
  for (int k = 0; k <= kKnots; ++k) T_[k] = Interpolate(motion.T_start, motion.T_end, static_cast<double>(k) / kKnots);
}

PreparedScan PrepareScan(const Scan& scan, double spacing_m, double min_range_m, double max_range_m, double mean_depth_m) {
  PreparedScan out;
  double sweep_s = 0;
  const bool timed = UsableTimes(scan, &sweep_s);
  if (timed) out.sweep_s = sweep_s;
  const bool with_intensity = scan.intensity.size() == scan.points.size();
  const bool with_ring = scan.ring.size() == scan.points.size();
  out.scan.stamp_s = scan.stamp_s;
  out.scan.points.reserve(scan.points.size());
  VoxelIndex patches(scan.points.size() / 4);
  const double min_range2_m2 = min_range_m * min_range_m, max_range2_m2 = max_range_m * max_range_m;
  for (size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d p = scan.points[i].cast<double>();
    const double range2_m2 = p.squaredNorm();
    if (!(range2_m2 >= min_range2_m2 && range2_m2 <= max_range2_m2)) continue;  // NaN fails too
    if (timed && !std::isfinite(scan.time_s[i])) continue;
    out.scan.points.push_back(scan.points[i]);
    if (with_intensity) out.scan.intensity.push_back(scan.intensity[i]);
    if (with_ring) out.scan.ring.push_back(scan.ring[i]);
    if (timed) out.scan.time_s.push_back(scan.time_s[i]);
    const double range_m = std::sqrt(range2_m2);
    const auto [patch, is_new] = patches.Insert(PatchKey(p, range_m, spacing_m));
    const double s = out.Fraction(out.scan.points.size() - 1);
    if (is_new) {
      out.points.push_back({p, s});
    } else if (mean_depth_m > 0) {
      TakeIntoMean(p, s, mean_depth_m, &out.points[patch]);
    }
  }
  return out;
}

Scan Deskew(const PreparedScan& prepared, const SweepMotion& motion) {
  Scan out = prepared.scan;
  if (prepared.sweep_s <= 0) return out;
  const SweepPoses poses({Eigen::Isometry3d::Identity(), motion.T_start.inverse() * motion.T_end});
  for (size_t i = 0; i < out.points.size(); ++i) {
    out.points[i] = poses.Apply(prepared.scan.points[i].cast<double>(), prepared.Fraction(i)).cast<float>();
  }
  return out;
}

}  // namespace plumb::runtime
