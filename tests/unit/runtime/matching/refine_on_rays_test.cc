#include "runtime/matching/refine_on_rays.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

class RefineOnRaysInTheHouse : public ::testing::Test {
 protected:
  const AGraph house_ = test::MakeHouse();
  const PlanIndex plan_{house_};
  MapView view_ = ViewMap(MakeSyntheticMap(house_, test::OnTour(test::kFromA, test::UprightPose(0, 0, 0, 0))), MatcherOptions());

  // Some way beside where the map lies.
  [[nodiscard]] WallFit Beside(double information) const {
    WallFit fit;
    fit.pose.t_m = view_.center_m + Eigen::Vector2d(0.22, -0.13);
    fit.pose.yaw_rad = 0.03;
    fit.information = information * Eigen::Matrix3d::Identity();
    return fit;
  }

  void ExpectFound(const PlanarPose& pose) const {
    EXPECT_LT((pose.t_m - view_.center_m).norm(), 0.04);
    EXPECT_LT(std::abs(pose.yaw_rad), 0.005);
  }
};

TEST_F(RefineOnRaysInTheHouse, FindsThePlaceThatWallsLeaveOpen) { ExpectFound(RefineOnRays(plan_, view_, Beside(0), MatcherOptions())); }

TEST_F(RefineOnRaysInTheHouse, LeavesItToAMajorityOfWalls) {
  const WallFit fit = Beside(1e6);
  const PlanarPose pose = RefineOnRays(plan_, view_, fit, MatcherOptions());
  EXPECT_EQ(pose.t_m, fit.pose.t_m);
  EXPECT_EQ(pose.yaw_rad, fit.pose.yaw_rad);
}

TEST_F(RefineOnRaysInTheHouse, DoesNotTrustTheWallsOfAPlanarLaser) {
  view_.planar = true;
  ExpectFound(RefineOnRays(plan_, view_, Beside(1e6), MatcherOptions()));
}

}  // namespace
}  // namespace plumb::runtime
