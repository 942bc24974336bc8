#include "runtime/mapping/segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "runtime/mapping/bridges.h"
#include "runtime/mapping/cell_planes.h"
#include "runtime/numerics/symmetric_eigen.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kSin15 = 0.25881904510252074, kCos15 = 0.9659258262890683;
constexpr double kMaxStep_m = 0.012;   // between a surfel and its region's plane, beyond their uncertainties, ...
constexpr double kMaxBend_rad = 0.03;  // ... and between their normals
constexpr double kRefitGrowth = 1.1;
constexpr double kMaxRmsSigmas = 1.5;      // of a region
constexpr double kBandSigmas = 3.0;        // between a point and its segment's plane
constexpr int kReach = 2;                  // voxels from a segment's surfels to points that may be its
constexpr double kMinCosIncidence = 0.15;  // flatter rays are biased by the beam's width
constexpr double kMinSigma_m = 0.01;
constexpr double kCoarse = 3;         // times the voxels, for what is far
constexpr int kMinCoarsePoints = 20;  // of a surfel there
constexpr double kTailShare = 0.25;   // of another plane's points about a cell: fewer beside so many are those points' noise
constexpr double kTailFacingCos = 0.94;
constexpr size_t kExplainStep = 3;  // every third point is enough to tell which planes are needed
constexpr double kExplainSigmas = 2.0, kMinUnexplained = 0.5;

// Surfels of one plane; `plane` is a surfel as large as the region.
struct Region {
  Surfel plane;
  std::vector<uint32_t> members;

