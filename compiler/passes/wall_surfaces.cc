#include "compiler/passes/wall_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kAlongAxis = 0.1736;  // sin 10 deg: edges closer to the axis' direction are sides, others are ends

// Who owns an edge, and on which of the owner's arcs it lies.
struct Owner {
  uint32_t wall = kNoIndex;
  size_t arc = 0;  // 1-based; 0: straight
  friend bool operator==(const Owner&, const Owner&) = default;
};

struct Stretch {
  Owner owner;
  std::vector<Eigen::Vector2d> points;
};

double Wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

class SurfaceBuilder {
 public:
  SurfaceBuilder(const FloorIr& floors, const RoomsByFace& rooms, const SurfaceOptions& options, AGraph& graph)
      : floors_(floors), rooms_(rooms), options_(options), graph_(graph) {}

  void Run() {
    for (size_t f = 0; f < floors_.floors.size(); ++f) {
      const Floor& floor = floors_.floors[f];
      for (size_t i = 1; i < floor.faces.size(); ++i) {
        if (rooms_[f][i].valid()) AddBoundaries(floor, floor.faces[i], rooms_[f][i]);
      }
      AddBoundaries(floor, floor.faces[0], {});
    }
    MarkExternal();
  }

 private:
  void AddBoundaries(const Floor& floor, const FloorFace& face, RoomId room) {
    if (face.bounded()) AddRuns(floor, face.outer, room);
    for (const auto& hole : face.holes) AddRuns(floor, hole, room);
  }

  Eigen::Vector2d From(const Floor& floor, const BoundaryEdge& e) const { return floor.vertices[e.from]; }
  Eigen::Vector2d To(const Floor& floor, const BoundaryEdge& e) const { return floor.vertices[e.to]; }

  Owner OwnerOf(const Floor& floor, const BoundaryEdge& edge) const {
    const Eigen::Vector2d along = (To(floor, edge) - From(floor, edge)).normalized();
    const std::vector<uint32_t>& behind = floor.faces[edge.face].cover;
    uint32_t best = kNoIndex;
    bool best_is_side = false;
    for (uint32_t f : edge.footprints) {
      const uint32_t w = floor.footprints[f].wall;
      if (w == kNoIndex || (!behind.empty() && !std::binary_search(behind.begin(), behind.end(), f))) continue;
      const Wall& wall = graph_.walls[w];
      const bool curved = !ArcsOf(w).empty();
      const bool is_side = curved || std::abs(Cross(along, (wall.axis_end - wall.axis_start).normalized())) < kAlongAxis;
      if (best != kNoIndex) {
        const Wall& rival = graph_.walls[best];
        if (is_side != best_is_side                 ? !is_side
            : wall.thickness_m != rival.thickness_m ? wall.thickness_m < rival.thickness_m
                                                    : wall.guid >= rival.guid)
          continue;
      }
      best = w;
      best_is_side = is_side;
    }
    if (best == kNoIndex) return {};
    return {best, ArcOf(best, From(floor, edge), To(floor, edge))};
  }

  const std::vector<Arc>& ArcsOf(uint32_t wall) const { return floors_.walls[wall].arcs; }

  // The arc of the wall that both points lie on, counted from 1.
  size_t ArcOf(uint32_t wall, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const std::vector<Arc>& arcs = ArcsOf(wall);
    for (size_t i = 0; i < arcs.size(); ++i) {
      const auto off = [&](const Eigen::Vector2d& p) { return std::abs((p - arcs[i].center).norm() - arcs[i].radius_m); };
      // A chord has its ends on the circle as well.
      if (off(a) <= options_.arc_m && off(b) <= options_.arc_m && off(0.5 * (a + b)) <= options_.facet_m) return i + 1;
    }
    return 0;
  }

  bool Extends(const Stretch& run, const Owner& owner, const Eigen::Vector2d& to) const {
    if (!(run.owner == owner)) return false;
    if (owner.arc != 0) return true;
    const Eigen::Vector2d &first = run.points.front(), &last = run.points.back();
    if ((to - last).dot(last - first) <= 0) return false;
    return std::all_of(run.points.begin(), run.points.end(),
                       [&](const auto& p) { return DistanceToSegment(p, first, to) <= options_.collinear_m; });
  }

