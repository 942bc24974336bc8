#include "compiler/passes/wall_footprints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"
#include "compiler/passes/vertical_probe.h"

namespace plumb::compiler {
namespace {

constexpr double kSameHeight_m = 0.01;
constexpr double kHoldingStep_m = 0.02;  // thinner than any wall
constexpr double kRail_m = 0.02;  // into the lowest and highest rail of a curtain wall

const Solid& SectionSolid(const PlanElement& e) { return e.uncut.empty() ? e.body : e.uncut; }

bool ActsAsWall(const PlanElement& e) {
  return e.kind == ElementKind::kWall || e.kind == ElementKind::kCurtainWall || (e.kind == ElementKind::kProxy && !e.uncut.empty());
}

Ring Rounded(const Ring& ring, double grid_m) {
  Ring out;
  for (const auto& p : ring) {
    const Eigen::Vector2d q = (p / grid_m).array().round() * grid_m;
    if (out.empty() || q != out.back()) out.push_back(q);
  }
  while (out.size() > 1 && out.front() == out.back()) out.pop_back();
  if (out.size() < 3) out.clear();
  return out;
}

class FootprintCutter {
 public:
  FootprintCutter(const PlanIr& plan, const std::vector<Level>& levels, const FootprintOptions& options, DiagnosticSink& sink)
      : plan_(plan),
        levels_(levels),
        options_(options),
        sink_(sink),
        covers_(plan, {ElementKind::kRoof, ElementKind::kSlab, ElementKind::kCovering}) {}

  FloorIr Run() {
    out_.walls = CollectWalls(plan_);
    for (const Level& level : levels_) {
      out_.floors.emplace_back();
      out_.floors.back().level = level;
      out_.floors.back().cut_heights_m = {level.section_z_m};
    }
    for (uint32_t w = 0; w < out_.walls.size(); ++w) ClassifyWall(w);
    for (Floor& floor : out_.floors) std::sort(floor.cut_heights_m.begin(), floor.cut_heights_m.end());
    for (uint32_t w = 0; w < out_.walls.size(); ++w) AddWall(w);
    for (uint32_t e = 0; e < plan_.elements.size(); ++e) {
      if (plan_.elements[e].kind == ElementKind::kColumn) AddColumn(e);
    }
    for (Floor& floor : out_.floors) AddFillings(floor);
    return std::move(out_);
  }

 private:
  static bool Crosses(const PlanWall& wall, double z_m) { return wall.z_min_m < z_m && wall.z_max_m >= z_m; }
  static double Middle(const PlanWall& wall) { return 0.5 * (wall.z_min_m + wall.z_max_m); }

  bool CrossesSection(const PlanWall& wall) const {
    return std::any_of(levels_.begin(), levels_.end(), [&](const Level& level) { return Crosses(wall, level.section_z_m); });
  }

  // Tells knee walls from parapets among the walls that cross no section, and has their level cut at their height too.
  void ClassifyWall(uint32_t index) {
    const PlanWall& wall = out_.walls[index];
    knee_wall_.push_back(false);
    if (CrossesSection(wall)) return;
    Floor& floor = FloorOf(wall.storey);
    const bool low = wall.z_max_m < floor.level.section_z_m;
    knee_wall_.back() = low && ClosedAbove(CutElements(wall.elements, {Middle(wall)}), wall.z_max_m);
    if (!knee_wall_.back()) return;
    const auto near = [&](double z) { return std::abs(z - Middle(wall)) < kSameHeight_m; };
    if (std::none_of(floor.cut_heights_m.begin(), floor.cut_heights_m.end(), near)) floor.cut_heights_m.push_back(Middle(wall));
  }

  void AddWall(uint32_t index) {
    const PlanWall& wall = out_.walls[index];
    if (CrossesSection(wall) || knee_wall_[index]) {
      for (Floor& floor : out_.floors) {
        const bool here = knee_wall_[index] ? &floor == &FloorOf(wall.storey) : Crosses(wall, floor.level.section_z_m);
        if (here) Add(floor, FootprintKind::kWall, index, wall.elements, floor.cut_heights_m, true);
      }
      return;
    }
    Floor& floor = FloorOf(wall.storey);
    Add(floor, FootprintKind::kWall, index, wall.elements, {Middle(wall)}, false);
    const PlanElement& e = plan_.elements[wall.elements[0]];
    sink_.Emit(
        DiagnosticKind::kWallOffSection, e.location,
        fmt::format(
            "{} is from {:.2f} m to {:.2f} m and nothing closes it above; walls that miss the section at {:.2f} m do not bound rooms",
            e.location.ToString(), wall.z_min_m + plan_.origin.z(), wall.z_max_m + plan_.origin.z(),
            floor.level.section_z_m + plan_.origin.z()));
  }

