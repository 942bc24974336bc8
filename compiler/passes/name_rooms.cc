#include "compiler/passes/name_rooms.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/divide_rooms.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kTouches = 0.05;  // share of a space in a room, or of a room in a space, that is no rounding of walls

struct Pairing {
  double overlap_m2, iou;
  size_t room, space;
};

struct OutlineOnFloor {
  std::vector<Ring> rings;
  double area_m2 = 0;
  size_t floor = 0;
};

std::vector<Ring> RingsOf(const Room& room) {
  std::vector<Ring> out = {room.polygon};
  out.insert(out.end(), room.holes.begin(), room.holes.end());
  return out;
}

std::string Label(const PlanSpace& space) {
  if (space.long_name.empty() || space.long_name == space.name) return space.name;
  return space.name.empty() ? space.long_name : space.name + " " + space.long_name;
}

class Namer {
 public:
  Namer(const PlanIr& plan, const FloorIr& floors, const NamingOptions& options, AGraph& graph, DiagnosticSink& sink)
      : plan_(plan), floors_(floors), options_(options), graph_(graph), sink_(sink) {}

  void Run() {
    for (const PlanSpace& space : plan_.spaces) outlines_.push_back(OutlineOf(space));
    Pair();
    space_of_room_.assign(graph_.rooms.size(), kNoIndex);
    room_of_space_.assign(plan_.spaces.size(), kNoIndex);
    Assign();
    Report();
    NameTheRest();
  }

 private:
  OutlineOnFloor OutlineOf(const PlanSpace& space) const {
    OutlineOnFloor out;
    out.floor = FloorOfStorey(floors_, space.storey);
    out.rings = SpaceOutline(space, floors_.floors[out.floor]);
    out.area_m2 = RegionArea(out.rings);
    return out;
  }

