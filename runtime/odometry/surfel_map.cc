#include "runtime/odometry/surfel_map.h"

#include <algorithm>
#include <numeric>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kMinCosIncidence = 0.08;   // flatter rays see a surface too badly to say which side they are on
constexpr double kGateSigmas = 3.0;
constexpr double kSameNormalCos = 0.94;     // 20 degrees
constexpr double kRefitGrowth = 1.15;       // a plane is fitted again when its points have grown by this
constexpr double kGiveUpCount = 150;        // waiting points that span no plane by then never will

int DominantAxis(const Eigen::Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (v[axis] < 0 ? 1 : 0);
}

Eigen::Vector3d TowardsSensor(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor) {
  const Eigen::Vector3d v = sensor - p;
  const double range_m = v.norm();
  return range_m > 0 ? Eigen::Vector3d(v / range_m) : Eigen::Vector3d::UnitZ();
}

}  // namespace

void Surfel::Add(const Eigen::Vector3d& p, const Eigen::Vector3d& view) {
  count += 1;
  const Eigen::Vector3d delta = p - mean;
  mean += delta / count;
  scatter += delta * (p - mean).transpose();
  view_sum += view;
}

void Surfel::Add(const Surfel& other) {
  const double total = count + other.count;
  const Eigen::Vector3d delta = other.mean - mean;
  scatter += other.scatter + delta * delta.transpose() * (count * other.count / total);
  mean += delta * (other.count / total);
  view_sum += other.view_sum;
  count = total;
}

double Surfel::DistanceVariance(const Eigen::Vector3d& p, double range_sigma_m) const {
  const Eigen::Vector3d offset = p - mean;
  const double u = minor.dot(offset), v = major.dot(offset);
  const double noise_m2 = std::max(var_normal_m2, range_sigma_m * range_sigma_m);
  return noise_m2 * (1 + (1 + u * u / var_minor_m2 + v * v / var_major_m2) / count);
}

SurfelMap::SurfelMap(const SurfelMapOptions& options) : options_(options) {
  // An axis and angle for which no coordinate plane comes near a grid plane.
  R_grid_ = Eigen::AngleAxisd(0.65, Eigen::Vector3d(0.9, 0.7, 1.1).normalized()).toRotationMatrix() / options.voxel_m;
}

uint32_t SurfelMap::NewSurfel(uint32_t voxel) {
  Surfel surfel;
  surfel.voxel = voxel;
  surfel.next = heads_[voxel];
  heads_[voxel] = static_cast<uint32_t>(surfels_.size());
  surfels_.push_back(surfel);
  return heads_[voxel];
}

void SurfelMap::Insert(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor) {
  const uint64_t key = VoxelKey(GridPosition(p));
  const auto [voxel, is_new] = index_.Insert(key);
  if (is_new) {
    keys_.push_back(key);
    heads_.push_back(VoxelIndex::kNone);
    last_seen_.push_back(scan_);
  }
  last_seen_[voxel] = scan_;
  const Eigen::Vector3d view = TowardsSensor(p, sensor);
  const int axis = DominantAxis(view);
  uint32_t best = VoxelIndex::kNone, waiting = VoxelIndex::kNone;
  double best_distance_m = std::numeric_limits<double>::infinity();
  for (uint32_t i = heads_[voxel]; i != VoxelIndex::kNone; i = surfels_[i].next) {
    const Surfel& s = surfels_[i];
    if (!s.planar) {
      if (s.view_axis == axis) waiting = i;
      continue;
    }
    if (s.normal.dot(view) < kMinCosIncidence) continue;
    const double distance_m = std::abs(s.SignedDistance(p));
    if (distance_m >= best_distance_m) continue;
    if (distance_m * distance_m > kGateSigmas * kGateSigmas * s.DistanceVariance(p, options_.range_sigma_m)) continue;
    best = i;
    best_distance_m = distance_m;
  }
  if (best != VoxelIndex::kNone && surfels_[best].count >= options_.max_points) return;
  if (best == VoxelIndex::kNone) {
    best = waiting != VoxelIndex::kNone ? waiting : NewSurfel(voxel);
    surfels_[best].view_axis = static_cast<int8_t>(axis);
  }
  surfels_[best].Add(p, view);
  touched_.push_back(best);
}

