#include "runtime/mapping/wall_splitting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::runtime {
namespace {

constexpr double kBandSigmas = 3.0;  // about the plane
constexpr size_t kMinColumnPoints = 30;
constexpr double kFlatness_m = 0.004;      // of walls and of the poses that they are seen from
constexpr double kMedianVariance = 1.571;  // of a median, times that of a mean
constexpr size_t kMinColumns = 5;          // of a piece
constexpr double kMaxChi2 = 9;
constexpr double kMinGain = 30;  // of chi square for two more parameters, at the best of many cuts
constexpr double kMinStep_m = 0.015;
constexpr double kMinShare = 0.05;  // of a keyframe's points: fewer on one piece are its noise beyond the cut

struct Line {
  double offset_m = 0, slope = 0;  // at along_m = 0
  double chi2 = 0;                 // no column counts for more than kMaxChi2
  [[nodiscard]] double At(double along_m) const { return offset_m + slope * along_m; }
};

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// By medians of all pairs' slopes (Theil and Sen) and of what they leave: a casing or a box on a third of a wall does not turn it.
Line FitLine(std::span<const WallColumn> columns) {
  std::vector<double> values;
  values.reserve(columns.size() * (columns.size() - 1) / 2);
  for (size_t i = 0; i < columns.size(); ++i) {
    for (size_t k = i + 1; k < columns.size(); ++k)
      values.push_back((columns[k].offset_m - columns[i].offset_m) / (columns[k].along_m - columns[i].along_m));
  }
  Line line;
  line.slope = Median(values);
  values.clear();
  for (const WallColumn& c : columns) values.push_back(c.offset_m - line.slope * c.along_m);
  line.offset_m = Median(values);
  for (const WallColumn& c : columns) {
    const double off_m = c.offset_m - line.At(c.along_m);
    line.chi2 += std::min(kMaxChi2, off_m * off_m / c.variance_m2);
  }
  return line;
}

// Calls visit(p, along_m, offset_m) for what a keyframe kept of the surface, p in the keyframe's frame.
template <class Visit>
void ForEachPoint(const Keyframe& keyframe, const SurfacePatch& patch, const MapperOptions& options, const Visit& visit) {
  const double band_m = kBandSigmas * options.plane_sigma_m;
  const Plane plane = patch.plane().Transformed(keyframe.T_map_kf.inverse());  // most points are not near it
  for (const Eigen::Vector3f& point : keyframe.points) {
    const Eigen::Vector3d p = point.cast<double>();
    const double offset_m = plane.SignedDistance(p);
    if (std::abs(offset_m) > band_m) continue;
    const Eigen::Vector3d p_map = keyframe.T_map_kf * p;
    if (patch.ViewsAt(p_map, band_m) > 0) visit(p, patch.Coordinates(p_map).x(), offset_m);
  }
}

std::vector<bool> Beyond(const SurfacePatch& patch, double along_m) {
  std::vector<bool> out;
  out.reserve(patch.cells().size());
  for (const Eigen::Vector2f& cell : patch.cells()) out.push_back(static_cast<double>(cell.x()) > along_m);
  return out;
}

}  // namespace

std::vector<WallColumn> ColumnsOf(const MapSurface& surface, const SurfaceTrack& track, const std::vector<Keyframe>& keyframes,
                                  const MapperOptions& options) {
  const double from_m = track.patch.lo().x() - 0.5 * kColumn_m;
  const auto num_columns = static_cast<size_t>((track.patch.hi().x() - from_m) / kColumn_m) + 1;
  std::vector<std::vector<double>> offsets_m(num_columns);
  for (const Observation& o : surface.observations) {
    ForEachPoint(keyframes[o.keyframe], track.patch, options, [&](const Eigen::Vector3d&, double along_m, double offset_m) {
      const double column = (along_m - from_m) / kColumn_m;
      if (column >= 0 && column < static_cast<double>(num_columns)) offsets_m[static_cast<size_t>(column)].push_back(offset_m);
    });
  }
  std::vector<WallColumn> columns;
  for (size_t i = 1; i + 1 < num_columns; ++i) {  // at its ends stand other walls
    std::vector<double>& values = offsets_m[i];
    if (values.size() < kMinColumnPoints) continue;
    const double noise_m2 = kMedianVariance * options.plane_sigma_m * options.plane_sigma_m / static_cast<double>(values.size());
    columns.push_back({from_m + (static_cast<double>(i) + 0.5) * kColumn_m, Median(values), kFlatness_m * kFlatness_m + noise_m2});
  }
  return columns;
}

std::optional<double> FindCut(std::span<const WallColumn> columns) {
  if (columns.size() < 2 * kMinColumns) return std::nullopt;
  double least = FitLine(columns).chi2 - kMinGain;
  if (least <= 0) return std::nullopt;
  std::optional<double> cut;
  for (size_t k = kMinColumns; k + kMinColumns <= columns.size(); ++k) {
    const std::span<const WallColumn> before = columns.first(k), after = columns.subspan(k);
    const Line a = FitLine(before), b = FitLine(after);
    if (a.chi2 + b.chi2 >= least) continue;
    const double at_m = 0.5 * (before.back().along_m + after.front().along_m);
    const double end_m = k < columns.size() - k ? before.front().along_m : after.back().along_m;
    least = a.chi2 + b.chi2;
    const double apart_m = std::max(std::abs(a.At(at_m) - b.At(at_m)), std::abs(a.At(end_m) - b.At(end_m)));
    cut = apart_m >= kMinStep_m ? std::optional(at_m) : std::nullopt;
  }
  return cut;
}

std::optional<TrackedSurface> CutWall(double along_m, const std::vector<Keyframe>& keyframes, const MapperOptions& options,
                                      MapSurface* surface, SurfaceTrack* track) {
  TrackedSurface here{*surface, *track}, beyond{*surface, *track};
  here.surface.observations.clear();
  beyond.surface.observations.clear();
  for (const Observation& o : surface->observations) {
    const Keyframe& keyframe = keyframes[o.keyframe];
    PlaneStats a, b;
    ForEachPoint(keyframe, track->patch, options, [&](const Eigen::Vector3d& p, double at_m, double) { (at_m > along_m ? b : a).Add(p); });
    const double total = a.count() + b.count();
    const bool in_doubt = total == 0;  // its points were merged away
    const bool centre_beyond = track->patch.Coordinates(keyframe.T_map_kf * o.stats.centroid()).x() > along_m;
    if (in_doubt ? centre_beyond : a.count() < kMinShare * total) {
      beyond.surface.observations.push_back(o);
    } else if (in_doubt || b.count() < kMinShare * total) {
      here.surface.observations.push_back(o);
    } else {
      here.surface.observations.push_back({o.keyframe, a});
      beyond.surface.observations.push_back({o.keyframe, b});
    }
  }
  if (here.surface.observations.empty() || beyond.surface.observations.empty()) return std::nullopt;
  std::vector<bool> gone = Beyond(track->patch, along_m);
  if (!TakeCells(gone, options, &here.surface, &here.track)) return std::nullopt;
  gone.flip();
  if (!TakeCells(gone, options, &beyond.surface, &beyond.track)) return std::nullopt;
  Recompute(keyframes, &here.surface, &here.track);
  Recompute(keyframes, &beyond.surface, &beyond.track);
  *surface = std::move(here.surface);
  *track = std::move(here.track);
  return beyond;
}

}  // namespace plumb::runtime
