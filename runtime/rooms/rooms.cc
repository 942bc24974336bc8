#include "runtime/rooms/rooms.h"

#include <fmt/core.h>

#include "runtime/rooms/corridors.h"
#include "runtime/rooms/doorways.h"
#include "runtime/rooms/floors.h"
#include "runtime/rooms/free_space.h"
#include "runtime/rooms/outline.h"
#include "runtime/rooms/regions.h"

namespace plumb::runtime {
namespace {

constexpr double kMinCovered = 0.5;   // of the outline of what is closed, or was only looked into
constexpr double kMaxUnseen_m = 0.6;  // of the outline of what is closed, in one stretch

std::vector<bool> VisitedRegions(const SGraph& graph, const MapFloor& floor, const FreeSpace& space, const Regions& regions) {
  std::vector<bool> visited(static_cast<size_t>(regions.count));
  for (const uint32_t k : floor.keyframes) {
    const int32_t region = regions.label[space.grid.CellAt(graph.keyframes[k].T_map_kf.translation().head<2>())];
    if (region >= 0) visited[static_cast<size_t>(region)] = true;
  }
  return visited;
}

MapRoom RoomOf(const Outline& outline, bool visited) {
  MapRoom room;
  room.polygon = outline.polygon;
  room.holes = outline.holes;
  room.area_m2 = SignedArea(outline.polygon);
  for (const Polygon2& hole : outline.holes) room.area_m2 += SignedArea(hole);
  room.center = AreaCentroid(outline.polygon);
  room.surfaces = outline.surfaces;
  room.covered_ratio = outline.covered_ratio;
  room.closed = outline.covered_ratio >= kMinCovered && outline.longest_unseen_m <= kMaxUnseen_m;
  room.visited = visited;
  return room;
}

class FloorLayers {
 public:
  FloorLayers(const SGraph& graph, const MapFloor& floor, const RoomOptions& options, UpperLayers* out)
      : graph_(graph),
        floor_(floor),
        options_(options),
        out_(*out),
        space_(FindFreeSpace(graph, floor, options)),
        regions_(FindRegions(space_, options)) {}

  void AddRooms() {
    const std::vector<Outline> outlines = TraceOutlines(space_, regions_);
    const std::vector<bool> visited = VisitedRegions(graph_, floor_, space_, regions_);
    room_of_.resize(outlines.size());
    for (size_t r = 0; r < outlines.size(); ++r) {
      if (outlines[r].polygon.empty() || (!visited[r] && outlines[r].covered_ratio < kMinCovered)) continue;
      MapRoom room = RoomOf(outlines[r], visited[r]);
      room.id = static_cast<uint32_t>(out_.rooms.size());
      room.floor = floor_.id;
      room_of_[r] = room.id;
      if (!room.closed) AddCorridors(static_cast<int32_t>(r), outlines[r], room.id);
      out_.rooms.push_back(std::move(room));
    }
  }

  void AddDoorways() {
    for (const Neck& neck : regions_.necks) {
      const std::optional<uint32_t> a = room_of_[static_cast<size_t>(neck.region_a)], b = room_of_[static_cast<size_t>(neck.region_b)];
      if (!a && !b) continue;
      const Neck from_room = a ? neck : Neck{neck.region_b, neck.region_a, neck.cell};
      const std::optional<Opening> opening = MeasureOpening(space_, regions_, from_room, options_);
      if (!opening) continue;
      const auto id = static_cast<uint32_t>(out_.doorways.size());
      out_.doorways.push_back({id, floor_.id, opening->position, opening->yaw_rad, opening->width_m, a ? *a : *b, a ? b : std::nullopt});
      if (a) out_.rooms[*a].doorways.push_back(id);
      if (b) out_.rooms[*b].doorways.push_back(id);
    }
  }

 private:
  void AddCorridors(int32_t region, const Outline& outline, uint32_t room) {
    for (MapCorridor& corridor : FindCorridors(space_, regions_, region, outline)) {
      corridor.id = static_cast<uint32_t>(out_.corridors.size());
      corridor.room = room;
      out_.corridors.push_back(corridor);
    }
  }

  const SGraph& graph_;
  const MapFloor& floor_;
  const RoomOptions& options_;
  UpperLayers& out_;
  FreeSpace space_;
  Regions regions_;
  std::vector<std::optional<uint32_t>> room_of_;  // per region
};

}  // namespace

std::string RoomOptions::Check() const {
  const auto bad = [](const char* field, double value, const char* rule) {
    return fmt::format("RoomOptions.{} = {}; must be {}", field, value, rule);
  };
  if (!(storey_step_m >= 0.5)) return bad("storey_step_m", storey_step_m, ">= 0.5");
  if (!(band_low_m >= 0)) return bad("band_low_m", band_low_m, ">= 0");
  if (!(band_high_m > band_low_m)) return bad("band_high_m", band_high_m, "> band_low_m");
  if (!(cell_m >= 0.02 && cell_m <= 0.2)) return bad("cell_m", cell_m, "in [0.02, 0.2]");
  if (!(max_cells >= 1e4 && max_cells <= 1e9)) return bad("max_cells", max_cells, "in [1e4, 1e9]");
  if (!(max_range_m >= 1)) return bad("max_range_m", max_range_m, ">= 1");
  if (!(door_width_m > 0)) return bad("door_width_m", door_width_m, "> 0");
  if (!(passage_width_m >= door_width_m)) return bad("passage_width_m", passage_width_m, ">= door_width_m");
  if (!(min_doorway_width_m >= 0)) return bad("min_doorway_width_m", min_doorway_width_m, ">= 0");
  if (!(min_room_area_m2 >= 0)) return bad("min_room_area_m2", min_room_area_m2, ">= 0");
  return {};
}

UpperLayers DeriveUpperLayers(const SGraph& graph, const RoomOptions& options) {
  UpperLayers layers;
  layers.floors = FindFloors(graph, options);
  for (const MapFloor& floor : layers.floors) {
    FloorLayers on_floor(graph, floor, options, &layers);
    on_floor.AddRooms();
    on_floor.AddDoorways();
  }
  return layers;
}

}  // namespace plumb::runtime
