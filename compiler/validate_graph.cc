#include "compiler/validate_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/alias_text.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kOnBoundary_m = 0.005;  // rounding and snapping of the planar map
constexpr double kProbe_m = 0.01;        // step off a surface to see what is before it
constexpr double kAreaShare = 0.01;      // by which a stated area may differ, and two rooms overlap
constexpr double kLeastAcross_m = 1;     // of wall surfaces across the others of a storey
constexpr double kOpeningSlack_m = 0.3;  // of an opening's middle to its wall, beyond the thickness

std::vector<Ring> RingsOf(const Room& room) {
  std::vector<Ring> out = {room.polygon};
  out.insert(out.end(), room.holes.begin(), room.holes.end());
  return out;
}

bool SelfIntersects(const Ring& ring) {
  const size_t n = ring.size();
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d u = ring[(i + 1) % n] - ring[i];
    for (size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      const Eigen::Vector2d v = ring[(j + 1) % n] - ring[j], w = ring[j] - ring[i];
      const double det = Cross(u, v);
      if (det == 0) continue;
      const double s = Cross(w, v) / det, t = Cross(w, u) / det;
      constexpr double kInside = 1e-6;  // rings may touch themselves in a corner
      if (s > kInside && s < 1 - kInside && t > kInside && t < 1 - kInside) return true;
    }
  }
  return false;
}

