// PlanIr: the plan as drawn. What a frontend makes of its file and the passes take: elements with their solids,
// openings, spaces and storeys, each with its place in the source. Frame: plan, metres, z up, minus `origin`.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/geometry/solid.h"
#include "schema/agraph.h"

namespace plumb::compiler {

inline constexpr uint32_t kNoIndex = 0xffffffffu;

struct PlanStorey {
  std::string guid, name;
  SourceLocation location;
  double elevation_m = 0;  // z of the storey's own zero, all placements applied
};

// One leaf of a door as DoorLeaf, but in the plan's directions: which rooms the door joins, and which is the first, is not known yet.
struct PlanLeaf {
  LeafOperation operation = LeafOperation::kUnknown;
  Eigen::Vector2d to_jamb = Eigen::Vector2d::Zero();   // along the wall, from the middle of the door to that jamb; zero: unknown
  Eigen::Vector2d opens_to = Eigen::Vector2d::Zero();  // across the wall; zero: unknown
  double width_m = 0;                                  // 0: unknown
  friend bool operator==(const PlanLeaf&, const PlanLeaf&) = default;
};

struct PlanElement {
  ElementKind kind = ElementKind::kOther;
  Material material = Material::kOpaque;
  std::string guid, name, type;
  SourceLocation location;
  uint32_t storey = kNoIndex;  // as contained in the source; none where it says nothing
  // As a ray sees it: openings cut. Solid parts of glass (panes) are elements of their own with the same guid; those of a wall or curtain
  // wall that is not all of glass are of kind kWindow, so that one wall stays one element. Empty for a door or window drawn without a body
  // and for a curtain wall that is nothing but its doors and windows.
  Solid body;
  // Before openings are cut, closed; only for walls, curtain walls, columns and proxies that act as walls. Its horizontal sections are the
  // wall's footprint. It may be several closed solids that touch or overlap (layers, parts, the doors in a curtain wall): the footprint is
  // their union.
  Solid uncut;
  std::optional<double> thickness_m;                                // where the source states it (material layers)
  std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> axis;  // where the source has one (Axis representation)
  std::vector<Arc> arcs;                                            // exact arcs of the footprint where the source has them (curved walls)
  bool external = false;                                            // stated by the source (Pset_WallCommon.IsExternal)
  std::vector<PlanLeaf> leaves;                                     // of a door, as far as known
};

struct PlanOpening {
  std::string guid, name;
  SourceLocation location;
  uint32_t wall = kNoIndex;  // element that it voids
  // Door, window or (set into a wall) curtain wall element that fills it; none: a passage if it reaches the floor.
  uint32_t filling = kNoIndex;
  Solid body;                               // the void; empty for a door without an opening chain (then the filling's box stands for it)
  std::optional<double> width_m, height_m;  // OverallWidth and OverallHeight of the filling where stated
};

struct PlanSpace {
  std::string guid, name, long_name;
  SourceLocation location;
  uint32_t storey = kNoIndex;
  Solid body;  // may be empty
};

struct PlanIr {
  std::string source_path, source_format, source_sha256;  // format: "IFC2X3", "IFC4", ...
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       // added to every coordinate it gives the plan frame
  std::optional<double> true_north_rad;                   // direction of true north, counter-clockwise from +x, where the source says
  std::vector<PlanStorey> storeys;                        // sorted by elevation
  std::vector<PlanElement> elements;                      // in file order
  std::vector<PlanOpening> openings;
  std::vector<PlanSpace> spaces;
};

}  // namespace plumb::compiler