void SurfelMap::FitPlane(uint32_t index) {
  Surfel& s = surfels_[index];
  s.fitted_count = s.count;
  const SymmetricEigen<3> eigen = RoughEigenOf(s.scatter / s.count);
  const Eigen::Vector3d variances = eigen.values.cwiseMax(1e-12);
  const double noise_m2 = std::max(variances[0], options_.range_sigma_m * options_.range_sigma_m);
  const bool is_plane = std::sqrt(variances[0]) <= options_.max_rms_m && variances[1] >= options_.min_minor_m * options_.min_minor_m &&
                        noise_m2 <= options_.max_normal_sigma_rad * options_.max_normal_sigma_rad * s.count * variances[1];
  if (!s.planar && !is_plane) {
    if (s.count >= kGiveUpCount) {
      s.count = s.fitted_count = 0;
      s.mean.setZero();
      s.scatter.setZero();
      s.view_sum.setZero();
    }
    return;
  }
  const bool was_planar = s.planar;
  const Eigen::Vector3d towards = was_planar ? s.normal : s.view_sum;
  s.planar = true;
  s.normal = eigen.vectors.col(0);
  if (s.normal.dot(towards) < 0) s.normal = -s.normal;
  s.minor = eigen.vectors.col(1);
  s.major = eigen.vectors.col(2);
  s.var_normal_m2 = variances[0];
  s.var_minor_m2 = variances[1];
  s.var_major_m2 = variances[2];
  if (!was_planar) Promote(index);
}

// A new plane of a voxel that already has the same plane goes into that one and leaves an empty surfel waiting.
void SurfelMap::Promote(uint32_t index) {
  Surfel& s = surfels_[index];
  for (uint32_t i = heads_[s.voxel]; i != VoxelIndex::kNone; i = surfels_[i].next) {
    Surfel& other = surfels_[i];
    if (i == index || !other.planar || other.normal.dot(s.normal) < kSameNormalCos) continue;
    const double distance_m = other.SignedDistance(s.mean);
    if (distance_m * distance_m > kGateSigmas * kGateSigmas * other.DistanceVariance(s.mean, options_.range_sigma_m)) continue;
    if (other.count < options_.max_points) other.Add(s);
    Surfel empty;
    empty.voxel = s.voxel;
    empty.next = s.next;
    empty.view_axis = s.view_axis;
    s = empty;
    FitPlane(i);
    return;
  }
}

void SurfelMap::EndScan() {
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const uint32_t i : touched_) {
    const Surfel& s = surfels_[i];
    if (s.count >= options_.min_points && s.count >= kRefitGrowth * s.fitted_count) FitPlane(i);
  }
  touched_.clear();
  ++scan_;
  if (heads_.size() > options_.max_voxels) Forget();
}

const Surfel* SurfelMap::Nearest(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor, bool neighbours) const {
  const Eigen::Vector3d view = TowardsSensor(p, sensor);
  const Surfel* best = nullptr;
  double best_distance_m = std::numeric_limits<double>::infinity();
  const auto search = [&](uint64_t key) {
    const uint32_t voxel = index_.Find(key);
    if (voxel == VoxelIndex::kNone) return;
    for (uint32_t i = heads_[voxel]; i != VoxelIndex::kNone; i = surfels_[i].next) {
      const Surfel& s = surfels_[i];
      if (!s.planar || s.normal.dot(view) < kMinCosIncidence) continue;
      const double distance_m = std::abs(s.SignedDistance(p));
      if (distance_m >= best_distance_m) continue;
      best = &s;
      best_distance_m = distance_m;
    }
  };
  const Eigen::Vector3d g = GridPosition(p);
  search(VoxelKey(g));
  if (!neighbours) return best;
  for (int k = 0; k < 27; ++k) {
    if (k != 13) search(VoxelKey(g + NeighbourOffset(k)));
  }
  return best;
}

void SurfelMap::Around(const Eigen::Vector3d& p, std::vector<uint32_t>* indices) const {
  const Eigen::Vector3d g = GridPosition(p);
  for (int k = 0; k < 27; ++k) {
    const uint32_t voxel = index_.Find(VoxelKey(g + NeighbourOffset(k)));
    if (voxel == VoxelIndex::kNone) continue;
    for (uint32_t i = heads_[voxel]; i != VoxelIndex::kNone; i = surfels_[i].next) {
      if (surfels_[i].planar) indices->push_back(i);
    }
  }
}

// Keeps the three quarters of the voxels seen last; of those equally long unseen, the older ones.
void SurfelMap::Forget() {
  std::vector<uint32_t> order(heads_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return last_seen_[a] > last_seen_[b]; });
  order.resize(options_.max_voxels / 4 * 3);
  std::sort(order.begin(), order.end());
  SurfelMap kept(options_);
  for (const uint32_t old_voxel : order) {
    const uint32_t voxel = kept.index_.Insert(keys_[old_voxel]).first;
    kept.keys_.push_back(keys_[old_voxel]);
    kept.heads_.push_back(VoxelIndex::kNone);
    kept.last_seen_.push_back(last_seen_[old_voxel]);
    for (uint32_t i = heads_[old_voxel]; i != VoxelIndex::kNone; i = surfels_[i].next) {
      Surfel surfel = surfels_[i];
      surfel.voxel = voxel;
      surfel.next = kept.heads_[voxel];
      kept.heads_[voxel] = static_cast<uint32_t>(kept.surfels_.size());
      kept.surfels_.push_back(surfel);
    }
  }
  kept.scan_ = scan_;
  *this = std::move(kept);
}

}  // namespace plumb::runtime
