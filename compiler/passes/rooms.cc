#include "compiler/passes/rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/divide_rooms.h"
#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/vertical_probe.h"

namespace plumb::compiler {
namespace {

constexpr double kProbeClearance_m = 0.05;  // probes keep off walls: skirtings, wall edges of slabs
constexpr double kFloorSearch_m = 1.0;      // a floor further below its level than this belongs to another one (a void)
constexpr double kCornerReach_m = 0.02;     // from the corner of an opening to the border of the room it leads to
constexpr double kDoorReach_m = 0.6;        // from the middle of a door to the room behind its wall
constexpr double kHeadroom_m = 0.3;         // ceilings are looked for from here above the floor
constexpr double kBeforeDoor_m = 0.3;       // from the border of a room to where one stands before a door

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double Perimeter(const std::vector<Ring>& rings) {
  double out = 0;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) out += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  }
  return out;
}

// Direction of the longest side, in [0, pi/2).
double YawOf(const Ring& ring) {
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d side = ring[(i + 1) % ring.size()] - ring[i];
    if (side.norm() > longest.norm() + 1e-6) longest = side;
  }
  constexpr double kQuarter = std::numbers::pi / 2;
  const double yaw = std::fmod(std::atan2(longest.y(), longest.x()) + 4 * kQuarter, kQuarter);
  return kQuarter - yaw < 1e-9 ? 0.0 : yaw;
}

// Points of a lattice along the room's longest side that lie inside, at least one.
std::vector<Eigen::Vector2d> ProbePoints(const std::vector<Ring>& rings, double yaw_rad) {
  const Eigen::Vector2d u(std::cos(yaw_rad), std::sin(yaw_rad)), v = Rot90Ccw(u);
  Eigen::AlignedBox2d box;
  for (const auto& p : rings[0]) box.extend(Eigen::Vector2d(u.dot(p), v.dot(p)));
  std::vector<Eigen::Vector2d> out;
  for (int n = 5; n <= 45 && out.empty(); n *= 3) {
    for (int i = 0; i < n * n; ++i) {
      const Eigen::Vector2d f((i % n + 0.5) / n, (i / n + 0.5) / n);
      const Eigen::Vector2d q = box.min() + f.cwiseProduct(box.sizes());
      const Eigen::Vector2d p = q.x() * u + q.y() * v;
      if (WindingNumber(rings, p) != 0 && DistanceToRings(p, rings) > kProbeClearance_m) out.push_back(p);
    }
  }
  if (out.empty()) out.push_back(Centroid(rings));
  return out;
}

class RoomFinder {
 public:
  RoomFinder(const PlanIr& plan, const FloorIr& floors, const RoomOptions& options, AGraph& graph, DiagnosticSink& sink)
      : plan_(plan),
        floors_(floors),
        options_(options),
        graph_(graph),
        sink_(sink),
        below_(plan, {ElementKind::kSlab, ElementKind::kRoof, ElementKind::kCovering, ElementKind::kGround}),
        standing_(plan, {ElementKind::kSlab, ElementKind::kRoof, ElementKind::kGround, ElementKind::kStair}),
        above_(plan, {ElementKind::kSlab, ElementKind::kRoof, ElementKind::kCovering}),
        stairs_(plan, {ElementKind::kStair}),
        has_walls_(graph.storeys.size(), false) {
    for (const PlanWall& wall : floors.walls) {
      if (wall.storey < has_walls_.size()) has_walls_[wall.storey] = true;
    }
    for (const PlanElement& e : plan.elements) {
      if (e.kind == ElementKind::kDoor && !e.body.empty()) door_boxes_.push_back(Bounds(e.body));
    }
    doors_ = BoxTree<3>(door_boxes_);
    std::vector<Eigen::AlignedBox3d> openings;
    for (const PlanOpening& o : plan.openings) openings.push_back(Bounds(o.body));
    openings_ = BoxTree<3>(std::move(openings));
  }