  void AddColumn(uint32_t e) {
    const Eigen::AlignedBox3d box = Bounds(SectionSolid(plan_.elements[e]));
    if (box.isEmpty()) return;
    for (Floor& floor : out_.floors) {
      const double z = floor.level.section_z_m;
      if (box.min().z() < z && box.max().z() >= z) Add(floor, FootprintKind::kColumn, kNoIndex, {e}, {z}, true);
    }
  }

  // Doors and windows that close a gap between walls: those that a section cuts and no wall holds.
  void AddFillings(Floor& floor) {
    std::vector<Footprint> out;
    for (uint32_t e = 0; e < plan_.elements.size(); ++e) {
      const PlanElement& element = plan_.elements[e];
      if (element.kind != ElementKind::kDoor && element.kind != ElementKind::kWindow) continue;
      const Eigen::AlignedBox3d box = Bounds(element.body);
      if (box.isEmpty() || box.min().z() >= floor.level.section_z_m || box.max().z() < floor.level.section_z_m) continue;
      std::vector<Eigen::Vector2d> points;
      for (const Ring& ring : CutSolid(element.body, floor.level.section_z_m).rings) points.insert(points.end(), ring.begin(), ring.end());
      Ring leaf = Rounded(LeastRectangle(std::move(points)), options_.grid_m);
      if (leaf.size() == 4 && !IsHeld(floor, leaf)) out.push_back({FootprintKind::kFilling, kNoIndex, e, true, {std::move(leaf)}});
    }
    for (Footprint& f : out) floor.footprints.push_back(std::move(f));
  }

  // Whether a wall stands at the middle of a leaf or next to it; also for leaves too deep to close anything, as those that stand open.
  bool IsHeld(const Floor& floor, const Ring& leaf) const {
    Eigen::Vector2d across = leaf[1] - leaf[0];
    if (across.norm() > (leaf[2] - leaf[1]).norm()) across = leaf[2] - leaf[1];
    if (across.norm() > options_.max_curtain_depth_m) return true;
    across.normalize();
    const Eigen::Vector2d middle = 0.5 * (leaf[0] + leaf[2]);
    for (const Footprint& f : floor.footprints) {
      if (!f.bounds_rooms || !BoundingBox(f.rings).intersects(Eigen::AlignedBox2d(middle - Reach(), middle + Reach()))) continue;
      for (double t = -options_.max_holding_distance_m; t <= options_.max_holding_distance_m; t += kHoldingStep_m) {
        if (WindingNumber(f.rings, middle + t * across) != 0) return true;
      }
    }
    return false;
  }
  Eigen::Vector2d Reach() const { return Eigen::Vector2d::Constant(options_.max_holding_distance_m); }

  std::vector<Ring> CutElements(const std::vector<uint32_t>& elements, const std::vector<double>& heights_m) {
    std::vector<Ring> out;
    for (uint32_t e : elements) {
      for (double z_m : heights_m) {
        const Section section = CutSolid(SectionSolid(plan_.elements[e]), z_m);
        if (!section.closed && open_.insert(e).second) ReportOpen(e, z_m);
        for (const Ring& ring : section.rings) {
          Ring rounded = Rounded(ring, options_.grid_m);
          // Upright walls give the same ring at every height.
          if (!rounded.empty() && std::find(out.begin(), out.end(), rounded) == out.end()) out.push_back(std::move(rounded));
        }
      }
    }
    return out;
  }

  // The section of a curtain wall may be posts only, its panes being windows and doors: the band that they stand in is the wall. A straight
  // one is its least rectangle; others get the sections of their sill and head rails on top.
  void CloseCurtain(const PlanWall& wall, std::vector<Ring>& rings) {
    if (rings.size() < 2) return;
    std::vector<Eigen::Vector2d> points;
    for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
    const Ring band = Rounded(LeastRectangle(points), options_.grid_m);
    if (band.size() == 4 && std::min((band[1] - band[0]).norm(), (band[2] - band[1]).norm()) <= options_.max_curtain_depth_m) {
      rings = {band};
      return;
    }
    for (Ring& ring : CutElements(wall.elements, {wall.z_min_m + kRail_m, wall.z_max_m - kRail_m})) rings.push_back(std::move(ring));
  }

