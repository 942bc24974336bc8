#include "runtime/deviations/wall_presence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_openings.h"
#include "runtime/deviations/panel.h"
#include "runtime/deviations/standing_walls.h"
#include "runtime/matching/ray_caster.h"

namespace plumb::runtime {
namespace {

constexpr double kMinStanding_m2 = 0.5;                      // of a wall that is known to stand
constexpr double kStanding_m = 0.06, kStanding_rad = 0.087;  // of where it is planned
constexpr double kBeyond_m = 0.10;                           // a line that goes on so far behind a wall's back has passed it
constexpr double kOnThing_m = 0.10;                          // of what is seen from where it is planned
constexpr double kProbe_m = 0.05;                            // a face is where its triangles are, to this

struct Cell {
  bool solid = false;  // the plan has wall all over the cell and about it
  uint32_t passed = 0, ended = 0;
  uint32_t keyframes = 0, last_keyframe = 0xffffffffu;  // that lines passed from
};

// A face of a wall with its cells. The panel's plane is the wall's middle plane; cells begin at the margin.
struct FaceGrid {
  SurfaceId surface;
  WallId wall;
  Panel panel;
  double half_m = 0;  // of the wall's thickness
  double cell_m = 0, z_low_m = 0, z_high_m = 0;
  int columns = 0, rows = 0;
  std::vector<Cell> cells;

  [[nodiscard]] Cell* At(double u, double z, double margin_m) {
    const int column = static_cast<int>(std::floor((u - margin_m) / cell_m)), row = static_cast<int>(std::floor((z - z_low_m) / cell_m));
    if (column < 0 || column >= columns || row < 0 || row >= rows) return nullptr;
    Cell& cell = cells[static_cast<size_t>(row * columns + column)];
    return cell.solid ? &cell : nullptr;
  }
};

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

// What the plan has besides walls: furniture, columns, stairs. Seen where it is planned, it stands for no wall.
class PlannedThings {
 public:
  explicit PlannedThings(const AGraph& plan) : origin_(plan.origin), caster_(plan.mesh, Things(plan)) {}

  [[nodiscard]] bool IsOneAt(const Sight& sight) const {
    const double length_m = (sight.to - sight.from).norm();
    Ray ray;
    ray.direction = ((sight.to - sight.from) / length_m).cast<float>();
    ray.origin = (sight.to - origin_).cast<float>() - static_cast<float>(std::min(length_m, kOnThing_m)) * ray.direction;
    ray.max_range_m = static_cast<float>(2 * kOnThing_m);
    return caster_.Cast(ray).hit();
  }

 private:
  static std::vector<bool> Things(const AGraph& plan) {
    std::vector<bool> keep(plan.mesh.triangles.size());
    for (size_t i = 0; i < keep.size(); ++i) {
      const Element& e = plan.elements[plan.mesh.triangles[i].element];
      keep[i] = !e.wall.valid() && !e.doorway.valid() && e.kind != ElementKind::kWall && e.kind != ElementKind::kCurtainWall &&
                e.kind != ElementKind::kCovering;
    }
    return keep;
  }

  const Eigen::Vector3d origin_;
  const RayCaster caster_;
};

std::vector<FaceGrid> MakeGrids(const AGraph& plan, const PresenceOptions& options) {
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
    g.cell_m = options.cell_m;
    g.z_low_m = s.z_min_m + options.margin_m;
    g.z_high_m = s.z_max_m - options.margin_m;
    if (s.room.valid()) {  // floors and ceilings are no walls
      g.z_low_m = std::max(g.z_low_m, plan.rooms[s.room.index()].floor_z_m + options.margin_m);
      g.z_high_m = std::min(g.z_high_m, plan.rooms[s.room.index()].ceiling_z_m - options.margin_m);
    }
    g.panel.z_min_m = g.z_low_m;
    g.panel.z_max_m = g.z_high_m;
    g.columns = static_cast<int>(std::floor((g.panel.length_m - 2 * options.margin_m) / options.cell_m));
    g.rows = static_cast<int>(std::floor((g.z_high_m - g.z_low_m) / options.cell_m));
    if (g.columns <= 0 || g.rows <= 0) continue;
    const double reach_m = 0.5 * options.cell_m + options.margin_m;
    bool any = false;
    for (int row = 0; row < g.rows; ++row) {
      for (int column = 0; column < g.columns; ++column) {
        Cell cell;
        cell.solid = probe.IsSolid(s, g.panel, options.margin_m + (column + 0.5) * options.cell_m, g.z_low_m + (row + 0.5) * options.cell_m,
                                   reach_m);
        any = any || cell.solid;
        g.cells.push_back(cell);
      }
    }
    if (any) grids.push_back(std::move(g));
  }
  return grids;
}

class Presence {
 public:
  Presence(const SGraph& map, const AGraph& plan, const JointResult& estimate, const PresenceOptions& options)
      : map_(map),
        plan_(plan),
        estimate_(estimate),
        options_(options),
        T_plan_map_(estimate.T_plan_map),
        grids_(MakeGrids(plan, options)),
        near_walls_(Panels(grids_), options.gate_m),
        standing_(plan, estimate, kMinStanding_m2),
        things_(plan),
        result_(plan.walls.size()),
        keyframes_(plan.walls.size()) {}

