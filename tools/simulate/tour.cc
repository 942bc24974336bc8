#include "tools/simulate/tour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace plumb::tools {
namespace {

constexpr double kSeen_m = 2.5;           // the first visit to a room leaves no viewpoint farther than this from the way's stops
constexpr double kComfort_m = 0.6;        // clearance of viewpoints, where the room has it
constexpr double kLookAround = 0.35;      // chance to turn in place at a viewpoint
constexpr size_t kMaxViewpoints = 12;     // per visit

class TourPlanner {
 public:
  TourPlanner(const AGraph& house, const FreeSpace& space, const Reach& reach, const TourOptions& options, Random& random)
      : house_(house), space_(space), reach_(reach), options_(options), random_(random) {
    for (const RoomFloor& floor : reach.rooms) {
      if (floor.reachable) rooms_.push_back(&floor);
    }
  }

  Expected<Tour> Run() {
    if (rooms_.empty()) return Fail(ErrorCode::kPlanUnsuitable, "no room of the storey has a free place for a robot");
    if (rooms_.size() == 1 && reach_.rooms.size() > 1) {
      return Fail(ErrorCode::kPlanUnsuitable,
                  fmt::format("none of the storey's {} rooms can be left through a doorway, even by a robot of {:.2f} m radius",
                              reach_.rooms.size(), reach_.robot_radius_m));
    }
    const RoomFloor& start = *rooms_[random_.Index(rooms_.size())];
    const double yaw_rad = random_.Uniform(-std::numbers::pi, std::numbers::pi);
    at_ = RandomViewpoint(start);
    manoeuvres_.push_back({{space_.Center(space_.At(at_))}, 0});
    for (const RoomFloor* room : Order(start)) {
      if (planned_m_ > options_.drive.speed_m_s * options_.max_duration_s) break;  // what follows would be cut off again
      VisitThoroughly(*room);
    }
    // Every try replays the same wobble: it must not depend on how often the drive was lengthened.
    const Random wobble = random_;
    const auto drive = [&] {
      Random copy = wobble;
      return Drive(manoeuvres_, yaw_rad, space_, reach_.robot_radius_m, options_.drive, copy);
    };
    Random order(random_.Next());
    Tour tour{drive(), start.room, {}, {}, 0};
    while (tour.drive.duration_s() < options_.min_duration_s) {
      for (int i = 0; i < 3; ++i) GoTo(RandomViewpoint(*rooms_[order.Index(rooms_.size())]));
      tour.drive = drive();
    }
    tour.drive.CutAt(options_.max_duration_s);
    Judge(tour);
    return tour;
  }

 private:
  // In the order of the doorways.
  [[nodiscard]] std::map<RoomId, std::vector<const RoomFloor*>> Neighbours() const {
    std::map<RoomId, const RoomFloor*> floors;
    std::map<RoomId, std::vector<const RoomFloor*>> neighbours;
    for (const RoomFloor* room : rooms_) {
      floors[room->room] = room;
      neighbours[room->room] = {};
    }
    for (const Doorway& d : house_.doorways) {
      const auto a = floors.find(d.room_a), b = floors.find(d.room_b);
      if (a == floors.end() || b == floors.end() || a == b) continue;
      neighbours[d.room_a].push_back(b->second);
      neighbours[d.room_b].push_back(a->second);
    }
    return neighbours;
  }

  // Depth first through the doorways from `start`; rooms that no doorway of the plan leads to come last.
  std::vector<const RoomFloor*> Order(const RoomFloor& start) {
    std::vector<const RoomFloor*> order, stack = {&start}, rest = rooms_;
    std::set<RoomId> known;
    const std::map<RoomId, std::vector<const RoomFloor*>> neighbours = Neighbours();
    while (!stack.empty()) {
      const RoomFloor* room = stack.back();
      stack.pop_back();
      if (!known.insert(room->room).second) continue;
      order.push_back(room);
      std::vector<const RoomFloor*> next;
      for (const RoomFloor* other : neighbours.at(room->room)) {
        if (!known.contains(other->room)) next.push_back(other);
      }
      random_.Shuffle(next);
      stack.insert(stack.end(), next.begin(), next.end());
    }
    for (const RoomFloor* room : rest) {
      if (!known.contains(room->room)) order.push_back(room);
    }
    return order;
  }