  void Fit() {
    plane.fitted_count = plane.count;
    const SymmetricEigen<3> eigen = EigenOf(Eigen::Matrix3d(plane.scatter / plane.count));
    const Eigen::Vector3d n = eigen.vectors.col(0);
    plane.normal = n.dot(plane.normal) < 0 ? Eigen::Vector3d(-n) : n;
    plane.minor = eigen.vectors.col(1);
    plane.major = eigen.vectors.col(2);
    const Eigen::Vector3d variances = eigen.values.cwiseMax(1e-12);
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
  // Whether a surfel continues the plane: no step and no bend, as far as both are known. A surfel across the step at a recessed door bends.
  [[nodiscard]] bool Takes(const Surfel& s) const {
    const double angle_variance = s.NormalVariance(0) + plane.NormalVariance(0);
    if (std::acos(std::min(1.0, s.normal.dot(plane.normal))) > kMaxBend_rad + 3 * std::sqrt(angle_variance)) return false;
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

// A region's plane while points are given to it.
struct Candidate {
  const Region* region = nullptr;
  SurfaceKind kind = SurfaceKind::kWall;
  Plane plane;
  PlaneAxes axes;
  double sigma_m = 0;
  bool stays = true;
  VoxelIndex cell_index;
  std::vector<CellStats> cells;  // each kCell_m square

  [[nodiscard]] Eigen::Vector3d Cell(const Eigen::Vector3d& p) const {
    return {axes.along.dot(p) / kCell_m, axes.across.dot(p) / kCell_m, 0};
  }
  CellStats& CellAt(const Eigen::Vector3d& p) {
    const uint32_t cell = cell_index.Insert(VoxelKey(Cell(p))).first;
    if (cell == cells.size()) cells.emplace_back();
    return cells[cell];
  }
  // Points in the nine cells about p.
  [[nodiscard]] double CountAbout(const Eigen::Vector3d& p) const {
    double count = 0;
    for (int k = 0; k < 9; ++k) {
      const uint32_t cell = cell_index.Find(VoxelKey(Cell(p) + Eigen::Vector3d(k % 3 - 1, k / 3 - 1, 0)));
      if (cell != VoxelIndex::kNone) count += cells[cell].count();
    }
    return count;
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
    c.kind = *kind;
    c.plane = {region.plane.normal, -region.plane.normal.dot(region.plane.mean)};
    c.axes = AxesOf(c.plane, *kind, up);
    c.sigma_m = std::clamp(rms_m, kMinSigma_m, options.plane_sigma_m);
    candidates.push_back(std::move(c));
  }
  return candidates;
}

// Which candidates may own points of which voxels: those with a surfel near there.
class Reach {
 public:
  Reach(const std::vector<Candidate>& candidates, const SurfelMap& map) : map_(map) {
    for (uint32_t c = 0; c < candidates.size(); ++c) {
      for (const uint32_t member : candidates[c].region->members) {
        const Eigen::Vector3d g = map.GridPosition(map.surfels()[member].mean);
        for (int x = -kReach; x <= kReach; ++x) {
          for (int y = -kReach; y <= kReach; ++y) {
            for (int z = -kReach; z <= kReach; ++z) AddTo(VoxelKey(g + Eigen::Vector3d(x, y, z)), c);
          }
        }
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

struct Match {
  uint32_t candidate;
  double distance_m;
  bool steep;  // seen steeply enough to be measured
};

// The candidates in whose bands p is, on the side they are seen from.
void FindMatches(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor, const Reach& reach, const std::vector<Candidate>& candidates,
                 double band_sigmas, std::vector<Match>* matches) {
  matches->clear();
  const std::vector<uint32_t>* near = reach.At(p);
  if (near == nullptr) return;
  const Eigen::Vector3d ray = sensor - p;
  for (const uint32_t i : *near) {
    const Candidate& c = candidates[i];
    const double distance_m = std::abs(c.plane.SignedDistance(p)), toward_m = c.plane.n.dot(ray);
    if (distance_m <= band_sigmas * c.sigma_m && toward_m > 0)
      matches->push_back({i, distance_m, toward_m >= kMinCosIncidence * ray.norm()});
  }
}

// Where two planes meet or step, small "planes" fit the noise between them. From the largest on, a candidate stays if enough of its points
// are not already explained by those that stay.
void KeepUnexplained(const std::vector<View>& views, const Reach& reach, std::vector<Candidate>* candidates) {
  std::vector<std::vector<uint32_t>> points_of(candidates->size());
  std::vector<Match> matches;
  uint32_t num_points = 0;
  for (const View& view : views) {
    for (size_t i = 0; i < view.points.size(); i += kExplainStep, ++num_points) {
      FindMatches(view.points[i].cast<double>(), view.sensor, reach, *candidates, kExplainSigmas, &matches);
      for (const Match& m : matches) points_of[m.candidate].push_back(num_points);
    }
  }
  std::vector<bool> explained(num_points, false);
  for (size_t c = 0; c < candidates->size(); ++c) {
    const auto unexplained = std::count_if(points_of[c].begin(), points_of[c].end(), [&](uint32_t i) { return !explained[i]; });
    (*candidates)[c].stays =
        static_cast<double>(unexplained) >= kMinUnexplained * static_cast<double>(points_of[c].size()) && unexplained > 0;
    if (!(*candidates)[c].stays) continue;
    for (const uint32_t i : points_of[c]) explained[i] = true;
  }
}

void AssignPoints(const View& view, const Reach& reach, std::vector<Candidate>* candidates) {
  std::vector<Match> matches;
  for (const Eigen::Vector3f& point : view.points) {
    const Eigen::Vector3d p = point.cast<double>();
    FindMatches(p, view.sensor, reach, *candidates, kBandSigmas, &matches);
    const Match* best = nullptr;
    int claims = 0;
    for (const Match& m : matches) {
      if (!(*candidates)[m.candidate].stays) continue;
      ++claims;
      if (best == nullptr || m.distance_m < best->distance_m) best = &m;
    }
    if (best == nullptr || !best->steep) continue;
    CellStats& cell = (*candidates)[best->candidate].CellAt(p);
    cell.Add(p);
    if (claims > 1) cell.contested += 1;
  }
}

// Of the points of a plane those with most noise are nearer to another one a few centimetres before or behind it, a door leaf or a pane.
// Strewn over all of the first plane, they would make the second as large, or lean it. They go back.
void ReturnTails(const Reach& reach, std::vector<Candidate>* candidates) {
  struct Tail {
    uint32_t from, cell, to;
  };
  std::vector<Tail> tails;
  for (uint32_t i = 0; i < candidates->size(); ++i) {
    const Candidate& c = (*candidates)[i];
    for (uint32_t cell = 0; cell < c.cells.size(); ++cell) {
      const Eigen::Vector3d p = c.cells[cell].centroid();
      const std::vector<uint32_t>* const near = reach.At(p);
      if (near == nullptr) continue;
      double most = c.CountAbout(p) / kTailShare;
      Tail tail{i, cell, i};
      for (const uint32_t k : *near) {
        const Candidate& other = (*candidates)[k];
        if (k == i || !other.stays || other.plane.n.dot(c.plane.n) < kTailFacingCos ||
            std::abs(other.plane.SignedDistance(p)) > kBandSigmas * other.sigma_m)
          continue;
        const double count = other.CountAbout(p);
        if (count <= most) continue;
        most = count;
        tail.to = k;
      }
      if (tail.to != i) tails.push_back(tail);
    }
  }
  for (const Tail& tail : tails) {
    CellStats& cell = (*candidates)[tail.from].cells[tail.cell];
    const PlaneStats moved = cell;
    cell = {};
    (*candidates)[tail.to].CellAt(moved.centroid()).Add(moved);
  }
}

// What no segment's surfels are near to.
std::vector<View> PointsFarFrom(const std::vector<Candidate>& candidates, const Reach& reach, const std::vector<View>& views) {
  std::vector<View> rest;
  for (const View& view : views) {
    rest.push_back({view.sensor, {}, {}});
    for (const Eigen::Vector3f& p : view.points) {
      const std::vector<uint32_t>* const near = reach.At(p.cast<double>());
      if (near == nullptr || std::none_of(near->begin(), near->end(), [&](uint32_t c) { return candidates[c].stays; }))
        rest.back().points.push_back(p);
    }
  }
  return rest;
}

// Of what the surfels show. `rest`: views without the points near any of the segments.
std::vector<Segment> SegmentsOf(const std::vector<View>& views, const SurfelMap& surfels, const Eigen::Vector3d& up,
                                const MapperOptions& options, std::vector<View>* rest) {
  const std::vector<Region> regions = GrowRegions(surfels);
  std::vector<Candidate> candidates = MakeCandidates(regions, up, options);
  const Reach reach(candidates, surfels);
  KeepUnexplained(views, reach, &candidates);
  for (const View& view : views) AssignPoints(view, reach, &candidates);
  ReturnTails(reach, &candidates);
  std::vector<Segment> segments;
  for (Candidate& c : candidates) {
    const size_t before = segments.size();
    for (Segment& segment : SplitCells(c.cells, c.kind, c.plane.n, c.axes, c.sigma_m, options)) {
      // What is seen on two lines may have leaned its plane since the region was told to be a wall or a floor.
      if (KindOf(segment.plane.n, up) == c.kind) segments.push_back(std::move(segment));
    }
    c.stays = segments.size() > before;
  }
  if (rest != nullptr) *rest = PointsFarFrom(candidates, reach, views);
  return segments;
}

// Of points that make no planes in voxels of the usual size, as on a wall so far away that the scan's rings pass at most once through each.
SurfelMap CoarseSurfels(const std::vector<View>& views, SurfelMapOptions options) {
  options.voxel_m *= kCoarse;
  options.min_minor_m *= kCoarse;
  options.min_points = kMinCoarsePoints;
  SurfelMap surfels(options);
  for (const View& view : views) {
    for (const Eigen::Vector3f& p : view.points) surfels.Insert(p.cast<double>(), view.sensor);
    surfels.EndScan();
  }
  return surfels;
}

}  // namespace

std::vector<Segment> ExtractSegments(const KeyframeWindow& window, const MapperOptions& options) {
  const Eigen::Vector3d up = window.T_odom_kf().linear().transpose() * Eigen::Vector3d::UnitZ();
  std::vector<View> rest;
  std::vector<Segment> segments = SegmentsOf(window.views(), window.surfels(), up, options, &rest);
  const SurfelMap coarse = CoarseSurfels(rest, window.surfels().options());
  for (Segment& far : SegmentsOf(rest, coarse, up, options, nullptr)) segments.push_back(std::move(far));
  DropBridges(&segments);
  return segments;
}

}  // namespace plumb::runtime
