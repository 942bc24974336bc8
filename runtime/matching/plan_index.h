// The plan as matching needs it: flat wall faces, floor levels, openings, and two ray casting scenes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/matching/ray_caster.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// A flat piece of a wall surface, or a side of a column; a curved surface becomes several. Frame: the mesh's (plan minus AGraph::origin).
struct PlanFace {
  SurfaceId surface;  // none: a column's
  uint32_t physical_wall = 0;  // faces of one wall share it: they move together
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX(), along = Eigen::Vector2d::UnitY();  // along: from start to end
  double d_m = 0, length_m = 0, z_min_m = 0, z_max_m = 0;
};

// A height at which the plan has floors.
struct PlanLevel {
  StoreyId storey;
  double floor_z_m = 0, ceiling_z_m = 0;
  double area_m2 = 0;
};

// First what a ray meets, then what it meets if nothing movable or transparent is there.
struct PlanHit {
  RayHit first;
  RayHit solid;          // equals `first` unless that is soft
  bool soft = false;     // `first` is a door leaf, glass, or furniture: it may be open, transparent, or elsewhere
};

class PlanIndex {
 public:
  // Keeps a reference to `plan`. O(n log n) in triangles.
  explicit PlanIndex(const AGraph& plan);
  // Of `image`, the mirror image (mirror.h) of the plan of `original`, whose triangles it shares: those of `image` are not looked at.
  PlanIndex(const AGraph& image, const PlanIndex& original);

  [[nodiscard]] const AGraph& plan() const { return plan_; }
  [[nodiscard]] const std::vector<PlanFace>& faces() const { return faces_; }
  [[nodiscard]] const std::vector<PlanLevel>& levels() const { return levels_; }
  [[nodiscard]] uint32_t num_physical_walls() const { return num_physical_walls_; }

  // Indices into faces() of those within `margin_m` of the segment's bounding box (and some more), ascending. Thread-safe.
  void FacesNear(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin_m, std::vector<uint32_t>& out) const;

  // Thread-safe.
  [[nodiscard]] PlanHit Cast(const Ray& ray) const;

  // True within `margin_m` of a doorway or window: what a ray meets there depends on leaves, frames and glass.
  [[nodiscard]] bool NearOpening(const Eigen::Vector3d& point, double margin_m) const;

 private:
  struct Opening {
    Eigen::Vector3d sill = Eigen::Vector3d::Zero();  // middle of the opening, at the sill
    double reach_m = 0;                              // half the width, and half the wall
    double height_m = 0;
  };
  void AddStructure();
  void AddFaces(const Surface& surface, SurfaceId id);
  void AddFaces(const Column& column);
  void AddChain(const std::vector<Eigen::Vector2d>& points, PlanFace face);  // free space to the left
  void AddLevels();
  void AddToGrid();
  [[nodiscard]] Eigen::Vector2i CellOf(const Eigen::Vector2d& p) const;  // clamped to the grid
  void AddOpenings();

  const AGraph& plan_;
  std::vector<PlanFace> faces_;
  Eigen::Vector2d grid_low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2i grid_size_ = Eigen::Vector2i::Zero();
  std::vector<std::vector<uint32_t>> grid_;  // per cell the faces whose bounding boxes reach into it
  std::vector<PlanLevel> levels_;
  std::vector<Opening> openings_;
  std::vector<bool> soft_;  // per triangle
  uint32_t num_physical_walls_ = 0;
  RayCaster all_, solid_;
};

}  // namespace plumb::runtime
