#include "runtime/mapping/mapper.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "runtime/mapping/glimpses.h"
#include "runtime/mapping/keyframe_merging.h"
#include "runtime/mapping/planar_segmentation.h"
#include "runtime/mapping/pose_graph.h"
#include "runtime/mapping/segmentation.h"
#include "runtime/mapping/surface_splitting.h"
#include "runtime/mapping/view_alignment.h"
#include "runtime/odometry/planar/planar_scan.h"

namespace plumb::runtime {
namespace {

constexpr double kPointShare = 2.0 / 3.0;                              // of a point's noise in the spread about a wall
constexpr double kUntimedSweep_s = 0.1;                                // what a sweep without times is taken to last: that of most lidars
constexpr double kPlanarSpacing_m = 0.04;                              // of the points that planar scans are matched by
constexpr double kSettled_m = 0.005, kSettled_rad = 0.001;             // a solve that moves no keyframe by more changes nothing
constexpr double kStandingStill_m = 0.05, kStandingStill_rad = 0.026;  // a keyframe this close to the last one tells nothing new

struct Distance {
  double m, rad;
};

Distance DistanceBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d T = a.inverse() * b;
  return {T.translation().norm(), Eigen::AngleAxisd(T.linear()).angle()};
}

}  // namespace

std::string MapperOptions::Check() const {
  const auto bad = [](const char* field, auto value, const char* rule) {
    return fmt::format("MapperOptions.{} = {}; must be {}", field, value, rule);
  };
  if (!(keyframe_distance_m > 0)) return bad("keyframe_distance_m", keyframe_distance_m, "> 0");
  if (!(keyframe_rotation_rad > 0)) return bad("keyframe_rotation_rad", keyframe_rotation_rad, "> 0");
  if (!(keyframe_interval_s > 0)) return bad("keyframe_interval_s", keyframe_interval_s, "> 0");
  if (!(keyframe_voxel_m >= 0.005 && keyframe_voxel_m <= 1)) return bad("keyframe_voxel_m", keyframe_voxel_m, "in [0.005, 1]");
  if (max_keyframe_points < 100) return bad("max_keyframe_points", max_keyframe_points, ">= 100");
  if (!(min_range_m > 0)) return bad("min_range_m", min_range_m, "> 0");
  if (!(max_range_m > min_range_m)) return bad("max_range_m", max_range_m, "> min_range_m");
  if (!(plane_sigma_m >= 0.002 && plane_sigma_m <= 0.2)) return bad("plane_sigma_m", plane_sigma_m, "in [0.002, 0.2]");
  if (!(redundant_distance_m >= 0)) return bad("redundant_distance_m", redundant_distance_m, ">= 0");
  if (!(redundant_share > 0.5 && redundant_share <= 1)) return bad("redundant_share", redundant_share, "in (0.5, 1]");
  if (well_known_views < 1) return bad("well_known_views", well_known_views, ">= 1");
  if (recent_keyframes < 1) return bad("recent_keyframes", recent_keyframes, ">= 1");
  if (max_map_points < 10000) return bad("max_map_points", max_map_points, ">= 10000");
  if (min_segment_points < 3) return bad("min_segment_points", min_segment_points, ">= 3");
  if (min_line_points < 3) return bad("min_line_points", min_line_points, ">= 3");
  if (!(min_segment_extent_m >= 0)) return bad("min_segment_extent_m", min_segment_extent_m, ">= 0");
  if (!(merge_distance_m > 0)) return bad("merge_distance_m", merge_distance_m, "> 0");
  if (!(merge_angle_rad > 0 && merge_angle_rad < 0.5)) return bad("merge_angle_rad", merge_angle_rad, "in (0, 0.5)");
  if (!(merge_gap_m >= 0)) return bad("merge_gap_m", merge_gap_m, ">= 0");
  return loops.Check();
}

Mapper::Mapper(const MapperOptions& options)
    : options_(options), planar_loops_(kPointShare * options.plane_sigma_m), spatial_loops_(options.loops) {}

bool Mapper::AddScan(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar, const std::optional<Eigen::Matrix3d>& planar_step,
                     bool timed) {
  const bool grown = window_ && WindowIsFull(deskewed.stamp_s, T_odom_lidar) && CloseWindow();
  if (planar_step) planar_loops_.Move(Leveled(T_odom_lidar).pose, *planar_step);
  if (!window_ && planar_step) planar_loops_.Open();
  if (!window_) window_.emplace(options_, deskewed.stamp_s, T_odom_lidar);
  window_->Add(deskewed, T_odom_lidar, planar_step.has_value(), timed ? Smear() : SmearOf(deskewed.stamp_s, T_odom_lidar),
               VelocitySinceLast(deskewed.stamp_s, T_odom_lidar));
  last_scan_ = LastScan{deskewed.stamp_s, T_odom_lidar};
  return grown;
}

