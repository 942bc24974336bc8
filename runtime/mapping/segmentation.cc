#include "runtime/mapping/segmentation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "runtime/mapping/plane_fit.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kSin15 = 0.25881904510252074, kCos15 = 0.9659258262890683;
constexpr double kSameNormalCos = 0.94;     // 20 degrees between a surfel and its region
constexpr double kSurfelBandSigmas = 1.5;   // between a surfel's mean and its region's plane
constexpr double kBandSigmas = 3.0;         // between a point and its segment's plane
constexpr double kMinCosIncidence = 0.15;   // flatter rays are biased by the beam's width
constexpr double kMinSigma_m = 0.01;
constexpr double kMinAcross_m = 0.2;        // height of a wall segment
constexpr int kMinCellPoints = 2;
constexpr double kRefitGrowth = 1.1;

// Surfels of one plane.
struct Region {
  Surfel sum;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double rms_m = 0, fitted_count = 0;
  std::vector<uint32_t> members;

  void Fit() {
    fitted_count = sum.count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum.scatter / sum.count);
    const Eigen::Vector3d n = eigen.eigenvectors().col(0);
    normal = n.dot(normal) < 0 ? Eigen::Vector3d(-n) : n;
    rms_m = std::sqrt(std::max(0.0, eigen.eigenvalues()[0]));
  }
  void Add(const Surfel& s, uint32_t index) {
    if (members.empty()) normal = s.normal;
    sum.Add(s);
    members.push_back(index);
    if (sum.count >= kRefitGrowth * fitted_count) Fit();
  }
  [[nodiscard]] double SignedDistance(const Eigen::Vector3d& p) const { return normal.dot(p - sum.mean); }
};

Region GrowRegion(const SurfelMap& map, uint32_t seed, double max_distance_m, std::vector<bool>* taken) {
  const std::vector<Surfel>& surfels = map.surfels();
  Region region;
  region.Add(surfels[seed], seed);
  (*taken)[seed] = true;
  std::vector<uint32_t> around;
  for (size_t next = 0; next < region.members.size(); ++next) {
    around.clear();
    map.Around(surfels[region.members[next]].mean, &around);
    for (const uint32_t i : around) {
      const Surfel& s = surfels[i];
      if ((*taken)[i] || s.normal.dot(region.normal) < kSameNormalCos || std::abs(region.SignedDistance(s.mean)) > max_distance_m) continue;
      (*taken)[i] = true;
      region.Add(s, i);
    }
  }
  region.Fit();
  return region;
}

std::vector<Region> GrowRegions(const SurfelMap& map, double max_distance_m) {
  const std::vector<Surfel>& surfels = map.surfels();
  std::vector<uint32_t> seeds;
  for (uint32_t i = 0; i < surfels.size(); ++i) {
    if (surfels[i].planar) seeds.push_back(i);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [&](uint32_t a, uint32_t b) { return surfels[a].count > surfels[b].count; });
  std::vector<bool> taken(surfels.size(), false);
  std::vector<Region> regions;
  for (const uint32_t seed : seeds) {
    if (!taken[seed]) regions.push_back(GrowRegion(map, seed, max_distance_m, &taken));
  }
  std::stable_sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.sum.count > b.sum.count; });
  return regions;
}

std::optional<SurfaceKind> KindOf(const Eigen::Vector3d& normal, const Eigen::Vector3d& up) {
  const double n_z = normal.dot(up);
  if (std::abs(n_z) < kSin15) return SurfaceKind::kWall;
  if (std::abs(n_z) > kCos15) return n_z > 0 ? SurfaceKind::kFloor : SurfaceKind::kCeiling;
  return std::nullopt;
}

// A segment while points are given to it.
struct Candidate {
  Segment segment;
  const Region* region = nullptr;
  PlaneAxes axes;
  double band_m = 0;
  struct Cell {
    int count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  };
  VoxelIndex cell_index;
  std::vector<Cell> cells;

  void Add(const Eigen::Vector3d& p) {
    segment.stats.Add(p);
    const double u = axes.along.dot(p) / kCell_m, v = axes.across.dot(p) / kCell_m;
    const uint32_t cell = cell_index.Insert(VoxelKey({u, v, 0})).first;
    if (cell == cells.size()) cells.emplace_back();
    ++cells[cell].count;
    cells[cell].sum += p;
  }
};

std::vector<Candidate> MakeCandidates(const std::vector<Region>& regions, const Eigen::Vector3d& up, const MapperOptions& options) {
  std::vector<Candidate> candidates;
  for (const Region& region : regions) {
    const std::optional<SurfaceKind> kind = KindOf(region.normal, up);
    if (!kind || region.rms_m > kSurfelBandSigmas * options.plane_sigma_m) continue;
    Candidate c;
    c.region = &region;
    c.segment.kind = *kind;
    c.segment.plane = {region.normal, -region.normal.dot(region.sum.mean)};
    c.axes = AxesOf(c.segment.plane, *kind, up);
    c.band_m = kBandSigmas * std::clamp(region.rms_m, kMinSigma_m, options.plane_sigma_m);
    candidates.push_back(std::move(c));
  }
  return candidates;
}

