#include "runtime/deviations/wall_presence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/displaced_wall.h"
#include "runtime/deviations/face_grid.h"
#include "runtime/deviations/panel.h"
#include "runtime/deviations/planned_things.h"
#include "runtime/deviations/standing_walls.h"

namespace plumb::runtime {
namespace {

constexpr double kMinStanding_m2 = 0.5;                      // of a wall that is known to stand
constexpr double kStanding_m = 0.06, kStanding_rad = 0.087;  // of where it is planned
constexpr double kBeyond_m = 0.10;                           // a line that goes on so far behind a wall's back has passed it

class Presence {
 public:
  Presence(const SGraph& map, const AGraph& plan, const JointResult& estimate, const PresenceOptions& options)
      : map_(map),
        plan_(plan),
        estimate_(estimate),
        options_(options),
        T_plan_map_(estimate.T_plan_map),
        grids_(MakeFaceGrids(plan, options.cell_m, options.margin_m)),
        near_walls_(Panels(grids_), options.gate_m),
        standing_(plan, estimate, kMinStanding_m2),
        things_(plan),
        result_(plan.walls.size()),
        keyframes_(plan.walls.size()) {}

  std::vector<WallPresence> Run() {
    LeaveOutCutEnds(plan_, estimate_, kMinStanding_m2, grids_);
    ForEachSight(map_, T_plan_map_, [this](const Sight& sight) { Count(sight); });
    std::vector<std::vector<const FaceGrid*>> by_wall(result_.size());
    for (const FaceGrid& g : grids_) by_wall[g.wall.index()].push_back(&g);
    for (size_t w = 0; w < by_wall.size(); ++w) Decide(by_wall[w], result_[w]);
    for (const WallEstimate& wall : estimate_.walls) {
      if (StandsInPart(wall)) result_[wall.wall.index()].missing = false;
    }
    LeaveOutDisplaced();
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
      FaceCell* cell = g.At(m.u, m.z);
      if (!cell) continue;
      if (!std::exchange(looked_up, true)) standing_.At(sight.to, on_);
      const bool on_itself = std::find(on_.begin(), on_.end(), g.wall) != on_.end();
      const bool on_other = !on_itself && !on_.empty();
      const bool within_gate = m.to_m > -options_.gate_m;
      if (on_itself || (within_gate && !on_other && sight.to.z() > g.z_low_m && sight.to.z() < g.z_high_m)) {
        if (on_itself || !things_.IsOneAt(sight)) ++cell->ended;
      } else if (m.from_m >= options_.gate_m && WouldMeet(g, m) && (!within_gate || (on_other && m.to_m < -g.half_m - kBeyond_m))) {
        cell->CountPassed(sight.keyframe);
        std::vector<uint32_t>& seen_from = keyframes_[g.wall.index()];
        if (seen_from.empty() || seen_from.back() != sight.keyframe) seen_from.push_back(sight.keyframe);
      }
    }
  }

  // Walls that may stand elsewhere, farther off at an end than the gate: those are not known to be missing.
  void LeaveOutDisplaced() {
    const std::vector<WallFrame> frames = WallFrames(plan_);
    std::vector<std::pair<WallId, DisplacedWall>> walls;
    for (size_t w = 0; w < result_.size(); ++w) {
      if (!result_[w].missing) continue;
      std::vector<FaceGrid> faces;
      for (const FaceGrid& g : grids_) {
        if (g.wall == WallId(w)) faces.push_back(g.Uncounted());
      }
      walls.emplace_back(WallId(w), DisplacedWall(frames[w], std::move(faces), options_));
    }
    if (walls.empty()) return;
    ForEachSight(map_, T_plan_map_, [&](const Sight& sight) {
      standing_.At(sight.to, on_);
      const bool on_thing = on_.empty() && things_.IsOneAt(sight);
      for (auto& [wall, displaced] : walls) {
        const bool on_other = !on_.empty() && std::find(on_.begin(), on_.end(), wall) == on_.end();
        displaced.Count(sight, !on_other && !on_thing);
      }
    });
    for (const auto& [wall, displaced] : walls) result_[wall.index()].missing = !displaced.MayStand();
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
          const FaceCell& cell = g->cells[static_cast<size_t>(row * g->columns + column)];
          if (!cell.solid) continue;
          any_solid = true;
          face.lines += cell.passed;
          if (IsOpen(cell, options_)) {
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
  const std::pair<const char*, double> motions[] = {{"margin_m", margin_m}, {"max_offset_m", max_offset_m}, {"max_yaw_rad", max_yaw_rad}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("PresenceOptions.{} = {}; must be a positive number", name, value);
  }
  for (const auto& [name, value] : motions) {
    if (!(value >= 0 && std::isfinite(value))) return fmt::format("PresenceOptions.{} = {}; must be >= 0 and finite", name, value);
  }
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