class Validator {
 public:
  explicit Validator(const AGraph& graph) : graph_(graph), sides_(graph.walls.size()) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const Room& r : graph.rooms) {
      rings_.push_back(RingsOf(r));
      boxes.push_back(BoundingBox(rings_.back()));
    }
    rooms_ = BoxTree<2>(std::move(boxes));
    for (uint32_t s = 0; s < graph.surfaces.size(); ++s) sides_[graph.surfaces[s].wall.index()].push_back(s);
  }

  std::vector<Diagnostic> Run() {
    CheckRooms();
    CheckSurfaces();
    CheckOpenings();
    CheckWalls();
    if (graph_.rooms.empty()) Emit(DiagnosticKind::kNoRooms, {}, "the plan has no room");
    if (graph_.mesh.triangles.empty()) Emit(DiagnosticKind::kNoTriangles, {}, "the plan has no triangle");
    for (const Diagnostic& d : DescribeAliases(graph_)) sink_.Emit(d.kind, d.location, d.message, d.hint);
    bool fixed_somewhere = false;
    for (size_t s = 0; s < graph_.storeys.size(); ++s) fixed_somewhere |= FixesPosition(StoreyId(s));
    if (!fixed_somewhere)
      Emit(DiagnosticKind::kNowhereToLocalize, {}, "no storey has wall surfaces in two directions: nothing fixes a robot's position");
    return sink_.all();
  }

 private:
  void Emit(DiagnosticKind kind, const std::string& guid, std::string message) {
    SourceLocation where;
    where.guid = guid;
    sink_.Emit(kind, where, std::move(message));
  }
  std::string NameOf(size_t room) const { return NameOf("room", room, graph_.rooms[room].name); }
  static std::string NameOf(const char* what, size_t i, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", what, i) : fmt::format("{} {} `{}`", what, i, name);
  }

  // True if there is enough wall across the longest one; false also where the storey has no wall. Curved walls face every way.
  bool FixesPosition(StoreyId storey) {
    const Surface* longest = nullptr;
    for (const Surface& s : graph_.surfaces) {
      if (s.storey != storey) continue;
      if (s.arc) return true;
      if (!longest || s.length_m() > longest->length_m()) longest = &s;
    }
    if (!longest) return false;
    double across_m = 0;
    for (const Surface& s : graph_.surfaces) {
      if (s.storey == storey) across_m += s.length_m() * std::abs(Cross(longest->normal.head<2>(), s.normal.head<2>()));
    }
    if (across_m >= kLeastAcross_m) return true;
    const Storey& where = graph_.storeys[storey.index()];
    Emit(DiagnosticKind::kWallsInOneDirection, where.guid,
         fmt::format(
             "the wall surfaces of storey `{}` run in one direction, with {:.2f} m across it; at least {:.2f} m fix a position along them",
             where.name, across_m, kLeastAcross_m));
    return false;
  }

  void CheckRooms() {
    std::vector<bool> entered(graph_.rooms.size(), false);
    for (const Doorway& d : graph_.doorways) {
      for (RoomId r : {d.room_a, d.room_b}) {
        if (r.valid()) entered[r.index()] = true;
      }
    }
    for (const OpenBoundary& b : graph_.open_boundaries) entered[b.room_a.index()] = entered[b.room_b.index()] = true;
    for (size_t i = 0; i < graph_.rooms.size(); ++i) {
      const Room& r = graph_.rooms[i];
      CheckClosed(i);
      if (r.surfaces.empty()) Emit(DiagnosticKind::kRoomWithoutSurfaces, r.guid, fmt::format("{} has no wall surface", NameOf(i)));
      if (r.ceiling_z_m <= r.floor_z_m) {
        Emit(DiagnosticKind::kRoomUpsideDown, r.guid,
             fmt::format("{} has its floor at {:.3f} m and its ceiling at {:.3f} m", NameOf(i), r.floor_z_m, r.ceiling_z_m));
      }
      if (!entered[i]) {
        Emit(DiagnosticKind::kRoomWithoutDoorway, r.guid,
             fmt::format("no doorway leads into {} around ({:.2f}, {:.2f})", NameOf(i), r.center.x(), r.center.y()));
      }
      for (uint32_t j : RoomsIn(BoundingBox(rings_[i]))) {
        if (j < i) CheckApart(j, i);
      }
    }
  }

  void CheckClosed(size_t i) {
    const Room& r = graph_.rooms[i];
    const std::vector<Ring>& rings = rings_[i];
    double area = 0;
    bool simple = true;
    for (const Ring& ring : rings) {
      simple &= ring.size() >= 3 && !SelfIntersects(ring);
      if (ring.size() >= 3) area += SignedArea(ring);
    }
    if (!simple)
      Emit(DiagnosticKind::kRoomUnclosed, r.guid, fmt::format("a boundary of {} has fewer than 3 corners or crosses itself", NameOf(i)));
    else if (area <= 0)
      Emit(DiagnosticKind::kRoomUnclosed, r.guid, fmt::format("the boundary of {} encloses {:.3f} m2", NameOf(i), area));
    else if (std::abs(area - r.area_m2) > kAreaShare * area) {
      Emit(DiagnosticKind::kRoomUnclosed, r.guid,
           fmt::format("the boundary of {} encloses {:.3f} m2, its area is given as {:.3f} m2", NameOf(i), area, r.area_m2));
    }
  }

  void CheckApart(size_t i, size_t j) {
    const Room &a = graph_.rooms[i], &b = graph_.rooms[j];
    if (a.storey != b.storey || std::min(a.ceiling_z_m, b.ceiling_z_m) <= std::max(a.floor_z_m, b.floor_z_m)) return;
    const double overlap = OverlapArea(rings_[i], rings_[j]);
    if (overlap <= kAreaShare * std::min(a.area_m2, b.area_m2)) return;
    Emit(DiagnosticKind::kRoomsOverlap, a.guid, fmt::format("{} and {} have {:.3f} m2 in common", NameOf(i), NameOf(j), overlap));
  }

  void CheckSurfaces() {
    std::vector<RoomId> claimed(graph_.surfaces.size());
    for (size_t r = 0; r < graph_.rooms.size(); ++r) {
      for (SurfaceId s : graph_.rooms[r].surfaces) claimed[s.index()] = RoomId(r);
    }
    for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
      const Surface& s = graph_.surfaces[i];
      const std::string& guid = graph_.walls[s.wall.index()].guid;
      if (claimed[i] != s.room)
        Emit(DiagnosticKind::kSurfaceUnclaimed, guid, fmt::format("surface {} names another room than the one that lists it", i));
      const Eigen::Vector2d before = s.midpoint() + kProbe_m * s.normal.head<2>();
      if (s.room.valid()) {
        const std::vector<Ring>& rings = rings_[s.room.index()];
        const double off = std::max(DistanceToRings(s.start, rings), DistanceToRings(s.end, rings));
        const bool faces_in = s.arc || WindingNumber(rings, before) != 0;
        if (off > kOnBoundary_m || !faces_in) {
          Emit(DiagnosticKind::kSurfaceOffRoom, guid,
               fmt::format("surface {} lies {:.3f} m off the boundary of {}{}", i, off, NameOf(s.room.index()),
                           faces_in ? "" : " and faces out of it"));
        }
        continue;
      }
      if (s.arc) continue;
      for (uint32_t r : RoomsIn(Eigen::AlignedBox2d(before))) {
        if (graph_.rooms[r].storey != s.storey || WindingNumber(rings_[r], before) == 0) continue;
        Emit(DiagnosticKind::kSurfaceUnclaimed, guid, fmt::format("surface {} has no room but faces {}", i, NameOf(r)));
      }
    }
  }

  // To the wall's sides where it has some, since the axis of a curved wall is its chord.
  double DistanceToWall(WallId wall, const Eigen::Vector2d& p) const {
    double best = std::numeric_limits<double>::infinity();
    for (uint32_t side : sides_[wall.index()]) {
      const Surface& s = graph_.surfaces[side];
      const double chord = DistanceToSegment(p, s.start, s.end);
      best = std::min(best, s.arc ? std::min(chord, std::abs((p - s.arc->center).norm() - s.arc->radius_m)) : chord);
    }
    const Wall& w = graph_.walls[wall.index()];
    return std::min(best, DistanceToSegment(p, w.axis_start, w.axis_end));
  }

  template <class Node>
  void CheckOnWall(const char* what, size_t i, const Node& node) {
    if (!node.wall.valid()) {
      Emit(DiagnosticKind::kOpeningOffWall, node.guid, fmt::format("{} has no wall", NameOf(what, i, node.name)));
      return;
    }
    const double distance = DistanceToWall(node.wall, node.position.template head<2>()),
                 thickness = graph_.walls[node.wall.index()].thickness_m;
    if (distance <= thickness + kOpeningSlack_m) return;
    Emit(DiagnosticKind::kOpeningOffWall, node.guid,
         fmt::format("{} lies {:.3f} m off its wall, which is {:.3f} m thick", NameOf(what, i, node.name), distance, thickness));
  }

  void CheckOpenings() {
    for (size_t i = 0; i < graph_.doorways.size(); ++i) {
      const Doorway& d = graph_.doorways[i];
      CheckOnWall("doorway", i, d);
      if (!d.room_a.valid())
        Emit(DiagnosticKind::kDoorwayWithoutRoom, d.guid, fmt::format("{} leads into no room", NameOf("doorway", i, d.name)));
      if (d.room_a.valid() && d.room_a == d.room_b) {
        Emit(DiagnosticKind::kDoorwayWithoutRoom, d.guid,
             fmt::format("{} has {} on both sides", NameOf("doorway", i, d.name), NameOf(d.room_a.index())));
      }
    }
    for (size_t i = 0; i < graph_.windows.size(); ++i) CheckOnWall("window", i, graph_.windows[i]);
  }

  void CheckWalls() {
    std::vector<bool> seen(graph_.walls.size(), false);
    for (const Surface& s : graph_.surfaces) seen[s.wall.index()] = true;
    for (size_t w = 0; w < graph_.walls.size(); ++w) {
      if (!seen[w])
        Emit(DiagnosticKind::kWallWithoutSurfaces, graph_.walls[w].guid,
             fmt::format("wall {} bounds no room and no outside",
                         graph_.walls[w].name.empty() ? fmt::format("{}", w) : fmt::format("{} `{}`", w, graph_.walls[w].name)));
    }
  }

  // Ascending.
  std::vector<uint32_t> RoomsIn(const Eigen::AlignedBox2d& box) const {
    std::vector<uint32_t> out;
    rooms_.ForEachIn(box, [&](uint32_t r) { out.push_back(r); });
    std::sort(out.begin(), out.end());
    return out;
  }

  const AGraph& graph_;
  std::vector<std::vector<Ring>> rings_;      // of rooms
  std::vector<std::vector<uint32_t>> sides_;  // of walls, in AGraph::surfaces
  BoxTree<2> rooms_;
  DiagnosticSink sink_;
};

}  // namespace

std::vector<Diagnostic> ValidateGraph(const AGraph& graph) { return Validator(graph).Run(); }

}  // namespace plumb::compiler
