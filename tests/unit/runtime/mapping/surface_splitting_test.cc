#include "runtime/mapping/surface_splitting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "runtime/mapping/mapper.h"

namespace plumb::runtime {
namespace {

constexpr double kRoughness_m = 0.02;

// Where a wall seen from the side of smaller y stands, at x.
using Wall = std::function<double(double x_m)>;

// A keyframe's view of a wall, 2 m high, from x_m on along 1.5 m. The keyframe sees everything `off_m` too far in y.
TrackedSurface View(const Keyframe& keyframe, double x_m, const Wall& wall, double off_m = 0) {
  const double y0 = wall(x_m), lean = (wall(x_m + 1.5) - y0) / 1.5;
  const Eigen::Vector3d normal = Eigen::Vector3d(lean, -1, 0).normalized();
  Segment segment;
  segment.plane = {normal, -normal.dot(Eigen::Vector3d(x_m, y0 + off_m, 0))};
  int i = 0;
  for (double x = x_m + 0.05; x < x_m + 1.5; x += 0.1) {
    for (double z = 0.05; z < 2; z += 0.1) {
      const Eigen::Vector3d p(x, wall(x) + off_m, z);
      for (int k = 0; k < 4; ++k, ++i) segment.stats.Add(p + (i % 2 == 0 ? kRoughness_m : -kRoughness_m) * normal);
      segment.cells.push_back(p.cast<float>());
    }
  }
  return SurfaceOf(segment, keyframe);
}

// Six views along 4 m of a wall taken for one surface.
struct Seen {
  std::vector<Keyframe> keyframes;
  TrackedSurface surface;

  explicit Seen(const Wall& wall) : keyframes(6), surface(At(0, wall)) {
    for (uint32_t i = 1; i < keyframes.size(); ++i) Absorb(At(i, wall), keyframes, &surface.surface, &surface.track);
  }
  std::optional<TrackedSurface> Split() { return SplitOff(keyframes, MapperOptions(), &surface.surface, &surface.track); }

 private:
  TrackedSurface At(uint32_t i, const Wall& wall) {
    keyframes[i].id = i;
    return View(keyframes[i], (i < 3 ? 0.0 : 2.5) + 0.25 * (i % 3), wall);
  }
};

double AtX(const MapSurface& s, double x_m) { return -(s.plane.d + s.plane.n.x() * x_m) / s.plane.n.y(); }

void ExpectWall(const MapSurface& s, const Wall& wall, double from_m, double to_m) {
  EXPECT_NEAR(AtX(s, from_m), wall(from_m), 0.004);
  EXPECT_NEAR(AtX(s, to_m), wall(to_m), 0.004);
  EXPECT_NEAR(s.length_m(), std::hypot(to_m - from_m, wall(to_m) - wall(from_m)), 0.15);
  EXPECT_EQ(s.observations.size(), 3u);
  EXPECT_NEAR(s.area_m2, 2.0 * s.length_m(), 1.0);
}

TEST(SplitOff, PartsWallsThatStandOneBehindTheOther) {
  const Wall wall = [](double x_m) { return x_m < 2.25 ? 2.0 : 2.12; };
  Seen seen(wall);
  const std::optional<TrackedSurface> other = seen.Split();
  ASSERT_TRUE(other);
  const bool first_is_left = AtX(seen.surface.surface, 0) < 2.06;
  ExpectWall(first_is_left ? seen.surface.surface : other->surface, wall, 0, 2);
  ExpectWall(first_is_left ? other->surface : seen.surface.surface, wall, 2.5, 4.5);
  EXPECT_FALSE(seen.Split()) << "what is left lies on one plane";
}

TEST(SplitOff, PartsWallsAtABend) {
  const Wall wall = [](double x_m) { return x_m < 2.25 ? 2.0 : 2.0 + 0.15 * (x_m - 2.25); };
  Seen seen(wall);
  const std::optional<TrackedSurface> other = seen.Split();
  ASSERT_TRUE(other);
  const bool first_is_left = std::abs(AtX(seen.surface.surface, 0) - 2) < 0.02;
  ExpectWall(first_is_left ? seen.surface.surface : other->surface, wall, 0, 2);
  ExpectWall(first_is_left ? other->surface : seen.surface.surface, wall, 2.5, 4.5);
}

TEST(SplitOff, LeavesWallsThatOnePlaneFits) {
  for (const double step_m : {0.0, 0.02, 0.04}) {
    Seen seen([&](double x_m) { return x_m < 2.25 ? 2.0 : 2.0 + step_m; });
    const size_t cells = seen.surface.surface.cells.size();
    EXPECT_FALSE(seen.Split()) << step_m;
    EXPECT_EQ(seen.surface.surface.observations.size(), 6u);
    EXPECT_EQ(seen.surface.surface.cells.size(), cells);
  }
}

TEST(SplitOff, LeavesWallsThatBow) {
  Seen seen([](double x_m) { return 2.0 + 0.03 * std::pow(x_m / 2.25 - 1, 2); });
  EXPECT_FALSE(seen.Split());
}

TEST(SplitOff, LeavesWhatTwoPlanesDoNotFitEither) {
  Seen seen([](double x_m) { return x_m < 1.8 ? 2.0 : x_m < 2.7 ? 2.3 : 2.0 + 0.4 * std::sin(5 * x_m); });
  EXPECT_FALSE(seen.Split());
}

// Points of a wall as seen from `at`, in the axes of the map.
Scan ScanOf(const Eigen::Vector3d& at, double from_m, double y_m, double stamp_s) {
  Scan scan;
  scan.stamp_s = stamp_s;
  for (double x = from_m; x < from_m + 3; x += 0.02) {
    for (double z = 0; z < 2; z += 0.05) scan.points.push_back((Eigen::Vector3d(x, y_m, z) - at).cast<float>());
  }
  return scan;
}

size_t NumWalls(const SGraph& graph) {
  size_t count = 0;
  for (const MapSurface& s : graph.surfaces) count += s.kind == SurfaceKind::kWall && !s.observations.empty();
  return count;
}

TEST(Mapper, PartsWallsWhenPosesThatHadLaidThemOnEachOtherArePutRight) {
  constexpr double kError_m = 0.1;
  Mapper mapper;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d at(0.5 * i + 0.6, 0, 1);
    Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
    T_odom_lidar.translation() = at - (i < 4 ? 0.0 : kError_m) * Eigen::Vector3d::UnitY();
    mapper.AddScan(i < 4 ? ScanOf(at, 0, 2.0, i) : ScanOf(at, 2.8, 2.0 + kError_m, i), T_odom_lidar);
  }
  mapper.Flush();
  ASSERT_EQ(NumWalls(mapper.graph()), 1u);
  const auto shift_later = [&](double y_m) {
    for (size_t i = 4; i < mapper.graph().keyframes.size(); ++i) mapper.mutable_graph().keyframes[i].T_map_kf.translation().y() += y_m;
    mapper.OnPosesChanged();
  };
  shift_later(kError_m);
  EXPECT_EQ(NumWalls(mapper.graph()), 2u);
  shift_later(0);
  EXPECT_EQ(NumWalls(mapper.graph()), 2u);
  shift_later(-kError_m);
  EXPECT_EQ(NumWalls(mapper.graph()), 1u);
}

}  // namespace
}  // namespace plumb::runtime
