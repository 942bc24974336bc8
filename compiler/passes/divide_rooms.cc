#include "compiler/passes/divide_rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"

namespace plumb::compiler {
namespace {

constexpr double kCollinear_m = 0.0015;  // as for room corners

struct Outline {
  uint32_t space;
  std::vector<Ring> rings;
  double area_m2;
  double free_m2;  // without what lies under walls: some are drawn to the middle of the walls
};

// By place: of things with rings, in their order.
template <class Things>
BoxTree<2> BoxesOf(const Things& things) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const auto& thing : things) boxes.push_back(BoundingBox(thing.rings));
  return BoxTree<2>(std::move(boxes));
}

std::vector<uint32_t> SortedIn(const Eigen::AlignedBox2d& box, const BoxTree<2>& tree) {
  std::vector<uint32_t> out;
  tree.ForEachIn(box, [&](uint32_t i) { out.push_back(i); });
  std::sort(out.begin(), out.end());
  return out;
}

double FreeArea(const std::vector<Ring>& rings, double area_m2, const Floor& floor, const BoxTree<2>& footprints) {
  std::vector<Ring> walls;
  for (const uint32_t i : SortedIn(BoundingBox(rings), footprints)) {
    const Footprint& f = floor.footprints[i];
    if (f.bounds_rooms) walls.insert(walls.end(), f.rings.begin(), f.rings.end());
  }
  return area_m2 - OverlapArea(rings, walls);
}

// Of the spaces within the face those that do not overlap: smaller ones first, so that zones of several spaces drop out.
std::vector<Outline> PartsOf(const std::vector<Ring>& face, const std::vector<Outline>& outlines, const BoxTree<2>& tree,
                             const DivideOptions& options) {
  std::vector<Outline> inside;
  for (const uint32_t i : SortedIn(BoundingBox(face), tree)) {
    const Outline& o = outlines[i];
    if (o.area_m2 < options.min_area_m2) continue;
    if (OverlapArea(face, o.rings) >= options.min_inside_share * o.free_m2) inside.push_back(o);
  }
  std::stable_sort(inside.begin(), inside.end(), [](const Outline& a, const Outline& b) { return a.area_m2 < b.area_m2; });
  std::vector<Outline> out;
  for (Outline& o : inside) {
    const bool zone = std::any_of(out.begin(), out.end(), [&](const Outline& part) {
      return OverlapArea(part.rings, o.rings) > options.max_overlap_share * part.area_m2;
    });
    if (!zone) out.push_back(std::move(o));
  }
  return out;
}

// From each corner to the nearest place on the face's walls. Spaces are drawn to the plaster or with a margin: without these lines the
// strip around several spaces is one piece.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> SpokesOf(const std::vector<Ring>& outline, const std::vector<Ring>& face,
                                                                  double max_m) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> out;
  for (const Ring& ring : outline) {
    for (const auto& corner : ring) {
      double best_m = max_m;
      std::optional<Eigen::Vector2d> best;
      for (const Ring& wall : face) {
        for (size_t i = 0; i < wall.size(); ++i) {
          const Eigen::Vector2d q = NearestOnSegment(corner, wall[i], wall[(i + 1) % wall.size()]);
          if ((q - corner).norm() >= best_m) continue;
          best_m = (q - corner).norm();
          best = q;
        }
      }
      if (best && WindingNumber(face, corner) != 0) out.emplace_back(corner, *best);
    }
  }
  return out;
}

// Spaces that no wall bounds anywhere: zones within an open plan, as around a bar, and no rooms.
std::set<uint32_t> Islands(const Floor& floor) {
  std::map<uint32_t, bool> at_wall;  // by space
  const auto runs_along_walls = [](const std::vector<BoundaryEdge>& ring) {
    return std::any_of(ring.begin(), ring.end(), [](const BoundaryEdge& e) { return !e.footprints.empty(); });
  };
  for (const FloorFace& face : floor.faces) {
    if (face.space == kNoIndex) continue;
    at_wall[face.space] |= runs_along_walls(face.outer) || std::any_of(face.holes.begin(), face.holes.end(), runs_along_walls);
  }
  std::set<uint32_t> out;
  for (const auto& [space, bounded] : at_wall) {
    if (!bounded) out.insert(space);
  }
  return out;
}

}  // namespace

std::string DivideOptions::Check() const {
  if (!(min_inside_share > 0.5 && min_inside_share <= 1))
    return fmt::format("DivideOptions.min_inside_share = {}; must be in (0.5, 1]", min_inside_share);
  if (!(max_overlap_share >= 0 && max_overlap_share < 1))
    return fmt::format("DivideOptions.max_overlap_share = {}; must be in [0, 1)", max_overlap_share);
  if (!(min_area_m2 >= 0)) return fmt::format("DivideOptions.min_area_m2 = {}; must not be negative", min_area_m2);
  return {};
}

