#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runtime/sources/recording.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::runtime {
namespace {

StampedPose Pose(double stamp_s, double x_m, double yaw_rad) {
  StampedPose pose;
  pose.stamp_s = stamp_s;
  pose.T = Eigen::Translation3d(x_m, 2, 3) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  return pose;
}

Expected<Trajectory> Parse(const std::string& text) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(WriteFileAtomically(folder / "a.tum", text));
  return ReadTum(folder / "a.tum");
}

TEST(Tum, ReadsBackWhatItWrote) {
  const Trajectory trajectory = {Pose(1630577758.569489956, -1.25, 0.3), Pose(1630577759.068947077, 4, -3)};
  const Expected<Trajectory> read = Parse(WriteTum(trajectory));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*read)[i].stamp_s, trajectory[i].stamp_s);
    EXPECT_TRUE((*read)[i].T.isApprox(trajectory[i].T, 1e-6));
  }
}

TEST(Tum, SkipsCommentsAndBlankLines) {
  const Expected<Trajectory> read = Parse("# t x y z qx qy qz qw\n\n 1 2 3 4 0 0 0 1\r\n\t2 2 3 4 0 0 0 1");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->size(), 2u);
}

TEST(Tum, NamesTheBadLine) {
  for (const char* line : {"2 0 0 0 0 0 0", "2 0 0 0 0 0 0 1 7", "2 0 0 x 0 0 0 1", "2 0 0 nan 0 0 0 1",
                           "2 0 0 0 0 0 0 0", "0.5 0 0 0 0 0 0 1"}) {
    const Expected<Trajectory> read = Parse(std::string("1 0 0 0 0 0 0 1\n") + line + "\n");
    ASSERT_FALSE(read) << line;
    EXPECT_EQ(read.error().code, ErrorCode::kBadTrajectory);
    EXPECT_NE(read.error().message.find("line 2"), std::string::npos) << read.error().message;
  }
  EXPECT_EQ(ReadTum("/nonexistent.tum").error().code, ErrorCode::kFileNotFound);
}

TEST(Tum, TakesTheLaterOfTwoPosesAtOneTime) {
  const Expected<Trajectory> read = Parse("1 0 0 0 0 0 0 1\n1 5 0 0 0 0 0 1\n");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 1u);
  EXPECT_EQ((*read)[0].T.translation().x(), 5);
}

TEST(InterpolatePose, IsLinearInTranslationAndAngle) {
  const Trajectory trajectory = {Pose(10, 0, 0), Pose(10.4, 1, std::numbers::pi / 2)};
  const auto T = InterpolatePose(trajectory, 10.1);
  ASSERT_TRUE(T);
  EXPECT_TRUE(T->isApprox(Pose(0, 0.25, std::numbers::pi / 8).T, 1e-9));
  EXPECT_TRUE(InterpolatePose(trajectory, 10)->isApprox(trajectory[0].T));
  EXPECT_TRUE(InterpolatePose(trajectory, 10.4)->isApprox(trajectory[1].T));
}

TEST(InterpolatePose, GivesNothingOutsideOrInGaps) {
  const Trajectory trajectory = {Pose(10, 0, 0), Pose(11, 1, 0)};
  EXPECT_FALSE(InterpolatePose(trajectory, 9.99));
  EXPECT_FALSE(InterpolatePose(trajectory, 11.01));
  EXPECT_FALSE(InterpolatePose(trajectory, 10.5, 0.5));
  EXPECT_TRUE(InterpolatePose(trajectory, 10.5, 1.0));
  EXPECT_TRUE(InterpolatePose(trajectory, 11, 0.5));
  EXPECT_FALSE(InterpolatePose({}, 1));
}

}  // namespace
}  // namespace plumb::runtime