  RoomsByFace Run() {
    RoomsByFace out;
    for (const Floor& floor : floors_.floors) {
      out.emplace_back(floor.faces.size());
      std::vector<Candidate> candidates;
      for (uint32_t f = 1; f < floor.faces.size(); ++f) {
        if (std::optional<Candidate> c = Consider(floor, f)) candidates.push_back(std::move(*c));
      }
      // A plan may draw no slabs at all: then rooms do without.
      const bool has_slabs = std::any_of(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.floor_share >= 0.5; });
      for (Candidate& c : candidates) {
        if (has_slabs && IsVoid(floor.level, c))
          ReportVoid(floor.level, c);
        else
          out.back()[c.face] = AddRoom(floor.level, c);
      }
    }
    return out;
  }

 private:
  // A face that is large enough for a room.
  struct Candidate {
    uint32_t face = kNoIndex;
    std::vector<Ring> rings;
    double yaw_rad = 0;
    std::vector<Eigen::Vector2d> probes;
    double floor_share = 0, deep_share = 0;  // of the probes: a floor of this level below, one of a level further down
  };

  std::optional<Candidate> Consider(const Floor& floor, uint32_t f) const {
    const FloorFace& face = floor.faces[f];
    if (!face.cover.empty() || face.area_m2 < std::min(options_.min_closet_area_m2, options_.min_area_m2)) return std::nullopt;
    Candidate out;
    out.face = f;
    for (const Ring& ring : FaceRings(floor, face)) {
      Ring simple = Simplified(ring, options_.collinear_m);
      if (simple.size() >= 3)
        out.rings.push_back(std::move(simple));
      else if (out.rings.empty())
        return std::nullopt;
    }
    if (2 * face.area_m2 / Perimeter(out.rings) < options_.min_width_m || IsShaft(floor, face.area_m2, out.rings)) return std::nullopt;
    out.yaw_rad = YawOf(out.rings[0]);
    out.probes = ProbePoints(out.rings, out.yaw_rad);
    for (const auto& p : out.probes) {
      const std::optional<double> z = standing_.Below(p, floor.level.section_z_m);
      if (!z) continue;
      (IsOfLevel(floor.level, *z) ? out.floor_share : out.deep_share) += 1.0 / static_cast<double>(out.probes.size());
    }
    return out;
  }

  // Small, and nothing says that anybody enters it.
  bool IsShaft(const Floor& floor, double area_m2, const std::vector<Ring>& rings) const {
    if (area_m2 > options_.max_shaft_area_m2) return false;
    bool opens = false;
    openings_.ForEachIn(Around(rings, kCornerReach_m, floor.level), [&](uint32_t o) { opens |= LeadsTo(plan_.openings[o].body, rings); });
    if (area_m2 < options_.min_area_m2 || opens) return !opens;
    if (HasDoor(floor.level, rings)) return false;
    const Eigen::Vector2d middle = Centroid(rings);
    return std::none_of(plan_.spaces.begin(), plan_.spaces.end(), [&](const PlanSpace& space) {
      return Bounds(space.body).exteriorDistance(Eigen::Vector3d(middle.x(), middle.y(), floor.level.section_z_m)) == 0 &&
             WindingNumber(SpaceOutline(space, floor), middle) != 0;
    });
  }

  // From where the level's floors may lie to the height of the section.
  static Eigen::AlignedBox3d Around(const std::vector<Ring>& rings, double reach_m, const Level& level) {
    Eigen::AlignedBox3d out;
    for (const auto& p : rings[0]) {
      out.extend(Eigen::Vector3d(p.x(), p.y(), level.section_z_m));
      out.extend(Eigen::Vector3d(p.x(), p.y(), level.base_z_m - kFloorSearch_m));
    }
    out.min().head<2>().array() -= reach_m;
    out.max().head<2>().array() += reach_m;
    return out;
  }

  // An opening leads to where it has a side on the border or within: two of its corners.
  static bool LeadsTo(const Solid& body, const std::vector<Ring>& rings) {
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector3d& v : body.vertices) {
      const Eigen::Vector2d p = v.head<2>();
      const bool known = std::any_of(corners.begin(), corners.end(), [&](const auto& c) { return (c - p).norm() < kCornerReach_m; });
      if (!known && (WindingNumber(rings, p) != 0 || DistanceToRings(p, rings) <= kCornerReach_m)) corners.push_back(p);
    }
    return corners.size() >= 2;
  }

  static bool IsOfLevel(const Level& level, double floor_z_m) { return floor_z_m >= level.base_z_m - kFloorSearch_m; }

  // Nothing to stand on but the floor of a room further down, and no door leads here: the upper part of that room.
  bool IsVoid(const Level& level, const Candidate& c) const {
    return c.floor_share < options_.min_floor_share && c.deep_share >= 0.5 && !HasDoor(level, c.rings);
  }

  bool HasDoor(const Level& level, const std::vector<Ring>& rings) const { return !DoorsOf(level, rings).empty(); }

  // Middles of the level's doors in the room and on its border.
  std::vector<Eigen::Vector2d> DoorsOf(const Level& level, const std::vector<Ring>& rings) const {
    std::vector<Eigen::Vector2d> out;
    doors_.ForEachIn(Around(rings, kDoorReach_m, level), [&](uint32_t d) {
      const Eigen::AlignedBox3d& box = door_boxes_[d];
      const Eigen::Vector2d at = box.center().head<2>();
      if (!IsOfLevel(level, box.min().z())) return;
      if (WindingNumber(rings, at) != 0 || DistanceToRings(at, rings) <= kDoorReach_m) out.push_back(at);
    });
    return out;
  }

  // Where one stands before each of the room's doors: from the side of the room next to it straight inwards.
  std::vector<Eigen::Vector2d> PlacesBeforeDoors(const Level& level, const std::vector<Ring>& rings) const {
    std::vector<Eigen::Vector2d> out;
    for (const Eigen::Vector2d& door : DoorsOf(level, rings)) {
      double least_m = std::numeric_limits<double>::infinity();
      Eigen::Vector2d place = door;
      for (const Ring& ring : rings) {
        for (size_t i = 0; i < ring.size(); ++i) {
          const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
          const Eigen::Vector2d foot = NearestOnSegment(door, a, b);
          const double distance_m = (door - foot).norm();
          if (distance_m >= least_m) continue;
          least_m = distance_m;
          place = foot + kBeforeDoor_m * Rot90Ccw((b - a).normalized());
        }
      }
      out.push_back(place);
    }
    return out;
  }

  void ReportVoid(const Level& level, const Candidate& c) {
    const Eigen::Vector2d at = Centroid(c.rings);
    sink_.Emit(DiagnosticKind::kVoidOverRoom, {},
               fmt::format("the space around ({:.2f}, {:.2f}) on `{}` has no floor and no door; it is the upper part of what is below it",
                           at.x() + plan_.origin.x(), at.y() + plan_.origin.y(), graph_.storeys[level.first_storey].name));
  }

  RoomId AddRoom(const Level& level, const Candidate& c) {
    Room room;
    room.polygon = c.rings[0];
    room.holes.assign(c.rings.begin() + 1, c.rings.end());
    for (const Ring& ring : c.rings) room.area_m2 += SignedArea(ring);
    room.yaw_rad = c.yaw_rad;
    if (!SetHeights(level, c, room)) return {};
    room.center << Centroid(c.rings), room.floor_z_m;
    graph_.rooms.push_back(std::move(room));
    return RoomId(graph_.rooms.size() - 1);
  }

  // The middle height of the level's floor at these places; none where most show no floor.
  std::optional<double> FloorAt(const Level& level, const std::vector<Eigen::Vector2d>& places) const {
    std::vector<double> hits;
    for (const auto& p : places) {
      const std::optional<double> z = below_.Below(p, level.section_z_m);
      if (z && IsOfLevel(level, *z)) hits.push_back(*z);
    }
    if (hits.empty() || 2 * hits.size() < places.size()) return std::nullopt;
    return Median(std::move(hits));
  }

  // Stairs overhead count where a person can stand below them: on the floor or on the flight below.
  std::optional<double> CeilingAt(const Eigen::Vector2d& p, double floor_z_m) const {
    const std::optional<double> ceiling = above_.Above(p, floor_z_m + kHeadroom_m);
    double below_z_m = floor_z_m;
    while (const std::optional<double> stairs = stairs_.Above(p, below_z_m + kHeadroom_m)) {
      if (ceiling && *stairs >= *ceiling) break;
      if (*stairs >= below_z_m + options_.min_clear_height_m) return stairs;
      below_z_m = *stairs;
    }
    return ceiling;
  }

  // False if a person cannot stand in it.
  bool SetHeights(const Level& level, const Candidate& c, Room& room) {
    const std::vector<Eigen::Vector2d>& probes = c.probes;
    std::optional<double> floor_z_m = FloorAt(level, probes);
    if (!floor_z_m) floor_z_m = FloorAt(level, PlacesBeforeDoors(level, c.rings));  // most of a stair hall is open to below
    room.floor_z_m = floor_z_m.value_or(graph_.storeys[level.first_storey].elevation_m);
    room.storey = StoreyAt(level, room.floor_z_m);
    std::vector<double> ceiling_hits;
    for (const auto& p : probes) {
      if (const std::optional<double> z = CeilingAt(p, room.floor_z_m)) ceiling_hits.push_back(*z);
    }
    const bool has_ceiling = 2 * ceiling_hits.size() >= probes.size();
    room.ceiling_z_m = has_ceiling ? Median(ceiling_hits) : std::max(level.top_z_m, room.floor_z_m + kHeadroom_m);
    const double clear = (has_ceiling ? *std::max_element(ceiling_hits.begin(), ceiling_hits.end()) : room.ceiling_z_m) - room.floor_z_m;
    if (clear >= options_.min_clear_height_m) return true;
    sink_.Emit(DiagnosticKind::kRoomTooLow, {},
               fmt::format("the space of {:.1f} m2 around ({:.2f}, {:.2f}) on `{}` is {:.2f} m high; rooms have at least {:.2f} m",
                           room.area_m2, Centroid(c.rings).x() + plan_.origin.x(), Centroid(c.rings).y() + plan_.origin.y(),
                           graph_.storeys[room.storey.index()].name, clear, options_.min_clear_height_m));
    return false;
  }

  // Of the level's storeys with walls (all, if none has any: some files have a roof or a site as a storey at zero) the one whose zero is
  // nearest to the floor; the lower one on a tie.
  StoreyId StoreyAt(const Level& level, double floor_z_m) const {
    const auto rank = [&](uint32_t s) { return std::pair(!has_walls_[s], std::abs(graph_.storeys[s].elevation_m - floor_z_m)); };
    uint32_t best = level.first_storey;
    for (uint32_t s = level.first_storey; s <= level.last_storey; ++s) {
      if (rank(s) < rank(best)) best = s;
    }
    return StoreyId(best);
  }

  const PlanIr& plan_;
  const FloorIr& floors_;
  const RoomOptions& options_;
  AGraph& graph_;
  DiagnosticSink& sink_;
  VerticalProbe below_, standing_, above_, stairs_;
  std::vector<bool> has_walls_;  // by storey
  std::vector<Eigen::AlignedBox3d> door_boxes_;
  BoxTree<3> doors_, openings_;
};

}  // namespace

