#include "runtime/mapping/surface_splitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "runtime/mapping/mapper.h"
#include "runtime/optimization/map_polish.h"

namespace plumb::runtime {
namespace {

constexpr double kRoughness_m = 0.02, kWidth_m = 1.6, kHeight_m = 2;

// How far a surface stands out, towards where it is seen from, at (along, across).
using Relief = std::function<double(double u_m, double v_m)>;

// Which way a surface lies: seen along its normal.
struct Facing {
  SurfaceKind kind;
  Eigen::Vector3d u, v, normal;
};
const Facing kWall = {SurfaceKind::kWall, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY()};
const Facing kFloor = {SurfaceKind::kFloor, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};

// A keyframe's view of 1.6 m x 2 m of a surface; the keyframe keeps a point of each cell.
TrackedSurface View(Keyframe& keyframe, const Facing& f, double u_m, double v_m, const Relief& relief) {
  Segment segment;
  segment.kind = f.kind;
  int i = 0;
  for (double u = u_m + 0.05; u < u_m + kWidth_m; u += 0.1) {
    for (double v = v_m + 0.05; v < v_m + kHeight_m; v += 0.1) {
      const Eigen::Vector3d p = u * f.u + v * f.v + relief(u, v) * f.normal;
      for (int k = 0; k < 4; ++k, ++i) segment.stats.Add(p + (i % 2 == 0 ? kRoughness_m : -kRoughness_m) * f.normal);
      segment.cells.push_back(p.cast<float>());
      keyframe.points.push_back(p.cast<float>());
    }
  }
  const auto lean = [&](double to_u, double to_v) { return relief(u_m + to_u, v_m + to_v) - relief(u_m, v_m); };
  const Eigen::Vector3d n = f.normal - lean(kWidth_m, 0) / kWidth_m * f.u - lean(0, kHeight_m) / kHeight_m * f.v;
  segment.plane.n = n.normalized();
  segment.plane.d = -segment.plane.n.dot(segment.stats.centroid());
  return SurfaceOf(segment, keyframe);
}

using Starts = std::vector<Eigen::Vector2d>;  // of each view
const Starts kAlong = {{0, 0}, {0.2, 0}, {0.4, 0}, {2.6, 0}, {2.8, 0}, {3, 0}};
const Starts kAcross = {{0, 0}, {0, 0.2}, {0, 0.4}, {0, 2.8}, {0, 3}, {0, 3.2}};

// Views taken for one surface.
struct Seen {
  std::vector<Keyframe> keyframes;
  TrackedSurface surface;

  explicit Seen(const Relief& relief, const Facing& facing = kWall, const Starts& starts = kAlong)
      : keyframes(starts.size()), surface(At(0, relief, facing, starts)) {
    for (uint32_t i = 1; i < keyframes.size(); ++i) {
      Absorb(At(i, relief, facing, starts), keyframes, &surface.surface, &surface.track);
    }
  }
  std::optional<TrackedSurface> Split() { return SplitOff(keyframes, MapperOptions(), &surface.surface, &surface.track); }
  [[nodiscard]] uint64_t num_views() const { return NumViews(surface); }
  static uint64_t NumViews(const TrackedSurface& s) {
    return std::accumulate(s.track.patch.views().begin(), s.track.patch.views().end(), uint64_t{0});
  }

