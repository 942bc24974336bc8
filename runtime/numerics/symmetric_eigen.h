// Eigenvalues and eigenvectors of small symmetric matrices. Compiled once, as every file that includes Eigen's own solver builds for
// seconds.
#pragma once

#include <Eigen/Core>

namespace plumb::runtime {

template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;   // ascending
  Eigen::Matrix<double, N, N> vectors;  // orthonormal columns, in the order of `values`; their signs mean nothing
};

// Only the lower triangle is read. Not finite in, not finite out.
[[nodiscard]] SymmetricEigen<2> EigenOf(const Eigen::Matrix2d& m);
[[nodiscard]] SymmetricEigen<3> EigenOf(const Eigen::Matrix3d& m);
[[nodiscard]] SymmetricEigen<6> EigenOf(const Eigen::Matrix<double, 6, 6>& m);

// In closed form: several times as fast, exact to about 1e-8 of the largest value. For what is done per point.
[[nodiscard]] SymmetricEigen<3> RoughEigenOf(const Eigen::Matrix3d& m);

}  // namespace plumb::runtime
