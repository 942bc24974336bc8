// A planar laser with bad wheels through a real building, against its surveyed-by-SLAM poses.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <vector>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {
namespace {

struct Placed {
  size_t keyframe;
  Eigen::Isometry3d T_odom_lidar;
  Eigen::Vector3d truth;
};

double RmsAfterAlignment(const std::vector<Placed>& placed, const std::vector<Keyframe>& keyframes) {
  Eigen::Matrix3Xd estimated(3, placed.size()), truth(3, placed.size());
  for (size_t i = 0; i < placed.size(); ++i) {
    const Keyframe& keyframe = keyframes[placed[i].keyframe];
    const auto column = static_cast<Eigen::Index>(i);
    estimated.col(column) = keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * placed[i].T_odom_lidar.translation();
    truth.col(column) = placed[i].truth;
  }
  const Eigen::Isometry3d T(Eigen::umeyama(estimated, truth, false));
  return std::sqrt(((T * estimated) - truth).colwise().squaredNorm().mean());
}

double MapError(const std::string& folder, bool with_wheels) {
  const Expected<Recording> recording = Recording::Open(folder);
  const Expected<Trajectory> truth = ReadTum(folder + "/truth.tum"), wheels = ReadTum(folder + "/odometry.tum");
  if (!recording || !truth || !wheels) return INFINITY;
  Odometry odometry;
  Mapper mapper;
  std::vector<Placed> placed;
  int failed = 0;
  for (size_t i = 0; i < recording->size(); ++i) {
    const Expected<Scan> scan = recording->Read(i);
    if (!scan) return INFINITY;
    std::optional<Odometry::GivenMotion> given;
    const std::optional<Eigen::Isometry3d> wheel = InterpolatePose(*wheels, scan->stamp_s), at = InterpolatePose(*truth, scan->stamp_s);
    if (with_wheels && wheel) given = {*wheel, *wheel};
    const OdometryResult r = odometry.Register(*scan, given);
    failed += r.ok ? 0 : 1;
    if (r.ok) mapper.AddScan(r.deskewed, r.T_odom_lidar, r.step_covariance);
    if (at && r.ok)
      placed.push_back({mapper.graph().keyframes.empty() ? 0 : mapper.graph().keyframes.size() - 1, r.T_odom_lidar, at->translation()});
  }
  mapper.Flush();
  EXPECT_LE(failed, with_wheels ? 2 : 20);
  EXPECT_GT(placed.size(), 1400u);
  return RmsAfterAlignment(placed, mapper.graph().keyframes);
}

TEST(PlanarRecording, Freiburg079WithBadWheelsAndWithout) {
  const std::string folder = PLUMB_SOURCE_DIR "/../shared/data/lidar/fr079";
  if (!std::filesystem::exists(folder + "/truth.tum")) GTEST_SKIP() << "the recording fr079 is not there";
  EXPECT_LT(MapError(folder, true), 0.10);
  EXPECT_LT(MapError(folder, false), 0.15);
}

}  // namespace
}  // namespace plumb::runtime
