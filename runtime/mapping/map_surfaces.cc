#include "runtime/mapping/map_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/mapping/cell_planes.h"
#include "runtime/mapping/plane_fit.h"

namespace plumb::runtime {
namespace {

constexpr double kSameFacingCos = 0.8;
// Two views of one surface may differ in direction by this much at the shorter one's ends, and by odometry's drift.
constexpr double kEndOffset_m = 0.03, kMinAngle_rad = 0.02;
constexpr double kMaxJointOff =
    0.5;  // of the merge distance: how much further from the common plane than from its own a part's points may be, rms
constexpr double kEchoPoints = 0.2, kEchoFacingCos = 0.94, kEchoDistance_m = 0.15, kEchoShare = 0.6;
constexpr uint32_t kEchoViews = 5;         // times an echo's
constexpr uint32_t kOwnViews = 2;          // times the stronger surface's views of a place make it the weaker one's
constexpr double kEdge_m = 0.5 * kCell_m;  // a cell's mean point lies inside the surface's edge by about this

double MeanSquareDistance(const PlaneStats& sum, const Plane& plane) {
  const Eigen::Vector4d p(plane.n.x(), plane.n.y(), plane.n.z(), plane.d);
  return p.dot(sum.C * p) / sum.count();
}

// Angle between the normals; for walls of their horizontal parts, since low segments know little of their tilt.
double NormalAngle(const Plane& a, const Plane& b, SurfaceKind kind) {
  if (kind != SurfaceKind::kWall) return std::acos(std::clamp(a.n.dot(b.n), -1.0, 1.0));
  return std::abs(std::atan2(a.n.x() * b.n.y() - a.n.y() * b.n.x(), a.n.head<2>().dot(b.n.head<2>())));
}

void UpdateExtent(const SurfaceTrack& track, MapSurface* surface) {
  MapSurface& s = *surface;
  const SurfacePatch& patch = track.patch;
  s.area_m2 = patch.area_m2();
  const Eigen::Vector2d lo = patch.lo().array() - kEdge_m, hi = patch.hi().array() + kEdge_m;
  const double middle = 0.5 * (lo.y() + hi.y());
  if (s.kind == SurfaceKind::kWall) {
    s.start = patch.Point({lo.x(), middle}).head<2>();
    s.end = patch.Point({hi.x(), middle}).head<2>();
    s.z_min_m = patch.Point({lo.x(), lo.y()}).z();
    s.z_max_m = patch.Point({lo.x(), hi.y()}).z();
    s.cells.clear();
    for (const Eigen::Vector2f& at : patch.cells()) {
      const Eigen::Vector2d c = at.cast<double>();
      s.cells.emplace_back(static_cast<float>(c.x() - lo.x()), static_cast<float>(patch.Point(c).z()));
    }
    return;
  }
  s.z_min_m = s.z_max_m = track.sum.centroid().z();
  s.start.setConstant(std::numeric_limits<double>::infinity());
  s.end = -s.start;
  for (const Eigen::Vector2d& corner : {lo, hi, Eigen::Vector2d(lo.x(), hi.y()), Eigen::Vector2d(hi.x(), lo.y())}) {
    const Eigen::Vector2d p = patch.Point(corner).head<2>();
    s.start = s.start.cwiseMin(p);
    s.end = s.end.cwiseMax(p);
  }
}

// `towards`: roughly the normal.
void UpdatePlane(const std::vector<Keyframe>& keyframes, const Eigen::Vector3d& towards, MapSurface* surface, SurfaceTrack* track) {
  surface->plane = FitPlane(track->sum, towards).plane;
  surface->num_points = track->sum.count();
  track->patch.Follow(keyframes[track->patch.keyframe()].T_map_kf, surface->plane);
}

bool AreWithin(const Ball& a, const Ball& b, double margin_m) {
  const double reach_m = a.radius_m + b.radius_m + margin_m;
  return (a.center - b.center).squaredNorm() <= reach_m * reach_m;
}

// From its ball, what a surface may cover or have seen.
double EchoReach_m() { return kEchoDistance_m + std::numbers::sqrt2 * SurfacePatch::CoverMargin_m(); }

// Bounds of b in a's coordinates.
struct Bounds {
  Eigen::Vector2d lo, hi;
  [[nodiscard]] bool Meet(const SurfacePatch& a) const {
    return (lo.array() <= a.hi().array()).all() && (hi.array() >= a.lo().array()).all();
  }
};
Bounds BoundsIn(const SurfacePatch& a, const SurfacePatch& b) {
  Bounds bounds;
  bounds.lo.setConstant(std::numeric_limits<double>::infinity());
  bounds.hi = -bounds.lo;
  for (const Eigen::Vector2d& corner : {b.lo(), b.hi(), Eigen::Vector2d(b.lo().x(), b.hi().y()), Eigen::Vector2d(b.hi().x(), b.lo().y())}) {
    const Eigen::Vector2d at = a.Coordinates(b.Point(corner));
    bounds.lo = bounds.lo.cwiseMin(at);
    bounds.hi = bounds.hi.cwiseMax(at);
  }
  return bounds;
}

}  // namespace

TrackedSurface SurfaceOf(const Segment& segment, const Keyframe& keyframe) {
  MapSurface s;
  s.kind = segment.kind;
  s.plane = segment.plane.Transformed(keyframe.T_map_kf);
  s.observations = {{keyframe.id, segment.stats}};
  const PlaneStats sum = segment.stats.Transformed(keyframe.T_map_kf);
  s.num_points = sum.count();
  SurfacePatch patch(keyframe.id, keyframe.T_map_kf, s.plane, s.kind, sum.centroid(), segment.cell_height_m);
  for (const Eigen::Vector3f& cell : segment.cells) patch.Mark(keyframe.T_map_kf * cell.cast<double>());
  TrackedSurface tracked{std::move(s), {std::move(patch), sum}};
  UpdateExtent(tracked.track, &tracked.surface);
  return tracked;
}

double SurfaceDistance(const SurfacePatch& a, const SurfacePatch& b, const MapperOptions& options, bool directed) {
  constexpr double kApart = std::numeric_limits<double>::infinity();
  if (a.kind() != b.kind() || a.plane().n.dot(b.plane().n) < kSameFacingCos) return kApart;
  const double shorter_m = std::min(a.hi().x() - a.lo().x(), b.hi().x() - b.lo().x());
  const double end_angle_rad = directed ? kEndOffset_m / shorter_m : options.merge_angle_rad;
  const double max_angle_rad = std::clamp(end_angle_rad, kMinAngle_rad, std::max(kMinAngle_rad, options.merge_angle_rad));
  if (NormalAngle(a.plane(), b.plane(), a.kind()) > max_angle_rad) return kApart;
  const Bounds other = BoundsIn(a, b);
  const Eigen::Vector2d from = a.lo().cwiseMax(other.lo), to = a.hi().cwiseMin(other.hi);
  const Eigen::Vector2d overlap_m = to - from;
  if (-overlap_m.minCoeff() > options.merge_gap_m) return kApart;
  const Eigen::Vector2d middle = 0.5 * (from + to);
  const bool at_ends = overlap_m.x() > 0 && a.kind() == SurfaceKind::kWall;
  double sum_m = 0, worst_m = 0;
  for (const double u : {at_ends ? from.x() : middle.x(), at_ends ? to.x() : middle.x()}) {
    const double offset_m = std::abs(b.plane().SignedDistance(a.Point({u, middle.y()})));
    sum_m += offset_m;
    worst_m = std::max(worst_m, offset_m);
  }
  return worst_m <= options.merge_distance_m ? 0.5 * sum_m : kApart;
}

// Where two surfaces that are one are compared, each reaches to within a gap in both coordinates, and their planes to within the merge
// distance of each other. What one covers in the other's coordinates is bounded by a rectangle, as turned: up to sqrt(2) times its ball.
bool MayTouch(const Ball& a, const Ball& b, const MapperOptions& options) {
  const double margin_m = 4 * options.merge_gap_m + 4 * options.merge_distance_m;
  return AreWithin({a.center, std::numbers::sqrt2 * a.radius_m}, {b.center, std::numbers::sqrt2 * b.radius_m}, margin_m);
}

bool FitOnePlane(const SurfaceTrack& a, const SurfaceTrack& b, const MapperOptions& options) {
  return FitOnePlane(a.sum, b.sum, a.patch.plane().n, options);
}

bool FitOnePlane(const PlaneStats& a, const PlaneStats& b, const Eigen::Vector3d& towards, const MapperOptions& options) {
  PlaneStats both = a;
  both.Add(b);
  const Plane joint = FitPlane(both, towards).plane;
  const double max_off_m = kMaxJointOff * options.merge_distance_m;
  const auto fits = [&](const PlaneStats& sum) {
    const double own_m = FitPlane(sum, towards).rms_m, joint_m2 = MeanSquareDistance(sum, joint);
    return joint_m2 - own_m * own_m <= max_off_m * max_off_m;
  };
  return fits(a) && fits(b);
}

double CoveredShare(const SurfacePatch& b, const std::vector<const SurfacePatch*>& by, double distance_m) {
  const std::vector<Eigen::Vector3d> cells = b.CellPoints();
  size_t covered = 0;
  for (size_t c = 0; c < cells.size(); ++c) {
    // A wall's plane may graze the next one, of which it has a few cells then: many points elsewhere are no evidence here.
    covered += std::any_of(by.begin(), by.end(),
                           [&](const SurfacePatch* a) { return kOwnViews * a->ViewsAbout(cells[c], distance_m) >= b.views()[c]; });
  }
  return static_cast<double>(covered) / static_cast<double>(cells.size());
}

bool IsEcho(const MapSurface& b, const SurfacePatch& b_patch, const std::vector<MapSurface>& surfaces,
            const std::vector<SurfaceTrack>& tracks, const std::vector<Ball>& balls) {
  const Ball b_ball = b_patch.ball();
  std::vector<const SurfacePatch*> stronger;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (!AreWithin(b_ball, balls[i], EchoReach_m())) continue;
    const MapSurface& a = surfaces[i];
    const bool strong = a.kind == b.kind && !a.observations.empty() && b.num_points <= kEchoPoints * a.num_points;
    if (strong && a.plane.n.dot(b.plane.n) >= kEchoFacingCos) stronger.push_back(&tracks[i].patch);
  }
  return !stronger.empty() && CoveredShare(b_patch, stronger, kEchoDistance_m) >= kEchoShare;
}

