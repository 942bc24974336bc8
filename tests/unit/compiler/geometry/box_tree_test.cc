#include "compiler/geometry/box_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <set>

namespace plumb::compiler {
namespace {

// n x n unit squares, two units apart.
std::vector<Eigen::AlignedBox2d> Squares(int n) {
  std::vector<Eigen::AlignedBox2d> out;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) out.emplace_back(Eigen::Vector2d(2 * i, 2 * j), Eigen::Vector2d(2 * i + 1, 2 * j + 1));
  }
  return out;
}

TEST(BoxTree, FindsWhatMeetsTheQueryAndNothingElse) {
  const std::vector<Eigen::AlignedBox2d> boxes = Squares(20);
  const BoxTree<2> tree(boxes);
  for (const Eigen::AlignedBox2d& query : {Eigen::AlignedBox2d(Eigen::Vector2d(3, 3), Eigen::Vector2d(8.5, 4)),
                                           Eigen::AlignedBox2d(Eigen::Vector2d(1, 1)), Eigen::AlignedBox2d(Eigen::Vector2d(1.5, 1.5))}) {
    std::set<uint32_t> expected, found;
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].intersects(query)) expected.insert(i);
    }
    tree.ForEachIn(query, [&](uint32_t i) { EXPECT_TRUE(found.insert(i).second); });
    EXPECT_EQ(found, expected);
  }
}

TEST(BoxTree, LooksAtFewBoxes) {
  const BoxTree<2> tree(Squares(200));
  const Eigen::AlignedBox2d query(Eigen::Vector2d(100.5, 100.5));
  size_t looked_at = 0;
  tree.ForEach(
      [&](const Eigen::AlignedBox2d& box) {
        ++looked_at;
        return box.intersects(query);
      },
      [&](uint32_t) { ++looked_at; });
  EXPECT_LT(looked_at, 150u);  // of 40000
}

TEST(BoxTree, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<Eigen::AlignedBox2d> boxes = Squares(300);
  const auto visited = [&boxes](size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<uint32_t> out;
    BoxTree<2>(boxes).ForEach([](const Eigen::AlignedBox2d&) { return true; }, [&](uint32_t i) { out.push_back(i); });
    return out;
  };
  const std::vector<uint32_t> alone = visited(1);
  EXPECT_EQ(std::set<uint32_t>(alone.begin(), alone.end()).size(), boxes.size());
  for (const size_t threads : {2, 3, 8}) EXPECT_EQ(visited(threads), alone) << threads;
}

TEST(BoxTree, OfBoxesInOnePlaceFindsAll) {
  const BoxTree<2> tree(std::vector<Eigen::AlignedBox2d>(1000, Eigen::AlignedBox2d(Eigen::Vector2d(1, 2))));
  size_t found = 0;
  tree.ForEachIn(Eigen::AlignedBox2d(Eigen::Vector2d(1, 2)), [&](uint32_t) { ++found; });
  EXPECT_EQ(found, 1000u);
}

TEST(BoxTree, EmptyOneHoldsNothing) {
  BoxTree<3>(std::vector<Eigen::AlignedBox3d>()).ForEachIn(Eigen::AlignedBox3d(Eigen::Vector3d::Zero()), [](uint32_t) { FAIL(); });
  BoxTree<3>().ForEachIn(Eigen::AlignedBox3d(Eigen::Vector3d::Zero()), [](uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace plumb::compiler
