#include "runtime/numerics/symmetric_eigen.h"

#include <gtest/gtest.h>

namespace plumb::runtime {
namespace {

// Rebuilds the matrix from its parts; `tolerance` relative to the largest value.
template <int N>
void ExpectParts(const Eigen::Matrix<double, N, N>& m, const SymmetricEigen<N>& eigen, double tolerance) {
  const double size = eigen.values.cwiseAbs().maxCoeff();
  EXPECT_LT((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose() - m).cwiseAbs().maxCoeff(), tolerance * size);
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - Eigen::Matrix<double, N, N>::Identity()).cwiseAbs().maxCoeff(), tolerance);
  for (int i = 1; i < N; ++i) EXPECT_LE(eigen.values[i - 1], eigen.values[i]);
}

template <int N>
Eigen::Matrix<double, N, N> Symmetric(int seed) {
  Eigen::Matrix<double, N, N> m;
  for (int r = 0; r < N; ++r) {
    for (int c = 0; c <= r; ++c) m(r, c) = m(c, r) = std::sin(seed * 17.0 + r * 5.0 + c * 3.0);
  }
  return m;
}

TEST(SymmetricEigen, PartsMakeTheMatrixAgain) {
  for (int seed = 0; seed < 50; ++seed) {
    ExpectParts<2>(Symmetric<2>(seed), EigenOf(Symmetric<2>(seed)), 1e-12);
    ExpectParts<3>(Symmetric<3>(seed), EigenOf(Symmetric<3>(seed)), 1e-12);
    ExpectParts<6>(Symmetric<6>(seed), EigenOf(Symmetric<6>(seed)), 1e-12);
    ExpectParts<3>(Symmetric<3>(seed), RoughEigenOf(Symmetric<3>(seed)), 1e-6);
  }
}

TEST(SymmetricEigen, ValuesAscendAndTheNormalOfAPlaneComesFirst) {
  const Eigen::Matrix3d scatter = Eigen::Vector3d(4, 1e-6, 9).asDiagonal();
  for (const SymmetricEigen<3>& eigen : {EigenOf(scatter), RoughEigenOf(scatter)}) {
    EXPECT_NEAR(eigen.values[0], 1e-6, 1e-9);
    EXPECT_NEAR(eigen.values[2], 9, 1e-9);
    EXPECT_NEAR(std::abs(eigen.vectors(1, 0)), 1, 1e-9);
  }
}

}  // namespace
}  // namespace plumb::runtime
