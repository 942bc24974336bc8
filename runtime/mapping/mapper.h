// Turns registered scans into the S-Graph: keyframes, planar segments, data association, merging.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/mapping/keyframe_window.h"
#include "runtime/mapping/loop_closure.h"
#include "runtime/mapping/map_surfaces.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

// Of SGraph::surfaces: `from` keeps its slot and the larger part, the other is in `part`, which was empty or is new.
struct SurfaceSplit {
  uint32_t from = 0, part = 0;
};

// Scans are gathered in a window that opens at a keyframe's pose and closes when the robot has moved on; the closed window is the keyframe.
// A robot that stands still makes no further keyframes, one that comes by again makes none that last (keyframe_merging.h). So memory grows
// with the area driven through (points, 130 bytes per surface seen from a keyframe, cells), and by 0.4 kB per keyframe with time.
class Mapper {
 public:
  explicit Mapper(const MapperOptions& options = {});

  // Adds one deskewed scan, points in the lidar frame at its stamp. True if it closed a keyframe, i.e. the graph has grown.
  // `planar_step`: of a planar laser (OdometryResult::planar), the covariance of (x, y, yaw) of the motion since the last scan. Its scans
  // see walls only, as lines (planar_segmentation.h), and the loops they make are closed here (loop_closure.h). `timed`: its points were
  // put where the sensor was when each was measured; else the keyframe is smeared by the motion meanwhile.
  bool AddScan(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar,
               const std::optional<Eigen::Matrix3d>& planar_step = std::nullopt, bool timed = true);
  // While the plan holds the keyframes' poses, loops are found but move nothing: they know nothing of the plan and would pull the map off
  // it.
  void HoldPoses(bool hold) { poses_held_ = hold; }
  // Makes a keyframe of what AddScan() has gathered since the last one, at a recording's end. True if the graph has grown.
  bool Flush();

  // From odometry's frame to the map's; changes when the optimizer moves keyframes.
  [[nodiscard]] const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }

  [[nodiscard]] const SGraph& graph() const { return graph_; }
  [[nodiscard]] SGraph& mutable_graph() { return graph_; }

  // After keyframe poses in mutable_graph() were changed: recomputes surface planes and extents, splits what no longer lies on one plane,
  // merges what now coincides, and takes T_map_odom from the newest keyframe. Maps of planar lasers are not split. `settled`: the poses are
  // those of the last solve, and nothing more is to be seen of what was seen from one keyframe alone; then that is merged whatever its
  // direction, cells that are echoes are taken from their surfaces for good, and glimpses (glimpses.h) are dropped. O(observations log
  // observations + surfaces^2), and O(points of the views' keyframes) for a surface whose views lie on two planes. Returns what was split,
  // in that order.
  std::vector<SurfaceSplit> OnPosesChanged(bool settled = false);

 private:
  [[nodiscard]] bool WindowIsFull(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const;
  bool CloseWindow();
  [[nodiscard]] Eigen::Vector3d VelocitySinceLast(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const;
  [[nodiscard]] Smear SmearOf(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) const;
  void AddSegment(const Segment& segment, const Keyframe& keyframe);
  void AbsorbInto(size_t i, const TrackedSurface& other);
  void RecomputeSurface(size_t i);
  void Put(TrackedSurface surface, size_t slot);
  void Empty(size_t i);
  [[nodiscard]] bool AreOne(size_t i, size_t k, bool settled) const;
  std::vector<SurfaceSplit> SplitSurfaces();
  void ClosePlanarLoops(const KeyframeWindow& window);
  void CloseSpatialLoops();
  void MergeDuplicates(bool settled = false);
  void DropEchoCells();
  void DropGlimpses();
  void BoundKeyframes();
  void Merge(uint32_t keyframe, uint32_t into);

  MapperOptions options_;
  SGraph graph_;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
  std::vector<SurfaceTrack> tracks_;  // of each surface
  std::vector<Ball> balls_;           // of each track's patch
  std::optional<KeyframeWindow> window_;
  struct LastScan {
    double stamp_s = 0;
    Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
  };
  std::optional<LastScan> last_scan_;
  LoopCloser planar_loops_;
  SpatialLoops spatial_loops_;
  bool poses_held_ = false;
};

}  // namespace plumb::runtime
