#include "runtime/sources/recording.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::runtime {
namespace {

class RecordingFolder : public testing::Test {
 protected:
  RecordingFolder() { std::filesystem::create_directories(folder_ / "scans"); }
  void AddScan(const std::string& name, float x_m) {
    Scan scan;
    scan.points = {{x_m, 0, 0}};
    ASSERT_TRUE(WritePcd(scan, folder_ / ("scans/" + name)));
  }

  test::TemporaryFolder folder_;
};

TEST(ScanFileName, PadsToTenAndNineDigits) {
  EXPECT_EQ(ScanFileName(12.3), "0000000012.300000000.pcd");
  EXPECT_EQ(ScanFileName(0), "0000000000.000000000.pcd");
  EXPECT_EQ(ScanFileName(1630577758.569489956), "1630577758.569489956.pcd");
}

TEST_F(RecordingFolder, ReadsScansInTimeOrderWithExactStamps) {
  AddScan("1630577759.068947077.pcd", 2);
  AddScan("1630577758.569489956.pcd", 1);
  const Expected<Recording> recording = Recording::Open(folder_.path());
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->size(), 2u);
  EXPECT_EQ(recording->stamp_s(0), 1630577758.569489956);
  EXPECT_EQ(ScanFileName(recording->stamp_s(1)), "1630577759.068947077.pcd");
  const Expected<Scan> scan = recording->Read(0);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->stamp_s, recording->stamp_s(0));
  EXPECT_EQ(scan->points[0].x(), 1.0f);
  EXPECT_TRUE(recording->odometry().empty());
}

// As some drivers write them.
TEST_F(RecordingFolder, TakesTheFirstPointForTheStampWhereThatIsTheSweepsEnd) {
  Scan scan;
  scan.points = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  scan.time_s = {-0.1f, -0.05f, 0.0f};
  ASSERT_TRUE(WritePcd(scan, folder_ / "scans/0000000012.500000000.pcd"));
  const Expected<Recording> recording = Recording::Open(folder_.path());
  ASSERT_TRUE(recording);
  const Expected<Scan> read = recording->Read(0);
  ASSERT_TRUE(read);
  EXPECT_NEAR(read->stamp_s, 12.4, 1e-6);
  ASSERT_EQ(read->time_s.size(), 3u);
  EXPECT_EQ(read->time_s[0], 0.0f);
  EXPECT_NEAR(read->time_s[1], 0.05, 1e-6);
  EXPECT_NEAR(read->time_s[2], 0.1, 1e-6);
}

TEST_F(RecordingFolder, ReadsOdometryButNoTruth) {
  AddScan("0000000001.000000000.pcd", 1);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "odometry.tum", std::string_view("1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n")));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "truth.tum", std::string_view("not a trajectory\n")));
  const Expected<Recording> recording = Recording::Open(folder_.path());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->odometry().size(), 2u);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "odometry.tum", std::string_view("broken\n")));
  EXPECT_EQ(Recording::Open(folder_.path()).error().code, ErrorCode::kBadTrajectory);
}

TEST_F(RecordingFolder, RefusesFoldersWithoutScans) {
  EXPECT_EQ(Recording::Open(folder_.path()).error().code, ErrorCode::kNotARecording);
  EXPECT_EQ(Recording::Open("/nonexistent").error().code, ErrorCode::kNotARecording);
  AddScan("cloud.pcd", 1);
  EXPECT_EQ(Recording::Open(folder_.path()).error().code, ErrorCode::kNotARecording);
}

TEST_F(RecordingFolder, GoesOnPastFaultsForThoseWhoLookForThem) {
  AddScan("0000000001.000000000.pcd", 1);
  AddScan("cloud.pcd", 2);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "odometry.tum", std::string_view("broken\n")));
  std::vector<Error> faults;
  const Expected<Recording> recording = Recording::OpenWithFaults(folder_.path(), faults);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->size(), 1u);
  EXPECT_TRUE(recording->odometry().empty());
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_NE(faults[0].message.find("cloud.pcd"), std::string::npos);
  EXPECT_EQ(faults[1].code, ErrorCode::kBadTrajectory);
  EXPECT_EQ(Recording::Open(folder_.path()).error().message, faults[0].message);
}

struct Case {
  const char* folder;
  size_t scans;
  size_t first_scan_points;
  bool odometry;
};

class RecordingOfOthers : public testing::TestWithParam<Case> {};

TEST_P(RecordingOfOthers, IsRead) {
  const std::string folder = std::string(PLUMB_SOURCE_DIR "/../shared/data/lidar/") + GetParam().folder;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared recordings are absent";
  const Expected<Recording> recording = Recording::Open(folder);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->size(), GetParam().scans);
  EXPECT_EQ(!recording->odometry().empty(), GetParam().odometry);
  const Expected<Scan> first = recording->Read(0);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->points.size(), GetParam().first_scan_points);
  for (size_t i = 0; i < recording->size(); ++i) {
    const Expected<Scan> scan = recording->Read(i);
    ASSERT_TRUE(scan) << scan.error().message;
    ASSERT_FALSE(scan->points.empty());
    for (const Eigen::Vector3f& p : scan->points) ASSERT_LT(p.norm(), 200.0f);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RecordingOfOthers,
                         testing::Values(Case{"hilti_uzh_run2", 89, 24484, false}, Case{"fr079", 1464, 360, true}));

}  // namespace
}  // namespace plumb::runtime