  void AddRuns(const Floor& floor, const std::vector<BoundaryEdge>& edges, RoomId room) {
    std::vector<Stretch> runs;
    for (const BoundaryEdge& edge : edges) {
      const Owner owner = OwnerOf(floor, edge);
      if (runs.empty() || !Extends(runs.back(), owner, To(floor, edge))) runs.push_back({owner, {From(floor, edge)}});
      runs.back().points.push_back(To(floor, edge));
    }
    // The boundary may begin in the middle of a run.
    if (runs.size() > 1 && runs.back().owner == runs.front().owner) {
      Stretch joined = runs.back();
      bool fits = true;
      for (size_t i = 1; i < runs.front().points.size() && fits; ++i) {
        fits = Extends(joined, runs.front().owner, runs.front().points[i]);
        joined.points.push_back(runs.front().points[i]);
      }
      if (fits) {
        runs.front() = std::move(joined);
        runs.pop_back();
      }
    }
    for (const Stretch& run : runs) {
      if (!FacesCrack(run, room)) AddSurface(floor, run, room);
    }
  }

  // Before a side in a crack, as linings that do not quite touch leave them, there is no space to see it from.
  bool FacesCrack(const Stretch& run, RoomId room) const {
    if (!room.valid() || run.owner.arc != 0) return false;
    const Eigen::Vector2d &from = run.points.front(), &to = run.points.back();
    const Eigen::Vector2d before = 0.5 * (from + to) + options_.crack_m * Rot90Ccw((to - from).normalized());
    const Room& r = graph_.rooms[room.index()];
    const auto inside = [&](const Ring& ring) { return WindingNumber(std::span(&ring, 1), before) != 0; };
    return !inside(r.polygon) || std::any_of(r.holes.begin(), r.holes.end(), inside);
  }

  void AddSurface(const Floor& floor, const Stretch& run, RoomId room) {
    const Eigen::Vector2d along = run.points.back() - run.points.front();
    if (run.owner.wall == kNoIndex) return;
    const bool closed_arc = run.owner.arc != 0 && along.norm() < options_.min_length_m && run.points.size() > 3;
    if (closed_arc) return AddHalves(floor, run, room);
    if (along.norm() < options_.min_length_m) return;
    const Wall& wall = graph_.walls[run.owner.wall];
    Surface s;
    s.wall = WallId(run.owner.wall);
    s.room = room;
    s.start = run.points.front();
    s.end = run.points.back();
    s.normal << Rot90Ccw(along.normalized()), 0;
    s.d_m = -s.normal.head<2>().dot(s.midpoint());
    if (run.owner.arc != 0) s.arc = ArcAlong(ArcsOf(run.owner.wall)[run.owner.arc - 1], run.points);
    if (room.valid()) {
      const Room& r = graph_.rooms[room.index()];
      s.storey = r.storey;
      s.z_min_m = std::max(wall.z_min_m, r.floor_z_m);
      s.z_max_m = std::min(wall.z_max_m, r.ceiling_z_m);
    } else {
      const bool lowest = &floor == &floors_.floors.front(), highest = &floor == &floors_.floors.back();
      s.storey = ExteriorStorey(floor.level, wall);
      s.z_min_m = lowest ? wall.z_min_m : std::max(wall.z_min_m, floor.level.base_z_m);
      s.z_max_m = highest ? wall.z_max_m : std::min(wall.z_max_m, floor.level.top_z_m);
    }
    // A knee wall may end below the middle of a sloping ceiling, a wall may stand on a step: never an empty band.
    if (s.z_max_m <= s.z_min_m) {
      s.z_min_m = wall.z_min_m;
      s.z_max_m = wall.z_max_m;
    }
    if (room.valid()) graph_.rooms[room.index()].surfaces.push_back(SurfaceId(graph_.surfaces.size()));
    graph_.surfaces.push_back(s);
  }

  // A full circle has no chord: two surfaces.
  void AddHalves(const Floor& floor, const Stretch& run, RoomId room) {
    const auto middle = run.points.begin() + static_cast<std::ptrdiff_t>(run.points.size() / 2);
    AddSurface(floor, {run.owner, {run.points.begin(), middle + 1}}, room);
    AddSurface(floor, {run.owner, {middle, run.points.end()}}, room);
  }

  static Arc ArcAlong(const Arc& source, const std::vector<Eigen::Vector2d>& points) {
    Arc out = source;
    const auto angle = [&](const Eigen::Vector2d& p) { return std::atan2(p.y() - source.center.y(), p.x() - source.center.x()); };
    out.start_rad = angle(points.front());
    out.sweep_rad = 0;
    for (size_t i = 1; i < points.size(); ++i) out.sweep_rad += Wrapped(angle(points[i]) - angle(points[i - 1]));
    return out;
  }

