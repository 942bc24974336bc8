#include "compiler/passes/doorways.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kStep_m = 0.02;                              // of the probe away from the wall
constexpr std::array<double, 3> kAbreast = {0.0, -0.3, 0.3};  // probes' places, in widths from the middle; the middle decides a tie

enum class SideKind : uint8_t { kRoom, kOutside, kBlocked };

struct Side {
  SideKind kind = SideKind::kBlocked;
  RoomId room;
  friend bool operator==(const Side&, const Side&) = default;
};

// In the terms of a doorway that leads along the unit vector `through`. What lies in no clear direction of it is unknown.
std::vector<DoorLeaf> LeavesIn(const std::vector<PlanLeaf>& leaves, const Eigen::Vector2d& through) {
  constexpr double kClear = 0.5;  // cosine
  const Eigen::Vector2d left = Rot90Ccw(through);
  std::vector<DoorLeaf> out;
  for (const PlanLeaf& leaf : leaves) {
    const double to_left = leaf.to_jamb.dot(left), to_b = leaf.opens_to.dot(through);
    DoorLeaf d;
    d.operation = leaf.operation;
    d.width_m = leaf.width_m;
    if (std::abs(to_left) > kClear) d.jamb = to_left > 0 ? Jamb::kLeft : Jamb::kRight;
    if (std::abs(to_b) > kClear) d.opens_to = to_b > 0 ? DoorwaySide::kRoomB : DoorwaySide::kRoomA;
    out.push_back(d);
  }
  std::stable_sort(out.begin(), out.end(), [](const DoorLeaf& a, const DoorLeaf& b) { return a.jamb < b.jamb; });
  return out;
}

class DoorwayMaker {
 public:
  DoorwayMaker(const PlanIr& plan, const FloorIr& floors, const RoomsByFace& rooms, const DoorwayOptions& options, AGraph& graph,
               DiagnosticSink& sink)
      : plan_(plan), rooms_(rooms), options_(options), graph_(graph), sink_(sink) {
    for (const Floor& floor : floors.floors) locators_.emplace_back(floor);
  }

  OpeningElements Run(const std::vector<HostedOpening>& openings) {
    std::vector<Eigen::AlignedBox3d> places;
    for (const HostedOpening& o : openings) places.push_back(PlaceOf(o));
    const BoxTree<3> tree(std::move(places));
    std::vector<bool> leads_through(openings.size());
    for (size_t i = 0; i < openings.size(); ++i) leads_through[i] = openings[i].use == OpeningUse::kDoor;
    for (size_t i = 0; i < openings.size(); ++i) {
      const HostedOpening& o = openings[i];
      if (o.use == OpeningUse::kWindow) AddWindow(o);
      if (o.use == OpeningUse::kDoor) AddDoorway(o);
      if (o.use != OpeningUse::kUnfilled || !IsPassage(o)) continue;
      // A door or an earlier opening may lead through the same place.
      bool is_known = false;
      tree.ForEachIn(PlaceOf(o), [&](uint32_t k) { is_known |= leads_through[k] && IsSamePlace(o, openings[k]); });
      if (is_known) continue;
      AddDoorway(o);
      leads_through[i] = true;
    }
    return std::move(elements_);
  }

 private:
  const SourceLocation& LocationOf(const HostedOpening& o) const {
    return o.fillings.empty() ? plan_.openings[o.opening].location : plan_.elements[o.fillings[0]].location;
  }

  Side Probe(const HostedOpening& o, const Eigen::Vector2d& from, const Eigen::Vector2d& away) const {
    const double reach = 0.5 * o.depth_m + options_.max_reach_m;
    for (double t = 0.5 * o.depth_m + 0.5 * kStep_m; t <= reach; t += kStep_m) {
      const uint32_t face = locators_[o.floor].FaceAt(from + t * away);
      if (face == 0) return {SideKind::kOutside, {}};
      if (const RoomId room = rooms_[o.floor][face]; room.valid()) return {SideKind::kRoom, room};
    }
    return {};
  }

  // What most of three probes side by side meet.
  Side SideOf(const HostedOpening& o, const Eigen::Vector2d& away) const {
    std::array<Side, 3> sides;
    for (size_t i = 0; i < sides.size(); ++i) sides[i] = Probe(o, o.center + kAbreast[i] * o.width_m * o.along, away);
    if (sides[1].kind != SideKind::kBlocked && sides[1] == sides[2]) return sides[1];
    for (const Side& s : sides) {
      if (s.kind != SideKind::kBlocked) return s;
    }
    return {};
  }

  double FloorUnder(const HostedOpening& o, const Side& left, const Side& right) const {
    double out = graph_.storeys[o.storey.index()].elevation_m;
    for (const Side& s : {left, right}) {
      if (s.kind == SideKind::kRoom) out = std::max(out, graph_.rooms[s.room.index()].floor_z_m);
    }
    return out;
  }

  bool IsPassage(const HostedOpening& o) const {
    if (!o.through || o.width_m < options_.min_width_m) return false;
    const Eigen::Vector2d across = Rot90Ccw(o.along);
    const Side left = SideOf(o, across), right = SideOf(o, -across);
    if (left == right || left.kind == SideKind::kBlocked || right.kind == SideKind::kBlocked) return false;
    const double floor_z = FloorUnder(o, left, right);
    return o.z_min_m <= floor_z + options_.max_sill_m && o.z_max_m - std::max(o.z_min_m, floor_z) >= options_.min_height_m;
  }

