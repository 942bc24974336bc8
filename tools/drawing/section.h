// What a horizontal cut through the plan's triangles shows: outlines of what is cut, and edges of what lies below.
#pragma once

#include <utility>
#include <vector>

#include "schema/agraph.h"

namespace plumb::tools {

// Centred at `middle`, `length_m` along the unit vector `along` and `width_m` across it; counter-clockwise.
[[nodiscard]] Ring RectangleAlong(const Eigen::Vector2d& middle, const Eigen::Vector2d& along, double length_m, double width_m);

// The cut through one element: closed rings (inner ones are holes; fill them even-odd), plan frame, metres.
struct ElementSection {
  uint32_t element = 0;  // AGraph::elements
  std::vector<Ring> rings;
};

// The cut through one triangle of an element; the solid lies to its left.
struct SectionSegment {
  uint32_t element = 0;
  Eigen::Vector2d from, to;
};

// Everything that the plane z = `z_m` cuts, in the order of the triangles.
[[nodiscard]] std::vector<SectionSegment> SegmentsAt(const AGraph& graph, double z_m);

// Sections of all elements that the plane z = `z_m` cuts, by element. Outlines that do not close (solids with holes in their skin)
// are left out. Exact for closed solids: points are computed from the edge, the same for both triangles at it. O(n log n).
[[nodiscard]] std::vector<ElementSection> CutAt(const AGraph& graph, double z_m);
[[nodiscard]] std::vector<ElementSection> ClosedSections(const std::vector<SectionSegment>& segments);

using Edge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

// Edges of stairs, railings and furniture that are seen from above between the heights: creases and borders of faces that look up.
[[nodiscard]] std::vector<Edge> EdgesSeenFromAbove(const AGraph& graph, double z_min_m, double z_max_m);

}  // namespace plumb::tools
