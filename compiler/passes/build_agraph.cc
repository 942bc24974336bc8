#include "compiler/passes/build_agraph.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"
#include "compiler/passes/wall_axes.h"

namespace plumb::compiler {
namespace {

// True if there is no fault.
bool Passes(const std::vector<std::string>& faults, const char* ir, DiagnosticSink& sink) {
  for (const std::string& fault : faults) sink.Emit(DiagnosticKind::kInternalError, {}, fmt::format("{}: {}", ir, fault));
  return faults.empty();
}

void AddStoreys(const PlanIr& plan, const FloorIr& floors, AGraph& graph) {
  for (const PlanStorey& s : plan.storeys) graph.storeys.push_back({s.guid, s.name, s.elevation_m, 0});
  for (size_t s = 0; s + 1 < graph.storeys.size(); ++s)
    graph.storeys[s].height_m = graph.storeys[s + 1].elevation_m - graph.storeys[s].elevation_m;
  graph.storeys.back().height_m = floors.floors.back().level.top_z_m - graph.storeys.back().elevation_m;
}

// The last storey reaches to its highest ceiling, if it has rooms.
void SetLastStoreyHeight(AGraph& graph) {
  double highest = graph.storeys.back().elevation_m;
  for (const Room& r : graph.rooms) {
    if (r.storey.index() + 1 == graph.storeys.size()) highest = std::max(highest, r.ceiling_z_m);
  }
  if (highest > graph.storeys.back().elevation_m) graph.storeys.back().height_m = highest - graph.storeys.back().elevation_m;
}

void AddColumns(const PlanIr& plan, const FloorIr& floors, AGraph& graph) {
  std::vector<bool> known(plan.elements.size(), false);
  for (const Floor& floor : floors.floors) {
    for (const Footprint& f : floor.footprints) {
      if (f.kind != FootprintKind::kColumn || known[f.element]) continue;
      known[f.element] = true;
      const PlanElement& e = plan.elements[f.element];
      Column out;
      out.guid = e.guid;
      out.name = e.name;
      out.storey = StoreyId(std::clamp(e.storey, floor.level.first_storey, floor.level.last_storey));
      out.outline =
          *std::max_element(f.rings.begin(), f.rings.end(), [](const Ring& a, const Ring& b) { return SignedArea(a) < SignedArea(b); });
      const Eigen::AlignedBox3d box = Bounds(e.uncut.empty() ? e.body : e.uncut);
      out.z_min_m = box.min().z();
      out.z_max_m = box.max().z();
      graph.columns.push_back(std::move(out));
    }
  }
}

void AddElements(const PlanIr& plan, const FloorIr& floors, const OpeningElements& openings, AGraph& graph) {
  for (const PlanElement& e : plan.elements) {
    Element out;
    out.guid = e.guid;
    out.name = e.name;
    out.type = e.type;
    out.kind = e.kind;
    out.material = e.material;
    out.storey = StoreyId(e.storey);
    graph.elements.push_back(std::move(out));
  }
  for (size_t w = 0; w < floors.walls.size(); ++w) {
    for (uint32_t e : floors.walls[w].elements) graph.elements[e].wall = WallId(w);
  }
  for (size_t d = 0; d < openings.of_doorway.size(); ++d) {
    for (uint32_t e : openings.of_doorway[d]) {
      graph.elements[e].wall = graph.doorways[d].wall;
      graph.elements[e].doorway = DoorwayId(d);
    }
  }
  for (size_t w = 0; w < openings.of_window.size(); ++w) {
    for (uint32_t e : openings.of_window[w]) graph.elements[e].wall = graph.windows[w].wall;
  }
}

}  // namespace

std::string PassOptions::Check() const {
  if (!(section_height_m > 0 && section_height_m < 10))
    return fmt::format("PassOptions.section_height_m = {}; must be in (0, 10)", section_height_m);
  for (const std::string& fault : {storeys.Check(), footprints.Check(), planar_map.Check(), bridges.Check(), division.Check(), arcs.Check(),
                                   rooms.Check(), naming.Check(), surfaces.Check(), hosting.Check(), doorways.Check()}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

std::optional<FloorIr> BuildFloors(PlanIr& plan, const PassOptions& options, DiagnosticSink& sink) {
  if (options.verify && !Passes(VerifyPlanIr(plan), "PlanIr", sink)) return std::nullopt;
  AssignStoreys(plan, options.storeys, sink);
  FloorIr floors = CutFootprints(plan, GroupStoreys(plan, options.section_height_m, options.storeys), options.footprints, sink);
  for (Floor& floor : floors.floors) {
    if (const Expected<void> ok = BridgeGaps(options.bridges, options.planar_map, floor); !ok) {
      sink.Emit(DiagnosticKind::kInternalError, {}, ok.error().message);
      return std::nullopt;
    }
  }
  if (const Expected<void> ok = DivideRooms(plan, options.division, options.planar_map, floors, sink); !ok) {
    sink.Emit(DiagnosticKind::kInternalError, {}, ok.error().message);
    return std::nullopt;
  }
  FindWallArcs(plan, options.arcs, floors);
  ReportBridges(plan, floors, sink);
  if (options.verify && !Passes(VerifyFloorIr(floors, plan), "FloorIr", sink)) return std::nullopt;
  return floors;
}

std::optional<Built> BuildAGraph(PlanIr& plan, const PassOptions& options, DiagnosticSink& sink) {
  std::optional<FloorIr> floors = BuildFloors(plan, options, sink);
  if (!floors) return std::nullopt;
  Built out{std::move(*floors), {}};
  AGraph& graph = out.graph;
  AddStoreys(plan, out.floors, graph);
  AddWalls(plan, out.floors, graph);
  const RoomsByFace rooms = FindRooms(plan, out.floors, options.rooms, graph, sink);
  SetLastStoreyHeight(graph);
  NameRooms(plan, out.floors, options.naming, graph, sink);
  AddSurfaces(out.floors, rooms, options.surfaces, graph);
  const std::vector<HostedOpening> hosted = HostOpenings(plan, out.floors, options.hosting, graph, sink);
  const OpeningElements openings = AddDoorwaysAndWindows(plan, out.floors, rooms, hosted, options.doorways, graph, sink);
  AddOpenBoundaries(out.floors, rooms, graph);
  AddColumns(plan, out.floors, graph);
  AddElements(plan, out.floors, openings, graph);
  AddFactors(graph);
  return out;
}

}  // namespace plumb::compiler
