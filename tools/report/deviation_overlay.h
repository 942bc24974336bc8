// The deviations on the floor plan: planned surfaces by status, and where deviated ones really stand.
#pragma once

#include <string>
#include <vector>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

// What the run says about one physical wall.
struct WallRow {
  WallId wall;
  const SurfaceEntry* surface = nullptr;  // speaks for the wall: of its surfaces with the gravest status the best observed one
  int number = 0;                         // 1, 2, ... for walls that deviate, by size, and then for missing ones; else 0
};

inline constexpr const char* kMissingColor = "#d32f2f";

[[nodiscard]] bool Deviates(const SurfaceEntry& surface);  // deviated or missing

// Deviated walls by size, then missing ones, then the others by size, unobserved ones last. Points into `deviations`, whose surface ids
// must exist in `graph`.
[[nodiscard]] std::vector<WallRow> WallRows(const AGraph& graph, const Deviations& deviations);

// Full scale of the colours: the largest deviation, up to the next 5 cm; at least 10 cm.
[[nodiscard]] double ColorLimit(const Deviations& deviations);

[[nodiscard]] std::string DeviationStyle();

// Layers for one storey. Deviated surfaces carry what the page's script needs to exaggerate them.
[[nodiscard]] std::string DrawSurfaces(const AGraph& graph, StoreyId storey, const Deviations& deviations, double limit_m,
                                       const Sheet& sheet);
// Walls that are in no plan.
[[nodiscard]] std::string DrawUnplanned(const AGraph& graph, StoreyId storey, const Deviations& deviations, const Sheet& sheet);
[[nodiscard]] std::string DrawWallNumbers(const AGraph& graph, StoreyId storey, const std::vector<WallRow>& rows, const Sheet& sheet);

}  // namespace plumb::tools