// In the axes of odom.
Eigen::Vector3d Mapper::VelocitySinceLast(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const {
  if (!last_scan_ || stamp_s <= last_scan_->stamp_s) return Eigen::Vector3d::Zero();
  return (T_odom_lidar.translation() - last_scan_->T_odom_lidar.translation()) / (stamp_s - last_scan_->stamp_s);
}

// Points of a sweep are evenly spread over the sensor's way meanwhile, at the speed since the last scan, and the pose is that of their
// middle: the root mean square of a uniform distribution of that width. The lidar's axes.
Smear Mapper::SmearOf(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const {
  if (!last_scan_) return {};
  const Eigen::Isometry3d T_now_last = T_odom_lidar.inverse() * last_scan_->T_odom_lidar;
  const Eigen::AngleAxisd turn(T_now_last.linear());
  const double spread = std::sqrt(1.0 / 12) * std::min(1.0, kUntimedSweep_s / (stamp_s - last_scan_->stamp_s));
  const Eigen::Vector3d moved_m = spread * T_now_last.translation(), turned_rad = spread * turn.angle() * turn.axis();
  return {moved_m * moved_m.transpose(), turned_rad * turned_rad.transpose()};
}

bool Mapper::Flush() { return window_ && CloseWindow(); }

bool Mapper::WindowIsFull(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const {
  const Distance moved = DistanceBetween(window_->T_odom_kf(), T_odom_lidar);
  return moved.m >= options_.keyframe_distance_m || moved.rad >= options_.keyframe_rotation_rad ||
         stamp_s - window_->stamp_s() >= options_.keyframe_interval_s;
}

// True if the window became a keyframe.
bool Mapper::CloseWindow() {
  const KeyframeWindow window = std::move(*window_);
  window_.reset();
  if (!graph_.keyframes.empty()) {
    const Distance moved = DistanceBetween(graph_.keyframes.back().T_odom_kf, window.T_odom_kf());
    if (moved.m < kStandingStill_m && moved.rad < kStandingStill_rad) return false;
  }
  Keyframe keyframe;
  keyframe.id = static_cast<uint32_t>(graph_.keyframes.size());
  keyframe.stamp_s = window.stamp_s();
  keyframe.T_odom_kf = window.T_odom_kf();
  keyframe.T_map_kf = T_map_odom_ * window.T_odom_kf();
  ThinnedPoints thinned = window.Thinned();
  keyframe.points = std::move(thinned.points);
  keyframe.standpoints = std::move(thinned.standpoints);
  keyframe.smear = window.smear();
  if (keyframe.points.empty()) return false;
  if (!graph_.keyframes.empty()) {
    const Keyframe& last = graph_.keyframes.back();
    const Distance moved = DistanceBetween(last.T_odom_kf, keyframe.T_odom_kf);
    keyframe.travelled_m = last.travelled_m + moved.m;
    keyframe.turned_rad = last.turned_rad + moved.rad;
  }
  graph_.keyframes.push_back(std::move(keyframe));
  graph_.planar = window.planar();
  const std::vector<Segment> segments = window.planar() ? ExtractLineSegments(window, options_) : ExtractSegments(window, options_);
  for (const Segment& segment : segments) AddSegment(segment, graph_.keyframes.back());
  MergeDuplicates();
  if (window.planar()) {
    ClosePlanarLoops(window);
  } else {
    CloseSpatialLoops();
    BoundKeyframes();
  }
  return true;
}

// Merges the keyframe that has just ceased to be recent, if it can be.
void Mapper::BoundKeyframes() {
  const size_t recent = static_cast<size_t>(options_.recent_keyframes);
  if (graph_.keyframes.size() > recent) {
    const uint32_t oldest = static_cast<uint32_t>(graph_.keyframes.size() - recent - 1);
    if (const std::optional<uint32_t> into = RedundantTo(graph_, oldest, options_)) Merge(oldest, *into);
  }
  BoundPoints(static_cast<size_t>(options_.max_map_points), &graph_.keyframes);
}

// Merged, the two are one body, which no solve will bend: unless a plan has solved their poses, odometry's little errors have to be taken
// out now.
void Mapper::Merge(uint32_t keyframe, uint32_t into) {
  std::vector<Keyframe>& keyframes = graph_.keyframes;
  if (!poses_held_) keyframes[keyframe].T_map_kf = keyframes[into].T_map_kf * AlignedPose(graph_, keyframe, into, options_);
  MergeKeyframe(keyframe, into, &graph_);
  for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
    if (FindObservation(graph_.surfaces[i], into) != nullptr) RecomputeSurface(i);
  }
}

// After a planar keyframe.
void Mapper::ClosePlanarLoops(const KeyframeWindow& window) {
  Scan seen;
  seen.points = window.views().front().points;
  const PreparedScan prepared = PrepareScan(seen, kPlanarSpacing_m, options_.min_range_m, options_.max_range_m);
  std::vector<LeveledPose> poses;
  std::vector<Pose2> planar;
  for (const Keyframe& keyframe : graph_.keyframes) {
    poses.push_back(Leveled(keyframe.T_map_kf));
    planar.push_back(poses.back().pose);
  }
  const bool closed = planar_loops_.Add(MakePlanarScan(prepared, poses.back().leveling, {}, kPointShare * options_.plane_sigma_m), planar);
  graph_.edges = planar_loops_.edges();
  if (!closed || poses_held_) return;
  const std::vector<Pose2> solved = SolvePoseGraph(planar, planar_loops_.edges());
  bool settled = true;
  for (size_t i = 0; i < solved.size(); ++i) {
    const Pose2 moved = Between(planar[i], solved[i]);
    settled = settled && moved.t_m.norm() <= kSettled_m && std::abs(moved.yaw_rad) <= kSettled_rad;
    poses[i].pose = solved[i];
  }
  if (settled) return;
  for (size_t i = 0; i < solved.size(); ++i) graph_.keyframes[i].T_map_kf = poses[i].Lifted();
  OnPosesChanged();
}

void Mapper::CloseSpatialLoops() {
  const std::vector<SpatialEdge> loops = spatial_loops_.Add(graph_);
  graph_.loops.insert(graph_.loops.end(), loops.begin(), loops.end());
  if (loops.empty() || poses_held_) return;
  const bool settled = std::all_of(loops.begin(), loops.end(), [&](const SpatialEdge& loop) {
    const Distance off = DistanceBetween(graph_.keyframes[loop.from].T_map_kf * loop.T_from_to, graph_.keyframes[loop.to].T_map_kf);
    return off.m <= kSettled_m && off.rad <= kSettled_rad;
  });
  if (settled) return;
  const std::vector<Eigen::Isometry3d> solved = SolvePoseGraph(graph_.keyframes, spatial_loops_.EdgesOf(graph_));
  for (size_t i = 0; i < solved.size(); ++i) graph_.keyframes[i].T_map_kf = solved[i];
  OnPosesChanged();
}

void Mapper::AddSegment(const Segment& segment, const Keyframe& keyframe) {
  TrackedSurface candidate = SurfaceOf(segment, keyframe);
  size_t best = graph_.surfaces.size();
  double best_m = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
    if (graph_.surfaces[i].observations.empty()) continue;
    const double distance_m = SurfaceDistance(tracks_[i].patch, candidate.track.patch, options_);
    if (distance_m >= best_m || !FitOnePlane(tracks_[i], candidate.track, options_)) continue;
    best = i;
    best_m = distance_m;
  }
  if (best < graph_.surfaces.size()) {
    AbsorbInto(best, candidate);
    return;
  }
  if (IsEcho(candidate.surface, candidate.track.patch, graph_.surfaces, tracks_, balls_)) return;
  Put(std::move(candidate), graph_.surfaces.size());
}

// Into an empty slot, or a new one behind all.
void Mapper::Put(TrackedSurface surface, size_t slot) {
  if (slot == graph_.surfaces.size()) {
    graph_.surfaces.emplace_back();
    balls_.emplace_back();
    tracks_.push_back(surface.track);
  }
  surface.surface.id = static_cast<uint32_t>(slot);
  graph_.surfaces[slot] = std::move(surface.surface);
  balls_[slot] = surface.track.patch.ball();
  tracks_[slot] = std::move(surface.track);
}

void Mapper::AbsorbInto(size_t i, const TrackedSurface& other) {
  Absorb(other, graph_.keyframes, &graph_.surfaces[i], &tracks_[i]);
  balls_[i] = tracks_[i].patch.ball();
}

void Mapper::RecomputeSurface(size_t i) {
  Recompute(graph_.keyframes, &graph_.surfaces[i], &tracks_[i]);
  balls_[i] = tracks_[i].patch.ball();
}

void Mapper::Empty(size_t i) {
  const uint32_t id = graph_.surfaces[i].id;
  graph_.surfaces[i] = {};
  graph_.surfaces[i].id = id;
  SurfacePatch& patch = tracks_[i].patch;
  patch.Forget(std::vector<bool>(patch.cells().size(), true));
  balls_[i] = {};
}

// Each part may split again. Parts go where nothing is, so that splitting and merging in turn takes no memory.
std::vector<SurfaceSplit> Mapper::SplitSurfaces() {
  std::vector<SurfaceSplit> out;
  std::vector<MapSurface>& surfaces = graph_.surfaces;
  std::vector<size_t> queue(surfaces.size());
  std::iota(queue.rbegin(), queue.rend(), size_t{0});
  while (!queue.empty()) {
    const size_t i = queue.back();
    std::optional<TrackedSurface> part = SplitOff(graph_.keyframes, options_, &surfaces[i], &tracks_[i]);
    if (!part) {
      queue.pop_back();
      continue;
    }
    balls_[i] = tracks_[i].patch.ball();
    const size_t slot = static_cast<size_t>(
        std::find_if(surfaces.begin(), surfaces.end(), [](const MapSurface& s) { return s.observations.empty(); }) - surfaces.begin());
    Put(std::move(*part), slot);
    queue.push_back(slot);
    out.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(slot)});
  }
  return out;
}