  StoreyId ExteriorStorey(const Level& level, const Wall& wall) const {
    return StoreyId(std::clamp(wall.storey.value, level.first_storey, level.last_storey));
  }

  void MarkExternal() {
    std::vector<double> outside(graph_.walls.size(), 0);
    std::vector<bool> seen(graph_.walls.size(), false);
    for (const Surface& s : graph_.surfaces) {
      seen[s.wall.index()] = true;
      if (!s.room.valid()) outside[s.wall.index()] += s.length_m();
    }
    for (size_t w = 0; w < graph_.walls.size(); ++w) {
      const Wall& wall = graph_.walls[w];
      // The end of a wall in a facade does not make it external.
      const double least = std::max(options_.min_external_m, 1.5 * wall.thickness_m);
      if (seen[w]) graph_.walls[w].external = outside[w] >= least;
    }
  }

  const FloorIr& floors_;
  const RoomsByFace& rooms_;
  const SurfaceOptions& options_;
  AGraph& graph_;
};

// Whether two surfaces are the two faces of `wall`, opposite each other.
bool Opposite(const Wall& wall, const Surface& a, const Surface& b) {
  constexpr double kAntiparallel = -0.9962, kMinOverlap_m = 0.1, kSlack_m = 0.1;
  if (a.storey != b.storey || a.normal.dot(b.normal) > kAntiparallel) return false;
  const double gap = a.normal.head<2>().dot(a.start - b.midpoint());
  if (gap <= 0 || gap > 2 * wall.thickness_m + kSlack_m) return false;
  const Eigen::Vector2d along = (a.end - a.start).normalized();
  const double overlap = std::min(a.length_m(), along.dot(b.start - a.start)) - std::max(0.0, along.dot(b.end - a.start));
  return overlap >= kMinOverlap_m;
}

}  // namespace

std::string SurfaceOptions::Check() const {
  if (!(collinear_m > 0)) return fmt::format("SurfaceOptions.collinear_m = {}; must be positive", collinear_m);
  if (!(arc_m > 0)) return fmt::format("SurfaceOptions.arc_m = {}; must be positive", arc_m);
  if (!(facet_m > 0)) return fmt::format("SurfaceOptions.facet_m = {}; must be positive", facet_m);
  if (!(min_length_m > 0)) return fmt::format("SurfaceOptions.min_length_m = {}; must be positive", min_length_m);
  if (!(crack_m > 0)) return fmt::format("SurfaceOptions.crack_m = {}; must be positive", crack_m);
  if (!(min_external_m > 0)) return fmt::format("SurfaceOptions.min_external_m = {}; must be positive", min_external_m);
  return {};
}

void AddSurfaces(const FloorIr& floors, const RoomsByFace& rooms, const SurfaceOptions& options, AGraph& graph) {
  SurfaceBuilder(floors, rooms, options, graph).Run();
}

void AddFactors(AGraph& graph) {
  std::vector<std::vector<uint32_t>> of_wall(graph.walls.size());
  for (uint32_t s = 0; s < graph.surfaces.size(); ++s) of_wall[graph.surfaces[s].wall.index()].push_back(s);
  for (uint32_t w = 0; w < graph.walls.size(); ++w) {
    for (size_t i = 0; i < of_wall[w].size(); ++i) {
      for (size_t j = i + 1; j < of_wall[w].size(); ++j) {
        const uint32_t a = of_wall[w][i], b = of_wall[w][j];
        if (Opposite(graph.walls[w], graph.surfaces[a], graph.surfaces[b])) graph.factors.push_back({FactorKind::kWallSurfaces, {w, a, b}});
      }
    }
  }
  for (uint32_t r = 0; r < graph.rooms.size(); ++r) {
    Factor factor{FactorKind::kRoomSurfaces, {r}};
    for (SurfaceId s : graph.rooms[r].surfaces) factor.variables.push_back(s.value);
    graph.factors.push_back(std::move(factor));
  }
  for (uint32_t d = 0; d < graph.doorways.size(); ++d) {
    const Doorway& doorway = graph.doorways[d];
    if (doorway.room_a.valid() && doorway.room_b.valid() && doorway.room_a != doorway.room_b) {
      graph.factors.push_back({FactorKind::kDoorwayRooms, {d, doorway.room_a.value, doorway.room_b.value}});
    }
  }
  for (uint32_t r = 0; r < graph.rooms.size(); ++r) graph.factors.push_back({FactorKind::kStoreyRoom, {graph.rooms[r].storey.value, r}});
}

}  // namespace plumb::compiler
