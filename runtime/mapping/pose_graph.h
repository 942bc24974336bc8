// Graphs of poses, in the plane and in space.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/mapping/pose_motion.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// The poses that agree best with the edges, the first held; started from `poses`. Levenberg-Marquardt with a sparse factorisation:
// about a millisecond per hundred poses.
[[nodiscard]] std::vector<Pose2> SolvePoseGraph(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges);

// Covariance of (x, y, yaw) of every pose in `source`, in the axes of `source`: along the surest path of edges. What other paths know as
// well is left out, so this is never less than the marginal of the graph (Dijkstra projection; Bosse et al., IJRR 2004). O(edges log
// poses). Poses that no path reaches get infinite variances.
[[nodiscard]] std::vector<Eigen::Matrix3d> RelativeCovariances(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges,
                                                               uint32_t source);

// The same in space. Keyframes that were merged into others go where those go, so edges within one do nothing. Returns T_map_kf of all.
[[nodiscard]] std::vector<Eigen::Isometry3d> SolvePoseGraph(const std::vector<Keyframe>& keyframes, std::span<const SpatialEdge> edges);

// Of each keyframe's increment (rotation, translation), in the axes of `source`.
[[nodiscard]] std::vector<Matrix6d> RelativeCovariances(const std::vector<Keyframe>& keyframes, std::span<const SpatialEdge> edges,
                                                        uint32_t source);

// What poses say of an edge between two keyframes, each of which may have been merged into another.
[[nodiscard]] MotionResidual ResidualOf(const SpatialEdge& edge, const std::vector<Keyframe>& keyframes);
// The keyframe itself, or the one that it was merged into.
[[nodiscard]] inline uint32_t RootOf(const Keyframe& keyframe) { return keyframe.merged ? keyframe.merged->into : keyframe.id; }

}  // namespace plumb::runtime
