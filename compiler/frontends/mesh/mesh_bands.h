// Pairs of faces that are the two sides of a wall, and faces that have no partner.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontends/mesh/mesh_sections.h"

namespace plumb::compiler {

struct Span {
  double s0_m = 0, s1_m = 0;
};

// Two faces with solid between them, or one with nothing behind it, at the heights of the section.
struct Band {
  size_t direction = 0;
  double c0_m = 0, c1_m = 0;             // offsets of its faces across; c0 < c1
  uint32_t group = 0;                    // of objects that make walls together
  bool sheet = false;                    // has one face only; the other one is made up
  std::vector<std::vector<Span>> spans;  // by height: where it is solid, sorted
};

// `group_of`: by object. In the order of directions, groups and offsets.
[[nodiscard]] std::vector<Band> FindBands(const std::vector<FaceDirection>& directions, const SectionStack& stack,
                                          const std::vector<uint32_t>& group_of, Facing facing, const MeshOptions& options);

}  // namespace plumb::compiler
