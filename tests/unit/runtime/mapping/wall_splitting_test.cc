#include "runtime/mapping/wall_splitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>

#include "runtime/mapping/mapper.h"

namespace plumb::runtime {
namespace {

using Shape = std::function<double(double along_m)>;

std::vector<WallColumn> Columns(double length_m, const Shape& shape, double noise_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_m);
  std::vector<WallColumn> columns;
  for (double along_m = 0; along_m < length_m; along_m += kColumn_m)
    columns.push_back({along_m, shape(along_m) + noise(random), noise_m * noise_m});
  return columns;
}

TEST(FindCut, FindsAStepWhereItIs) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::optional<double> cut = FindCut(Columns(
        6, [](double u) { return u < 2.5 ? 0 : 0.03; }, 0.004, seed));
    ASSERT_TRUE(cut) << seed;
    EXPECT_NEAR(*cut, 2.5, 0.21) << seed;
  }
}

TEST(FindCut, FindsABend) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::optional<double> cut = FindCut(Columns(
        6, [](double u) { return u < 3 ? 0 : 0.05 * (u - 3); }, 0.004, seed));
    ASSERT_TRUE(cut) << seed;
    EXPECT_NEAR(*cut, 3, 0.61) << seed;
  }
}

TEST(FindCut, LeavesWholeWhatIsOneWall) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    EXPECT_FALSE(FindCut(Columns(
        8, [](double u) { return 0.02 * u; }, 0.004, seed)))
        << "askew to its plane";
    EXPECT_FALSE(FindCut(Columns(
        8, [](double u) { return u > 3 && u < 4.1 ? -0.05 : 0; }, 0.004, seed)))
        << "a doorway's leaf";
    EXPECT_FALSE(FindCut(Columns(
        8, [](double u) { return u > 7.3 ? 0.06 : 0; }, 0.004, seed)))
        << "a box at its end";
    EXPECT_FALSE(FindCut(Columns(
        8, [](double u) { return u < 4 ? 0 : 0.008; }, 0.004, seed)))
        << "a step within what plaster has";
  }
  EXPECT_FALSE(FindCut({}));
}

// Seen by two keyframes: 3 m of wall at y = 0 and, from x = 3 on, 3 m at y = step_m, 2 m high, as one surface.
struct Stepped {
  std::vector<Keyframe> keyframes;
  std::optional<TrackedSurface> wall;
};
Stepped SteppedWall(double step_m, double noise_m) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, noise_m);
  Stepped out;
  for (uint32_t k = 0; k < 2; ++k) {
    Keyframe& keyframe = out.keyframes.emplace_back();
    keyframe.id = k;
    keyframe.T_map_kf = Eigen::Translation3d(1.0 + 3 * k, -3, 1) * Eigen::AngleAxisd(0.5 * k, Eigen::Vector3d::UnitZ());
    Segment segment;
    for (double x_m = 0.025; x_m < 6; x_m += 0.05) {
      for (double z_m = 0.025; z_m < 2; z_m += 0.05) {
        const Eigen::Vector3d p(x_m, (x_m > 3 ? step_m : 0) + noise(random), z_m);
        const Eigen::Vector3d p_kf = keyframe.T_map_kf.inverse() * p;
        keyframe.points.push_back(p_kf.cast<float>());
        segment.stats.Add(p_kf);
        segment.cells.push_back(p_kf.cast<float>());
      }
    }
    segment.plane = Plane{-Eigen::Vector3d::UnitY(), 0.5 * step_m}.Transformed(keyframe.T_map_kf.inverse());
    const TrackedSurface seen = SurfaceOf(segment, keyframe);
    if (k == 0) {
      out.wall = seen;
    } else {
      Absorb(seen, out.keyframes, &out.wall->surface, &out.wall->track);
    }
  }
  return out;
}

