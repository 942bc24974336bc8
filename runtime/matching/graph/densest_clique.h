// The clique of a weighted graph whose edges weigh most for its size: the largest set of correspondences that all agree with each other.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace plumb::runtime {

struct DensestCliqueOptions {
  int starts = 8;       // gradient ascents, the leading eigenvector's among them
  int max_steps = 200;  // of one ascent at one penalty
  int max_penalties = 100;
  double tolerance = 1e-8;  // an ascent ends when no entry changes by more
};

struct Clique {
  std::vector<size_t> members;  // ascending; empty for an empty graph
  // u^T M u / u^T u of the members' indicator u: 1 + the mean weight of a member's edges to the others. The sum over edges for a clique of
  // k that all agree perfectly is k.
  double density = 0;
};

// `affinity`: symmetric, in [0, 1], ones on the diagonal, 0 where two must not be in one clique.
//
// Maximize u^T M u over unit vectors u >= 0, with a penalty on pairs of weight 0 that grows until none is left; then round: in the order of
// u, whatever agrees with all before it and makes the clique denser. Started from the leading eigenvector and from the neighbourhoods of
// the heaviest vertices, so that the same graph gives the same clique. A relaxation: it may miss the optimum (the tests compare with
// exhaustive search). O(starts * penalties * steps * n^2) at most; in practice some 100 n^2 per start.
[[nodiscard]] Clique DensestClique(const Eigen::MatrixXd& affinity, const DensestCliqueOptions& options = {});

// Distinct cliques that cover all vertices: the densest in a vertex's neighbourhood, then in that of the heaviest vertex in none of them
// yet, and so on. What is consistent in several ways (a room and itself turned by 180 degrees) is found in each of them. In the order
// found.
[[nodiscard]] std::vector<Clique> CoveringCliques(const Eigen::MatrixXd& affinity, const DensestCliqueOptions& options = {});

}  // namespace plumb::runtime
