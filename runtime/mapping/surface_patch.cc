#include "runtime/mapping/surface_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/mapping/cell_planes.h"

namespace plumb::runtime {

SurfacePatch::SurfacePatch(uint32_t keyframe, const Eigen::Isometry3d& T_map_kf, const Plane& plane, SurfaceKind kind,
                           const Eigen::Vector3d& at, double cell_height_m)
    : keyframe_(keyframe), kind_(kind), cell_height_m_(cell_height_m) {
  lo_.setConstant(std::numeric_limits<double>::infinity());
  hi_ = -lo_;
  anchor_kf_ = T_map_kf.inverse() * at;
  along_kf_ = T_map_kf.linear().transpose() * AxesOf(plane, kind, Eigen::Vector3d::UnitZ()).along;
  normal_kf_ = T_map_kf.linear().transpose() * plane.n;
  Follow(T_map_kf, plane);
}

void SurfacePatch::Follow(const Eigen::Isometry3d& T_map_kf, const Plane& plane) {
  plane_ = plane;
  const Eigen::Vector3d anchor = T_map_kf * anchor_kf_;
  anchor_ = anchor - plane.SignedDistance(anchor) * plane.n;
  // A wall's direction follows from its plane; a floor's does not and turns with the keyframe.
  const Eigen::Vector3d along =
      kind_ == SurfaceKind::kWall ? AxesOf(plane, kind_, Eigen::Vector3d::UnitZ()).along : Eigen::Vector3d(T_map_kf.linear() * along_kf_);
  along_ = (along - plane.n.dot(along) * plane.n).normalized();
  across_ = kind_ == SurfaceKind::kWall ? along_.cross(plane.n) : plane.n.cross(along_);
}

void SurfacePatch::Mark(const Eigen::Vector3d& p, uint32_t views) {
  const Eigen::Vector2d at = Coordinates(p);
  lo_ = lo_.cwiseMin(at);
  hi_ = hi_.cwiseMax(at);
  const auto [cell, is_new] = index_.Insert(VoxelKey({at.x() / kCell_m, at.y() / kCell_m, 0}));
  if (is_new) {
    cells_.push_back(at.cast<float>());
    views_.push_back(0);
  }
  views_[cell] += views;
}

void SurfacePatch::MarkAll(const SurfacePatch& other) {
  for (size_t i = 0; i < other.cells_.size(); ++i) Mark(other.Point(other.cells_[i].cast<double>()), other.views_[i]);
}

void SurfacePatch::Forget(const std::vector<bool>& gone) {
  const std::vector<Eigen::Vector2f> cells = std::move(cells_);
  const std::vector<uint32_t> views = std::move(views_);
  index_ = VoxelIndex();
  cells_.clear();
  views_.clear();
  lo_.setConstant(std::numeric_limits<double>::infinity());
  hi_ = -lo_;
  for (size_t i = 0; i < cells.size(); ++i) {
    if (!gone[i]) Mark(Point(cells[i].cast<double>()), views[i]);
  }
}

std::vector<Eigen::Vector3d> SurfacePatch::CellPoints() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(cells_.size());
  for (const Eigen::Vector2f& at : cells_) points.push_back(Point(at.cast<double>()));
  return points;
}

uint32_t SurfacePatch::ViewsAbout(const Eigen::Vector3d& p, double distance_m) const {
  if (std::abs(plane_.SignedDistance(p)) > distance_m) return 0;
  const Eigen::Vector2d on = Coordinates(p), at = on / kCell_m;
  if ((on - hi_).maxCoeff() > CoverMargin_m() || (lo_ - on).maxCoeff() > CoverMargin_m()) return 0;
  uint32_t most = 0;
  for (int k = 0; k < 9; ++k) {
    const uint32_t cell = index_.Find(VoxelKey({at.x() + k % 3 - 1, at.y() + k / 3 - 1, 0}));
    if (cell != VoxelIndex::kNone) most = std::max(most, views_[cell]);
  }
  return most;
}

double SurfacePatch::CoverMargin_m() { return 2 * kCell_m; }

uint32_t SurfacePatch::ViewsAt(const Eigen::Vector3d& p, double distance_m) const {
  if (std::abs(plane_.SignedDistance(p)) > distance_m) return 0;
  const Eigen::Vector2d at = Coordinates(p) / kCell_m;
  const uint32_t cell = index_.Find(VoxelKey({at.x(), at.y(), 0}));
  return cell == VoxelIndex::kNone ? 0 : views_[cell];
}

double SurfacePatch::area_m2() const { return kCell_m * cell_height_m_ * static_cast<double>(cells_.size()); }

}  // namespace plumb::runtime
