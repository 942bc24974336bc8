#include "runtime/numerics/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace plumb::runtime {
namespace {

template <int N>
SymmetricEigen<N> Iterated(const Eigen::Matrix<double, N, N>& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

SymmetricEigen<2> EigenOf(const Eigen::Matrix2d& m) { return Iterated<2>(m); }
SymmetricEigen<3> EigenOf(const Eigen::Matrix3d& m) { return Iterated<3>(m); }
SymmetricEigen<6> EigenOf(const Eigen::Matrix<double, 6, 6>& m) { return Iterated<6>(m); }

SymmetricEigen<3> RoughEigenOf(const Eigen::Matrix3d& m) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace plumb::runtime
