// What the planar map's faces are labelled with while it is built. Private to planar_map.cc and its parts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

// Winding number per outline, in their order: of footprints by their index, then of dividers. Those with 0 are left out.
using Windings = std::vector<std::pair<uint32_t, int>>;

inline void AddTo(Windings& windings, uint32_t outline, int count) {
  const auto at = std::lower_bound(windings.begin(), windings.end(), outline, [](const auto& w, uint32_t o) { return w.first < o; });
  if (at == windings.end() || at->first != outline)
    windings.insert(at, {outline, count});
  else if ((at->second += count) == 0)
    windings.erase(at);
}

struct FaceLabel {
  bool known = false;
  Windings windings;
  uint32_t index = kNoIndex;   // in Floor::faces
  uint32_t region = kNoIndex;  // free faces that no wall divides have the same
  uint32_t space = kNoIndex;   // divider that the face belongs to
};

// Calls visit(edge) for the halfedges of all boundaries of a face; those of holes clockwise about them.
template <class Circulator, class Face, class Visit>
void ForEachEdge(Face face, const Visit& visit) {
  const auto walk = [&visit](Circulator first) {
    auto edge = first;
    do visit(edge);
    while (++edge != first);
  };
  for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb) walk(*ccb);
  for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb) walk(*ccb);
}

}  // namespace plumb::compiler
