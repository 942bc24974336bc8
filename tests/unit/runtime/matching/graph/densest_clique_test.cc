#include "runtime/matching/graph/densest_clique.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "tests/support/random.h"

namespace plumb::runtime {
namespace {

// By trying all subsets.
Clique Exhaustive(const Eigen::MatrixXd& affinity) {
  Clique best;
  const auto n = static_cast<size_t>(affinity.rows());
  for (uint32_t subset = 1; subset < (1u << n); ++subset) {
    Clique clique;
    for (size_t i = 0; i < n; ++i)
      if (subset >> i & 1u) clique.members.push_back(i);
    bool allowed = true;
    for (size_t i : clique.members) {
      for (size_t j : clique.members) {
        const double w = affinity(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        allowed &= w > 0;
        clique.density += w / static_cast<double>(clique.members.size());
      }
    }
    if (allowed && clique.density > best.density + 1e-12) best = clique;
  }
  return best;
}

Eigen::MatrixXd RandomAffinity(test::Random& random, Eigen::Index n, double agreeing_ratio) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) m(i, j) = m(j, i) = random.Uniform(0, 1) < agreeing_ratio ? random.Uniform(0.3, 1) : 0;
  }
  return m;
}

TEST(DensestClique, IsTheOptimumOfSmallGraphsNearlyAlwaysAndNeverFarBelow) {
  test::Random random(7);
  int optimal = 0, all = 0;
  for (double ratio : {0.2, 0.4, 0.6, 0.8}) {
    for (int i = 0; i < 50; ++i, ++all) {
      const Eigen::MatrixXd affinity = RandomAffinity(random, 4 + i % 9, ratio);
      const Clique found = DensestClique(affinity), best = Exhaustive(affinity);
      EXPECT_LE(found.density, best.density + 1e-9);
      EXPECT_GE(found.density, 0.85 * best.density);
      optimal += found.density > best.density - 1e-9;
    }
  }
  EXPECT_GE(optimal, all * 97 / 100);
}

TEST(DensestClique, FindsAPlantedCliqueAmongOutliers) {
  test::Random random(3);
  Eigen::MatrixXd affinity = RandomAffinity(random, 80, 0.25);
  for (Eigen::Index i = 0; i < 9; ++i)
    for (Eigen::Index j = 0; j < 9; ++j) affinity(7 * i + 2, 7 * j + 2) = i == j ? 1 : 0.95;
  const Clique clique = DensestClique(affinity);
  EXPECT_EQ(clique.members, (std::vector<size_t>{2, 9, 16, 23, 30, 37, 44, 51, 58}));
  EXPECT_NEAR(clique.density, 1 + 8 * 0.95, 1e-9);
}

TEST(DensestClique, TakesOneOfTwoThatDisagree) {
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Ones(3, 3);
  affinity(0, 1) = affinity(1, 0) = 0;
  EXPECT_EQ(DensestClique(affinity).members.size(), 2u);
  EXPECT_DOUBLE_EQ(DensestClique(affinity).density, 2);
}

TEST(DensestClique, LeavesOutWhatWeakensTheRest) {
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Ones(4, 4);
  for (Eigen::Index i = 0; i < 3; ++i) affinity(3, i) = affinity(i, 3) = 0.05;
  EXPECT_EQ(DensestClique(affinity).members, (std::vector<size_t>{0, 1, 2}));
}

TEST(DensestClique, OfNothingIsEmptyAndOfOneIsThat) {
  EXPECT_TRUE(DensestClique(Eigen::MatrixXd(0, 0)).members.empty());
  EXPECT_EQ(DensestClique(Eigen::MatrixXd::Ones(1, 1)).members, std::vector<size_t>{0});
}

}  // namespace
}  // namespace plumb::runtime
