// Where on a map surface points were seen.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

// Occupied cells on a plane, in coordinates (along, across) of AxesOf() about an anchor point. The anchor is kept in the frame of a
// keyframe, so that the patch follows when the optimizer moves it; everything that is returned is in the map frame.
class SurfacePatch {
 public:
  // `keyframe` is the first that saw the surface and T_map_kf its pose; `at` a point near the plane; `cell_height_m` as in Segment.
  SurfacePatch(uint32_t keyframe, const Eigen::Isometry3d& T_map_kf, const Plane& plane, SurfaceKind kind, const Eigen::Vector3d& at,
               double cell_height_m);

  // Marks the cell of p as seen from so many keyframes more and extends the bounds to p.
  void Mark(const Eigen::Vector3d& p, uint32_t views = 1);
  // Marks the cells of another patch.
  void MarkAll(const SurfacePatch& other);
  // Forgets the cells for which gone[i] is true, in the order of cells(), and fits the bounds to those left.
  void Forget(const std::vector<bool>& gone);
  // Moves onto the new plane after it or the keyframe's pose has changed.
  void Follow(const Eigen::Isometry3d& T_map_kf, const Plane& plane);

  [[nodiscard]] uint32_t keyframe() const { return keyframe_; }
  [[nodiscard]] SurfaceKind kind() const { return kind_; }
  [[nodiscard]] const Plane& plane() const { return plane_; }
  // Where the normal points, if the surface has turned with the keyframe.
  [[nodiscard]] Eigen::Vector3d NormalGuess(const Eigen::Isometry3d& T_map_kf) const { return T_map_kf.linear() * normal_kf_; }
  [[nodiscard]] Eigen::Vector2d Coordinates(const Eigen::Vector3d& p) const { return {along_.dot(p - anchor_), across_.dot(p - anchor_)}; }
  [[nodiscard]] Eigen::Vector3d Point(const Eigen::Vector2d& coordinates) const {
    return anchor_ + coordinates.x() * along_ + coordinates.y() * across_;
  }
  // Bounds of what was marked.
  [[nodiscard]] const Eigen::Vector2d& lo() const { return lo_; }
  [[nodiscard]] const Eigen::Vector2d& hi() const { return hi_; }
  // Around these bounds. Map frame.
  [[nodiscard]] Ball ball() const { return {Point(0.5 * (lo_ + hi_)), 0.5 * (hi_ - lo_).norm()}; }
  // Coordinates of the first point marked in every cell, in that order; and the points.
  [[nodiscard]] const std::vector<Eigen::Vector2f>& cells() const { return cells_; }
  [[nodiscard]] std::vector<Eigen::Vector3d> CellPoints() const;
  // From how many keyframes each cell was seen, in that order, roughly: where cells of different grids meet, one may count twice. And of
  // the cell that p lies on, within distance_m of the plane: 0 if there is none.
  [[nodiscard]] const std::vector<uint32_t>& views() const { return views_; }
  [[nodiscard]] uint32_t ViewsAt(const Eigen::Vector3d& p, double distance_m) const;
  // The same of the cell with most views of those on or next to which p lies.
  [[nodiscard]] uint32_t ViewsAbout(const Eigen::Vector3d& p, double distance_m) const;
  [[nodiscard]] double cell_height_m() const { return cell_height_m_; }
  [[nodiscard]] double area_m2() const;
  // How far outside the bounds, in either coordinate, a point may have views about it: less than this.
  [[nodiscard]] static double CoverMargin_m();

 private:
  uint32_t keyframe_;
  SurfaceKind kind_;
  double cell_height_m_;
  Plane plane_;
  Eigen::Vector3d anchor_kf_, along_kf_, normal_kf_;  // keyframe frame
  Eigen::Vector3d anchor_, along_, across_;           // map frame
  VoxelIndex index_;
  std::vector<Eigen::Vector2f> cells_;  // coordinates of each cell's first point
  std::vector<uint32_t> views_;         // of each cell
  Eigen::Vector2d lo_, hi_;
};

}  // namespace plumb::runtime
