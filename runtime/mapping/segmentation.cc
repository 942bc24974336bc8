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
constexpr double kMaxStep_m = 0.02;         // between a surfel and its region's plane, beyond their uncertainties: door leaves are recessed by little more
constexpr double kMaxRmsSigmas = 1.5;       // of a region
constexpr double kBandSigmas = 3.0;         // between a point and its segment's plane
constexpr double kMinCosIncidence = 0.15;   // flatter rays are biased by the beam's width
constexpr double kMinSigma_m = 0.01;
constexpr double kMinAcross_m = 0.2;        // height of a wall segment
constexpr double kSmallRegion = 0.2;        // of the points of another region that wants the same point
constexpr int kMinCellPoints = 2;
constexpr double kMinCellShare = 0.25;      // of the median cell's points: less is noise beyond an edge
constexpr double kRefitGrowth = 1.1;

// Surfels of one plane; `plane` is a surfel as large as the region.
struct Region {
  Surfel plane;
  std::vector<uint32_t> members;

  void Fit() {
    plane.fitted_count = plane.count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(plane.scatter / plane.count);
    const Eigen::Vector3d n = eigen.eigenvectors().col(0);
    plane.normal = n.dot(plane.normal) < 0 ? Eigen::Vector3d(-n) : n;
    plane.minor = eigen.eigenvectors().col(1);
    plane.major = eigen.eigenvectors().col(2);
    const Eigen::Vector3d variances = eigen.eigenvalues().cwiseMax(1e-12);
    plane.var_normal_m2 = variances[0];
    plane.var_minor_m2 = variances[1];
    plane.var_major_m2 = variances[2];
  }
  void Add(const Surfel& s, uint32_t index) {
    if (members.empty()) plane.normal = s.normal;
    plane.Add(s);
    members.push_back(index);
    if (plane.count >= kRefitGrowth * plane.fitted_count) Fit();
  }
  // Whether a surfel continues the plane: no step, as far as the plane is known there and the surfel's place is known.
  [[nodiscard]] bool Takes(const Surfel& s) const {
    if (s.normal.dot(plane.normal) < kSameNormalCos) return false;
    const double variance_m2 = plane.DistanceVariance(s.mean, 0) - plane.var_normal_m2 + s.var_normal_m2 / s.count;
    return std::abs(plane.SignedDistance(s.mean)) <= kMaxStep_m + 3 * std::sqrt(variance_m2);
  }
};

Region GrowRegion(const SurfelMap& map, uint32_t seed, std::vector<bool>* taken) {
  const std::vector<Surfel>& surfels = map.surfels();
  Region region;
  region.Add(surfels[seed], seed);
  (*taken)[seed] = true;
  std::vector<uint32_t> around;
  for (size_t next = 0; next < region.members.size(); ++next) {
    around.clear();
    map.Around(surfels[region.members[next]].mean, &around);
    for (const uint32_t i : around) {
      if ((*taken)[i] || !region.Takes(surfels[i])) continue;
      (*taken)[i] = true;
      region.Add(surfels[i], i);
    }
  }
  region.Fit();
  return region;
}

std::vector<Region> GrowRegions(const SurfelMap& map) {
  const std::vector<Surfel>& surfels = map.surfels();
  std::vector<uint32_t> seeds;
  for (uint32_t i = 0; i < surfels.size(); ++i) {
    if (surfels[i].planar) seeds.push_back(i);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [&](uint32_t a, uint32_t b) { return surfels[a].count > surfels[b].count; });
  std::vector<bool> taken(surfels.size(), false);
  std::vector<Region> regions;
  for (const uint32_t seed : seeds) {
    if (!taken[seed]) regions.push_back(GrowRegion(map, seed, &taken));
  }
  std::stable_sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.plane.count > b.plane.count; });
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
    const double rms_m = std::sqrt(region.plane.var_normal_m2);
    const std::optional<SurfaceKind> kind = KindOf(region.plane.normal, up);
    if (!kind || rms_m > kMaxRmsSigmas * options.plane_sigma_m) continue;
    Candidate c;
    c.region = &region;
    c.segment.kind = *kind;
    c.segment.plane = {region.plane.normal, -region.plane.normal.dot(region.plane.mean)};
    c.axes = AxesOf(c.segment.plane, *kind, up);
    c.band_m = kBandSigmas * std::clamp(rms_m, kMinSigma_m, options.plane_sigma_m);
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

// Where two planes meet, small "planes" fit the corner's rounded noise: a point that may be a large segment's is never a small one's.
void AssignPoints(const View& view, const Reach& reach, std::vector<Candidate>* candidates) {
  struct Match {
    Candidate* candidate;
    double distance_m;
  };
  std::vector<Match> matches;
  for (const Eigen::Vector3f& point : view.points) {
    const Eigen::Vector3d p = point.cast<double>();
    const std::vector<uint32_t>* near = reach.At(p);
    if (near == nullptr) continue;
    const Eigen::Vector3d ray = view.sensor - p;
    const double min_toward_m = kMinCosIncidence * ray.norm();
    matches.clear();
    double largest = 0;
    for (const uint32_t i : *near) {
      Candidate& c = (*candidates)[i];
      const double distance_m = std::abs(c.segment.plane.SignedDistance(p));
      if (distance_m > c.band_m || c.segment.plane.n.dot(ray) < min_toward_m) continue;
      matches.push_back({&c, distance_m});
      largest = std::max(largest, c.region->plane.count);
    }
    Match best{nullptr, std::numeric_limits<double>::infinity()};
    for (const Match& m : matches) {
      if (m.candidate->region->plane.count >= kSmallRegion * largest && m.distance_m < best.distance_m) best = m;
    }
    if (best.candidate != nullptr) best.candidate->Add(p);
  }
}

int MinCellCount(const Candidate& c) {
  std::vector<int> counts;
  counts.reserve(c.cells.size());
  for (const Candidate::Cell& cell : c.cells) counts.push_back(cell.count);
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  return std::max(kMinCellPoints, static_cast<int>(kMinCellShare * *middle));
}

// The finished segment, or none if it is too small.
std::optional<Segment> Finish(Candidate& c, const MapperOptions& options) {
  if (c.segment.stats.count() < options.min_segment_points) return std::nullopt;
  c.segment.plane = FitPlane(c.segment.stats, c.segment.plane.n).plane;
  Eigen::Vector2d lo = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  const int min_count = MinCellCount(c);
  for (const Candidate::Cell& cell : c.cells) {
    if (cell.count < min_count) continue;
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
  const std::vector<Region> regions = GrowRegions(window.surfels());
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
