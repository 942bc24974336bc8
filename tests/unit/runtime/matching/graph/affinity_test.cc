#include "runtime/matching/graph/affinity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace plumb::runtime {
namespace {

using Room = std::array<WallPoint, 4>;

// 4 m x 3 m about its centre: east, north, west, south.
Room MakeRoom() {
  const auto wall = [](double nx, double ny, double half_m) { return AboutOrigin({nx, ny}, half_m, Eigen::Vector2d::Zero()); };
  return {wall(-1, 0, 2), wall(0, -1, 1.5), wall(1, 0, 2), wall(0, 1, 1.5)};
}

WallPoint Turned(const WallPoint& w, double yaw_rad) {
  return {Eigen::Rotation2Dd(yaw_rad) * w.foot, Eigen::Rotation2Dd(yaw_rad) * w.normal};
}

// Least affinity of two walls when wall i of the plan is wall permutation[i] of the map.
double Weakest(const Room& plan, const Room& map, const std::array<size_t, 4>& permutation) {
  double weakest = 1;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) {
      weakest = std::min(weakest, WallAffinity(plan[i], plan[j], map[permutation[i]], map[permutation[j]], {}));
    }
  }
  return weakest;
}

TEST(WallAffinity, KeepsIdentityAndHalfTurnOfARoomAndNoMirrorImage) {
  const Room room = MakeRoom();
  std::array<size_t, 4> permutation{0, 1, 2, 3};
  std::vector<std::array<size_t, 4>> consistent;
  do {
    if (Weakest(room, room, permutation) > 0) consistent.push_back(permutation);
  } while (std::next_permutation(permutation.begin(), permutation.end()));
  EXPECT_EQ(consistent, (std::vector<std::array<size_t, 4>>{{0, 1, 2, 3}, {2, 3, 0, 1}}));
}

TEST(WallAffinity, IsOneAtAnyYaw) {
  const Room room = MakeRoom();
  for (double yaw_rad : {0.3, 1.5708, 2.39, 3.1416, -1.2}) {
    Room turned;
    for (size_t i = 0; i < 4; ++i) turned[i] = Turned(room[i], yaw_rad);
    EXPECT_NEAR(Weakest(room, turned, {0, 1, 2, 3}), 1, 1e-9) << yaw_rad;
  }
}

TEST(WallAffinity, TellsMirroredSidesOfPerpendicularWallsFromAnOriginBesideThem) {
  const Eigen::Vector2d origin(0, 0);
  const WallPoint a = AboutOrigin({1, 0}, -2, origin), b = AboutOrigin({0, 1}, -3, origin);  // at x = 2, y = 3
  const WallPoint across = AboutOrigin({1, 0}, 2, origin);                                   // at x = -2, the same normal
  EXPECT_DOUBLE_EQ(WallAffinity(a, b, a, b, {}), 1);
  EXPECT_EQ(WallAffinity(a, b, across, b, {}), 0);
  EXPECT_EQ(WallAffinity(b, a, b, across, {}), 0);
}

TEST(WallAffinity, FallsWithADeviationAndEndsAtEpsilon) {
  Room built = MakeRoom();
  const Room plan = built;
  built[0].foot.x() += 0.05;
  const double small = WallAffinity(plan[0], plan[2], built[0], built[2], {});
  EXPECT_NEAR(small, std::exp(-0.5 * 0.05 * 0.05 / 0.25), 1e-9);
  built[0].foot.x() += 0.06;
  EXPECT_EQ(WallAffinity(plan[0], plan[2], built[0], built[2], {}), 0);
}

TEST(PointAffinity, ComparesDistances) {
  EXPECT_DOUBLE_EQ(PointAffinity({0, 0}, {3, 4}, {1, 1}, {1, 6}, {}), 1);
  EXPECT_NEAR(PointAffinity({0, 0}, {3, 4}, {1, 1}, {1, 6.1}, {}), std::exp(-0.5 * 0.01 / 0.25), 1e-9);
  EXPECT_EQ(PointAffinity({0, 0}, {3, 4}, {1, 1}, {1, 6.3}, {}), 0);
}

TEST(WallConsistency, NamesWhatIsWrong) {
  EXPECT_EQ(WallConsistency().Check(), "");
  EXPECT_NE((WallConsistency{0.5, 0, 0.05, 0.1}).Check().find("epsilon_m"), std::string::npos);
  EXPECT_NE((PointConsistency{-1, 0.2}).Check().find("sigma_m"), std::string::npos);
}

}  // namespace
}  // namespace plumb::runtime
