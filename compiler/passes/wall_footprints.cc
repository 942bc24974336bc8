#include "compiler/passes/wall_footprints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"
#include "compiler/passes/vertical_probe.h"

namespace plumb::compiler {
namespace {

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
      : plan_(plan), levels_(levels), options_(options), sink_(sink), covers_(plan, {ElementKind::kRoof, ElementKind::kSlab, ElementKind::kCovering}) {}

  FloorIr Run() {
    out_.walls = CollectWalls(plan_, sink_);
    for (const Level& level : levels_) out_.floors.push_back({level, {}, {}, {}});
    for (uint32_t w = 0; w < out_.walls.size(); ++w) AddWall(w);
    for (uint32_t e = 0; e < plan_.elements.size(); ++e) {
      if (plan_.elements[e].kind == ElementKind::kColumn) AddColumn(e);
    }
    return std::move(out_);
  }

 private:
  static bool Crosses(const PlanWall& wall, double z_m) { return wall.z_min_m < z_m && wall.z_max_m >= z_m; }

  void AddWall(uint32_t index) {
    const PlanWall& wall = out_.walls[index];
    bool crosses_any = false;
    for (Floor& floor : out_.floors) {
      if (!Crosses(wall, floor.level.section_z_m)) continue;
      crosses_any |= Add(floor, FootprintKind::kWall, index, wall.elements, floor.level.section_z_m, true);
    }
    if (crosses_any) return;
    Floor& floor = FloorOf(wall.storey);
    const double middle = 0.5 * (wall.z_min_m + wall.z_max_m);
    const bool low = wall.z_max_m < floor.level.section_z_m;
    if (!Add(floor, FootprintKind::kWall, index, wall.elements, middle, false)) return;
    Footprint& footprint = floor.footprints.back();
    footprint.bounds_rooms = low && ClosedAbove(footprint, wall.z_max_m);
    if (footprint.bounds_rooms) return;
    const PlanElement& e = plan_.elements[footprint.element];
    sink_.Emit(DiagnosticKind::kWallOffSection, e.location,
               fmt::format("{} is from {:.2f} m to {:.2f} m and nothing closes it above; walls that miss the section at {:.2f} m do not bound rooms",
                           e.location.ToString(), wall.z_min_m + plan_.origin.z(), wall.z_max_m + plan_.origin.z(),
                           floor.level.section_z_m + plan_.origin.z()));
  }

  void AddColumn(uint32_t e) {
    const Eigen::AlignedBox3d box = Bounds(SectionSolid(plan_.elements[e]));
    if (box.isEmpty()) return;
    for (Floor& floor : out_.floors) {
      const double z = floor.level.section_z_m;
      if (box.min().z() < z && box.max().z() >= z) Add(floor, FootprintKind::kColumn, kNoIndex, {e}, z, true);
    }
  }

  // False if nothing is there at that height.
  bool Add(Floor& floor, FootprintKind kind, uint32_t wall, const std::vector<uint32_t>& elements, double z_m, bool bounds_rooms) {
    Footprint out;
    out.kind = kind;
    out.wall = wall;
    out.element = elements[0];
    out.cut_z_m = z_m;
    out.bounds_rooms = bounds_rooms;
    for (uint32_t e : elements) {
      const Section section = CutSolid(SectionSolid(plan_.elements[e]), z_m);
      if (!section.closed) {
        const PlanElement& element = plan_.elements[e];
        sink_.Emit(DiagnosticKind::kFootprintOpen, element.location,
                   fmt::format("the section of {} at {:.2f} m is no closed outline; the rectangle around it stands in", element.location.ToString(),
                               z_m + plan_.origin.z()));
      }
      for (const Ring& ring : section.rings) {
        if (Ring rounded = Rounded(ring, options_.grid_m); !rounded.empty()) out.rings.push_back(std::move(rounded));
      }
    }
    if (out.rings.empty()) return false;
    floor.footprints.push_back(std::move(out));
    return true;
  }

  Floor& FloorOf(uint32_t storey) {
    for (Floor& floor : out_.floors) {
      if (storey <= floor.level.last_storey) return floor;
    }
    return out_.floors.back();
  }

  // Whether roofs or slabs begin right above most of the footprint's outline.
  bool ClosedAbove(const Footprint& footprint, double top_z_m) const {
    size_t closed = 0, probes = 0;
    for (const Ring& ring : footprint.rings) {
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
};

}  // namespace

std::string FootprintOptions::Check() const {
  if (!(grid_m > 0 && grid_m < 0.01)) return fmt::format("FootprintOptions.grid_m = {}; must be in (0, 0.01)", grid_m);
  if (!(closed_above_gap_m >= 0)) return fmt::format("FootprintOptions.closed_above_gap_m = {}; must not be negative", closed_above_gap_m);
  return {};
}

std::vector<PlanWall> CollectWalls(const PlanIr& plan, DiagnosticSink& sink) {
  std::vector<PlanWall> out;
  std::map<std::string, size_t> by_guid;
  for (uint32_t i = 0; i < plan.elements.size(); ++i) {
    const PlanElement& e = plan.elements[i];
    if (!ActsAsWall(e)) continue;
    const Eigen::AlignedBox3d box = Bounds(SectionSolid(e));
    if (box.isEmpty() || SectionSolid(e).empty()) {
      sink.Emit(DiagnosticKind::kWallNotCut, e.location, fmt::format("{} has no solid; it is left out", e.location.ToString()));
      continue;
    }
    const auto known = e.guid.empty() ? by_guid.end() : by_guid.find(e.guid);
    if (known != by_guid.end()) {
      PlanWall& wall = out[known->second];
      wall.elements.push_back(i);
      wall.storey = std::min(wall.storey, e.storey);
      wall.z_min_m = std::min(wall.z_min_m, box.min().z());
      wall.z_max_m = std::max(wall.z_max_m, box.max().z());
      continue;
    }
    if (!e.guid.empty()) by_guid.emplace(e.guid, out.size());
    out.push_back({{i}, e.storey, box.min().z(), box.max().z()});
  }
  return out;
}

FloorIr CutFootprints(const PlanIr& plan, const std::vector<Level>& levels, const FootprintOptions& options, DiagnosticSink& sink) {
  return FootprintCutter(plan, levels, options, sink).Run();
}

}  // namespace plumb::compiler
