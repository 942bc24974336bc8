#include "tools/simulate/reach.h"

#include <algorithm>
#include <array>
#include <map>

namespace plumb::tools {
namespace {

constexpr std::array kRadii_m = {0.25, 0.22, 0.19, 0.17, 0.15, 0.12};

// Cells connected to `start` (4 neighbours) for which allowed(index) holds; marks them in `seen`.
template <class Allowed>
std::vector<size_t> Flood(const FreeSpace& space, size_t start, std::vector<uint8_t>& seen, Allowed allowed) {
  std::vector<size_t> cells = {start};
  seen[start] = 1;
  for (size_t i = 0; i < cells.size(); ++i) {
    const Cell c = space.At(cells[i]);
    for (const Cell n : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}}) {
      if (n.x < 0 || n.y < 0 || n.x >= space.width() || n.y >= space.height()) continue;
      const size_t index = space.Index(n);
      if (seen[index] != 0 || !allowed(index)) continue;
      seen[index] = 1;
      cells.push_back(index);
    }
  }
  return cells;
}

}  // namespace

Reach ReachWithRadius(const AGraph& house, StoreyId storey, const FreeSpace& space, double radius_m) {
  Reach reach;
  reach.robot_radius_m = radius_m;
  // Of a room's connected pieces the largest: others lie inside a cupboard, or behind a wall that was built inside the room.
  std::map<int16_t, std::vector<size_t>> cells_of;
  std::vector<uint8_t> in_room(space.size(), 0);
  for (size_t i = 0; i < space.size(); ++i) {
    const int16_t room = space.room(i);
    if (room < 0 || in_room[i] != 0 || space.clearance_m(i) < radius_m) continue;
    std::vector<size_t> cells =
        Flood(space, i, in_room, [&](size_t k) { return space.room(k) == room && space.clearance_m(k) >= radius_m; });
    if (cells.size() > cells_of[room].size()) cells_of[room] = std::move(cells);
  }
  for (size_t r = 0; r < house.rooms.size(); ++r) {
    if (house.rooms[r].storey != storey) continue;
    RoomFloor floor;
    floor.room = RoomId(r);
    if (const auto it = cells_of.find(static_cast<int16_t>(r)); it != cells_of.end()) {
      floor.cells = std::move(it->second);
      std::sort(floor.cells.begin(), floor.cells.end());
      const auto tighter = [&space](size_t a, size_t b) { return space.clearance_m(a) < space.clearance_m(b); };
      floor.middle = *std::max_element(floor.cells.begin(), floor.cells.end(), tighter);
    }
    reach.rooms.push_back(std::move(floor));
  }
  // Groups of rooms; the one with the most rooms stays.
  std::vector<uint8_t> seen(space.size(), 0);
  std::vector<size_t> best;
  for (const RoomFloor& first : reach.rooms) {
    if (first.cells.empty() || seen[first.middle] != 0) continue;
    std::vector<uint8_t> group(space.size(), 0);
    for (const size_t i : Flood(space, first.middle, group, [&](size_t k) { return space.clearance_m(k) >= radius_m; })) seen[i] = 1;
    std::vector<size_t> members;
    for (size_t k = 0; k < reach.rooms.size(); ++k) {
      if (!reach.rooms[k].cells.empty() && group[reach.rooms[k].middle] != 0) members.push_back(k);
    }
    if (members.size() > best.size()) best = members;
  }
  for (const size_t k : best) reach.rooms[k].reachable = true;
  return reach;
}

size_t Reach::reachable() const {
  return static_cast<size_t>(std::count_if(rooms.begin(), rooms.end(), [](const RoomFloor& r) { return r.reachable; }));
}

Reach FindReach(const AGraph& house, StoreyId storey, const FreeSpace& space) {
  Reach best;
  for (const double radius_m : kRadii_m) {
    Reach reach = ReachWithRadius(house, storey, space, radius_m);
    if (best.rooms.empty() || reach.reachable() > best.reachable()) best = std::move(reach);
    if (best.reachable() == best.rooms.size()) break;
  }
  return best;
}

}  // namespace plumb::tools
