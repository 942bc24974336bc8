// Pass: openings with what fills them and the wall that hosts them, in the wall's own frame. Doors and windows that the source ties to
// nothing are hosted by geometry.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

enum class OpeningUse : uint8_t { kDoor, kWindow, kUnfilled };

struct HostedOpening {
  OpeningUse use = OpeningUse::kUnfilled;
  uint32_t opening = kNoIndex;     // in PlanIr::openings; none: a door or window element without any
  std::vector<uint32_t> fillings;  // elements of the door or window: the one stated and those of the same source
  WallId wall;                     // none: no wall is near
  size_t floor = 0;                // in FloorIr::floors
  StoreyId storey;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // of the opening along the wall, on the wall's centre line there
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // the wall's direction there
  double depth_m = 0;                                // the wall's thickness there
  double width_m = 0, z_min_m = 0, z_max_m = 0;      // of the void (of the filling where there is none)
  bool through = true;                               // false: a niche
};

struct HostingOptions {
  double max_host_distance_m = 0.3;  // from the middle of an opening, door or window to its wall
  double max_filling_offset_m =
      0.5;  // between the middles of an unfilled opening and the door or window in it that the source does not tie to it
  double storey_slack_m = 0.5;  // how far a sill may lie below its level's zero
  [[nodiscard]] std::string Check() const;
};

// In the order of openings, then of elements. Openings in slabs and roofs, windows that lie in them, and unfilled ones that miss their wall
// are left out. Needs graph.walls and graph.storeys.
[[nodiscard]] std::vector<HostedOpening> HostOpenings(const PlanIr& plan, const FloorIr& floors, const HostingOptions& options,
                                                      const AGraph& graph, DiagnosticSink& sink);

}  // namespace plumb::compiler
