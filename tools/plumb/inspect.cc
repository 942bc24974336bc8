#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <numbers>

#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/report/floor_plan_svg.h"

namespace plumb::tools {
namespace {

struct InspectFlags {
  std::string path, svg;
  bool json = false;
  uint32_t storey = 0;
};

std::string RoomName(const AGraph& g, RoomId id) { return id.valid() ? g.rooms[id.index()].name : std::string("outside"); }

void AliasesToText(const AGraph& g, std::string& out) {
  auto write = std::back_inserter(out);
  for (size_t i = 0; i < g.aliases.size(); ++i) {
    const Alias& a = g.aliases[i];
    fmt::format_to(write, "\nalias {}: turned by {:.1f} deg, moved by ({:.2f}, {:.2f}, {:.2f}) m; {:.0f} % of {:.0f} m of wall sections coincide within {} m{}\n", i,
                   a.yaw_rad * 180 / std::numbers::pi, a.translation.x(), a.translation.y(), a.translation.z(), 100 * a.overlap_ratio,
                   a.section_length_m, a.tolerance_m, a.closed ? "" : "; other rooms tell");
    for (size_t k = 0; k < a.rooms.size(); ++k) fmt::format_to(write, "  {} = {}\n", RoomName(g, a.rooms[k]), RoomName(g, a.twins[k]));
  }
  if (!g.look_alikes.empty()) fmt::format_to(write, "\nrooms that look alike from inside\n");
  for (const LookAlikes& l : g.look_alikes) {
    for (size_t k = 0; k < l.rooms.size(); ++k) fmt::format_to(write, "{}{}", k == 0 ? "  " : " = ", RoomName(g, l.rooms[k]));
    fmt::format_to(write, "\n");
  }
}

std::string GraphToText(const AGraph& g) {
  std::string out;
  auto write = std::back_inserter(out);
  fmt::format_to(write, "source    {} ({})\n", g.source_path, g.source_format);
  fmt::format_to(write, "contents  {} storeys, {} walls, {} surfaces, {} rooms, {} doorways, {} windows, {} columns, {} triangles\n", g.storeys.size(),
                 g.walls.size(), g.surfaces.size(), g.rooms.size(), g.doorways.size(), g.windows.size(), g.columns.size(), g.mesh.triangles.size());
  for (size_t s = 0; s < g.storeys.size(); ++s) {
    fmt::format_to(write, "\nstorey {}: {}, {:+.3f} m\n", s, g.storeys[s].name, g.storeys[s].elevation_m);
    for (size_t i = 0; i < g.rooms.size(); ++i) {
      const Room& r = g.rooms[i];
      if (r.storey != StoreyId(s)) continue;
      fmt::format_to(write, "  room {:>3}  {:<28} {:>8.2f} m2  {} surfaces\n", i, r.name, r.area_m2, r.surfaces.size());
    }
    for (size_t i = 0; i < g.doorways.size(); ++i) {
      const Doorway& d = g.doorways[i];
      if (d.storey != StoreyId(s)) continue;
      fmt::format_to(write, "  door {:>3}  {} - {}, {:.2f} m wide\n", i, RoomName(g, d.room_a), RoomName(g, d.room_b), d.width_m);
    }
  }
  AliasesToText(g, out);
  return out;
}

Status RunInspect(const InspectFlags& flags, Session& session) {
  const auto graph = ReadAGraphFile(flags.path);
  if (!graph) return session.Fail(graph.error());
  if (!flags.svg.empty()) {
    if (flags.storey >= graph->storeys.size()) {
      return session.Fail({ErrorCode::kBadOption, fmt::format("--storey {}; `{}` has {} storeys, counted from 0", flags.storey, flags.path,
                                                              graph->storeys.size())});
    }
    const auto written = WriteFileAtomically(flags.svg, std::string_view(FloorPlanToSvg(*graph, StoreyId(flags.storey))));
    if (!written) return session.Fail(written.error());
    return Status::kFine;
  }
  session.console.Print(flags.json ? AGraphToJson(*graph) : GraphToText(*graph));
  return Status::kFine;
}

}  // namespace

void AddInspect(CLI::App& app, Session& session) {
  auto flags = std::make_shared<InspectFlags>();
  CLI::App* sub = AddSubcommand(app, session, "inspect", "Show what is in an A-Graph",
                                "  plumb inspect house.agraph\n"
                                "  plumb inspect house.agraph --json\n"
                                "  plumb inspect house.agraph --svg ground.svg --storey 0");
  sub->add_option("FILE.agraph", flags->path, "the A-Graph")->required();
  sub->add_flag("--json", flags->json, "print it as JSON");
  sub->add_option("--svg", flags->svg, "draw one storey's floor plan into this file")->type_name("FILE.svg");
  sub->add_option("--storey", flags->storey, "the storey to draw, counted from 0");
  sub->callback([flags, &session] { session.status = RunInspect(*flags, session); });
}

}  // namespace plumb::tools
