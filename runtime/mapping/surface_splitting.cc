#include "runtime/mapping/surface_splitting.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "runtime/mapping/cell_planes.h"
#include "runtime/mapping/plane_fit.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr size_t kLeastViews = 2;      // of each part
constexpr double kMargin = 1.2;        // by which two planes must be further apart than two that merge may be
constexpr double kLeastOff_m = 0.005;  // how much further than from their views' planes points are off the common one, rms: noise is less
constexpr double kMaxLeft = 0.25;  // of the square of that, off two planes: chance alone leaves 0.36 of a normal distribution cut in two
constexpr double kPartOff = 0.5;   // of the merge distance: the same off a part's own plane
constexpr int kRefinements = 4;
constexpr double kMaxCovered = 0.5;   // of a part's cells, below what makes it an echo
constexpr double kBandSigmas = 3.0;   // of a point about its view's plane
constexpr double kCellSigma_m = 0.1;  // how far from a view's points a cell of it may lie, besides

double MeanSquare(const PlaneStats& stats, const Eigen::Vector3d& towards) {
  const double rms_m = FitPlane(stats, towards).rms_m;
  return rms_m * rms_m;
}

// Summed squares of the points' distances.
double SquareSum(const PlaneStats& stats, const Plane& plane) {
  const Eigen::Vector4d p(plane.n.x(), plane.n.y(), plane.n.z(), plane.d);
  return p.dot(stats.C * p);
}

Eigen::Matrix3d CovarianceOf(const PlaneStats& stats) {
  const Eigen::Vector3d c = stats.centroid();
  return stats.C.topLeftCorner<3, 3>() / stats.count() - c * c.transpose();
}

std::vector<PlaneStats> ViewsOf(const std::vector<Observation>& observations, const std::vector<Keyframe>& keyframes) {
  std::vector<PlaneStats> views;
  views.reserve(observations.size());
  for (const Observation& o : observations) views.push_back(o.stats.Transformed(keyframes[o.keyframe].T_map_kf));
  return views;
}

// Two planes, and which views lie on the second.
struct Split {
  std::array<PlaneStats, 2> sums;
  std::array<Plane, 2> planes;
  std::vector<bool> second;
  double square_sum_m2 = std::numeric_limits<double>::infinity();
};

Split SplitInto(const std::vector<PlaneStats>& views, std::vector<bool> second, const Eigen::Vector3d& towards) {
  Split split;
  for (size_t i = 0; i < views.size(); ++i) split.sums[second[i]].Add(views[i]);
  split.square_sum_m2 = 0;
  for (const size_t part : {size_t{0}, size_t{1}}) {
    const PlaneFit fit = FitPlane(split.sums[part], towards);
    split.planes[part] = fit.plane;
    split.square_sum_m2 += split.sums[part].count() * fit.rms_m * fit.rms_m;
  }
  split.second = std::move(second);
  return split;
}

// The best of all cuts in an order.
Split BestCut(const std::vector<PlaneStats>& views, const std::vector<size_t>& order, const Eigen::Vector3d& towards) {
  std::vector<double> rest_m2(order.size() + 1, 0.0);
  const auto grow = [&](PlaneStats& sum, size_t k) {
    sum.Add(views[order[k]]);
    return sum.count() * MeanSquare(sum, towards);
  };
  PlaneStats rest, first;
  for (size_t k = order.size(); k-- > 0;) rest_m2[k] = grow(rest, k);
  size_t best = 0;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (size_t k = 1; k + kLeastViews <= order.size(); ++k) {
    const double sum_m2 = grow(first, k - 1) + rest_m2[k];
    if (k < kLeastViews || sum_m2 >= least_m2) continue;
    least_m2 = sum_m2;
    best = k;
  }
  std::vector<bool> second(views.size(), false);
  for (size_t k = best; k < order.size(); ++k) second[order[k]] = true;
  return SplitInto(views, std::move(second), towards);
}

// Each view to the nearer plane, and planes anew, as long as that leaves less.
void Refine(const std::vector<PlaneStats>& views, const Eigen::Vector3d& towards, Split* split) {
  for (int round = 0; round < kRefinements; ++round) {
    std::vector<bool> second(views.size());
    for (size_t i = 0; i < views.size(); ++i) second[i] = SquareSum(views[i], split->planes[1]) < SquareSum(views[i], split->planes[0]);
    const auto num_second = static_cast<size_t>(std::count(second.begin(), second.end(), true));
    if (second == split->second || num_second < kLeastViews || num_second + kLeastViews > views.size()) return;
    Split next = SplitInto(views, std::move(second), towards);
    if (next.square_sum_m2 >= split->square_sum_m2) return;
    *split = std::move(next);
  }
}