std::vector<bool> EchoCells(const MapSurface& b, const SurfacePatch& b_patch, const std::vector<MapSurface>& surfaces,
                            const std::vector<SurfaceTrack>& tracks, const std::vector<Ball>& balls) {
  const Ball b_ball = b_patch.ball();
  const std::vector<Eigen::Vector3d> cells = b_patch.CellPoints();
  std::vector<bool> echo(cells.size(), false);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const MapSurface& a = surfaces[i];
    const SurfacePatch& a_patch = tracks[i].patch;
    if (!AreWithin(b_ball, balls[i], EchoReach_m())) continue;
    if (a.observations.size() < kEchoViews || a.kind != b.kind || &a_patch == &b_patch || a.plane.n.dot(b.plane.n) < kEchoFacingCos ||
        !BoundsIn(a_patch, b_patch).Meet(a_patch))
      continue;
    for (size_t c = 0; c < cells.size(); ++c) {
      if (!echo[c]) echo[c] = a_patch.ViewsAt(cells[c], kEchoDistance_m) >= kEchoViews * b_patch.views()[c];
    }
  }
  return echo;
}

bool IsLargeEnough(const SurfacePatch& patch, const MapperOptions& options) {
  const double extent_m = options.min_segment_extent_m, area_m2 = kCell_m * kCell_m * static_cast<double>(patch.cells().size());
  return area_m2 >= extent_m * extent_m && patch.hi().x() - patch.lo().x() + 2 * kEdge_m >= extent_m;
}

