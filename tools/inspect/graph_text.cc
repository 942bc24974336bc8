#include "tools/inspect/graph_text.h"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <numbers>

#include "schema/agraph_json.h"
#include "schema/counted.h"

namespace plumb::tools {
namespace {

using Writer = std::back_insert_iterator<std::string>;

std::string RoomName(const AGraph& g, RoomId id) { return id.valid() ? g.rooms[id.index()].name : std::string("outside"); }

double Degrees(double rad) { return rad * 180 / std::numbers::pi; }

// ", swing into Kitchen at the left": at the jamb to the left of who passes in the order of the rooms.
std::string LeavesInWords(const AGraph& g, const Doorway& d) {
  if (!d.has_leaf) return ", without a leaf";
  std::string out;
  for (const DoorLeaf& l : d.leaves) {
    fmt::format_to(std::back_inserter(out), "{}{}", out.empty() ? ", " : " and ", NameOf(l.operation));
    if (l.opens_to != DoorwaySide::kUnknown) out += " into " + RoomName(g, l.opens_to == DoorwaySide::kRoomA ? d.room_a : d.room_b);
    const bool slides = l.operation == LeafOperation::kSliding;
    if (l.jamb != Jamb::kUnknown)
      fmt::format_to(std::back_inserter(out), "{} {}", slides ? " to the" : " at the", l.jamb == Jamb::kLeft ? "left" : "right");
  }
  return out;
}

// Doors by how their leaves open, two of one door as one.
void WriteLeafCounts(const AGraph& g, Writer write) {
  std::map<std::string, size_t> by_kind;
  size_t doors = 0, known = 0;
  for (const Doorway& d : g.doorways) {
    doors += d.has_leaf;
    if (d.leaves.empty()) continue;
    ++known;
    ++by_kind[fmt::format("{} {}", d.leaves.size() == 1 ? "single" : "double", NameOf(d.leaves[0].operation))];
  }
  if (known == 0) return;
  std::string kinds;
  for (const auto& [kind, n] : by_kind) fmt::format_to(std::back_inserter(kinds), "{}{} {}", kinds.empty() ? "" : ", ", n, kind);
  fmt::format_to(write, "leaves    of {} of {} known: {}\n", known, Counted(doors, "door"), kinds);
}

void WriteHead(const AGraph& g, size_t triangles, Writer write) {
  fmt::format_to(write, "source    {} ({})\n", g.source_path, g.source_format);
  if (!g.tool_version.empty()) fmt::format_to(write, "made by   plumb {}\n", g.tool_version);
  if (!g.options.empty()) fmt::format_to(write, "options  ");
  for (const Option& o : g.options) fmt::format_to(write, " {}={}", o.name, o.value);
  if (!g.options.empty()) fmt::format_to(write, "\n");
  fmt::format_to(write, "contents  {}, {}, {}, {}, {}, {}, {}, {}\n", Counted(g.storeys.size(), "storey"), Counted(g.walls.size(), "wall"),
                 Counted(g.surfaces.size(), "surface"), Counted(g.rooms.size(), "room"), Counted(g.doorways.size(), "doorway"),
                 Counted(g.windows.size(), "window"), Counted(g.columns.size(), "column"), Counted(triangles, "triangle"));
  WriteLeafCounts(g, write);
  if (g.true_north_rad) fmt::format_to(write, "north     {:.1f} deg counter-clockwise from +x\n", Degrees(*g.true_north_rad));
}

void WriteStorey(const AGraph& g, StoreyId storey, Writer write) {
  const Storey& s = g.storeys[storey.index()];
  fmt::format_to(write, "\nstorey {}: {}, {:+.3f} m\n", storey.value, s.name, s.elevation_m);
  for (size_t i = 0; i < g.rooms.size(); ++i) {
    const Room& r = g.rooms[i];
    if (r.storey != storey) continue;
    fmt::format_to(write, "  room {:>3}  {:<28} {:>8.2f} m2  {}\n", i, r.name, r.area_m2, Counted(r.surfaces.size(), "surface"));
  }
  for (size_t i = 0; i < g.doorways.size(); ++i) {
    const Doorway& d = g.doorways[i];
    if (d.storey != storey) continue;
    fmt::format_to(write, "  door {:>3}  {} - {}, {:.2f} m wide{}\n", i, RoomName(g, d.room_a), RoomName(g, d.room_b), d.width_m,
                   LeavesInWords(g, d));
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