std::vector<Ring> SpaceOutline(const PlanSpace& space, const Floor& floor) {
  std::vector<Ring> out;
  const Eigen::AlignedBox3d box = Bounds(space.body);
  if (box.isEmpty()) return out;
  std::vector<double> heights;
  for (double z : floor.cut_heights_m) {
    if (box.min().z() < z && z <= box.max().z()) heights.push_back(z);
  }
  if (heights.empty()) heights.push_back(box.center().z());
  for (double z : heights) {
    for (Ring& ring : CutSolid(space.body, z).rings) out.push_back(std::move(ring));
  }
  return out;
}

size_t FloorOfStorey(const FloorIr& floors, uint32_t storey) {
  for (size_t f = 0; f < floors.floors.size(); ++f) {
    if (storey <= floors.floors[f].level.last_storey) return f;
  }
  return floors.floors.size() - 1;
}

Expected<void> DivideRooms(const PlanIr& plan, const DivideOptions& options, const PlanarMapOptions& map_options, FloorIr& floors,
                           DiagnosticSink& sink) {
  if (!options.divide) return {};
  std::vector<std::vector<Outline>> outlines(floors.floors.size());
  std::vector<BoxTree<2>> footprints;
  for (const Floor& floor : floors.floors) footprints.push_back(BoxesOf(floor.footprints));
  for (uint32_t s = 0; s < plan.spaces.size(); ++s) {
    const size_t f = FloorOfStorey(floors, plan.spaces[s].storey);
    std::vector<Ring> rings = SpaceOutline(plan.spaces[s], floors.floors[f]);
    const double area = RegionArea(rings), free = FreeArea(rings, area, floors.floors[f], footprints[f]);
    outlines[f].push_back({s, std::move(rings), area, free});
  }
  for (size_t f = 0; f < floors.floors.size(); ++f) {
    Floor& floor = floors.floors[f];
    const BoxTree<2> tree = BoxesOf(outlines[f]);
    for (const FloorFace& face : floor.faces) {
      if (!face.bounded() || !face.cover.empty()) continue;
      std::vector<Outline> parts = PartsOf(FaceRings(floor, face), outlines[f], tree, options);
      if (parts.size() < 2) continue;
      for (Outline& part : parts) {
        auto spokes = SpokesOf(part.rings, FaceRings(floor, face), map_options.max_strip_width_m);
        floor.dividers.push_back({part.space, std::move(part.rings), std::move(spokes)});
      }
    }
    if (floor.dividers.empty()) continue;
    if (Expected<void> ok = BuildPlanarMap(floor, map_options); !ok) return ok;
    if (const std::set<uint32_t> islands = Islands(floor); !islands.empty()) {
      std::erase_if(floor.dividers, [&](const Divider& d) { return islands.contains(d.space); });
      if (Expected<void> ok = BuildPlanarMap(floor, map_options); !ok) return ok;
    }
    for (const Divider& d : floor.dividers) {
      const PlanSpace& space = plan.spaces[d.space];
      sink.Emit(DiagnosticKind::kSpaceWithinRoom, space.location,
                fmt::format("no walls divide space `{}` ({:.2f} m2) from the rest of an open plan; its own outline does", space.name,
                            RegionArea(d.rings)));
    }
  }
  return {};
}

void AddOpenBoundaries(const FloorIr& floors, const std::vector<std::vector<RoomId>>& rooms_by_face, AGraph& graph) {
  for (size_t f = 0; f < floors.floors.size(); ++f) {
    const Floor& floor = floors.floors[f];
    for (size_t i = 1; i < floor.faces.size(); ++i) {
      const RoomId room = rooms_by_face[f][i];
      std::vector<std::vector<BoundaryEdge>> rings = floor.faces[i].holes;
      rings.push_back(floor.faces[i].outer);
      for (const auto& ring : rings) {
        bool extends = false;
        for (const BoundaryEdge& edge : ring) {
          const RoomId other = rooms_by_face[f][edge.face];
          // Each line once, from the room with the lower id.
          if (!edge.footprints.empty() || !room.valid() || !other.valid() || other <= room) {
            extends = false;
            continue;
          }
          const Eigen::Vector2d &from = floor.vertices[edge.from], &to = floor.vertices[edge.to];
          if (extends && graph.open_boundaries.back().room_b == other &&
              DistanceToSegment(from, graph.open_boundaries.back().start, to) <= kCollinear_m) {
            graph.open_boundaries.back().end = to;
          } else {
            graph.open_boundaries.push_back({graph.rooms[room.index()].storey, room, other, from, to});
          }
          extends = true;
        }
      }
    }
  }
}

}  // namespace plumb::compiler