  bool IsSamePlace(const HostedOpening& o, const HostedOpening& other) const {
    const Eigen::Vector2d offset = other.center - o.center;
    return other.floor == o.floor && std::abs(offset.dot(o.along)) < 0.5 * std::max(o.width_m, other.width_m) &&
           std::abs(Cross(o.along, offset)) < options_.max_reach_m &&
           std::min(o.z_max_m, other.z_max_m) > std::max(o.z_min_m, other.z_min_m);
  }

  // Those of two openings in the same place meet.
  Eigen::AlignedBox3d PlaceOf(const HostedOpening& o) const {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(0.5 * o.width_m + options_.max_reach_m);
    Eigen::AlignedBox3d out;
    out.min() << o.center - reach, o.z_min_m;
    out.max() << o.center + reach, o.z_max_m;
    return out;
  }

  // Fills what doorways and windows have in common; `out.yaw_rad` from the first side to the second.
  template <class Node>
  void Describe(const HostedOpening& o, const Eigen::Vector2d& direction, Node& out) const {
    const PlanOpening* opening = o.opening == kNoIndex ? nullptr : &plan_.openings[o.opening];
    if (!o.fillings.empty()) {
      out.guid = plan_.elements[o.fillings[0]].guid;
      out.name = plan_.elements[o.fillings[0]].name;
    } else {
      out.guid = opening->guid;
      out.name = opening->name;
    }
    out.storey = o.storey;
    out.wall = o.wall;
    out.position << o.center, o.z_min_m;
    out.yaw_rad = std::atan2(direction.y(), direction.x());
    out.width_m = opening != nullptr && opening->width_m ? *opening->width_m : o.width_m;
    out.height_m = opening != nullptr && opening->height_m ? *opening->height_m : o.z_max_m - o.z_min_m;
  }

  void AddDoorway(const HostedOpening& o) {
    Eigen::Vector2d across = Rot90Ccw(o.along);
    Side a = SideOf(o, -across), b = SideOf(o, across);
    if (Rank(b) < Rank(a)) {
      std::swap(a, b);
      across = -across;
    }
    Doorway out;
    Describe(o, across, out);
    out.room_a = a.room;
    out.room_b = b.room;
    out.has_leaf = o.use == OpeningUse::kDoor;
    for (const uint32_t e : o.fillings) {
      if (out.leaves.empty()) out.leaves = LeavesIn(plan_.elements[e].leaves, across);
    }
    Report(o, a, b);
    graph_.doorways.push_back(std::move(out));
    elements_.of_doorway.push_back(o.fillings);
  }

  void AddWindow(const HostedOpening& o) {
    if (!o.wall.valid()) return;
    Eigen::Vector2d across = Rot90Ccw(o.along);
    if (Rank(SideOf(o, across)) < Rank(SideOf(o, -across))) across = -across;
    Window out;
    Describe(o, across, out);
    graph_.windows.push_back(std::move(out));
    elements_.of_window.push_back(o.fillings);
  }

  // Rooms by id, then outside, then nothing.
  static uint64_t Rank(const Side& s) {
    if (s.kind == SideKind::kRoom) return s.room.value;
    return s.kind == SideKind::kOutside ? uint64_t{1} << 32 : uint64_t{1} << 33;
  }

  void Report(const HostedOpening& o, const Side& a, const Side& b) {
    const SourceLocation& where = LocationOf(o);
    if (b.kind == SideKind::kBlocked) {
      sink_.Emit(DiagnosticKind::kDoorwayBlocked, where,
                 fmt::format("{} leads to no room within {:.2f} m behind its wall; a doorway joins two rooms or a room and the outside",
                             where.ToString(), options_.max_reach_m));
    } else if (a.kind == SideKind::kRoom && a == b) {
      sink_.Emit(DiagnosticKind::kDoorwayWithinRoom, where,
                 fmt::format("{} has room `{}` on both sides; a doorway joins two rooms or a room and the outside", where.ToString(),
                             graph_.rooms[a.room.index()].name));
    } else if (a.kind == SideKind::kOutside) {
      sink_.Emit(DiagnosticKind::kDoorwayOutside, where,
                 fmt::format("{} has the outside on both sides; a doorway joins two rooms or a room and the outside", where.ToString()),
                 "the walls around the room behind it may not close");
    }
  }

  const PlanIr& plan_;
  std::vector<FaceLocator> locators_;
  const RoomsByFace& rooms_;
  const DoorwayOptions& options_;
  AGraph& graph_;
  DiagnosticSink& sink_;
  OpeningElements elements_;
};

}  // namespace

std::string DoorwayOptions::Check() const {
  if (!(max_sill_m >= 0)) return fmt::format("DoorwayOptions.max_sill_m = {}; must not be negative", max_sill_m);
  if (!(min_height_m > 0)) return fmt::format("DoorwayOptions.min_height_m = {}; must be positive", min_height_m);
  if (!(min_width_m > 0)) return fmt::format("DoorwayOptions.min_width_m = {}; must be positive", min_width_m);
  if (!(max_reach_m >= 0)) return fmt::format("DoorwayOptions.max_reach_m = {}; must not be negative", max_reach_m);
  return {};
}

OpeningElements AddDoorwaysAndWindows(const PlanIr& plan, const FloorIr& floors, const RoomsByFace& rooms,
                                      const std::vector<HostedOpening>& openings, const DoorwayOptions& options, AGraph& graph,
                                      DiagnosticSink& sink) {
  return DoorwayMaker(plan, floors, rooms, options, graph, sink).Run(openings);
}

}  // namespace plumb::compiler
