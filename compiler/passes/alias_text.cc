#include "compiler/passes/alias_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace plumb::compiler {
namespace {

constexpr size_t kMaxNamed = 4;
constexpr double kNoTurn_rad = 0.001, kNoMove_m = 0.005;

// "a, b and 3 more"
std::string Listed(const std::vector<std::string>& names) {
  std::string out;
  const size_t shown = names.size() <= kMaxNamed ? names.size() : kMaxNamed - 1;
  for (size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == names.size();
    out += fmt::format("{}{}", i == 0 ? "" : (last ? " and " : ", "), names[i]);
  }
  if (shown < names.size()) out += fmt::format(" and {} more", names.size() - shown);
  return out;
}

std::string NameOf(const AGraph& graph, RoomId room) {
  const std::string& name = graph.rooms[room.index()].name;
  return name.empty() ? fmt::format("room {}", room.value) : fmt::format("`{}`", name);
}

std::string NameOf(const Element& e) {
  if (!e.name.empty()) return fmt::format("`{}`", e.name);
  return e.guid.empty() ? e.type : fmt::format("{} {}", e.type, e.guid);
}

std::string MotionOf(const Alias& a) {
  std::string out;
  const double yaw_rad = a.yaw_rad < kNoTurn_rad - std::numbers::pi ? std::numbers::pi : a.yaw_rad;  // 180, never -180
  if (std::abs(yaw_rad) > kNoTurn_rad) out = fmt::format("turned by {:.1f} deg", yaw_rad * 180 / std::numbers::pi);
  if (a.translation.norm() > kNoMove_m) {
    const Eigen::Vector3d t = (a.translation * 100).array().round() / 100 + 0.0;  // no -0.00
    out += fmt::format("{}moved by ({:.2f}, {:.2f}, {:.2f}) m", out.empty() ? "" : " and ", t.x(), t.y(), t.z());
  }
  return out;
}

// Rooms that fall on each other are named once.
std::string PairsOf(const AGraph& graph, const Alias& a) {
  std::set<std::pair<RoomId, RoomId>> named;
  std::vector<std::string> names;
  for (size_t i = 0; i < a.rooms.size(); ++i) {
    if (!named.insert(std::minmax(a.rooms[i], a.twins[i])).second) continue;
    names.push_back(a.rooms[i] == a.twins[i] ? NameOf(graph, a.rooms[i]) + " on itself"
                                             : NameOf(graph, a.rooms[i]) + " on " + NameOf(graph, a.twins[i]));
  }
  return Listed(names);
}

// Rooms next to `rooms` that are none of them.
std::vector<std::string> WaysOut(const AGraph& graph, const std::vector<RoomId>& rooms) {
  const std::set<RoomId> inside(rooms.begin(), rooms.end());
  std::set<RoomId> next;
  const auto add = [&](RoomId a, RoomId b) {
    if (a.valid() && b.valid() && inside.contains(a) && !inside.contains(b)) next.insert(b);
  };
  for (const Doorway& d : graph.doorways) {
    add(d.room_a, d.room_b);
    add(d.room_b, d.room_a);
  }
  for (const OpenBoundary& b : graph.open_boundaries) {
    add(b.room_a, b.room_b);
    add(b.room_b, b.room_a);
  }
  std::vector<std::string> names;
  for (RoomId room : next) names.push_back(NameOf(graph, room));
  return names;
}

// What would tell them apart.
std::string HintOf(const AGraph& graph, const Alias& a) {
  std::vector<std::string> things;
  for (ElementId e : a.differences) things.push_back(NameOf(graph.elements[e.index()]));
  std::string out;
  if (!things.empty()) out = fmt::format("these differ: {}", Listed(things));
  if (a.closed) return out.empty() ? "give the robot its start pose, or set up something that stands on one side only" : out;
  std::vector<RoomId> all = a.rooms;
  all.insert(all.end(), a.twins.begin(), a.twins.end());
  const std::vector<std::string> ways = WaysOut(graph, all);
  if (ways.empty()) return out;
  return fmt::format("{}{}the way out tells: {}", out, out.empty() ? "" : "; ", Listed(ways));
}

SourceLocation LocationOf(const AGraph& graph, RoomId room) {
  SourceLocation where;
  where.guid = graph.rooms[room.index()].guid;
  return where;
}

void Describe(const AGraph& graph, const Alias& a, DiagnosticSink& sink) {
  if (a.rooms.empty()) return;  // from a file before schema 1.1
  sink.Emit(a.closed ? DiagnosticKind::kPlanAlias : DiagnosticKind::kPartialAlias, LocationOf(graph, a.rooms.front()),
            fmt::format("{}, {} {} on {} that a LiDAR cannot tell apart: {}; {:.0f} % of {:.0f} m of wall sections coincide within {} m",
                        MotionOf(a), a.rooms.size(), a.rooms.size() == 1 ? "room falls" : "rooms fall",
                        a.rooms.size() == 1 ? "one" : "rooms", PairsOf(graph, a), 100 * a.overlap_ratio, a.section_length_m, a.tolerance_m),
            HintOf(graph, a));
}

}  // namespace

std::vector<Diagnostic> DescribeAliases(const AGraph& graph) {
  DiagnosticSink sink;
  for (const Alias& a : graph.aliases) Describe(graph, a, sink);
  for (const LookAlikes& l : graph.look_alikes) {
    if (l.rooms.empty()) continue;
    std::vector<std::string> names;
    for (RoomId room : l.rooms) names.push_back(NameOf(graph, room));
    sink.Emit(DiagnosticKind::kRoomsAlike, LocationOf(graph, l.rooms.front()),
              fmt::format("{} rooms look alike from inside: {}", l.rooms.size(), Listed(names)),
              "a robot must leave the room to tell which one it is");
  }
  return sink.all();
}

}  // namespace plumb::compiler