// Views ordered along the common plane part where it bends or steps, in either direction; by their distance from it at a niche.
Split BestSplit(const std::vector<PlaneStats>& views, const PlaneStats& sum, const Eigen::Vector3d& towards) {
  const Eigen::Matrix3d axes = EigenOf(CovarianceOf(sum)).vectors;
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<size_t> order(views.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return axes.col(axis).dot(views[a].centroid()) < axes.col(axis).dot(views[b].centroid()); });
    Split split = BestCut(views, order, towards);
    Refine(views, towards, &split);
    if (split.square_sum_m2 < best.square_sum_m2) best = std::move(split);
  }
  if (best.second.front()) {  // which is first must not depend on an axis' sign
    best.second.flip();
    best = SplitInto(views, std::move(best.second), towards);
  }
  return best;
}

// How far the planes are from each other midway between the parts' facing ends, taken as evenly seen: what merging asks where two surfaces
// meet (SurfaceDistance).
double OffsetWhereTheyMeet(const Split& split) {
  const std::array<Eigen::Vector3d, 2> centers = {split.sums[0].centroid(), split.sums[1].centroid()};
  Eigen::Vector3d middle = 0.5 * (centers[0] + centers[1]);
  const Eigen::Vector3d between = centers[1] - centers[0];
  if (between.norm() > 1e-6) {
    const Eigen::Vector3d e = between.normalized();
    const auto half_m = [&](const PlaneStats& sum) { return std::sqrt(3 * std::max(0.0, e.dot(CovarianceOf(sum) * e))); };
    middle += 0.5 * (half_m(split.sums[0]) - half_m(split.sums[1])) * e;
  }
  return std::abs(split.planes[0].SignedDistance(middle) - split.planes[1].SignedDistance(middle));
}

bool AreApart(const Split& split, const Eigen::Vector3d& towards, const MapperOptions& options) {
  MapperOptions wide = options;
  wide.merge_distance_m *= kMargin;
  return OffsetWhereTheyMeet(split) > wide.merge_distance_m || !FitOnePlane(split.sums[0], split.sums[1], towards, wide);
}

// None if one plane fits, or no two do.
std::optional<Split> FindSplit(const std::vector<PlaneStats>& views, const Eigen::Vector3d& towards, const MapperOptions& options) {
  if (views.size() < 2 * kLeastViews) return {};
  PlaneStats sum;
  std::vector<double> own_m2;  // of each view, off its own plane
  for (const PlaneStats& view : views) {
    sum.Add(view);
    own_m2.push_back(view.count() * MeanSquare(view, towards));
  }
  const double all_own_m2 = std::accumulate(own_m2.begin(), own_m2.end(), 0.0);
  const double excess_m2 = sum.count() * MeanSquare(sum, towards) - all_own_m2;
  if (excess_m2 <= sum.count() * kLeastOff_m * kLeastOff_m) return {};
  Split split = BestSplit(views, sum, towards);
  if (split.square_sum_m2 - all_own_m2 > kMaxLeft * excess_m2) return {};
  const double max_off_m = kPartOff * options.merge_distance_m;
  std::array<double, 2> part_m2 = {SquareSum(split.sums[0], split.planes[0]), SquareSum(split.sums[1], split.planes[1])};
  for (size_t i = 0; i < views.size(); ++i) part_m2[split.second[i]] -= own_m2[i];
  for (const size_t part : {size_t{0}, size_t{1}}) {
    if (part_m2[part] > split.sums[part].count() * max_off_m * max_off_m) return {};
  }
  return AreApart(split, towards, options) ? std::optional(std::move(split)) : std::nullopt;
}

using PartViews = std::array<uint32_t, 2>;  // from how many keyframes a cell was seen on each plane

// By the points that the keyframes keep.
std::vector<PartViews> CountViews(const MapSurface& surface, const SurfacePatch& patch, const Split& split,
                                  const std::vector<Keyframe>& keyframes, double band_m) {
  VoxelIndex index(patch.cells().size());
  std::vector<uint32_t> places;  // of the cells in `counts`
  for (const Eigen::Vector2f& cell : patch.cells()) {
    const Eigen::Vector2d at = cell.cast<double>() / kCell_m;
    places.push_back(index.Insert(VoxelKey({at.x(), at.y(), 0})).first);
  }
  std::vector<PartViews> counts(index.size()), out;
  std::vector<size_t> last_view(index.size());  // that was counted, from 1
  for (size_t i = 0; i < surface.observations.size(); ++i) {
    const Keyframe& keyframe = keyframes[surface.observations[i].keyframe];
    const size_t part = split.second[i];
    for (const Eigen::Vector3f& point : keyframe.points) {
      const Eigen::Vector3d p = keyframe.T_map_kf * point.cast<double>();
      const double off_m = std::abs(split.planes[part].SignedDistance(p));
      if (off_m > band_m || off_m > std::abs(split.planes[1 - part].SignedDistance(p))) continue;
      const Eigen::Vector2d at = patch.Coordinates(p) / kCell_m;
      const uint32_t place = index.Find(VoxelKey({at.x(), at.y(), 0}));
      if (place != VoxelIndex::kNone && std::exchange(last_view[place], i + 1) != i + 1) ++counts[place][part];
    }
  }
  for (const uint32_t place : places) out.push_back(counts[place]);
  return out;
}