  std::vector<WallPresence> Run() {
    ForEachSight(map_, T_plan_map_, [this](const Sight& sight) { Count(sight); });
    std::vector<std::vector<const FaceGrid*>> by_wall(result_.size());
    for (const FaceGrid& g : grids_) by_wall[g.wall.index()].push_back(&g);
    for (size_t w = 0; w < by_wall.size(); ++w) Decide(by_wall[w], result_[w]);
    for (const WallEstimate& wall : estimate_.walls) {
      if (StandsInPart(wall)) result_[wall.wall.index()].missing = false;
    }
    return std::move(result_);
  }

 private:
  static std::vector<Panel> Panels(const std::vector<FaceGrid>& grids) {
    std::vector<Panel> panels;
    for (const FaceGrid& g : grids) panels.push_back(g.panel);
    return panels;
  }

  void Count(const Sight& sight) {
    near_walls_.Near(sight.from.head<2>(), sight.to.head<2>(), near_);
    bool looked_up = false;
    for (const uint32_t i : near_) {
      FaceGrid& g = grids_[i];
      Meeting m;
      if (!Meet(g.panel, sight, &m) || m.incidence < options_.min_incidence || m.sight_m > options_.max_sight_m || m.to_m > options_.gate_m)
        continue;
      Cell* cell = g.At(m.u, m.z, options_.margin_m);
      if (!cell) continue;
      if (!std::exchange(looked_up, true)) standing_.At(sight.to, on_);
      const bool on_itself = std::find(on_.begin(), on_.end(), g.wall) != on_.end();
      const bool on_other = !on_itself && !on_.empty();
      const bool within_gate = m.to_m > -options_.gate_m;
      if (on_itself || (within_gate && !on_other && sight.to.z() > g.z_low_m && sight.to.z() < g.z_high_m)) {
        if (on_itself || !things_.IsOneAt(sight)) ++cell->ended;
      } else if (m.from_m >= options_.gate_m && WouldMeet(g, m) && (!within_gate || (on_other && m.to_m < -g.half_m - kBeyond_m))) {
        ++cell->passed;
        if (cell->last_keyframe != sight.keyframe) ++cell->keyframes;
        cell->last_keyframe = sight.keyframe;
        std::vector<uint32_t>& seen_from = keyframes_[g.wall.index()];
        if (seen_from.empty() || seen_from.back() != sight.keyframe) seen_from.push_back(sight.keyframe);
      }
    }
  }

  // Would the wall stop the line as well if it stood elsewhere within the gate? A flat line goes past the end of a wall that stands off.
  [[nodiscard]] bool WouldMeet(const FaceGrid& g, const Meeting& m) const {
    const double aside_m = std::abs(m.u_per_m) * options_.gate_m;
    return m.u > aside_m && m.u < g.panel.length_m - aside_m;
  }

  // Was some of it seen where it is planned? A wall is cut short where the next one was built through its place, and seen through there.
  [[nodiscard]] bool StandsInPart(const WallEstimate& wall) const {
    return std::abs(wall.deviation.offset_m) < kStanding_m && std::abs(wall.deviation.yaw_rad) < kStanding_rad &&
           wall.seen_m >= options_.min_length_ratio * Length_m(plan_.walls[wall.wall.index()], plan_.surfaces[wall.reference.index()]);
  }

