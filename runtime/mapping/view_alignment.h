// Two keyframes that saw the same surfaces, laid on each other.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Pose of `keyframe` in `into`: where the surfaces that both saw are thinnest, each plane being free (runtime/METHOD.md, plane bundle
// adjustment, of two poses). Directions that they leave open stay as the graph has them. O(observations).
[[nodiscard]] Eigen::Isometry3d AlignedPose(const SGraph& graph, uint32_t keyframe, uint32_t into, const MapperOptions& options);

}  // namespace plumb::runtime
