// Pass: the aliasing forecast. Finds the rigid motions of the plan, and the rooms, that LiDAR geometry cannot tell apart, so that a robot
// is warned before it drives: a flat and its copy next door, a floor and the one above, a house that a half turn maps onto itself.
// A mirror image is no alias, since a LiDAR tells left from right.
#pragma once

#include <string>

#include "compiler/passes/room_sections.h"
#include "compiler/passes/room_twins.h"

namespace plumb::compiler {

struct AliasOptions {
  SectionOptions sections;
  TwinOptions twins;
  double min_overlap_ratio = 0.9;    // of a room's sections that coincide with those of its twin
  double min_difference_m = 0.3;     // of section of one element without a counterpart, to be named as a difference
  size_t max_aliases = 32;           // those of the most section stay
  size_t max_alias_rooms = 1 << 16;  // of all aliases together; an alias beyond is not looked for: huge halls of equal cells have thousands
  size_t max_votes = 1 << 18;        // about so many pairs of rooms are asked which motion joins them
  [[nodiscard]] std::string Check() const;
};

// Sets graph.aliases, closed ones first, then those with the most section, and graph.look_alikes. Needs rooms, doorways, open boundaries
// and the mesh, all in the plan frame, as they stand in the file.
//
// Rooms of one shape vote for the motions that take one onto the other. A motion stays if it takes several connected rooms, or a room that
// leads nowhere else, onto rooms whose sections coincide. O(R^2 + V log V + T log L) for R rooms, V votes, T triangles, L floor levels.
void ForecastAliases(const AliasOptions& options, AGraph& graph);

}  // namespace plumb::compiler