// Whether the view nearest to p, in its own sigmas, is of the second part.
class NearestView {
 public:
  NearestView(const std::vector<PlaneStats>& views, const std::vector<bool>& second) : second_(second) {
    for (const PlaneStats& view : views) {
      centers_.push_back(view.centroid());
      information_.emplace_back((CovarianceOf(view) + kCellSigma_m * kCellSigma_m * Eigen::Matrix3d::Identity()).inverse());
    }
  }
  [[nodiscard]] size_t PartAt(const Eigen::Vector3d& p) const {
    size_t part = 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < centers_.size(); ++i) {
      const Eigen::Vector3d d = p - centers_[i];
      const double squared = d.dot(information_[i] * d);
      if (squared >= least) continue;
      least = squared;
      part = second_[i];
    }
    return part;
  }

 private:
  const std::vector<bool>& second_;
  std::vector<Eigen::Vector3d> centers_;
  std::vector<Eigen::Matrix3d> information_;
};

// Of each cell's views, those of each part; none is lost.
std::vector<PartViews> ShareViews(const MapSurface& surface, const SurfacePatch& patch, const std::vector<PlaneStats>& views,
                                  const Split& split, const std::vector<Keyframe>& keyframes, double band_m) {
  std::vector<PartViews> shares = CountViews(surface, patch, split, keyframes, band_m);
  const NearestView nearest(views, split.second);
  const std::vector<Eigen::Vector3d> cells = patch.CellPoints();
  for (size_t c = 0; c < cells.size(); ++c) {
    const uint32_t all = patch.views()[c], counted = shares[c][0] + shares[c][1];
    if (counted == 0) shares[c][nearest.PartAt(cells[c])] = 1;
    const double first = static_cast<double>(shares[c][0]) / static_cast<double>(std::max(counted, 1u));
    shares[c][0] = static_cast<uint32_t>(std::lround(first * static_cast<double>(all)));
    shares[c][1] = all - shares[c][0];
  }
  return shares;
}

// The views of one part as a surface of its own, its cells on the grid of the whole.
TrackedSurface PartOf(const MapSurface& from, const SurfacePatch& patch, const Split& split, size_t part,
                      const std::vector<PartViews>& shares, const std::vector<Keyframe>& keyframes) {
  MapSurface surface;
  surface.id = from.id;
  surface.kind = from.kind;
  for (size_t i = 0; i < split.second.size(); ++i) {
    if (split.second[i] == (part == 1)) surface.observations.push_back(from.observations[i]);
  }
  const Keyframe& first = keyframes[surface.observations.front().keyframe];
  SurfacePatch own(first.id, first.T_map_kf, split.planes[part], from.kind, patch.Point(Eigen::Vector2d::Zero()), patch.cell_height_m());
  const std::vector<Eigen::Vector3d> cells = patch.CellPoints();
  for (size_t c = 0; c < cells.size(); ++c) {
    if (shares[c][part] > 0) own.Mark(cells[c], shares[c][part]);
  }
  return {std::move(surface), {std::move(own), split.sums[part]}};
}

}  // namespace

bool LieOnTwoPlanes(const MapSurface& a, const MapSurface& b, const std::vector<Keyframe>& keyframes, const MapperOptions& options) {
  // A surface that was seen at two distances in one place does not split; that is no reason to keep others from it.
  for (const MapSurface* s : {&a, &b}) {
    if (FindSplit(ViewsOf(s->observations, keyframes), a.plane.n, options)) return false;
  }
  std::vector<Observation> both = a.observations;
  AddObservations(b.observations, &both);
  return FindSplit(ViewsOf(both, keyframes), a.plane.n, options).has_value();
}

std::optional<TrackedSurface> SplitOff(const std::vector<Keyframe>& keyframes, const MapperOptions& options, MapSurface* surface,
                                       SurfaceTrack* track) {
  const std::vector<PlaneStats> views = ViewsOf(surface->observations, keyframes);
  const std::optional<Split> split = FindSplit(views, surface->plane.n, options);
  if (!split) return {};
  const SurfacePatch& patch = track->patch;
  const std::vector<PartViews> shares = ShareViews(*surface, patch, views, *split, keyframes, kBandSigmas * options.plane_sigma_m);
  const size_t larger = split->sums[1].count() > split->sums[0].count() ? 1 : 0;
  TrackedSurface kept = PartOf(*surface, patch, *split, larger, shares, keyframes);
  TrackedSurface part = PartOf(*surface, patch, *split, 1 - larger, shares, keyframes);
  const SurfacePatch &a = kept.track.patch, &b = part.track.patch;
  if (!IsLargeEnough(a, options) || !IsLargeEnough(b, options)) return {};
  constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
  if (CoveredShare(a, {&b}, kAnyDistance) >= kMaxCovered || CoveredShare(b, {&a}, kAnyDistance) >= kMaxCovered) return {};
  Recompute(keyframes, &kept.surface, &kept.track);
  Recompute(keyframes, &part.surface, &part.track);
  *surface = std::move(kept.surface);
  *track = std::move(kept.track);
  return part;
}

}  // namespace plumb::runtime