 private:
  TrackedSurface At(uint32_t i, const Relief& relief, const Facing& facing, const Starts& starts) {
    keyframes[i].id = i;
    return View(keyframes[i], facing, starts[i].x(), starts[i].y(), relief);
  }
};

std::vector<uint32_t> KeyframesOf(const MapSurface& s) {
  std::vector<uint32_t> out;
  for (const Observation& o : s.observations) out.push_back(o.keyframe);
  return out;
}

// Of three views each, with their cells, counts and points and no other's.
void ExpectHalves(const Facing& facing, const Starts& starts, const Relief& relief) {
  Seen seen(relief, facing, starts);
  const uint64_t num_views = seen.num_views();
  const double num_points = seen.surface.surface.num_points;
  const std::optional<TrackedSurface> other = seen.Split();
  ASSERT_TRUE(other);
  EXPECT_EQ(KeyframesOf(seen.surface.surface), (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(KeyframesOf(other->surface), (std::vector<uint32_t>{3, 4, 5}));
  EXPECT_EQ(Seen::NumViews(seen.surface) + Seen::NumViews(*other), num_views);
  EXPECT_DOUBLE_EQ(seen.surface.surface.num_points + other->surface.num_points, num_points);
  for (const TrackedSurface* part : std::array<const TrackedSurface*, 2>{&seen.surface, &*other}) {
    EXPECT_NEAR(part->surface.area_m2, &starts == &kAlong ? 4.0 : 3.84, 0.1);
    EXPECT_LE(*std::max_element(part->track.patch.views().begin(), part->track.patch.views().end()), 3u);
    for (const Observation& o : part->surface.observations) {
      EXPECT_LT(std::abs(part->surface.plane.SignedDistance(o.stats.centroid())), 0.004);
    }
  }
  EXPECT_TRUE(LieOnTwoPlanes(seen.surface.surface, other->surface, seen.keyframes, {})) << "or they would merge again";
  EXPECT_FALSE(seen.Split()) << "what is left lies on one plane";
}

TEST(SplitOff, SplitsWallsAtAStep) {
  ExpectHalves(kWall, kAlong, [](double u_m, double) { return u_m < 2.3 ? 0.0 : 0.12; });
  ExpectHalves(kWall, kAlong, [](double u_m, double) { return u_m < 2.3 ? 0.0 : -0.06; });
}

TEST(SplitOff, SplitsWallsAtABend) {
  ExpectHalves(kWall, kAlong, [](double u_m, double) { return u_m < 2.3 ? 0.0 : 0.15 * (u_m - 2.3); });
}

TEST(SplitOff, SplitsFloorsAtStepsAndBendsInEitherDirection) {
  ExpectHalves(kFloor, kAlong, [](double u_m, double) { return u_m < 2.3 ? 0.0 : 0.12; });
  ExpectHalves(kFloor, kAlong, [](double u_m, double) { return u_m < 2.3 ? 0.0 : 0.15 * (u_m - 2.3); });
  ExpectHalves(kFloor, kAcross, [](double, double v_m) { return v_m < 2.6 ? 0.0 : 0.12; });
  ExpectHalves(kFloor, kAcross, [](double, double v_m) { return v_m < 2.6 ? 0.0 : 0.15 * (v_m - 2.6); });
}

TEST(SplitOff, SplitsANicheFromTheWallOnBothSidesOfIt) {
  const auto in_niche = [](double u_m) { return u_m > 1.9 && u_m < 3.7; };
  Seen seen([&](double u_m, double) { return in_niche(u_m) ? -0.12 : 0.0; }, kWall, {{0, 0}, {0.2, 0}, {2, 0}, {2, 0}, {3.8, 0}, {4, 0}});
  const std::optional<TrackedSurface> other = seen.Split();
  ASSERT_TRUE(other);
  EXPECT_EQ(KeyframesOf(seen.surface.surface), (std::vector<uint32_t>{0, 1, 4, 5}));
  EXPECT_EQ(KeyframesOf(other->surface), (std::vector<uint32_t>{2, 3}));
}

void ExpectLeft(const char* why, const Relief& relief, const Starts& starts = kAlong) {
  Seen seen(relief, kWall, starts);
  const size_t cells = seen.surface.surface.cells.size();
  EXPECT_FALSE(seen.Split()) << why;
  EXPECT_EQ(seen.surface.surface.observations.size(), starts.size());
  EXPECT_EQ(seen.surface.surface.cells.size(), cells);
}

TEST(SplitOff, LeavesWhatOnePlaneFitsOrNoTwoDo) {
  for (const double step_m : {0.0, 0.02, 0.04}) {
    ExpectLeft("a step that merges", [&](double u_m, double) { return u_m < 2.3 ? 0.0 : step_m; });
  }
  ExpectLeft("a bow", [](double u_m, double) { return 0.03 * std::pow(u_m / 2.3 - 1, 2); });
  ExpectLeft("no plane", [](double u_m, double) { return u_m < 1.8 ? 0.0 : u_m < 2.7 ? 0.3 : 0.4 * std::sin(5 * u_m); });
  ExpectLeft("one view only", [](double u_m, double) { return u_m < 2.3 ? 0.0 : 0.12; }, {{0, 0}, {0.1, 0}, {0.2, 0}, {0.3, 0}, {2.5, 0}});
}

// One wall hides the other: a pose is wrong, or a thing has moved.
TEST(SplitOff, LeavesWhatWasSeenInTheSamePlace) {
  for (const double off_m : {0.12, 0.3}) {
    int view = 0;
    const Relief moved = [&](double u_m, double v_m) {
      view += u_m == 0.05 && v_m == 0.05;
      return view > 3 ? off_m : 0.0;
    };
    ExpectLeft("poses differ", moved, Starts(6, Eigen::Vector2d(0, 0)));
  }
}

// Whatever the relief: what splits would not merge at once, nor would what merges split.
TEST(SplitOff, SplitsOnlyWhatWouldNotMerge) {
  size_t split = 0;
  for (int i = 0; i <= 120; ++i) {
    const double step_m = 0.002 * (i % 61), lean = i < 61 ? 0.0 : 0.003 * (i - 61);
    Seen seen([&](double u_m, double) { return u_m < 2.3 ? 0.0 : (i < 61 ? step_m : 0) + lean * (u_m - 2.3); });
    const std::optional<TrackedSurface> other = seen.Split();
    if (!other) continue;
    ++split;
    MapperOptions wider;
    wider.merge_distance_m *= 1.1;
    EXPECT_TRUE(std::isinf(SurfaceDistance(seen.surface.track.patch, other->track.patch, wider)) ||
                !FitOnePlane(seen.surface.track, other->track, wider))
        << step_m << " " << lean;
  }
  EXPECT_GT(split, 40u);
  EXPECT_LT(split, 110u);
}

// A wall at y = 2 m that steps back by 12 cm at x = 6 m, as seen from `at`, in the axes of the map.
constexpr double kStep_m = 0.12, kStepAt_m = 6;
Scan ScanOf(const Eigen::Vector3d& at, double from_m, double to_m, double stamp_s) {
  Scan scan;
  scan.stamp_s = stamp_s;
  for (double x = from_m; x < to_m; x += 0.02) {
    for (double z = 0; z < 2; z += 0.05) {
      scan.points.push_back((Eigen::Vector3d(x, x < kStepAt_m ? 2.0 : 2.0 + kStep_m, z) - at).cast<float>());
    }
  }
  return scan;
}

// Twelve scans of the long wall, then four of the short one behind the step, which odometry lays on the long one's plane.
struct SteppedWall {
  Mapper mapper;
  int scans = 0;

  SteppedWall() {
    for (int i = 0; i < 12; ++i) Add(0.55 * i + 0.3, std::max(0.0, 0.4 * i - 0.5), std::min(kStepAt_m, 0.4 * i + 2));
    for (int i = 0; i < 4; ++i) Add(0.55 * i + 6.9, kStepAt_m, kStepAt_m + 1.2);
    mapper.Flush();
  }
  // As seen from (x, 0, 1), where odometry is off by the step from the short wall's first scan on.
  void Add(double x_m, double from_m, double to_m) {
    const Eigen::Vector3d at(x_m, 0, 1);
    Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
    T_odom_lidar.translation() = at - (scans < 12 ? 0.0 : kStep_m) * Eigen::Vector3d::UnitY();
    mapper.AddScan(ScanOf(at, from_m, to_m, scans++), T_odom_lidar);
  }
  std::vector<SurfaceSplit> ShiftLater(double y_m, bool settled = false) {
    for (size_t i = 12; i < mapper.graph().keyframes.size(); ++i) mapper.mutable_graph().keyframes[i].T_map_kf.translation().y() += y_m;
    return mapper.OnPosesChanged(settled);
  }
  [[nodiscard]] std::vector<MapSurface> Walls() const {
    std::vector<MapSurface> out;
    for (const MapSurface& s : mapper.graph().surfaces) {
      if (!s.observations.empty()) out.push_back(s);
    }
    return out;
  }
};

void ExpectBothWalls(const SteppedWall& seen, size_t long_views, size_t short_views) {
  const std::vector<MapSurface> walls = seen.Walls();
  ASSERT_EQ(walls.size(), 2u);
  const bool first_is_long = walls[0].length_m() > walls[1].length_m();
  const MapSurface &a = walls[first_is_long ? 0 : 1], &b = walls[first_is_long ? 1 : 0];
  EXPECT_EQ(a.observations.size(), long_views);
  EXPECT_EQ(b.observations.size(), short_views);
  EXPECT_NEAR(a.length_m(), 6, 0.15) << long_views;
  EXPECT_NEAR(b.length_m(), 1.2, 0.2);
  EXPECT_NEAR(a.area_m2, 12, 0.8);
  EXPECT_NEAR(b.area_m2, 2.4, 0.3);
  EXPECT_NEAR(b.start.y() - a.start.y(), kStep_m, 0.02);
}

TEST(Mapper, SplitsWallsWhenPosesThatHadLaidThemOnEachOtherArePutRight) {
  SteppedWall seen;
  ASSERT_EQ(seen.Walls().size(), 1u);
  EXPECT_EQ(seen.ShiftLater(kStep_m).size(), 1u);
  ExpectBothWalls(seen, 12, 4);
  for (int i = 0; i < 10; ++i) seen.Add(0.55 * i + 2.3, 0, kStepAt_m + 1.2);
  seen.mapper.Flush();
  const PolishResult polished = PolishMap(seen.mapper.graph());
  ASSERT_TRUE(polished.usable);
  for (size_t i = 0; i < polished.T_map_kf.size(); ++i) seen.mapper.mutable_graph().keyframes[i].T_map_kf = polished.T_map_kf[i];
  EXPECT_TRUE(seen.mapper.OnPosesChanged(true).empty());
  size_t merged = 0;
  for (const Keyframe& keyframe : seen.mapper.graph().keyframes) merged += keyframe.merged.has_value();
  EXPECT_EQ(merged, 0u);
  ExpectBothWalls(seen, 22, 14);
}

TEST(Mapper, SplitsAndMergesAsPosesSayInTheSameSlots) {
  SteppedWall seen;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(seen.ShiftLater(kStep_m).size(), 1u);
    EXPECT_EQ(seen.Walls().size(), 2u);
    EXPECT_TRUE(seen.ShiftLater(0).empty());
    EXPECT_EQ(seen.Walls().size(), 2u);
    EXPECT_TRUE(seen.ShiftLater(-kStep_m).empty());
    EXPECT_EQ(seen.Walls().size(), 1u);
  }
  EXPECT_EQ(seen.mapper.graph().surfaces.size(), 2u);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(seen.mapper.graph().surfaces[i].id, i);
}

size_t NumWalls(const SGraph& map) {
  return static_cast<size_t>(
      std::count_if(map.surfaces.begin(), map.surfaces.end(), [](const MapSurface& s) { return !s.observations.empty(); }));
}

// Four pieces of one wall, each seen from four keyframes, are brought now to one plane, now to four. With the same poses again
// nothing splits, so nothing can split and merge in turn.
TEST(Mapper, SplitsNothingTwiceWithTheSamePoses) {
  std::mt19937 rng(1);
  const auto within = [&](double limit) { return limit * (static_cast<double>(rng() >> 8) / static_cast<double>(1u << 23) - 1); };
  Mapper mapper;
  for (int i = 0; i < 16; ++i) {
    const Eigen::Vector3d at(0.55 * i, 0, 1);
    Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
    T_odom_lidar.translation() = at;
    mapper.AddScan(ScanOf(at, 1.4 * (i / 4), 1.4 * (i / 4) + 1.4, i), T_odom_lidar);
  }
  mapper.Flush();
  ASSERT_EQ(mapper.graph().keyframes.size(), 16u);
  size_t num_splits = 0, num_merges = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Eigen::Isometry3d group = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 16; ++i) {
      if (i % 4 == 0) {
        const Eigen::Translation3d middle(1.4 * (i / 4) + 0.7, 2 + within(0.05), 0);
        group = middle * Eigen::AngleAxisd(within(0.04), Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-middle.x(), -2, 0);
      }
      Eigen::Isometry3d& T_map_kf = mapper.mutable_graph().keyframes[static_cast<size_t>(i)].T_map_kf;
      T_map_kf = group * mapper.graph().keyframes[static_cast<size_t>(i)].T_odom_kf;
      T_map_kf.translation().y() += within(0.01);
    }
    const size_t before = NumWalls(mapper.graph());
    const size_t splits = mapper.OnPosesChanged().size();
    num_splits += splits;
    num_merges += before + splits - NumWalls(mapper.graph());
    for (int again = 0; again < 3; ++again) EXPECT_TRUE(mapper.OnPosesChanged().empty()) << "trial " << trial;
  }
  EXPECT_GT(num_splits, 20u);
  EXPECT_GT(num_merges, 20u);
}

}  // namespace
}  // namespace plumb::runtime
