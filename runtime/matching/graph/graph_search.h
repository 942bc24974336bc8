// Matching by graphs from what the localizer has: rooms of its map against rooms of each storey of the plan.
#pragma once

#include <vector>

#include "runtime/matching/graph/graph_matcher.h"

namespace plumb::runtime {

class GraphSearch {
 public:
  // `options` must pass Check().
  explicit GraphSearch(const AGraph& plan, const GraphMatcherOptions& options = {});

  // As Matcher::Match, by rooms alone: derives the map's rooms and takes the floor that has most of them. Of the hypotheses only pose,
  // storey, and how many walls agree and their share are given; they are equally probable. Deterministic.
  [[nodiscard]] MatchResult Match(const SGraph& map) const;

 private:
  struct Level {
    StoreyId storey;
    double floor_z_m = 0, ceiling_z_m = 0;  // medians of its rooms; less AGraph::origin
    GraphMatcher matcher;
  };
  [[nodiscard]] Hypothesis At(const Level& level, const MapFloor& floor, const PlanarPose& pose) const;

  Eigen::Vector3d origin_;
  GraphMatcherOptions options_;
  std::vector<Level> levels_;
};

}  // namespace plumb::runtime
