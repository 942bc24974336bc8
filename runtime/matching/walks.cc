#include "runtime/matching/walks.h"

#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kInside_m = 0.4;        // beyond the wall: from there all of the room is in view
constexpr double kInDoorway_m = 1.0;     // from an opening's middle: there a point is in no room

// The way through one opening in one direction.
struct Entry {
  RoomId from, to;
  size_t opening = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

class Walks {
 public:
  explicit Walks(const AGraph& plan) : entries_from_(plan.rooms.size()) {
    for (const Doorway& d : plan.doorways) {
      const double half_m = d.wall.valid() ? plan.walls[d.wall.index()].thickness_m / 2 : 0;
      Add(d.room_a, d.room_b, d.position, {std::cos(d.yaw_rad), std::sin(d.yaw_rad)}, half_m);
    }
    for (const OpenBoundary& b : plan.open_boundaries) {
      if (!b.room_a.valid()) continue;
      const Eigen::Vector2d along = (b.end - b.start).normalized(), middle = 0.5 * (b.start + b.end);
      Add(b.room_a, b.room_b, {middle.x(), middle.y(), plan.rooms[b.room_a.index()].floor_z_m}, {along.y(), -along.x()}, 0);
    }
  }

  [[nodiscard]] std::vector<WalkStop> From(const AGraph& plan, const Eigen::Vector3d& start, double max_m, size_t max_stops) const {
    using Step = std::tuple<double, size_t, int>;  // distance, entry, stop before
    std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
    const auto push = [&](size_t entry, const Eigen::Vector3d& at, double distance_m, int before) {
      const double total_m = distance_m + (entries_[entry].position_m - at).head<2>().norm();
      if (total_m <= max_m) open.emplace(total_m, entry, before);
    };
    const RoomId room = RoomAt(plan, start);
    for (size_t i = 0; i < entries_.size(); ++i) {
      if ((room.valid() && entries_[i].from == room) || (!room.valid() && IsAt(entries_[i], start))) push(i, start, 0, -1);
    }
    std::vector<bool> taken(entries_.size());
    std::vector<WalkStop> stops;
    while (!open.empty() && stops.size() < max_stops) {
      const auto [distance_m, i, before] = open.top();
      open.pop();
      if (taken[i]) continue;
      taken[i] = true;
      const Entry& entry = entries_[i];
      const int stop = static_cast<int>(stops.size());
      stops.push_back({entry.to, entry.position_m, distance_m, before});
      for (size_t next : entries_from_[entry.to.index()]) {
        if (!taken[next] && entries_[next].opening != entry.opening) push(next, entry.position_m, distance_m, stop);
      }
    }
    return stops;
  }

 private:
  // `passage`: unit vector from a to b.
  void Add(RoomId a, RoomId b, const Eigen::Vector3d& middle, const Eigen::Vector2d& passage, double half_wall_m) {
    if (!a.valid() || !b.valid()) return;
    const Eigen::Vector3d step = (half_wall_m + kInside_m) * Eigen::Vector3d(passage.x(), passage.y(), 0);
    for (const bool back : {false, true}) {
      entries_from_[(back ? b : a).index()].push_back(entries_.size());
      entries_.push_back(
          {back ? b : a, back ? a : b, num_openings_, back ? Eigen::Vector3d(middle - step) : Eigen::Vector3d(middle + step)});
    }
    ++num_openings_;
  }

  static bool IsAt(const Entry& entry, const Eigen::Vector3d& p) {
    constexpr double kBelow_m = 0.3, kAbove_m = 2.5;
    const Eigen::Vector3d v = p - entry.position_m;
    return v.z() > -kBelow_m && v.z() < kAbove_m && v.head<2>().norm() < kInDoorway_m;
  }

  std::vector<Entry> entries_;
  std::vector<std::vector<size_t>> entries_from_;  // per room
  size_t num_openings_ = 0;
};

}  // namespace

std::vector<WalkStop> WalksFrom(const AGraph& plan, const Eigen::Vector3d& start, double max_m, size_t max_stops) {
  return Walks(plan).From(plan, start, max_m, max_stops);
}

}  // namespace plumb::runtime
