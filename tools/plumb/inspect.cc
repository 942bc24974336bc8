#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "schema/source_paths.h"
#include "tools/drawing/plan_sheet.h"
#include "tools/inspect/graph_text.h"
#include "tools/inspect/graphml.h"
#include "tools/inspect/occupancy_map.h"
#include "tools/inspect/storeys.h"
#include "tools/plumb/command.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"

namespace plumb::tools {
namespace {

struct InspectFlags {
  std::string path, svg, graphml, nav2, storey;
  bool json = false;
  FloorPlanOptions floor_plan;
  OccupancyOptions occupancy;
};

std::string NameOf(const AGraph& graph, StoreyId storey) { return graph.storeys[storey.index()].name; }

// Where a storey is cut lower than asked for.
void SayWhereItIsCutLower(const AGraph& graph, const std::vector<StoreyId>& storeys, const FloorPlanOptions& options, Console& console) {
  for (const StoreyId storey : storeys) {
    const double height_m = SectionHeight(graph, storey, options);
    if (height_m < options.section_height_m)
      console.Info(fmt::format("{}: cut at {:.2f} m, as {:.2f} m is above all its rooms or walls", NameOf(graph, storey), height_m,
                               options.section_height_m));
  }
}

Expected<void> WriteSvg(const AGraph& graph, const InspectFlags& flags, StoreyId chosen, Console& console) {
  const std::vector<StoreyId> storeys = chosen.valid() ? std::vector<StoreyId>{chosen} : DrawnStoreys(graph);
  if (auto written = WriteFileAtomically(flags.svg, std::string_view(FloorPlansToSvg(graph, storeys, flags.floor_plan))); !written)
    return written;
  SayWhereItIsCutLower(graph, storeys, flags.floor_plan, console);
  std::string names;
  for (const StoreyId storey : storeys) names += (names.empty() ? "" : ", ") + NameOf(graph, storey);
  console.Info(fmt::format("{}: floor plan of {}", flags.svg, names.empty() ? "nothing: no storey has walls or rooms" : names));
  return {};
}

Expected<void> WriteNav2(const AGraph& graph, const InspectFlags& flags, StoreyId chosen, Console& console) {
  const StoreyId storey = chosen.valid() ? chosen : MainStorey(graph);
  if (!storey.valid()) return Fail(ErrorCode::kPlanUnsuitable, fmt::format("`{}` has no storey to make a map of", flags.path));
  const auto map = MakeOccupancyMap(graph, storey, flags.occupancy);
  if (!map) return tl::unexpected(map.error());
  const std::filesystem::path folder(flags.nav2);
  const auto made = OutputFolder::Make(flags.nav2);
  if (!made) return tl::unexpected(made.error());
  // The image first: no reader finds a map.yaml without it.
  if (auto written = WriteFileAtomically((folder / "map.pgm").string(), std::string_view(MapPgm(*map))); !written) return written;
  if (auto written = WriteFileAtomically((folder / "map.yaml").string(), std::string_view(MapYaml(*map, "map.pgm"))); !written)
    return written;
  console.Info(fmt::format("{}: map.yaml and map.pgm of {}, {} x {} cells, cut {} m above the floor", flags.nav2, NameOf(graph, storey),
                           map->columns, map->rows, flags.occupancy.height_m));
  return {};
}

Status RunInspect(const InspectFlags& flags, Session& session) {
  for (const std::string& wrong : {flags.floor_plan.Check(), flags.occupancy.Check()}) {
    if (!wrong.empty()) return session.Fail({ErrorCode::kBadOption, InFlags(wrong)});
  }
  if (const auto fits = CheckInputs({{flags.path, InputKind::kAGraph}}); !fits) return session.Fail(fits.error());
  auto file = AGraphFile::Open(flags.path);
  if (!file) return session.Fail(file.error());
  const size_t triangles = file->triangle_count();
  // With its triangles, so that a damaged file is said to be one whatever is asked of it.
  const Expected<AGraph> graph = std::move(*file).Load();
  if (!graph) return session.Fail(graph.error());
  std::vector<std::string> inputs = SplitSourcePaths(graph->source_path);
  inputs.insert(inputs.end(), {graph->source_path, flags.path});  // the source as one path, too: ` + ` may stand in its name
  const auto apart = CheckOutputs({{"--svg", flags.svg}, {"--graphml", flags.graphml}}, inputs);
  if (!apart) return session.Fail(apart.error());
  StoreyId storey;
  if (!flags.storey.empty()) {
    const auto found = FindStorey(*graph, flags.storey);
    if (!found) return session.Fail(found.error());
    storey = *found;
  }
  if (!flags.svg.empty()) {
    if (const auto written = WriteSvg(*graph, flags, storey, session.console); !written) return session.Fail(written.error());
  }
  if (!flags.graphml.empty()) {
    if (const auto written = WriteFileAtomically(flags.graphml, std::string_view(AGraphToGraphMl(*graph))); !written)
      return session.Fail(written.error());
  }
  if (!flags.nav2.empty()) {
    if (const auto written = WriteNav2(*graph, flags, storey, session.console); !written) return session.Fail(written.error());
  }
  const bool wrote = !flags.svg.empty() || !flags.graphml.empty() || !flags.nav2.empty();
  if (flags.json) session.console.Print(AGraphToJson(*graph));
  if (!flags.json && !wrote) session.console.Print(AGraphToText(*graph, triangles));
  return Status::kFine;
}

}  // namespace

void AddInspect(CLI::App& app, Session& session) {
  auto flags = std::make_shared<InspectFlags>();
  CLI::App* sub = AddSubcommand(app, session, "inspect", "Show what is in an A-Graph: text, JSON, floor plans, graph, map for nav2",
                                "  plumb inspect house.agraph\n"
                                "  plumb inspect house.agraph --json\n"
                                "  plumb inspect house.agraph --svg house.svg\n"
                                "  plumb inspect house.agraph --svg ground.svg --storey \"Ground floor\"\n"
                                "  plumb inspect house.agraph --graphml house.graphml\n"
                                "  plumb inspect house.agraph --nav2 map/ --storey 0 --sensor-height 0.25 --resolution 0.02");
  sub->add_option("FILE.agraph", flags->path, "the A-Graph")->required()->type_name("");
  sub->add_flag("--json", flags->json, "print it as JSON");
  sub->add_option("--svg", flags->svg, "draw the floor plans of all storeys, or of --storey, to scale into this file")
      ->type_name("FILE.svg");
  sub->add_option("--section-height", flags->floor_plan.section_height_m, "of the cut above the storey's zero, for --svg, m");
  sub->add_option("--graphml", flags->graphml, "write rooms, doorways and surfaces as a graph, for yEd or networkx")
      ->type_name("FILE.graphml");
  sub->add_option("--nav2", flags->nav2, "write map.yaml and map.pgm of --storey, or of the one with most rooms, into this folder")
      ->type_name("DIR");
  sub->add_option("--storey", flags->storey, "the storey, by name or counted from 0")->type_name("NAME");
  sub->add_option("--sensor-height", flags->occupancy.height_m, "above the floor, for --nav2, m");
  sub->add_option("--resolution", flags->occupancy.resolution_m, "edge of a cell, for --nav2, m");
  sub->callback([flags, &session] { session.status = RunInspect(*flags, session); });
}

}  // namespace plumb::tools
