#include "tools/simulate/doorway_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/simulate/box.h"
#include "tools/simulate/random.h"

namespace plumb::tools {
namespace {

constexpr double kMinWidth_m = 0.7;
constexpr double kJamb_m = 0.10;      // of wall that stays beside an opening
constexpr double kBeside_m = 0.02;    // the cut reaches this much beyond the farther of the planned and the built jamb
constexpr double kMostChange = 0.35;   // of the planned width, narrower or wider
constexpr int kDraws = 12;

// The frame of a doorway: u along the wall from the doorway's middle, w across it, z.
struct DoorwayFrame {
  Eigen::Vector2d middle, along, across;

  explicit DoorwayFrame(const Doorway& d)
      : middle(d.position.head<2>()), along(-std::sin(d.yaw_rad), std::cos(d.yaw_rad)), across(std::cos(d.yaw_rad), std::sin(d.yaw_rad)) {}

  [[nodiscard]] Eigen::Vector3d Local(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d v = p.head<2>() - middle;
    return {along.dot(v), across.dot(v), p.z()};
  }
  [[nodiscard]] Eigen::Vector3d Plan(const Eigen::Vector3d& local) const {
    const Eigen::Vector2d p = middle + local.x() * along + local.y() * across;
    return {p.x(), p.y(), local.z()};
  }
};

using Polygon = std::vector<Eigen::Vector3d>;

// Splits a convex polygon at `axis` = `at`.
std::pair<Polygon, Polygon> Split(const Polygon& polygon, int axis, double at) {
  Polygon below, above;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a[axis] <= at) below.push_back(a);
    if (a[axis] >= at) above.push_back(a);
    if ((a[axis] < at) == (b[axis] < at) || a[axis] == at || b[axis] == at) continue;
    const Eigen::Vector3d cut = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
    below.push_back(cut);
    above.push_back(cut);
  }
  return {below, above};
}

// Takes the wall's triangles out of u0..u1, z0..z1, and says how far they reached across it.
class WallCutter {
 public:
  WallCutter(AGraph& house, const DoorwayFrame& frame, double u0, double u1, double z0, double z1)
      : house_(house), frame_(frame), bounds_{{{0, u0, u1}, {2, z0, z1}}} {}

  // Element of the wall's body within the zone; none if it has nothing there.
  std::optional<uint32_t> Run(WallId wall) {
    std::vector<Triangle> kept;
    const std::vector<Triangle> triangles = std::move(house_.mesh.triangles);
    std::optional<uint32_t> cut;
    for (const Triangle& t : triangles) {
      const Element& e = house_.elements[t.element];
      if (e.wall != wall || !IsWallBody(e) || e.doorway.valid() || !Clip(t, kept)) {
        kept.push_back(t);
      } else if (!cut) {
        cut = t.element;
      }
    }
    house_.mesh.triangles = std::move(kept);
    return cut;
  }

  [[nodiscard]] const Eigen::AlignedBox1d& across() const { return across_; }

 private:
  struct Bound {
    int axis;
    double low, high;
  };

  [[nodiscard]] Eigen::Vector3d At(uint32_t vertex) const {
    return frame_.Local(house_.mesh.vertices[vertex].cast<double>() + house_.origin);
  }

  void Emit(const Polygon& polygon, uint32_t element, std::vector<Triangle>& out) {
    if (polygon.size() < 3) return;
    const auto base = static_cast<uint32_t>(house_.mesh.vertices.size());
    for (const Eigen::Vector3d& p : polygon) house_.mesh.vertices.push_back((frame_.Plan(p) - house_.origin).cast<float>());
    for (uint32_t i = 2; i < polygon.size(); ++i) out.push_back({base, base + i - 1, base + i, element});
  }

