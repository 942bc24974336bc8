#include "tools/inspect/graph_text.h"

#include <fmt/format.h>

#include <iterator>
#include <numbers>

namespace plumb::tools {
namespace {

using Writer = std::back_insert_iterator<std::string>;

std::string RoomName(const AGraph& g, RoomId id) { return id.valid() ? g.rooms[id.index()].name : std::string("outside"); }

double Degrees(double rad) { return rad * 180 / std::numbers::pi; }

void WriteHead(const AGraph& g, size_t triangles, Writer write) {
  fmt::format_to(write, "source    {} ({})\n", g.source_path, g.source_format);
  if (!g.tool_version.empty()) fmt::format_to(write, "made by   plumb {}\n", g.tool_version);
  if (!g.options.empty()) fmt::format_to(write, "options  ");
  for (const Option& o : g.options) fmt::format_to(write, " {}={}", o.name, o.value);
  if (!g.options.empty()) fmt::format_to(write, "\n");
  fmt::format_to(write, "contents  {} storeys, {} walls, {} surfaces, {} rooms, {} doorways, {} windows, {} columns, {} triangles\n",
                 g.storeys.size(), g.walls.size(), g.surfaces.size(), g.rooms.size(), g.doorways.size(), g.windows.size(), g.columns.size(),
                 triangles);
  if (g.true_north_rad) fmt::format_to(write, "north     {:.1f} deg counter-clockwise from +x\n", Degrees(*g.true_north_rad));
}

void WriteStorey(const AGraph& g, StoreyId storey, Writer write) {
  const Storey& s = g.storeys[storey.index()];
  fmt::format_to(write, "\nstorey {}: {}, {:+.3f} m\n", storey.value, s.name, s.elevation_m);
  for (size_t i = 0; i < g.rooms.size(); ++i) {
    const Room& r = g.rooms[i];
    if (r.storey != storey) continue;
    fmt::format_to(write, "  room {:>3}  {:<28} {:>8.2f} m2  {} surfaces\n", i, r.name, r.area_m2, r.surfaces.size());
  }
  for (size_t i = 0; i < g.doorways.size(); ++i) {
    const Doorway& d = g.doorways[i];
    if (d.storey != storey) continue;
    fmt::format_to(write, "  door {:>3}  {} - {}, {:.2f} m wide{}\n", i, RoomName(g, d.room_a), RoomName(g, d.room_b), d.width_m,
                   d.has_leaf ? "" : ", without a leaf");
  }
}

void WriteAliases(const AGraph& g, Writer write) {
  for (size_t i = 0; i < g.aliases.size(); ++i) {
    const Alias& a = g.aliases[i];
    fmt::format_to(write,
                   "\nalias {}: turned by {:.1f} deg, moved by ({:.2f}, {:.2f}, {:.2f}) m; {:.0f} % of {:.0f} m of wall sections coincide "
                   "within {} m{}\n",
                   i, Degrees(a.yaw_rad), a.translation.x(), a.translation.y(), a.translation.z(), 100 * a.overlap_ratio,
                   a.section_length_m, a.tolerance_m, a.closed ? "" : "; other rooms tell");
    for (size_t k = 0; k < a.rooms.size(); ++k) fmt::format_to(write, "  {} = {}\n", RoomName(g, a.rooms[k]), RoomName(g, a.twins[k]));
  }
  if (!g.look_alikes.empty()) fmt::format_to(write, "\nrooms that look alike from inside\n");
  for (const LookAlikes& l : g.look_alikes) {
    for (size_t k = 0; k < l.rooms.size(); ++k) fmt::format_to(write, "{}{}", k == 0 ? "  " : " = ", RoomName(g, l.rooms[k]));
    fmt::format_to(write, "\n");
  }
}

}  // namespace

std::string AGraphToText(const AGraph& g, size_t triangles) {
  std::string out;
  const auto write = std::back_inserter(out);
  WriteHead(g, triangles, write);
  for (size_t s = 0; s < g.storeys.size(); ++s) WriteStorey(g, StoreyId(s), write);
  WriteAliases(g, write);
  return out;
}

}  // namespace plumb::tools
