// Keyframes that tell nothing new: which ones, and how they go. Bounds what a map costs by the area that the robot drives through.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// The older keyframe that `keyframe` can be merged into (the rule: MapperOptions::redundant_distance_m), of several the one that saw most
// of its points' surfaces; none if there is none. O(observations).
[[nodiscard]] std::optional<uint32_t> RedundantTo(const SGraph& graph, uint32_t keyframe, const MapperOptions& options);

// Nothing that `keyframe` measured is lost but its points: its observations become those of `into`, from where they stand at present.
void MergeKeyframe(uint32_t keyframe, uint32_t into, SGraph* graph);

// Leaves out every second point of the keyframes that have most, until there are at most max_points in all.
void BoundPoints(size_t max_points, std::vector<Keyframe>* keyframes);

}  // namespace plumb::runtime