// Whether two surfaces are one. `settled` as in OnPosesChanged().
bool Mapper::AreOne(size_t i, size_t k, bool settled) const {
  const std::vector<MapSurface>& surfaces = graph_.surfaces;
  const bool directed = !settled || (surfaces[i].observations.size() > 1 && surfaces[k].observations.size() > 1);
  return !std::isinf(SurfaceDistance(tracks_[i].patch, tracks_[k].patch, options_, directed)) &&
         FitOnePlane(tracks_[i], tracks_[k], options_) &&
         (graph_.planar || !LieOnTwoPlanes(surfaces[i], surfaces[k], graph_.keyframes, options_));
}

// The older of two surfaces stays; the younger keeps its slot, empty. `settled` as in OnPosesChanged().
void Mapper::MergeDuplicates(bool settled) {
  std::vector<MapSurface>& surfaces = graph_.surfaces;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    for (size_t k = i + 1; k < surfaces.size(); ++k) {
      if (surfaces[i].observations.empty()) break;
      if (surfaces[k].observations.empty() || !MayTouch(balls_[i], balls_[k], options_)) continue;
      if (!AreOne(i, k, settled)) continue;
      AbsorbInto(i, {std::move(surfaces[k]), std::move(tracks_[k])});
      Empty(k);
      k = i;  // the grown surface may reach others
    }
  }
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (!surfaces[i].observations.empty() && IsEcho(surfaces[i], tracks_[i].patch, surfaces, tracks_, balls_)) Empty(i);
  }
}

