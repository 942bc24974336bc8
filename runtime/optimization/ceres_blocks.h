// What the problems of this folder share of Ceres. Only for their .cc files.
#pragma once

#include <ceres/ceres.h>

#include <array>

#include "runtime/optimization/residuals.h"

namespace plumb::runtime {

inline constexpr double kOdometryLoss = 3.0;  // in sigmas
// Far weaker than any observation: keeps planes regular that only a line of points was seen of.
inline constexpr std::array<double, kPlaneSize> kPlaneWeight{1.0, 1.0, 1.0, 0.1};

using PoseManifold = ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;  // qx qy qz qw tx ty tz
using PlaneManifold = ceres::ProductManifold<ceres::SphereManifold<3>, ceres::EuclideanManifold<1>>;       // n d

// Of a functor of residuals.h. The problem owns it.
template <class Functor, int kResiduals, int... kBlocks>
auto* Cost(const Functor& functor) {
  return new ceres::AutoDiffCostFunction<Functor, kResiduals, kBlocks...>(new Functor(functor));
}

// Losses and manifolds are members of whoever has the problem.
inline ceres::Problem::Options SharedLossesAndManifolds() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

}  // namespace plumb::runtime