  void ReportOpen(uint32_t e, double z_m) {
    const PlanElement& element = plan_.elements[e];
    sink_.Emit(DiagnosticKind::kFootprintOpen, element.location,
               fmt::format("the section of {} at {:.2f} m is no closed outline; the rectangle around it stands in",
                           element.location.ToString(), z_m + plan_.origin.z()));
  }

  void Add(Floor& floor, FootprintKind kind, uint32_t wall, const std::vector<uint32_t>& elements, const std::vector<double>& heights_m,
           bool bounds_rooms) {
    Footprint out{kind, wall, elements[0], bounds_rooms, CutElements(elements, heights_m)};
    if (plan_.elements[elements[0]].kind == ElementKind::kCurtainWall) CloseCurtain(out_.walls[wall], out.rings);
    if (!out.rings.empty()) floor.footprints.push_back(std::move(out));
  }

  Floor& FloorOf(uint32_t storey) {
    for (Floor& floor : out_.floors) {
      if (storey <= floor.level.last_storey) return floor;
    }
    return out_.floors.back();
  }

  // Whether roofs or slabs begin right above most of the outline.
  bool ClosedAbove(const std::vector<Ring>& rings, double top_z_m) const {
    size_t closed = 0, probes = 0;
    for (const Ring& ring : rings) {
      for (size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d p = 0.5 * (ring[i] + ring[(i + 1) % ring.size()]);
        const std::optional<double> above = covers_.Above(p, top_z_m - options_.closed_above_gap_m);
        ++probes;
        closed += above && *above <= top_z_m + options_.closed_above_gap_m;
      }
    }
    return 2 * closed > probes;
  }

  const PlanIr& plan_;
  const std::vector<Level>& levels_;
  const FootprintOptions& options_;
  DiagnosticSink& sink_;
  VerticalProbe covers_;
  FloorIr out_;
  std::vector<bool> knee_wall_;  // per wall
  std::set<uint32_t> open_;      // elements whose sections were reported
};

}  // namespace

std::string FootprintOptions::Check() const {
  if (!(grid_m > 0 && grid_m < 0.01)) return fmt::format("FootprintOptions.grid_m = {}; must be in (0, 0.01)", grid_m);
  if (!(closed_above_gap_m >= 0)) return fmt::format("FootprintOptions.closed_above_gap_m = {}; must not be negative", closed_above_gap_m);
  if (!(max_curtain_depth_m > 0)) return fmt::format("FootprintOptions.max_curtain_depth_m = {}; must be positive", max_curtain_depth_m);
  if (!(max_holding_distance_m >= 0))
    return fmt::format("FootprintOptions.max_holding_distance_m = {}; must not be negative", max_holding_distance_m);
  return {};
}

std::vector<PlanWall> CollectWalls(const PlanIr& plan) {
  std::vector<PlanWall> out;
  std::map<std::pair<std::string, uint64_t>, size_t> by_source;  // some programs give several walls one GlobalId
  for (uint32_t i = 0; i < plan.elements.size(); ++i) {
    const PlanElement& e = plan.elements[i];
    if (!ActsAsWall(e)) continue;
    const Eigen::AlignedBox3d box = Bounds(SectionSolid(e));
    if (box.isEmpty() || SectionSolid(e).empty()) continue;  // the frontend has said so
    const auto known = e.guid.empty() ? by_source.end() : by_source.find({e.guid, e.location.step_id});
    if (known != by_source.end()) {
      PlanWall& wall = out[known->second];
      wall.elements.push_back(i);
      wall.storey = std::min(wall.storey, e.storey);
      wall.z_min_m = std::min(wall.z_min_m, box.min().z());
      wall.z_max_m = std::max(wall.z_max_m, box.max().z());
      continue;
    }
    if (!e.guid.empty()) by_source.emplace(std::make_pair(e.guid, e.location.step_id), out.size());
    out.push_back({{i}, e.storey, box.min().z(), box.max().z()});
  }
  return out;
}

FloorIr CutFootprints(const PlanIr& plan, const std::vector<Level>& levels, const FootprintOptions& options, DiagnosticSink& sink) {
  return FootprintCutter(plan, levels, options, sink).Run();
}

}  // namespace plumb::compiler