// Which candidates may own points of which voxels: those with a surfel there or next to there.
class Reach {
 public:
  Reach(const std::vector<Candidate>& candidates, const SurfelMap& map) : map_(map) {
    for (uint32_t c = 0; c < candidates.size(); ++c) {
      for (const uint32_t member : candidates[c].region->members) {
        const Eigen::Vector3d g = map.GridPosition(map.surfels()[member].mean);
        for (int k = 0; k < 27; ++k) AddTo(VoxelKey(g + NeighbourOffset(k)), c);
      }
    }
  }
  [[nodiscard]] const std::vector<uint32_t>* At(const Eigen::Vector3d& p) const {
    const uint32_t voxel = voxels_.Find(VoxelKey(map_.GridPosition(p)));
    return voxel == VoxelIndex::kNone ? nullptr : &candidates_[voxel];
  }

 private:
  void AddTo(uint64_t key, uint32_t candidate) {
    const uint32_t voxel = voxels_.Insert(key).first;
    if (voxel == candidates_.size()) candidates_.emplace_back();
    if (candidates_[voxel].empty() || candidates_[voxel].back() != candidate) candidates_[voxel].push_back(candidate);
  }
  const SurfelMap& map_;
  VoxelIndex voxels_;
  std::vector<std::vector<uint32_t>> candidates_;
};

void AssignPoints(const View& view, const Reach& reach, std::vector<Candidate>* candidates) {
  for (const Eigen::Vector3f& point : view.points) {
    const Eigen::Vector3d p = point.cast<double>();
    const std::vector<uint32_t>* near = reach.At(p);
    if (near == nullptr) continue;
    const Eigen::Vector3d ray = view.sensor - p;
    const double min_toward_m = kMinCosIncidence * ray.norm();
    Candidate* best = nullptr;
    double best_distance_m = std::numeric_limits<double>::infinity();
    for (const uint32_t i : *near) {
      Candidate& c = (*candidates)[i];
      const double distance_m = std::abs(c.segment.plane.SignedDistance(p));
      if (distance_m > c.band_m || distance_m >= best_distance_m || c.segment.plane.n.dot(ray) < min_toward_m) continue;
      best = &c;
      best_distance_m = distance_m;
    }
    if (best != nullptr) best->Add(p);
  }
}

// The finished segment, or none if it is too small.
std::optional<Segment> Finish(Candidate& c, const MapperOptions& options) {
  if (c.segment.stats.count() < options.min_segment_points) return std::nullopt;
  c.segment.plane = FitPlane(c.segment.stats, c.segment.plane.n).plane;
  Eigen::Vector2d lo = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const Candidate::Cell& cell : c.cells) {
    if (cell.count < kMinCellPoints) continue;
    const Eigen::Vector3d mean = cell.sum / cell.count;
    const Eigen::Vector2d at(c.axes.along.dot(mean), c.axes.across.dot(mean));
    lo = lo.cwiseMin(at);
    hi = hi.cwiseMax(at);
    c.segment.cells.push_back(mean.cast<float>());
  }
  if (c.segment.cells.empty()) return std::nullopt;
  const Eigen::Vector2d size_m = hi - lo + Eigen::Vector2d::Constant(kCell_m);
  const double min_across_m = c.segment.kind == SurfaceKind::kWall ? std::min(kMinAcross_m, options.min_segment_extent_m) : options.min_segment_extent_m;
  if (size_m.x() < options.min_segment_extent_m || size_m.y() < min_across_m) return std::nullopt;
  return std::move(c.segment);
}

}  // namespace

PlaneAxes AxesOf(const Plane& plane, SurfaceKind kind, const Eigen::Vector3d& up) {
  PlaneAxes axes;
  if (kind == SurfaceKind::kWall) {
    axes.along = plane.n.cross(up).normalized();
    axes.across = axes.along.cross(plane.n);
    return axes;
  }
  axes.along = (Eigen::Vector3d::UnitX() - plane.n.x() * plane.n).normalized();
  axes.across = plane.n.cross(axes.along);
  return axes;
}

std::vector<Segment> ExtractSegments(const KeyframeWindow& window, const MapperOptions& options) {
  const Eigen::Vector3d up = window.T_odom_kf().linear().transpose() * Eigen::Vector3d::UnitZ();
  const std::vector<Region> regions = GrowRegions(window.surfels(), kSurfelBandSigmas * options.plane_sigma_m);
  std::vector<Candidate> candidates = MakeCandidates(regions, up, options);
  const Reach reach(candidates, window.surfels());
  for (const View& view : window.views()) AssignPoints(view, reach, &candidates);
  std::vector<Segment> segments;
  for (Candidate& c : candidates) {
    if (std::optional<Segment> segment = Finish(c, options)) segments.push_back(std::move(*segment));
  }
  return segments;
}

}  // namespace plumb::runtime