std::string RoomOptions::Check() const {
  if (!(min_area_m2 >= 0)) return fmt::format("RoomOptions.min_area_m2 = {}; must not be negative", min_area_m2);
  if (!(min_closet_area_m2 >= 0)) return fmt::format("RoomOptions.min_closet_area_m2 = {}; must not be negative", min_closet_area_m2);
  if (!(max_shaft_area_m2 >= 0)) return fmt::format("RoomOptions.max_shaft_area_m2 = {}; must not be negative", max_shaft_area_m2);
  if (!(min_width_m >= 0)) return fmt::format("RoomOptions.min_width_m = {}; must not be negative", min_width_m);
  if (!(min_clear_height_m >= 0)) return fmt::format("RoomOptions.min_clear_height_m = {}; must not be negative", min_clear_height_m);
  if (!(min_floor_share >= 0 && min_floor_share <= 0.5))
    return fmt::format("RoomOptions.min_floor_share = {}; must be in [0, 0.5]", min_floor_share);
  if (!(collinear_m > 0)) return fmt::format("RoomOptions.collinear_m = {}; must be positive", collinear_m);
  return {};
}

RoomsByFace FindRooms(const PlanIr& plan, const FloorIr& floors, const RoomOptions& options, AGraph& graph, DiagnosticSink& sink) {
  return RoomFinder(plan, floors, options, graph, sink).Run();
}

}  // namespace plumb::compiler
