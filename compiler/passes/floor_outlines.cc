#include "compiler/passes/floor_outlines.h"

#include <utility>

namespace plumb::compiler {

SnapGraph OutlinesOf(const Floor& floor) {
  SnapGraph graph;
  const auto append = [&graph](const std::vector<Ring>& rings, size_t outline) {
    for (const Ring& ring : rings) {
      const auto first = static_cast<uint32_t>(graph.vertices.size()), size = static_cast<uint32_t>(ring.size());
      graph.vertices.insert(graph.vertices.end(), ring.begin(), ring.end());
      for (uint32_t i = 0; i < size; ++i) graph.segments.push_back({first + i, first + (i + 1) % size, static_cast<uint32_t>(outline)});
    }
  };
  for (size_t f = 0; f < floor.footprints.size(); ++f) {
    if (floor.footprints[f].bounds_rooms) append(floor.footprints[f].rings, f);
  }
  for (size_t d = 0; d < floor.dividers.size(); ++d) append(floor.dividers[d].rings, floor.footprints.size() + d);
  const auto append_line = [&graph](const Eigen::Vector2d& a, const Eigen::Vector2d& b, size_t outline) {
    const auto from = static_cast<uint32_t>(graph.vertices.size());
    graph.vertices.insert(graph.vertices.end(), {a, b});
    graph.segments.push_back({from, from + 1, static_cast<uint32_t>(outline)});
  };
  const size_t first_bridge = floor.footprints.size() + floor.dividers.size();
  for (size_t b = 0; b < floor.bridges.size(); ++b) append_line(floor.bridges[b].from, floor.bridges[b].to, first_bridge + b);
  for (const Divider& d : floor.dividers) {
    for (const auto& [from, to] : d.spokes) append_line(from, to, first_bridge + floor.bridges.size());
  }
  return graph;
}

}  // namespace plumb::compiler
