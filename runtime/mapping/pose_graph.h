// A graph of poses in the plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

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

}  // namespace plumb::runtime