  // Places with room to spare, if the room has any.
  [[nodiscard]] std::vector<size_t> Viewpoints(const RoomFloor& floor) const {
    const double wanted_m = std::min(kComfort_m, 0.7 * space_.clearance_m(floor.middle));
    std::vector<size_t> cells;
    for (const size_t i : floor.cells) {
      if (space_.clearance_m(i) >= wanted_m) cells.push_back(i);
    }
    return cells;
  }

  size_t RandomViewpoint(const RoomFloor& floor) {
    const std::vector<size_t> cells = Viewpoints(floor);
    return cells[random_.Index(cells.size())];
  }

  // To the middle of the room, then to wherever a viewpoint is still far from all others so far.
  void VisitThoroughly(const RoomFloor& floor) {
    GoTo(floor.middle);
    const std::vector<size_t> cells = Viewpoints(floor);
    std::vector<double> nearest_m(cells.size(), 1e9);
    for (size_t n = 1; n < kMaxViewpoints; ++n) {
      const Eigen::Vector2d here = space_.Center(space_.At(at_));
      size_t farthest = 0;
      for (size_t i = 0; i < cells.size(); ++i) {
        nearest_m[i] = std::min(nearest_m[i], (space_.Center(space_.At(cells[i])) - here).norm());
        if (nearest_m[i] > nearest_m[farthest]) farthest = i;
      }
      if (nearest_m[farthest] < kSeen_m) return;
      GoTo(cells[farthest]);
    }
  }

  void GoTo(size_t target) {
    const Polyline route = FindRoute(space_, at_, target, reach_.robot_radius_m);
    if (route.size() < 2) return;
    Polyline& line = manoeuvres_.back().line;
    line.insert(line.end(), route.begin() + (line.empty() ? 0 : 1), route.end());
    at_ = target;
    for (size_t i = 1; i < route.size(); ++i) planned_m_ += (route[i] - route[i - 1]).norm();
    if (random_.Uniform() < kLookAround) {
      manoeuvres_.back().turn_rad = random_.Sign() * random_.Uniform(std::numbers::pi / 3, 2 * std::numbers::pi);
      manoeuvres_.push_back({{route.back()}, 0});
    }
  }

  void Judge(Tour& tour) const {
    std::set<RoomId> visited;
    std::map<int16_t, const RoomFloor*> floors;
    for (const RoomFloor& floor : reach_.rooms) floors[static_cast<int16_t>(floor.room.index())] = &floor;
    Eigen::Vector2d last = tour.drive.PoseAt(0).translation().head<2>();
    for (double t = 0; t <= tour.drive.duration_s(); t += 0.1) {
      const Eigen::Vector2d p = tour.drive.PoseAt(t).translation().head<2>();
      tour.path_m += (p - last).norm();
      last = p;
      const size_t index = space_.Index(space_.CellAt(p));
      const auto floor = floors.find(space_.room(index));
      if (floor == floors.end()) continue;
      const std::vector<size_t>& cells = floor->second->cells;
      if (std::binary_search(cells.begin(), cells.end(), index)) visited.insert(floor->second->room);
    }
    for (const RoomFloor& floor : reach_.rooms) (visited.contains(floor.room) ? tour.visited : tour.not_visited).push_back(floor.room);
  }

  const AGraph& house_;
  const FreeSpace& space_;
  const Reach& reach_;
  const TourOptions& options_;
  Random& random_;
  std::vector<const RoomFloor*> rooms_;  // the reachable ones
  std::vector<Manoeuvre> manoeuvres_;
  size_t at_ = 0;
  double planned_m_ = 0;
};

}  // namespace

Expected<Tour> PlanTour(const AGraph& house, const FreeSpace& space, const Reach& reach, const TourOptions& options, Random& random) {
  return TourPlanner(house, space, reach, options, random).Run();
}

}  // namespace plumb::tools
