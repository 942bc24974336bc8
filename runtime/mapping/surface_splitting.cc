#include "runtime/mapping/surface_splitting.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "runtime/mapping/plane_fit.h"

namespace plumb::runtime {
namespace {

constexpr size_t kLeastViews = 2;      // of each part
constexpr double kMargin = 1.2;        // by which two planes must be further apart than two that merge may be
constexpr double kPartOff = 0.5;       // of the merge distance: how much further than from its view's own plane a point may be off, rms
constexpr double kBetweenShare = 0.2;  // of its square: the least that a step or a bend between views leaves between them, too
constexpr double kOnBoth = 4.0;        // squared sigmas of the views nearest to it: a cell within that of both parts goes to both
constexpr double kCellSigma_m = 0.1;   // how far from a view's points a cell of it may lie, besides

double MeanSquare(const PlaneStats& stats, const Eigen::Vector3d& towards) {
  const double rms_m = FitPlane(stats, towards).rms_m;
  return rms_m * rms_m;
}

// Sums over the first k views in an order, for each k, and over the rest.
struct Sums {
  std::vector<PlaneStats> first, rest;
  Sums(const std::vector<PlaneStats>& views, const std::vector<size_t>& order) : first(order.size() + 1), rest(order.size() + 1) {
    for (size_t k = 0; k < order.size(); ++k) {
      first[k + 1] = first[k];
      first[k + 1].Add(views[order[k]]);
    }
    for (size_t k = order.size(); k-- > 0;) {
      rest[k] = rest[k + 1];
      rest[k].Add(views[order[k]]);
    }
  }
};

// Which views lie on the second of the two planes that fit best, with what the points are off these planes.
struct Parting {
  std::vector<bool> second;
  double square_sum_m2 = std::numeric_limits<double>::infinity();
};

// Views in the order of their distance from the common plane part at a step, in the order along it at a bend.
Parting BestParting(const std::vector<PlaneStats>& views, const Plane& plane) {
  const Eigen::Vector3d along =
      plane.n.cross(Eigen::Vector3d::UnitZ()).norm() > 0.5 ? plane.n.cross(Eigen::Vector3d::UnitZ()) : Eigen::Vector3d::UnitX();
  Parting best;
  for (const Eigen::Vector3d& by : {plane.n, along}) {
    std::vector<size_t> order(views.size());
    std::iota(order.begin(), order.end(), size_t{0});
    const auto at = [&](size_t i) { return by.dot(views[i].centroid()); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return at(a) < at(b); });
    const Sums sums(views, order);
    for (size_t k = kLeastViews; k + kLeastViews <= order.size(); ++k) {
      const double sum_m2 =
          sums.first[k].count() * MeanSquare(sums.first[k], plane.n) + sums.rest[k].count() * MeanSquare(sums.rest[k], plane.n);
      if (sum_m2 >= best.square_sum_m2) continue;
      best.square_sum_m2 = sum_m2;
      best.second.assign(views.size(), false);
      for (size_t i = k; i < order.size(); ++i) best.second[order[i]] = true;
    }
  }
  return best;
}

// Squared sigmas from p to the nearest view of each part, {first, second}.
std::pair<double, double> DistancesOf(const Eigen::Vector3d& p, const std::vector<PlaneStats>& views, const std::vector<bool>& second) {
  std::pair<double, double> out{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < views.size(); ++i) {
    const PlaneStats& s = views[i];
    const Eigen::Vector3d c = s.centroid(), d = p - c;
    const Eigen::Matrix3d covariance = s.C.topLeftCorner<3, 3>() / s.count() - c * c.transpose();
    double& least = second[i] ? out.second : out.first;
    least = std::min(least, d.dot((covariance + kCellSigma_m * kCellSigma_m * Eigen::Matrix3d::Identity()).ldlt().solve(d)));
  }
  return out;
}

std::vector<PlaneStats> ViewsOf(const MapSurface& surface, const std::vector<Keyframe>& keyframes) {
  std::vector<PlaneStats> views;
  views.reserve(surface.observations.size());
  for (const Observation& o : surface.observations) views.push_back(o.stats.Transformed(keyframes[o.keyframe].T_map_kf));
  return views;
}

// Mean square, over all points, of how far their views' centroids are from the common plane: what most surfaces have little of.
double BetweenViews(const std::vector<PlaneStats>& views, const Plane& plane) {
  double sum_m2 = 0, count = 0;
  for (const PlaneStats& view : views) {
    sum_m2 += view.count() * std::pow(plane.SignedDistance(view.centroid()), 2);
    count += view.count();
  }
  return sum_m2 / count;
}

// How much more than from their views' own planes the points of those of one part are off its plane, mean square.
double Excess(const std::vector<PlaneStats>& views, const std::vector<bool>& second, bool part, const Eigen::Vector3d& towards) {
  PlaneStats sum;
  double own_m2 = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    if (second[i] != part) continue;
    sum.Add(views[i]);
    own_m2 += views[i].count() * MeanSquare(views[i], towards);
  }
  return MeanSquare(sum, towards) - own_m2 / sum.count();
}