  // Emits what lies outside the zone. False: all of it does, and nothing was emitted.
  bool Clip(const Triangle& t, std::vector<Triangle>& out) {
    Polygon rest = {At(t.a), At(t.b), At(t.c)};
    for (const Bound& b : bounds_) {
      double low = rest[0][b.axis], high = low;
      for (const Eigen::Vector3d& p : rest) {
        low = std::min(low, p[b.axis]);
        high = std::max(high, p[b.axis]);
      }
      if (high <= b.low || low >= b.high) return false;
    }
    std::vector<Polygon> outside;
    for (const Bound& b : bounds_) {
      auto [below, inside] = Split(rest, b.axis, b.low);
      auto [middle, above] = Split(inside, b.axis, b.high);
      outside.push_back(std::move(below));
      outside.push_back(std::move(above));
      rest = std::move(middle);
      if (rest.size() < 3) return false;
    }
    for (const Polygon& polygon : outside) Emit(polygon, t.element, out);
    for (const Eigen::Vector3d& p : rest) across_.extend(Eigen::Matrix<double, 1, 1>(p.y()));
    return true;
  }

  AGraph& house_;
  const DoorwayFrame& frame_;
  const std::array<Bound, 2> bounds_;
  Eigen::AlignedBox1d across_;
};

// The door's frame goes with the jambs: each half with its own.
void MoveFrame(const DoorwayChange& change, const DoorwayFrame& frame, AGraph& house) {
  Mesh& mesh = house.mesh;
  const double left_m = change.shift_m - 0.5 * change.width_deviation_m, right_m = change.shift_m + 0.5 * change.width_deviation_m;
  for (Triangle& t : mesh.triangles) {
    if (house.elements[t.element].doorway != change.doorway) continue;
    for (uint32_t* v : {&t.a, &t.b, &t.c}) {
      Eigen::Vector3d p = frame.Local(mesh.vertices[*v].cast<double>() + house.origin);
      p.x() += p.x() < 0 ? left_m : right_m;
      *v = static_cast<uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back((frame.Plan(p) - house.origin).cast<float>());
    }
  }
}

double Reach_m(const DoorwayChange& change) {
  return std::abs(change.shift_m) + 0.5 * std::abs(change.width_deviation_m) + kBeside_m;
}

// Is there nothing but plain wall where the doorway is cut?
bool HasPlainWall(const AGraph& house, const std::vector<WallBody>& bodies, const DoorwayChange& change) {
  const Doorway& d = house.doorways[change.doorway.index()];
  const DoorwayFrame frame(d);
  const WallBody& body = bodies[d.wall.index()];
  const Rectangle zone{frame.middle, frame.along, 0.5 * d.width_m + Reach_m(change) + kJamb_m, body.footprint.half_width_m};
  const auto same_height = [&](double z_min_m, double z_max_m) {
    return z_min_m < d.position.z() + d.height_m && z_max_m > d.position.z();
  };
  const double end_m = std::abs(body.footprint.along.dot(frame.middle - body.footprint.center)) + zone.half_length_m;
  if (end_m > body.footprint.half_length_m) return false;
  for (size_t w = 0; w < bodies.size(); ++w) {
    if (w != d.wall.index() && same_height(bodies[w].z_min_m, bodies[w].z_max_m) && Overlap(zone.Grown(0, 0.01), bodies[w].footprint)) return false;
  }
  const auto meets = [&](const Eigen::Vector3d& at, double width_m, double height_m) {
    return same_height(at.z(), at.z() + height_m) && std::abs(frame.along.dot(at.head<2>() - frame.middle)) < zone.half_length_m + 0.5 * width_m;
  };
  for (size_t i = 0; i < house.doorways.size(); ++i) {
    const Doorway& other = house.doorways[i];
    if (i != change.doorway.index() && other.wall == d.wall && meets(other.position, other.width_m, other.height_m)) return false;
  }
  return std::none_of(house.windows.begin(), house.windows.end(),
                      [&](const Window& w) { return w.wall == d.wall && meets(w.position, w.width_m, w.height_m); });
}

std::vector<DoorwayId> InnerDoorways(const AGraph& house, StoreyId storey, const std::vector<WallBody>& bodies) {
  std::vector<DoorwayId> out;
  for (size_t i = 0; i < house.doorways.size(); ++i) {
    const Doorway& d = house.doorways[i];
    if (!d.room_a.valid() || !d.room_b.valid() || !d.wall.valid() || house.rooms[d.room_a.index()].storey != storey) continue;
    if (!bodies[d.wall.index()].curved) out.emplace_back(i);
  }
  return out;
}