void Mapper::DropEchoCells() {
  std::vector<std::vector<bool>> gone(graph_.surfaces.size());
  for (size_t i = 0; i < gone.size(); ++i) {
    if (!graph_.surfaces[i].observations.empty())
      gone[i] = EchoCells(graph_.surfaces[i], tracks_[i].patch, graph_.surfaces, tracks_, balls_);
  }
  for (size_t i = 0; i < gone.size(); ++i) {
    if (std::find(gone[i].begin(), gone[i].end(), true) == gone[i].end()) continue;
    if (TakeCells(gone[i], options_, &graph_.surfaces[i], &tracks_[i])) {
      balls_[i] = tracks_[i].patch.ball();
    } else {
      Empty(i);
    }
  }
}

void Mapper::DropGlimpses() {
  for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
    if (IsGlimpse(graph_.surfaces[i], balls_[i].center, graph_.keyframes)) Empty(i);
  }
}

std::vector<SurfaceSplit> Mapper::OnPosesChanged(bool settled) {
  for (Keyframe& keyframe : graph_.keyframes) {
    if (keyframe.merged) keyframe.T_map_kf = graph_.keyframes[keyframe.merged->into].T_map_kf * keyframe.merged->T_into_kf;
  }
  for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
    if (!graph_.surfaces[i].observations.empty()) RecomputeSurface(i);
  }
  std::vector<SurfaceSplit> splits;
  if (!graph_.planar) splits = SplitSurfaces();
  MergeDuplicates(settled && !graph_.planar);
  if (settled && !graph_.planar) {
    DropEchoCells();
    DropGlimpses();
  }
  if (graph_.keyframes.empty()) return splits;
  const Keyframe& newest = graph_.keyframes.back();
  T_map_odom_ = newest.T_map_kf * newest.T_odom_kf.inverse();
  return splits;
}

}  // namespace plumb::runtime
