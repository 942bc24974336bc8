#include "tools/simulate/wall_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/simulate/box.h"
#include "tools/simulate/random.h"

namespace plumb::tools {
namespace {

constexpr double kMinWall_m = 1.5;
constexpr double kFacing_cos = 0.9;     // a face, not an end
constexpr double kClear_m = 0.7;        // beside and beyond an added wall: a robot gets past
constexpr double kDoorClear_m = 0.3;
constexpr double kStart_m = 0.15;       // of an added wall, where it leaves the wall that it starts at
constexpr int kTriesPerWall = 200;

// Straight walls with a face of at least kMinWall_m towards a room of the storey on either side.
std::vector<size_t> WallsBetweenRooms(const AGraph& plan, StoreyId storey) {
  const std::vector<WallBody> bodies = FindWallBodies(plan);
  std::vector<bool> left(plan.walls.size(), false), right(plan.walls.size(), false);
  for (const Surface& s : plan.surfaces) {
    if (!s.wall.valid() || !s.room.valid() || plan.rooms[s.room.index()].storey != storey || s.length_m() < kMinWall_m) continue;
    const double across = bodies[s.wall.index()].footprint.across().dot(s.normal.head<2>());
    left[s.wall.index()] = left[s.wall.index()] || across > kFacing_cos;
    right[s.wall.index()] = right[s.wall.index()] || across < -kFacing_cos;
  }
  std::vector<size_t> walls;
  for (size_t w = 0; w < bodies.size(); ++w) {
    if (left[w] && right[w] && !bodies[w].curved) walls.push_back(w);
  }
  return walls;
}

// An added wall: from a point of a surface, into its room.
struct Draw {
  Rectangle footprint;
  double z_min_m = 0, z_max_m = 0;
};

std::optional<Draw> DrawWall(const AGraph& plan, StoreyId storey, const AsBuilt& built, Random& random) {
  const Surface& s = plan.surfaces[random.Index(plan.surfaces.size())];
  const double along = random.Uniform(0.25, 0.75), length_m = random.Uniform(1.2, 2.5), thickness_m = random.Uniform(0.1, 0.2);
  if (!s.room.valid() || s.arc || !s.wall.valid() || plan.rooms[s.room.index()].storey != storey) return std::nullopt;
  if (std::find(built.missing.begin(), built.missing.end(), s.wall) != built.missing.end()) return std::nullopt;
  const Room& room = plan.rooms[s.room.index()];
  const Eigen::Vector2d n = s.normal.head<2>().normalized();
  // It reaches into the wall that it starts at, wherever that stands.
  const Eigen::Vector2d start = built.motions[s.wall.index()] * (s.start + along * (s.end - s.start)) - 0.05 * n;
  return Draw{{start + 0.5 * length_m * n, n, 0.5 * length_m, 0.5 * thickness_m}, room.floor_z_m, room.ceiling_z_m};
}

// Is there nothing else where it would stand, and a way past?
bool HasSpace(const Draw& wall, const FreeSpace& space, const AsBuilt& built) {
  const auto meets = [](const Rectangle& a, const Rectangle& b) { return Overlap(a, b); };
  const Rectangle kept_free = wall.footprint.Grown(kDoorClear_m, kDoorClear_m);
  for (const Rectangle& passage : built.passages) {
    if (meets(kept_free, passage)) return false;
  }
  for (const AddedWall& other : built.unplanned) {
    if (meets(wall.footprint.Grown(kClear_m, kClear_m), other.footprint)) return false;
  }
  const Rectangle& r = wall.footprint;
  const Eigen::Vector2d start = r.center - r.half_length_m * r.along;
  const int16_t room = space.room(space.Index(space.CellAt(r.center)));
  if (room < 0) return false;
  for (double u = kStart_m; u <= 2 * r.half_length_m + kClear_m; u += kCell_m) {
    for (double v = -r.half_width_m - kClear_m; v <= r.half_width_m + kClear_m; v += kCell_m) {
      const size_t cell = space.Index(space.CellAt(start + u * r.along + v * r.across()));
      if (space.room(cell) != room || space.clearance_m(cell) <= 0) return false;
    }
  }
  return true;
}

}  // namespace

Expected<void> LeaveOutWalls(const AGraph& plan, StoreyId storey, int count, uint64_t seed, AsBuilt& built) {
  if (count == 0) return {};
  Random random(seed, static_cast<uint64_t>(RandomStream::kMissing));
  std::vector<size_t> walls = WallsBetweenRooms(plan, storey);
  std::erase_if(walls, [&](size_t w) { return !built.motions[w].matrix().isIdentity(0); });
  if (walls.size() < static_cast<size_t>(count)) {
    return Fail(ErrorCode::kPlanUnsuitable,
                fmt::format("only {} of {} walls can be left out: so many stand between rooms and as planned", walls.size(), count));
  }
  random.Shuffle(walls);
  walls.resize(static_cast<size_t>(count));
  std::sort(walls.begin(), walls.end());
  for (const size_t w : walls) built.missing.emplace_back(w);
  std::erase_if(built.house.mesh.triangles, [&](const Triangle& t) {
    const WallId wall = built.house.elements[t.element].wall;
    return wall.valid() && std::binary_search(walls.begin(), walls.end(), wall.index());
  });
  return {};
}

Expected<void> AddWalls(const AGraph& plan, StoreyId storey, int count, uint64_t seed, AsBuilt& built) {
  if (count == 0) return {};
  Random random(seed, static_cast<uint64_t>(RandomStream::kUnplanned));
  FreeSpace space(built.house, storey, built.passages);
  if (space.size() == 0) return Fail(ErrorCode::kPlanUnsuitable, "the storey has no rooms, or more than 400 m x 400 m of them");
  const Reach reach = FindReach(built.house, storey, space);
  for (int i = 0; i < count * kTriesPerWall && built.unplanned.size() < static_cast<size_t>(count); ++i) {
    const std::optional<Draw> wall = DrawWall(plan, storey, built, random);
    if (!wall || !HasSpace(*wall, space, built)) continue;
    FreeSpace with_wall = space;
    with_wall.Block(wall->footprint);
    if (ReachWithRadius(built.house, storey, with_wall, reach.robot_radius_m).reachable() < reach.reachable()) continue;
    space = std::move(with_wall);
    Element element;
    element.name = fmt::format("added wall {}", built.unplanned.size() + 1);
    element.kind = ElementKind::kWall;
    element.storey = storey;
    built.house.elements.push_back(element);
    const auto id = static_cast<uint32_t>(built.house.elements.size() - 1);
    AddBox(built.house, {wall->footprint, wall->z_min_m, wall->z_max_m}, id);
    built.unplanned.push_back({wall->footprint, wall->z_max_m - wall->z_min_m, id});
  }
  if (built.unplanned.size() < static_cast<size_t>(count)) {
    return Fail(ErrorCode::kPlanUnsuitable, fmt::format("only {} of {} unplanned walls found a place", built.unplanned.size(), count));
  }
  return {};
}

bool PassesThrough(const WallBody& body, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Rectangle& r = body.footprint;
  const double a = r.across().dot(from.head<2>() - r.center), b = r.across().dot(to.head<2>() - r.center);
  if (std::min(std::abs(a), std::abs(b)) < r.half_width_m || a * b >= 0) return false;
  const Eigen::Vector3d at = from + a / (a - b) * (to - from);
  return std::abs(r.along.dot(at.head<2>() - r.center)) < r.half_length_m && at.z() > body.z_min_m && at.z() < body.z_max_m;
}

}  // namespace plumb::tools