  void Pair() {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const OutlineOnFloor& o : outlines_) boxes.push_back(BoundingBox(o.rings));
    const BoxTree<2> tree(std::move(boxes));
    for (size_t r = 0; r < graph_.rooms.size(); ++r) {
      const std::vector<Ring> rings = RingsOf(graph_.rooms[r]);
      std::vector<size_t> near;
      tree.ForEachIn(BoundingBox(rings), [&](uint32_t s) { near.push_back(s); });
      std::sort(near.begin(), near.end());
      for (size_t s : near) {
        const OutlineOnFloor& outline = outlines_[s];
        if (outline.floor != FloorOfStorey(floors_, graph_.rooms[r].storey.value)) continue;
        const double overlap = OverlapArea(rings, outline.rings), both = graph_.rooms[r].area_m2 + outline.area_m2 - overlap;
        if (overlap > 0 && both > 0) pairs_.push_back({overlap, overlap / both, r, s});
      }
    }
    std::stable_sort(pairs_.begin(), pairs_.end(), [](const Pairing& a, const Pairing& b) { return a.iou > b.iou; });
  }

  void Assign() {
    for (const Pairing& p : pairs_) {
      if (p.iou < options_.min_name_iou || space_of_room_[p.room] != kNoIndex || room_of_space_[p.space] != kNoIndex) continue;
      space_of_room_[p.room] = static_cast<uint32_t>(p.space);
      room_of_space_[p.space] = static_cast<uint32_t>(p.room);
      graph_.rooms[p.room].name = Label(plan_.spaces[p.space]);
      graph_.rooms[p.room].guid = plan_.spaces[p.space].guid;
      if (p.iou >= options_.min_equal_iou) continue;
      const PlanSpace& space = plan_.spaces[p.space];
      sink_.Emit(
          DiagnosticKind::kRoomDiffersFromSpace, space.location,
          fmt::format("space `{}` has {:.2f} m2, the room between the walls {:.2f} m2, {:.2f} m2 in common; intersection over union {:.2f} "
                      "< {:.2f}",
                      Label(space), outlines_[p.space].area_m2, graph_.rooms[p.room].area_m2, p.overlap_m2, p.iou, options_.min_equal_iou));
    }
  }

  void Report() {
    std::vector<const Pairing*> part_of(outlines_.size(), nullptr);  // the first pairing with a room that holds most of the space
    std::vector<bool> touched(graph_.rooms.size(), false);
    for (const Pairing& p : pairs_) {
      if (part_of[p.space] == nullptr && p.overlap_m2 > 0.5 * outlines_[p.space].area_m2) part_of[p.space] = &p;
      if (p.overlap_m2 > kTouches * graph_.rooms[p.room].area_m2) touched[p.room] = true;
    }
    for (size_t s = 0; s < outlines_.size(); ++s) {
      const PlanSpace& space = plan_.spaces[s];
      if (outlines_[s].rings.empty()) {
        sink_.Emit(DiagnosticKind::kSpaceWithoutBody, space.location, fmt::format("space `{}` has no solid to compare with", Label(space)));
        continue;
      }
      if (room_of_space_[s] != kNoIndex) continue;
      if (part_of[s] != nullptr) {
        ReportPart(*part_of[s]);
      } else {
        sink_.Emit(DiagnosticKind::kSpaceWithoutRoom, space.location,
                   fmt::format("no walls close around space `{}` ({:.2f} m2)", Label(space), outlines_[s].area_m2));
      }
    }
    for (size_t r = 0; r < graph_.rooms.size() && !plan_.spaces.empty(); ++r) {
      const Room& room = graph_.rooms[r];
      if (touched[r]) continue;
      sink_.Emit(
          DiagnosticKind::kRoomWithoutSpace, {},
          fmt::format("the room of {:.2f} m2 around ({:.2f}, {:.2f}) on `{}` has no space", room.area_m2,
                      room.center.x() + plan_.origin.x(), room.center.y() + plan_.origin.y(), graph_.storeys[room.storey.index()].name));
    }
  }

  // A space without a room of its own, most of which lies in one.
  void ReportPart(const Pairing& p) {
    const PlanSpace& space = plan_.spaces[p.space];
    const double area_m2 = outlines_[p.space].area_m2, room_area_m2 = graph_.rooms[p.room].area_m2;
    if (area_m2 < room_area_m2) {
      sink_.Emit(
          DiagnosticKind::kSpaceWithinRoom, space.location,
          fmt::format("no walls divide space `{}` ({:.2f} m2) from the rest of a room of {:.2f} m2", Label(space), area_m2, room_area_m2));
      return;
    }
    const uint32_t other = space_of_room_[p.room];
    sink_.Emit(
        DiagnosticKind::kRoomDiffersFromSpace, space.location,
        fmt::format("space `{}` has {:.2f} m2, more than the room of {:.2f} m2 between the walls there{}", Label(space), area_m2,
                    room_area_m2, other == kNoIndex ? "" : fmt::format(", which is that of space `{}`", Label(plan_.spaces[other]))));
  }

  void NameTheRest() {
    std::vector<int> count(graph_.storeys.size(), 0);
    for (Room& room : graph_.rooms) {
      const int number = ++count[room.storey.index()];
      if (room.name.empty()) room.name = fmt::format("{} room {}", graph_.storeys[room.storey.index()].name, number);
    }
  }

  const PlanIr& plan_;
  const FloorIr& floors_;
  const NamingOptions& options_;
  AGraph& graph_;
  DiagnosticSink& sink_;
  std::vector<OutlineOnFloor> outlines_;
  std::vector<Pairing> pairs_;
  std::vector<uint32_t> space_of_room_, room_of_space_;
};

}  // namespace

std::string NamingOptions::Check() const {
  if (!(min_name_iou > 0 && min_name_iou <= 1)) return fmt::format("NamingOptions.min_name_iou = {}; must be in (0, 1]", min_name_iou);
  if (!(min_equal_iou > 0 && min_equal_iou <= 1)) return fmt::format("NamingOptions.min_equal_iou = {}; must be in (0, 1]", min_equal_iou);
  return {};
}

void NameRooms(const PlanIr& plan, const FloorIr& floors, const NamingOptions& options, AGraph& graph, DiagnosticSink& sink) {
  Namer(plan, floors, options, graph, sink).Run();
}

}  // namespace plumb::compiler