// The views of one part as a surface of its own, with the cells of `from` that are not gone.
TrackedSurface PartOf(const MapSurface& from, const SurfacePatch& patch, const std::vector<bool>& second, bool part,
                      const std::vector<bool>& gone, const std::vector<Keyframe>& keyframes) {
  MapSurface surface;
  surface.id = from.id;
  surface.kind = from.kind;
  PlaneStats sum;
  for (size_t i = 0; i < second.size(); ++i) {
    if (second[i] != part) continue;
    surface.observations.push_back(from.observations[i]);
    sum.Add(from.observations[i].stats.Transformed(keyframes[from.observations[i].keyframe].T_map_kf));
  }
  const Keyframe& first = keyframes[surface.observations.front().keyframe];
  SurfacePatch own(first.id, first.T_map_kf, FitPlane(sum, from.plane.n).plane, from.kind, sum.centroid(), patch.cell_height_m());
  const std::vector<Eigen::Vector3d> cells = patch.CellPoints();
  for (size_t c = 0; c < cells.size(); ++c) {
    if (!gone[c]) own.Mark(cells[c], patch.views()[c]);
  }
  TrackedSurface out{std::move(surface), {std::move(own), sum}};
  Recompute(keyframes, &out.surface, &out.track);
  return out;
}

}  // namespace

std::optional<TrackedSurface> SplitOff(const std::vector<Keyframe>& keyframes, const MapperOptions& options, MapSurface* surface,
                                       SurfaceTrack* track) {
  const size_t num_views = surface->observations.size();
  if (num_views < 2 * kLeastViews) return {};
  const std::vector<PlaneStats> views = ViewsOf(*surface, keyframes);
  const double max_off_m = kPartOff * options.merge_distance_m;
  if (BetweenViews(views, surface->plane) <= kBetweenShare * max_off_m * max_off_m) return {};
  const std::vector<bool> second = BestParting(views, surface->plane).second;
  for (const bool part : {false, true}) {
    if (Excess(views, second, part, surface->plane.n) > max_off_m * max_off_m) return {};
  }
  const std::vector<Eigen::Vector3d> cells = track->patch.CellPoints();
  std::vector<bool> not_first(cells.size()), not_second(cells.size());
  for (size_t c = 0; c < cells.size(); ++c) {
    const auto [to_first, to_second] = DistancesOf(cells[c], views, second);
    not_first[c] = to_first > std::max(to_second, kOnBoth);
    not_second[c] = to_second > std::max(to_first, kOnBoth);
  }
  for (const std::vector<bool>& gone : {not_first, not_second}) {
    if (std::find(gone.begin(), gone.end(), false) == gone.end()) return {};
  }
  TrackedSurface a = PartOf(*surface, track->patch, second, false, not_first, keyframes);
  TrackedSurface b = PartOf(*surface, track->patch, second, true, not_second, keyframes);
  MapperOptions wide = options;
  wide.merge_distance_m *= kMargin;
  if (!std::isinf(SurfaceDistance(a.track.patch, b.track.patch, wide)) && FitOnePlane(a.track, b.track, wide)) return {};
  *surface = std::move(a.surface);
  *track = std::move(a.track);
  return b;
}

}  // namespace plumb::runtime