bool TakeCells(const std::vector<bool>& gone, const MapperOptions& options, MapSurface* surface, SurfaceTrack* track) {
  track->patch.Forget(gone);
  if (!IsLargeEnough(track->patch, options)) return false;
  UpdateExtent(*track, surface);
  return true;
}

void AddObservations(const std::vector<Observation>& more, std::vector<Observation>* observations) {
  for (const Observation& o : more) {
    const auto at = std::lower_bound(observations->begin(), observations->end(), o.keyframe,
                                     [](const Observation& x, uint32_t keyframe) { return x.keyframe < keyframe; });
    if (at != observations->end() && at->keyframe == o.keyframe) {
      at->stats.Add(o.stats);
    } else {
      observations->insert(at, o);
    }
  }
}

void Absorb(const TrackedSurface& b, const std::vector<Keyframe>& keyframes, MapSurface* a, SurfaceTrack* a_track) {
  AddObservations(b.surface.observations, &a->observations);
  a_track->sum.Add(b.track.sum);
  UpdatePlane(keyframes, a->plane.n, a, a_track);
  a_track->patch.MarkAll(b.track.patch);
  UpdateExtent(*a_track, a);
}

void Recompute(const std::vector<Keyframe>& keyframes, MapSurface* surface, SurfaceTrack* track) {
  track->sum = {};
  for (const Observation& o : surface->observations) track->sum.Add(o.stats.Transformed(keyframes[o.keyframe].T_map_kf));
  UpdatePlane(keyframes, track->patch.NormalGuess(keyframes[track->patch.keyframe()].T_map_kf), surface, track);
  UpdateExtent(*track, surface);
}

}  // namespace plumb::runtime
