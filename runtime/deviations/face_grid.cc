#include "runtime/deviations/face_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_openings.h"
#include "runtime/matching/ray_caster.h"

namespace plumb::runtime {
namespace {

constexpr double kProbe_m = 0.05;       // a face is where its triangles are, to this
constexpr double kJoint_m = 0.10;       // a wall that ends so far from the body of another is joined to it, ...
constexpr double kMinJointSine = 0.25;  // ... unless it runs on along it

bool IsOpaqueBody(const Element& e) {
  return e.wall.valid() && e.kind != ElementKind::kDoor && e.kind != ElementKind::kWindow && e.material == Material::kOpaque &&
         !e.doorway.valid();
}

// Marks the cells behind which the plan's own triangles are wall, and no opening is listed.
class SolidProbe {
 public:
  explicit SolidProbe(const AGraph& plan) : plan_(plan), caster_(plan.mesh, Opaque(plan)), openings_(OpeningsOfWalls(plan)) {}

  [[nodiscard]] bool IsSolid(const Surface& s, const Panel& panel, double u, double z, double half_cell_m) const {
    if (InOpening(openings_[s.wall.index()], panel.along, panel.along.dot(panel.start) + u, z, half_cell_m)) return false;
    for (const double du : {-half_cell_m, 0.0, half_cell_m}) {
      for (const double dz : {-half_cell_m, 0.0, half_cell_m}) {
        if (!HasWall(s, u + du, z + dz, panel)) return false;
      }
    }
    return true;
  }

 private:
  static std::vector<bool> Opaque(const AGraph& plan) {
    std::vector<bool> keep(plan.mesh.triangles.size());
    for (size_t i = 0; i < keep.size(); ++i) keep[i] = IsOpaqueBody(plan.elements[plan.mesh.triangles[i].element]);
    return keep;
  }

  [[nodiscard]] bool HasWall(const Surface& s, double u, double z, const Panel& panel) const {
    const Eigen::Vector2d n = s.normal.head<2>().normalized(), at = s.start + u * panel.along + kProbe_m * n;
    Ray ray;
    ray.origin = (Eigen::Vector3d(at.x(), at.y(), z) - plan_.origin).cast<float>();
    ray.direction = Eigen::Vector3d(-n.x(), -n.y(), 0).cast<float>();
    ray.max_range_m = static_cast<float>(2 * kProbe_m);
    const RayHit hit = caster_.Cast(ray);
    return hit.hit() && plan_.elements[plan_.mesh.triangles[hit.triangle].element].wall == s.wall;
  }

  const AGraph& plan_;
  const RayCaster caster_;
  const std::vector<std::vector<WallOpening>> openings_;
};

double DistanceToAxis_m(const Wall& wall, const Eigen::Vector2d& p) {
  const Eigen::Vector2d step = wall.axis_end - wall.axis_start;
  const double t = step.squaredNorm() > 0 ? std::clamp(step.dot(p - wall.axis_start) / step.squaredNorm(), 0.0, 1.0) : 0.0;
  return (wall.axis_start + t * step - p).norm();
}

void CutAt(const Panel& built, const Wall& other, FaceGrid& g) {
  const double closer = built.normal.dot(g.panel.along);
  if (std::abs(closer) < kMinJointSine) return;
  const double crossing_m = -built.W(g.panel.start) / closer;  // along the face
  const double reach_m = 0.5 * g.cell_m + g.margin_m;
  for (const double end_m : {0.0, g.panel.length_m}) {
    const Eigen::Vector2d end = g.panel.start + end_m * g.panel.along;
    if (DistanceToAxis_m(other, end) > 0.5 * other.thickness_m + g.half_m + kJoint_m) continue;
    const double low_m = std::min(end_m, crossing_m) - reach_m, high_m = std::max(end_m, crossing_m) + reach_m;
    for (int column = 0; column < g.columns; ++column) {
      const double u = g.MiddleOf(column);
      if (u < low_m || u > high_m) continue;
      for (int row = 0; row < g.rows; ++row) g.cells[static_cast<size_t>(row * g.columns + column)].solid = false;
    }
  }
}

}  // namespace

bool IsOpen(const FaceCell& cell, const PresenceOptions& options) {
  return cell.passed >= static_cast<uint32_t>(options.min_lines) && cell.keyframes >= static_cast<uint32_t>(options.min_keyframes) &&
         cell.passed >= options.min_cell_ratio * static_cast<double>(cell.passed + cell.ended);
}

std::vector<FaceGrid> MakeFaceGrids(const AGraph& plan, double cell_m, double margin_m) {
  const SolidProbe probe(plan);
  const std::vector<WallFrame> frames = WallFrames(plan);
  std::vector<FaceGrid> grids;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& s = plan.surfaces[i];
    if (!s.wall.valid() || !IsFace(frames[s.wall.index()], s)) continue;
    FaceGrid g;
    g.surface = SurfaceId(i);
    g.wall = s.wall;
    g.half_m = 0.5 * plan.walls[s.wall.index()].thickness_m;
    g.panel.normal = s.normal.head<2>().normalized();
    g.panel.along = (s.end - s.start).normalized();
    g.panel.start = s.start - g.half_m * g.panel.normal;
    g.panel.length_m = s.length_m();
    g.cell_m = cell_m;
    g.margin_m = margin_m;
    g.z_low_m = s.z_min_m + margin_m;
    g.z_high_m = s.z_max_m - margin_m;
    if (s.room.valid()) {  // floors and ceilings are no walls
      g.z_low_m = std::max(g.z_low_m, plan.rooms[s.room.index()].floor_z_m + margin_m);
      g.z_high_m = std::min(g.z_high_m, plan.rooms[s.room.index()].ceiling_z_m - margin_m);
    }
    g.panel.z_min_m = g.z_low_m;
    g.panel.z_max_m = g.z_high_m;
    g.columns = static_cast<int>(std::floor((g.panel.length_m - 2 * margin_m) / cell_m));
    g.rows = static_cast<int>(std::floor((g.z_high_m - g.z_low_m) / cell_m));
    if (g.columns <= 0 || g.rows <= 0) continue;
    const double reach_m = 0.5 * cell_m + margin_m;
    bool any = false;
    for (int row = 0; row < g.rows; ++row) {
      for (int column = 0; column < g.columns; ++column) {
        FaceCell cell;
        cell.solid = probe.IsSolid(s, g.panel, g.MiddleOf(column), g.z_low_m + (row + 0.5) * cell_m, reach_m);
        any = any || cell.solid;
        g.cells.push_back(cell);
      }
    }
    if (any) grids.push_back(std::move(g));
  }
  return grids;
}

void LeaveOutCutEnds(const AGraph& plan, const JointResult& estimate, double min_observed_m2, std::vector<FaceGrid>& grids) {
  for (const WallEstimate& wall : estimate.walls) {
    if (wall.observed_m2 < min_observed_m2) continue;
    const Surface& reference = plan.surfaces[wall.reference.index()];
    const Eigen::Vector2d normal = reference.normal.head<2>().normalized();
    Panel built;  // the middle plane of the wall
    built.normal = Eigen::Rotation2Dd(wall.deviation.yaw_rad) * normal;
    built.along = {built.normal.y(), -built.normal.x()};
    const double half_m = 0.5 * plan.walls[wall.wall.index()].thickness_m;
    built.start = reference.midpoint() + wall.deviation.offset_m * normal - half_m * built.normal;
    for (FaceGrid& g : grids) {
      if (g.wall != wall.wall) CutAt(built, plan.walls[wall.wall.index()], g);
    }
  }
}

}  // namespace plumb::runtime
