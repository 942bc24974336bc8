#include "runtime/mapping/glimpses.h"

#include <gtest/gtest.h>

#include <vector>

namespace plumb::runtime {
namespace {

// At the origin, 0.8 m long, facing -y; seen by keyframe 0 from 3 m off, 45 degrees aside.
MapSurface Short() {
  MapSurface surface;
  surface.plane = {-Eigen::Vector3d::UnitY(), 0};
  surface.start = {-0.4, 0};
  surface.end = {0.4, 0};
  surface.observations = {{0, {}}};
  return surface;
}

std::vector<Keyframe> KeyframesAt(const std::vector<Eigen::Vector2d>& places) {
  std::vector<Keyframe> keyframes;
  for (const Eigen::Vector2d& place : places) {
    Keyframe& keyframe = keyframes.emplace_back();
    keyframe.id = static_cast<uint32_t>(keyframes.size() - 1);
    keyframe.T_map_kf.translation() = Eigen::Vector3d(place.x(), place.y(), 0);
  }
  return keyframes;
}

bool IsGlimpseFrom(const MapSurface& surface, const std::vector<Keyframe>& keyframes) {
  return IsGlimpse(surface, Eigen::Vector3d::Zero(), keyframes);
}

const Eigen::Vector2d kSeenFrom(2.1, -2.1), kNearer(0, -2), kNearerStill(0.5, -1), kFarther(0, -4), kAside(2, -0.5), kBehind(0, 2);

TEST(IsGlimpse, IfOthersShouldHaveSeenIt) {
  EXPECT_TRUE(IsGlimpseFrom(Short(), KeyframesAt({kSeenFrom, kNearer, kNearerStill})));
  EXPECT_FALSE(IsGlimpseFrom(Short(), KeyframesAt({kSeenFrom, kNearer})));
  EXPECT_FALSE(IsGlimpseFrom(Short(), KeyframesAt({kSeenFrom})));
}

TEST(IsGlimpse, NotIfTheyWereFartherOffOrAsideOrBehind) {
  EXPECT_FALSE(IsGlimpseFrom(Short(), KeyframesAt({kSeenFrom, kNearer, kFarther, kAside, kBehind})));
}

TEST(IsGlimpse, MergedKeyframesCountForThoseThatTheyWereMergedInto) {
  std::vector<Keyframe> keyframes = KeyframesAt({kSeenFrom, kNearer, kNearerStill});
  keyframes[2].merged = Keyframe::Merged{1, {}};
  EXPECT_FALSE(IsGlimpseFrom(Short(), keyframes));
}

TEST(IsGlimpse, NeverWhatIsLongOrWasSeenAgainOrIsNoWall) {
  const std::vector<Keyframe> keyframes = KeyframesAt({kSeenFrom, kNearer, kNearerStill});
  MapSurface surface = Short();
  surface.end.x() = 0.7;
  EXPECT_FALSE(IsGlimpseFrom(surface, keyframes));
  surface = Short();
  surface.observations.push_back({1, {}});
  EXPECT_FALSE(IsGlimpseFrom(surface, keyframes));
  surface = Short();
  surface.kind = SurfaceKind::kFloor;
  EXPECT_FALSE(IsGlimpseFrom(surface, keyframes));
}

}  // namespace
}  // namespace plumb::runtime
