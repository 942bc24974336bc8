// Odometry beside PCL's GICP and NDT, on one recording, scan by scan in turn: time per scan and error.
//   odometry_peers REC [LEAF_M]
// The peers register each scan, its motion during the sweep taken out with their last step, to the last scan that was at least half a metre
// or 15 degrees away, starting from constant velocity. Their poses are of the middle of the sweep: with those of its start, a step taken
// too long shifts the next one, and constant velocity does not settle. They get clouds thinned to LEAF_M, 0.1 m unless told: coarser ones
// are faster and drift more. Plumb thins on its own. All on one thread.
#include <fmt/core.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/odometry/odometry.h"
#include "runtime/sources/recording.h"

namespace {

using namespace plumb::runtime;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Eigen::Isometry3d;

constexpr double kPeriod_s = 0.1;  // of a sweep

// Scans in, poses out, each in a frame of its own.
class Subject {
 public:
  virtual ~Subject() = default;
  [[nodiscard]] virtual std::string Name() const = 0;
  // The pose at sample_s() after the scan's stamp.
  virtual Isometry3d Register(const Scan& scan) = 0;
  [[nodiscard]] virtual double sample_s() const { return 0; }
};

class Plumb : public Subject {
 public:
  std::string Name() const override { return "Plumb"; }
  Isometry3d Register(const Scan& scan) override { return odometry_.Register(scan, std::nullopt).T_odom_lidar; }

 private:
  Odometry odometry_;
};

class Peer : public Subject {
 public:
  Peer(std::string name, float leaf_m, std::shared_ptr<pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>> registration)
      : name_(std::move(name)), leaf_m_(leaf_m), registration_(std::move(registration)) {}
  std::string Name() const override { return name_; }
  double sample_s() const override { return 0.5 * kPeriod_s; }

  Isometry3d Register(const Scan& scan) override {
    const Cloud::Ptr cloud = Thinned(scan);
    if (!keyframe_) {
      SetKeyframe(cloud);
      return pose_;
    }
    const Isometry3d guess = T_odom_keyframe_.inverse() * pose_ * step_;
    Cloud aligned;
    registration_->setInputSource(cloud);
    registration_->align(aligned, guess.matrix().cast<float>());
    Isometry3d T_keyframe_lidar = guess;
    if (registration_->hasConverged()) {
      const Eigen::Matrix4d found = registration_->getFinalTransformation().template cast<double>();
      T_keyframe_lidar.translation() = found.topRightCorner<3, 1>();
      T_keyframe_lidar.linear() = Eigen::Quaterniond(found.topLeftCorner<3, 3>()).normalized().toRotationMatrix();
    }
    const Isometry3d pose = T_odom_keyframe_ * T_keyframe_lidar;
    step_ = pose_.inverse() * pose;
    pose_ = pose;
    if (T_keyframe_lidar.translation().norm() > 0.5 || Eigen::AngleAxisd(T_keyframe_lidar.linear()).angle() > 0.26) SetKeyframe(cloud);
    return pose_;
  }

 private:
  Cloud::Ptr Thinned(const Scan& scan) const {
    const auto whole = std::make_shared<Cloud>(), out = std::make_shared<Cloud>();
    const Eigen::AngleAxisd turn(step_.linear());
    for (size_t i = 0; i < scan.points.size(); ++i) {
      const double part = scan.time_s.empty() ? 0 : scan.time_s[i] / kPeriod_s - 0.5;
      const Eigen::Vector3d p =
          Eigen::AngleAxisd(part * turn.angle(), turn.axis()) * scan.points[i].cast<double>() + part * step_.translation();
      whole->push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    pcl::VoxelGrid<pcl::PointXYZ> grid;
    grid.setLeafSize(leaf_m_, leaf_m_, leaf_m_);
    grid.setInputCloud(whole);
    grid.filter(*out);
    return out;
  }

  void SetKeyframe(const Cloud::Ptr& cloud) {
    keyframe_ = cloud;
    T_odom_keyframe_ = pose_;
    registration_->setInputTarget(cloud);
  }

  std::string name_;
  float leaf_m_;
  std::shared_ptr<pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>> registration_;
  Cloud::Ptr keyframe_;
  Isometry3d pose_ = Isometry3d::Identity(), step_ = Isometry3d::Identity(), T_odom_keyframe_ = Isometry3d::Identity();
};

std::unique_ptr<Subject> Gicp(float leaf_m) {
  auto gicp = std::make_shared<pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>();
  gicp->setMaxCorrespondenceDistance(1.0);
  gicp->setMaximumIterations(64);
  gicp->setTransformationEpsilon(1e-3);
  return std::make_unique<Peer>("PCL GICP", leaf_m, gicp);
}

std::unique_ptr<Subject> Ndt(float leaf_m) {
  auto ndt = std::make_shared<pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>>();
  ndt->setResolution(1.0F);
  ndt->setStepSize(0.1);
  ndt->setMaximumIterations(35);
  ndt->setTransformationEpsilon(1e-3);
  return std::make_unique<Peer>("PCL NDT", leaf_m, ndt);
}

struct Result {
  std::vector<double> times_ms;
  std::optional<Isometry3d> T_truth_odom;  // aligned at the first scan with truth
  double square_sum_m2 = 0, worst_m = 0;
  int count = 0;