// Shifted, of another width, or both, by up to `largest_m` each.
DoorwayChange Draw(DoorwayId id, const Doorway& d, double largest_m, const SimulateOptions& options, Random& random) {
  const size_t kind = random.Index(3);
  const double shift_m = random.Sign() * random.Uniform(options.min_doorway_m, largest_m);
  const double most_m = std::min(largest_m, kMostChange * d.width_m);
  const double width_m = random.Sign() * random.Uniform(std::min(options.min_doorway_m, most_m), most_m);
  return {id, kind == 1 ? 0 : shift_m, kind == 0 ? 0 : width_m};
}

}  // namespace

void CutDoorway(const DoorwayChange& change, double reach_m, AGraph& house) {
  const Doorway d = house.doorways[change.doorway.index()];
  const DoorwayFrame frame(d);
  const double planned_m = 0.5 * d.width_m, zone_m = planned_m + reach_m, z0 = d.position.z(), z1 = z0 + d.height_m;
  WallCutter cutter(house, frame, -zone_m, zone_m, z0, z1);
  const std::optional<uint32_t> element = cutter.Run(d.wall);
  if (!element) return;
  const double w0 = cutter.across().min()(0), w1 = cutter.across().max()(0);
  const auto build = [&](double u0, double u1, double low, double high) {
    const Eigen::Vector3d middle = frame.Plan({0.5 * (u0 + u1), 0.5 * (w0 + w1), 0});
    AddBox(house, {{middle.head<2>(), frame.along, 0.5 * (u1 - u0), 0.5 * (w1 - w0)}, low, high}, *element);
  };
  build(-zone_m, -planned_m + change.shift_m - 0.5 * change.width_deviation_m, z0, z1);
  build(planned_m + change.shift_m + 0.5 * change.width_deviation_m, zone_m, z0, z1);
  constexpr double kLid_m = 1e-3;  // closes the lintel and what is below where the wall was cut open
  build(-zone_m, zone_m, z1, z1 + kLid_m);
  build(-zone_m, zone_m, z0 - kLid_m, z0);
  MoveFrame(change, frame, house);
}

Expected<std::vector<DoorwayChange>> ChangeDoorways(StoreyId storey, const SimulateOptions& options, const std::vector<WallBody>& bodies,
                                                    AGraph& house, std::vector<Doorway>& doorways) {
  std::vector<DoorwayChange> changes;
  if (options.doorways == 0 && options.doorways_ratio == 0) return changes;
  Random random(options.seed, static_cast<uint64_t>(RandomStream::kDoorways));
  std::vector<DoorwayId> candidates = InnerDoorways(house, storey, bodies);
  random.Shuffle(candidates);
  const bool by_share = options.doorways_ratio > 0;
  const auto wanted =
      static_cast<size_t>(by_share ? std::ceil(options.doorways_ratio * static_cast<double>(candidates.size())) : options.doorways);
  for (const DoorwayId id : candidates) {
    if (changes.size() == wanted) break;
    const Doorway& d = house.doorways[id.index()];
    for (int i = 0; i < kDraws; ++i) {
      // Less and less, as there may be little plain wall.
      const double largest_m = options.max_doorway_m - (options.max_doorway_m - options.min_doorway_m) * i / kDraws;
      const DoorwayChange change = Draw(id, d, largest_m, options, random);
      const bool tight = change.width_deviation_m < 0 && d.width_m + change.width_deviation_m < kMinWidth_m;
      if (tight || !HasPlainWall(house, bodies, change)) continue;
      changes.push_back(change);
      break;
    }
  }
  if (!by_share && changes.size() < wanted) {
    return Fail(ErrorCode::kPlanUnsuitable, fmt::format("only {} of {} doorways can be elsewhere: {} lie between rooms, the others have no "
                                                        "plain wall beside them", changes.size(), wanted, candidates.size()));
  }
  std::sort(changes.begin(), changes.end(), [](const DoorwayChange& a, const DoorwayChange& b) { return a.doorway < b.doorway; });
  for (const DoorwayChange& change : changes) {
    CutDoorway(change, Reach_m(change), house);
    Doorway& built = doorways[change.doorway.index()];
    built.position.head<2>() += change.shift_m * DoorwayFrame(built).along;
    built.width_m += change.width_deviation_m;
  }
  return changes;
}

}  // namespace plumb::tools