TEST(CutWall, GivesEachPieceItsPlaneAndItsShareOfEachView) {
  Stepped seen = SteppedWall(0.04, 0.03);
  const std::optional<double> cut = FindCut(ColumnsOf(seen.wall->surface, seen.wall->track, seen.keyframes, {}));
  ASSERT_TRUE(cut);
  const double points = seen.wall->surface.num_points;
  const std::optional<TrackedSurface> beyond = CutWall(*cut, seen.keyframes, {}, &seen.wall->surface, &seen.wall->track);
  ASSERT_TRUE(beyond);
  for (const MapSurface* piece : std::initializer_list<const MapSurface*>{&seen.wall->surface, &beyond->surface}) {
    const Eigen::Vector2d middle = 0.5 * (piece->start + piece->end);
    EXPECT_NEAR(middle.x(), middle.x() < 3 ? 1.5 : 4.5, 0.15);
    EXPECT_NEAR(piece->length_m(), 3, 0.25);
    EXPECT_NEAR(piece->plane.SignedDistance({middle.x(), 0, 1}), middle.x() < 3 ? 0 : 0.04, 0.003);
    EXPECT_LT(std::abs(piece->plane.n.x()), 0.003);
    EXPECT_EQ(piece->observations.size(), 2u);
  }
  EXPECT_NEAR(seen.wall->surface.num_points + beyond->surface.num_points, points, 0.02 * points);
}

TEST(CutWall, ChangesNothingIfAPieceWouldBeTooSmall) {
  Stepped seen = SteppedWall(0.04, 0.03);
  const double points = seen.wall->surface.num_points;
  const double end_m = seen.wall->track.patch.hi().x() - 0.2;
  EXPECT_FALSE(CutWall(end_m, seen.keyframes, {}, &seen.wall->surface, &seen.wall->track));
  EXPECT_EQ(seen.wall->surface.num_points, points);
}

// At each step of half a metre along it, one noisy scan of a wall in 2.5 m that steps back by 2.5 cm at y = 0.
Mapper MapOfSteppedWall() {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0, 0.03);
  Mapper mapper;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Isometry3d T_odom_lidar(Eigen::Translation3d(0, -1.5 + 0.6 * k, 1));
    Scan scan;
    scan.stamp_s = k;
    for (double y_m = -2.975; y_m < 3; y_m += 0.05) {
      for (double z_m = 0.025; z_m < 2; z_m += 0.05) {
        const Eigen::Vector3d p(2.5 + (y_m > 0 ? 0.025 : 0) + noise(random), y_m, z_m);
        scan.points.push_back((T_odom_lidar.inverse() * p).cast<float>());
      }
    }
    mapper.AddScan(scan, T_odom_lidar);
  }
  mapper.Flush();
  return mapper;
}

size_t NumSurfaces(const SGraph& graph) {
  return static_cast<size_t>(
      std::count_if(graph.surfaces.begin(), graph.surfaces.end(), [](const MapSurface& s) { return !s.observations.empty(); }));
}

TEST(MapperSplitWalls, TellsFromAllViewsWhatNoneTells) {
  Mapper mapper = MapOfSteppedWall();
  ASSERT_EQ(NumSurfaces(mapper.graph()), 1u);
  mapper.SplitWalls();
  ASSERT_EQ(NumSurfaces(mapper.graph()), 2u);
  for (const MapSurface& piece : mapper.graph().surfaces) {
    const double middle_m = 0.5 * (piece.start.y() + piece.end.y());
    EXPECT_NEAR(piece.plane.SignedDistance({2.5, middle_m, 1}), middle_m < 0 ? 0 : 0.025, 0.003);
    EXPECT_LT(std::abs(piece.plane.n.y()), 0.003);
  }
  mapper.SplitWalls();
  mapper.OnPosesChanged(true);
  EXPECT_EQ(NumSurfaces(mapper.graph()), 2u) << "joined again, or cut once more";
}

}  // namespace
}  // namespace plumb::runtime