  void Add(double time_ms, const Isometry3d& T_odom_lidar, const std::optional<Isometry3d>& truth) {
    times_ms.push_back(time_ms);
    if (!truth) return;
    if (!T_truth_odom) T_truth_odom = *truth * T_odom_lidar.inverse();
    const double error_m = (*T_truth_odom * T_odom_lidar.translation() - truth->translation()).norm();
    square_sum_m2 += error_m * error_m;
    worst_m = std::max(worst_m, error_m);
    ++count;
  }
  [[nodiscard]] double mean_ms() const {
    double sum = 0;
    for (const double t : times_ms) sum += t;
    return sum / static_cast<double>(times_ms.size());
  }
  [[nodiscard]] double p99_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() * 99 / 100];
  }
  [[nodiscard]] double rms_m() const { return count > 0 ? std::sqrt(square_sum_m2 / count) : 0; }
};

void Print(const std::vector<std::unique_ptr<Subject>>& subjects, std::vector<Result>& results) {
  fmt::print("{:<10} {:>8} {:>8} {:>8} {:>10} {:>10} {:>10}\n", "", "mean ms", "p99 ms", "time", "ATE m", "worst m", "error");
  for (size_t i = 0; i < subjects.size(); ++i) {
    Result& r = results[i];
    fmt::print("{:<10} {:>8.2f} {:>8.2f} {:>8} {:>10.4f} {:>10.4f} {:>10}\n", subjects[i]->Name(), r.mean_ms(), r.p99_ms(),
               fmt::format("{:.2f}", results[0].mean_ms() / r.mean_ms()), r.rms_m(), r.worst_m,
               fmt::format("{:.3f}", results[0].rms_m() / r.rms_m()));
  }
  fmt::print("time and error: Plumb's as a share of the row's; ATE: position, rms, aligned at the start\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: odometry_peers REC [LEAF_M]\n");
    return 2;
  }
  const auto recording = Recording::Open(argv[1]);
  if (!recording) {
    fmt::print(stderr, "{}\n", recording.error().message);
    return 2;
  }
  const auto truth = ReadTum(std::string(argv[1]) + "/truth.tum");
  const float leaf_m = argc > 2 ? std::strtof(argv[2], nullptr) : 0.1F;
  if (!(leaf_m > 0)) return 2;
  std::vector<std::unique_ptr<Subject>> subjects;
  subjects.push_back(std::make_unique<Plumb>());
  subjects.push_back(Gicp(leaf_m));
  subjects.push_back(Ndt(leaf_m));
  std::vector<Result> results(subjects.size());
  for (size_t i = 0; i < recording->size(); ++i) {
    const auto scan = recording->Read(i);
    if (!scan) continue;
    for (size_t k = 0; k < subjects.size(); ++k) {
      const auto start = std::chrono::steady_clock::now();
      const Isometry3d pose = subjects[k]->Register(*scan);
      const double time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
      results[k].Add(time_ms, pose, truth ? InterpolatePose(*truth, scan->stamp_s + subjects[k]->sample_s()) : std::nullopt);
    }
  }
  if (results[0].times_ms.empty()) return 2;
  Print(subjects, results);
}
