// FloorIr: per level of the building a clean planar map of the footprints of walls and columns. Between PlanIr and the A-Graph.
// Frame: as PlanIr (plan minus PlanIr::origin), metres. Plain data; indices are positions in the vectors of the same Floor.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compiler/ir/plan_ir.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// A physical wall: one element of the source, or several of one guid (panes and frames of a glazed wall).
struct PlanWall {
  std::vector<uint32_t> elements;  // in PlanIr::elements, file order
  uint32_t storey = kNoIndex;      // the lowest one that holds a part of it
  double z_min_m = 0, z_max_m = 0;
  std::vector<Arc> arcs = {};  // of its outline, where it is curved
};

// Storeys that share one map: those closer to the one below than a person is tall are landings or split levels of it.
struct Level {
  uint32_t first_storey = 0, last_storey = 0;
  double base_z_m = 0;     // lowest storey's elevation
  double section_z_m = 0;  // where walls are cut
  double top_z_m = 0;      // elevation of the next level; of the highest wall on the last one
};

enum class FootprintKind : uint8_t { kWall, kColumn, kFilling };  // filling: a door or window that stands in no wall but between walls

// What a solid leaves in the map of a level.
struct Footprint {
  FootprintKind kind = FootprintKind::kWall;
  uint32_t wall = kNoIndex;     // in FloorIr::walls; none for columns and fillings
  uint32_t element = kNoIndex;  // in PlanIr::elements (of a wall: its first)
  bool bounds_rooms = true;     // part of the planar map. False for what a person sees or walks over or under: parapets, hanging walls
  std::vector<Ring> rings;  // closed; outer ones counter-clockwise, holes clockwise; may overlap each other (winding number != 0 is inside)
};

// The outline of a space that shares an open plan with others: where no wall divides them, this does.
struct Divider {
  uint32_t space = kNoIndex;  // in PlanIr::spaces
  std::vector<Ring> rings;    // as Footprint::rings
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> spokes;  // from corners to the nearest wall: they cut up the strip along the walls
};

// Closes a gap between two outlines that nobody can pass: where it separates rooms, its line is one of both.
struct Bridge {
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
  uint32_t footprint_a = kNoIndex, footprint_b = kNoIndex;  // may be one: parts of a wall
};

// One edge of a face's boundary, the face on its left.
struct BoundaryEdge {
  uint32_t from = 0, to = 0;         // vertices
  uint32_t face = kNoIndex;          // the face on the other side
  std::vector<uint32_t> footprints;  // whose outline runs here, ascending; none: two spaces of an open plan meet
  uint32_t bridge = kNoIndex;        // in Floor::bridges, where nothing else runs here; `footprints` are then the two that it joins
};

struct FloorFace {
  std::vector<uint32_t> cover;                   // footprints over it, ascending; none: free space
  uint32_t space = kNoIndex;                     // of a divided open plan: the space that this part belongs to
  std::vector<BoundaryEdge> outer;               // counter-clockwise; empty for the unbounded face
  std::vector<std::vector<BoundaryEdge>> holes;  // clockwise
  double area_m2 = 0;                            // holes taken off; 0 for the unbounded face
  [[nodiscard]] bool bounded() const { return !outer.empty(); }
};

struct Floor {
  Level level;
  std::vector<double> cut_heights_m;  // where the walls are cut, ascending: the section height, and lower where knee walls bound rooms
  std::vector<Footprint> footprints;
  std::vector<Divider> dividers;
  std::vector<Bridge> bridges;
  std::vector<Eigen::Vector2d> vertices;
  std::vector<FloorFace> faces;  // the unbounded one first
};

struct FloorIr {
  std::vector<PlanWall> walls;
  std::vector<Floor> floors;  // from below
};

// Faults of an IR, one sentence each; empty if it keeps its invariants. Linear.
[[nodiscard]] std::vector<std::string> VerifyPlanIr(const PlanIr& plan);
[[nodiscard]] std::vector<std::string> VerifyFloorIr(const FloorIr& floors, const PlanIr& plan);

}  // namespace plumb::compiler