  // Rooms divide the wall into faces, of which the reference is one.
  static double Length_m(const Wall& wall, const Surface& reference) {
    return std::max((wall.axis_end - wall.axis_start).norm(), reference.length_m());
  }

  [[nodiscard]] bool IsOpen(const Cell& cell) const {
    return cell.passed >= static_cast<uint32_t>(options_.min_lines) && cell.keyframes >= static_cast<uint32_t>(options_.min_keyframes) &&
           cell.passed >= options_.min_cell_ratio * static_cast<double>(cell.passed + cell.ended);
  }

  void Decide(const std::vector<const FaceGrid*>& grids, WallPresence& wall) const {
    const double cell_m2 = options_.cell_m * options_.cell_m;
    double open_m2 = 0, closed_m2 = 0, most_open_m2 = 0, columns = 0, open_columns = 0;
    size_t seen_from = 0;
    for (const FaceGrid* g : grids) {
      FacePresence face;
      face.surface = g->surface;
      for (int column = 0; column < g->columns; ++column) {
        bool any_solid = false, any_open = false;
        for (int row = 0; row < g->rows; ++row) {
          const Cell& cell = g->cells[static_cast<size_t>(row * g->columns + column)];
          if (!cell.solid) continue;
          any_solid = true;
          face.lines += cell.passed;
          if (IsOpen(cell)) {
            any_open = true;
            face.open_m2 += cell_m2;
          } else if (cell.ended >= static_cast<uint32_t>(options_.min_lines)) {
            face.closed_m2 += cell_m2;
          }
        }
        columns += any_solid ? 1 : 0;
        open_columns += any_open ? 1 : 0;
      }
      open_m2 += face.open_m2;
      closed_m2 += face.closed_m2;
      most_open_m2 = std::max(most_open_m2, face.open_m2);
      wall.faces.push_back(face);
      seen_from = keyframes_[g->wall.index()].size();
    }
    wall.missing = most_open_m2 >= options_.min_open_m2 && open_m2 >= options_.min_open_ratio * (open_m2 + closed_m2) &&
                   open_columns >= options_.min_length_ratio * columns && seen_from >= static_cast<size_t>(options_.min_wall_keyframes);
  }

  const SGraph& map_;
  const AGraph& plan_;
  const JointResult& estimate_;
  const PresenceOptions& options_;
  const Eigen::Isometry3d T_plan_map_;
  std::vector<FaceGrid> grids_;
  PanelGrid near_walls_;
  StandingWalls standing_;
  const PlannedThings things_;
  std::vector<WallPresence> result_;
  std::vector<std::vector<uint32_t>> keyframes_;  // per wall: from which its place was seen through, ascending
  std::vector<uint32_t> near_;
  std::vector<WallId> on_;
};

}  // namespace

std::string PresenceOptions::Check() const {
  const std::pair<const char*, double> positive[] = {
      {"gate_m", gate_m}, {"cell_m", cell_m}, {"max_sight_m", max_sight_m}, {"min_open_m2", min_open_m2}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("PresenceOptions.{} = {}; must be a positive number", name, value);
  }
  if (!(margin_m >= 0)) return fmt::format("PresenceOptions.margin_m = {}; must be >= 0", margin_m);
  const std::pair<const char*, double> ratios[] = {{"min_incidence", min_incidence},
                                                   {"min_cell_ratio", min_cell_ratio},
                                                   {"min_open_ratio", min_open_ratio},
                                                   {"min_length_ratio", min_length_ratio}};
  for (const auto& [name, value] : ratios) {
    if (!(value > 0 && value <= 1)) return fmt::format("PresenceOptions.{} = {}; must be in (0, 1]", name, value);
  }
  const std::pair<const char*, int> counts[] = {
      {"min_lines", min_lines}, {"min_keyframes", min_keyframes}, {"min_wall_keyframes", min_wall_keyframes}};
  for (const auto& [name, value] : counts) {
    if (value < 1) return fmt::format("PresenceOptions.{} = {}; must be >= 1", name, value);
  }
  return {};
}

std::vector<WallPresence> JudgePresence(const SGraph& map, const AGraph& plan, const JointResult& estimate,
                                        const PresenceOptions& options) {
  if (map.planar) return std::vector<WallPresence>(plan.walls.size());
  return Presence(map, plan, estimate, options).Run();
}

}  // namespace plumb::runtime
