#include "runtime/optimization/map_polish.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/mapping/plane_view.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

// Of the keyframes' positions against the truth, with the first one laid on it.
double Ate_m(const test::Drive& drive, const std::vector<Eigen::Isometry3d>& T_map_kf) {
  const Eigen::Isometry3d T_plan_map = drive.T_plan_kf[0] * T_map_kf[0].inverse();
  double sum_m2 = 0;
  for (size_t i = 0; i < T_map_kf.size(); ++i)
    sum_m2 += (T_plan_map * T_map_kf[i].translation() - drive.T_plan_kf[i].translation()).squaredNorm();
  return std::sqrt(sum_m2 / static_cast<double>(T_map_kf.size()));
}

std::vector<Eigen::Isometry3d> Poses(const SGraph& map) {
  std::vector<Eigen::Isometry3d> out;
  for (const Keyframe& k : map.keyframes) out.push_back(k.T_map_kf);
  return out;
}

TEST(PolishMap, TakesTheDriftOutWithoutAPlan) {
  test::DriveOptions options;
  options.drift_m = 0.01;
  options.drift_rad = 0.002;
  const test::Drive drive = test::DriveThroughHouse(test::MakeHouse(), options);
  const PolishResult polished = PolishMap(drive.map);
  ASSERT_TRUE(polished.converged) << polished.message;
  ASSERT_EQ(polished.T_map_kf.size(), drive.map.keyframes.size());
  const double drifted_m = Ate_m(drive, Poses(drive.map));
  EXPECT_GT(drifted_m, 0.03);
  EXPECT_LT(Ate_m(drive, polished.T_map_kf), drifted_m / 3);
}

TEST(PolishMap, MakesTheSurfacesThin) {
  const test::Drive drive = test::DriveThroughHouse(test::MakeHouse());
  const PolishResult polished = PolishMap(drive.map);
  ASSERT_TRUE(polished.converged);
  // Of the walls' points about the plane that fits them all.
  const auto thickness_m = [&](const std::vector<Eigen::Isometry3d>& T_map_kf) {
    double sum_m2 = 0;
    int walls = 0;
    for (const MapSurface& s : drive.map.surfaces) {
      PlaneStats all;
      for (const Observation& o : s.observations) all.Add(o.stats.Transformed(T_map_kf[o.keyframe]));
      if (s.kind != SurfaceKind::kWall || all.count() < 1000) continue;
      sum_m2 += ComputeMoments(all).var_normal;
      ++walls;
    }
    return std::sqrt(sum_m2 / walls);
  };
  EXPECT_LT(thickness_m(polished.T_map_kf), 0.021);  // points are drawn with 0.02
  EXPECT_LT(thickness_m(polished.T_map_kf), thickness_m(Poses(drive.map)));
}

TEST(PolishMap, HoldsTheFirstKeyframe) {
  const test::Drive drive = test::DriveThroughHouse(test::MakeHouse());
  const PolishResult polished = PolishMap(drive.map);
  ASSERT_TRUE(polished.converged);
  const Eigen::Isometry3d moved = drive.map.keyframes[0].T_map_kf.inverse() * polished.T_map_kf[0];
  EXPECT_LT(moved.translation().norm(), 1e-3);
  EXPECT_LT(std::abs(std::atan2(moved(1, 0), moved(0, 0))), 1e-3);
}

TEST(PolishMap, LeavesPosesWhereThereIsNothingToGoBy) {
  EXPECT_FALSE(PolishMap(SGraph()).usable);
  SGraph map;
  map.keyframes.resize(2);
  map.keyframes[1].T_map_kf.translation().x() = map.keyframes[1].T_odom_kf.translation().x() = 1;
  const PolishResult polished = PolishMap(map);
  ASSERT_EQ(polished.T_map_kf.size(), 2u);
  EXPECT_TRUE(polished.T_map_kf[1].isApprox(map.keyframes[1].T_map_kf, 1e-6));
}

}  // namespace
}  // namespace plumb::runtime
