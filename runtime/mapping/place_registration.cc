#include "runtime/mapping/place_registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {
namespace {

constexpr double kVoxel_m = 0.5;
constexpr size_t kMapPoints = 6000, kPoints = 3000, kCoarsePoints = 500;  // of each keyframe of the place; of the newer one
constexpr int kCoarseIterations = 8;
constexpr double kStartSigmas = 2.0;
constexpr int kMaxRings = 2, kMaxTurns = 2;                     // of starts, either side
constexpr double kStill = 1e-8;                                 // variance of a motion during the sweep: keyframes have none
constexpr double kLeastSigma_m = 0.05, kLeastSigma_rad = 0.02;  // however sure the prediction is, the points decide

// Of the older way about the place, apart from each other, in order.
std::vector<uint32_t> Around(const std::vector<Keyframe>& keyframes, uint32_t place, double before_m,
                             const PlaceRegistrationOptions& options) {
  std::vector<uint32_t> out;
  const double at_m = keyframes[place].travelled_m;
  double last_m = -std::numeric_limits<double>::infinity();
  for (const Keyframe& k : keyframes) {
    if (k.travelled_m > std::min(before_m, at_m + options.submap_way_m)) break;
    if (k.merged || k.travelled_m < at_m - options.submap_way_m) continue;
    if (k.id != place && (k.travelled_m - last_m < options.keyframe_spacing_m)) continue;
    last_m = k.travelled_m;
    out.push_back(k.id);
  }
  return out;
}

void Insert(const Keyframe& keyframe, const Eigen::Isometry3d& T_place_kf, SurfelMap* map) {
  const std::vector<Keyframe::Standpoint>& standpoints = keyframe.standpoints;
  const size_t step = keyframe.points.size() / kMapPoints + 1;
  size_t stand = 0;
  Eigen::Vector3d sensor = T_place_kf.translation();
  for (size_t i = 0; i < keyframe.points.size(); i += step) {
    for (; stand < standpoints.size() && standpoints[stand].first_point <= i; ++stand) {
      sensor = T_place_kf * standpoints[stand].sensor.cast<double>();
    }
    map->Insert(T_place_kf * keyframe.points[i].cast<double>(), sensor);
  }
  map->EndScan();
}

std::vector<SweepPoint> Thinned(const std::vector<Eigen::Vector3f>& points, size_t count) {
  std::vector<SweepPoint> out;
  const size_t step = points.size() / count + 1;
  for (size_t i = 0; i < points.size(); i += step) out.push_back({points[i].cast<double>(), 0});
  return out;
}

// T among others about it, nearest first, so that of equally good ones it wins.
std::vector<Eigen::Isometry3d> Starts(const Eigen::Isometry3d& T, const Matrix6d& covariance, const PlaceRegistrationOptions& options) {
  const auto steps = [](double sigma, double basin, int most) {
    return std::clamp(static_cast<int>(std::ceil((kStartSigmas * sigma - basin) / (2 * basin))), 0, most);
  };
  const double sigma_m = std::sqrt(std::max(covariance(3, 3), covariance(4, 4)));
  const int rings = steps(sigma_m, options.basin_m, kMaxRings);
  const int turns = steps(std::sqrt(covariance(2, 2)), options.basin_rad, kMaxTurns);
  struct Shift {
    int x, y, yaw;
    [[nodiscard]] int Size() const { return x * x + y * y + yaw * yaw; }
  };
  std::vector<Shift> shifts;
  for (int x = -rings; x <= rings; ++x) {
    for (int y = -rings; y <= rings; ++y) {
      for (int yaw = -turns; yaw <= turns; ++yaw) shifts.push_back({x, y, yaw});
    }
  }
  std::stable_sort(shifts.begin(), shifts.end(), [](const Shift& a, const Shift& b) { return a.Size() < b.Size(); });
  std::vector<Eigen::Isometry3d> out;
  for (const Shift& shift : shifts) {
    Eigen::Isometry3d start = T;
    start.linear() = Eigen::AngleAxisd(2 * options.basin_rad * shift.yaw, Eigen::Vector3d::UnitZ()) * T.linear();
    start.translation() += 2 * options.basin_m * Eigen::Vector3d(shift.x, shift.y, 0);
    out.push_back(start);
  }
  return out;
}

SweepPrior PriorAt(const Eigen::Isometry3d& T, const Matrix6d& covariance) {
  SweepPrior prior;
  prior.mean = {T, T};
  prior.covariance = kStill * Matrix12d::Identity();
  prior.covariance.topLeftCorner<6, 6>() = covariance;
  prior.covariance.diagonal().head<3>().array() += kLeastSigma_rad * kLeastSigma_rad;
  prior.covariance.diagonal().segment<3>(3).array() += kLeastSigma_m * kLeastSigma_m;
  return prior;
}

}  // namespace

PlaceRegistration RegisterToPlace(const std::vector<Keyframe>& keyframes, uint32_t place, uint32_t keyframe, const Matrix6d& covariance,
                                  double min_way_m, const PlaceRegistrationOptions& options) {
  const Keyframe& newer = keyframes[keyframe];
  const Eigen::Isometry3d T_place_map = keyframes[place].T_map_kf.inverse();
  SurfelMapOptions surfels;
  surfels.voxel_m = kVoxel_m;
  surfels.range_sigma_m = options.range_sigma_m;
  surfels.max_rms_m = 1.75 * options.range_sigma_m;
  surfels.min_minor_m = 2 * options.range_sigma_m;
  SurfelMap map(surfels);
  for (const uint32_t i : Around(keyframes, place, newer.travelled_m - 0.5 * min_way_m, options)) {
    Insert(keyframes[i], T_place_map * keyframes[i].T_map_kf, &map);
  }
  RegistrationOptions registration;
  registration.range_sigma_m = options.range_sigma_m;
  registration.degenerate_ratio = options.degenerate_ratio;
  registration.initial_kernel_m = 2 * options.basin_m;
  registration.search_neighbours = true;
  const std::vector<Eigen::Isometry3d> starts = Starts(T_place_map * newer.T_map_kf, covariance, options);
  Eigen::Isometry3d best = starts.front();
  if (starts.size() > 1) {
    RegistrationOptions coarse = registration;
    coarse.max_iterations = kCoarseIterations;
    const std::vector<SweepPoint> few = Thinned(newer.points, kCoarsePoints);
    int most = -1;
    for (const Eigen::Isometry3d& start : starts) {
      const RegistrationResult r = RegisterSweep(few, false, map, PriorAt(start, covariance), coarse);
      if (r.num_inliers <= most) continue;
      most = r.num_inliers;
      best = r.motion.T_start;
    }
    registration.initial_kernel_m = 0.5 * options.basin_m;
  }
  const RegistrationResult r = RegisterSweep(Thinned(newer.points, kPoints), false, map, PriorAt(best, covariance), registration);
  return {r.ok, r.motion.T_start, r.information, r.num_held, r.num_inliers, r.inlier_ratio, r.overlap_ratio};
}

}  // namespace plumb::runtime
