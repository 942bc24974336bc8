#include "runtime/coupling/sight_lines.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace plumb::runtime {
namespace {

struct Scene {
  SGraph map;
  Surface wall;
  std::vector<WallOpening> openings;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();

  [[nodiscard]] SightLines::Count Count() const {
    return SightLines(map, T_plan_map).Meeting({0.5 * (wall.start + wall.end), wall.normal.head<2>(), &wall, &openings});
  }
};

// A wall of 4 m that leans at `yaw_rad` in the plan, seen from 2 m: so many lines end on it, so many go on beyond, none at its edges.
Scene SceneAt(const Eigen::Vector3d& origin, double yaw_rad, size_t ended, size_t passed) {
  Scene scene;
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  scene.T_plan_map = Eigen::Translation3d(origin) * turn;
  const auto at = [&](double x, double y) -> Eigen::Vector2d { return (scene.T_plan_map * Eigen::Vector3d(x, y, 0)).head<2>(); };
  scene.wall.start = at(-2, 0);
  scene.wall.end = at(2, 0);
  scene.wall.normal = turn * Eigen::Vector3d::UnitY();
  scene.wall.z_min_m = origin.z();
  scene.wall.z_max_m = origin.z() + 2.5;
  Keyframe keyframe;
  keyframe.T_map_kf = Eigen::Translation3d(0, 2, 1.2);
  test::Random random(7);
  for (size_t i = 0; i < ended + passed; ++i) {
    const double y = i < ended ? random.Normal(0.02) : -1.0;
    keyframe.points.push_back(Eigen::Vector3d(random.Uniform(-1, 1), y - 2, random.Uniform(-0.3, 0.3)).cast<float>());
  }
  scene.map.keyframes.push_back(keyframe);
  return scene;
}

TEST(SightLines, TellWhatEndsOnAWallFromWhatGoesBeyond) {
  const SightLines::Count count = SceneAt({0, 0, 0}, 0, 300, 80).Count();
  EXPECT_GE(count.ended, 295u);  // but for the tail of the noise
  EXPECT_LE(count.ended, 300u);
  EXPECT_EQ(count.passed, 80u);
}

TEST(SightLines, AreTheSameInAGeoreferencedPlan) {
  for (const double yaw_rad : {0.0, 0.4, 1.1, 2.9}) {
    const SightLines::Count here = SceneAt({0, 0, 0}, yaw_rad, 300, 80).Count(),
                            there = SceneAt({458000, 5429000, 310}, yaw_rad, 300, 80).Count();
    EXPECT_NEAR(static_cast<double>(there.ended), static_cast<double>(here.ended), 2) << yaw_rad;
    EXPECT_EQ(there.passed, here.passed) << yaw_rad;
  }
}

TEST(SightLines, DoNotCountThroughOpenings) {
  Scene scene = SceneAt({0, 0, 0}, 0, 300, 80);
  scene.openings.push_back({{0, 0}, 3.8, 0, 2.5});
  const SightLines::Count count = scene.Count();
  EXPECT_EQ(count.ended, 0u);
  EXPECT_EQ(count.passed, 0u);
}

}  // namespace
}  // namespace plumb::runtime
