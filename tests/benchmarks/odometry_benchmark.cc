// Odometry on a synthetic drive through the test house: error against truth and time per scan.
//   odometry_benchmark [rounds] [with time: 0|1] [noise_m]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "runtime/odometry/odometry.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

int main(int argc, char** argv) {
  using namespace plumb;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 1;
  test::SyntheticLidarOptions options;
  options.with_time = argc <= 2 || std::atoi(argv[2]) != 0;
  if (argc > 3) options.noise_m = std::atof(argv[3]);
  const test::SyntheticLidar lidar(test::MakeHouse(), options);
  const test::Drive drive = test::HouseDrive(rounds);
  runtime::Odometry odometry;
  double square_sum_m2 = 0, worst_m = 0, worst_z_m = 0, worst_rad = 0;
  std::vector<double> times_ms;
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  int failed = 0, iterations = 0;
  for (double t = 0; t + 0.1 < drive.duration_s(); t += 0.1) {
    const runtime::Scan scan = lidar.Sweep([&](double s) { return drive.At(s); }, t);
    const auto begin = std::chrono::steady_clock::now();
    const runtime::OdometryResult r = odometry.Register(scan, std::nullopt);
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    if (times_ms.size() == 1) T_plan_odom = drive.At(0) * r.T_odom_lidar.inverse();
    const Eigen::Isometry3d off = drive.At(t).inverse() * T_plan_odom * r.T_odom_lidar;
    const double error_m = off.translation().norm();
    square_sum_m2 += error_m * error_m;
    worst_m = std::max(worst_m, error_m);
    worst_z_m = std::max(worst_z_m, std::abs(off.translation().z()));
    worst_rad = std::max(worst_rad, Eigen::AngleAxisd(off.linear()).angle());
    failed += r.ok ? 0 : 1;
    iterations += r.iterations;
    if (std::getenv("VERBOSE") != nullptr)
      fmt::print("{:.1f} err {:.4f} {:.4f} {:.4f} rot {:.4f} it {} inl {} rms {:.4f}\n", t, off.translation().x(), off.translation().y(), off.translation().z(),
                 Eigen::AngleAxisd(off.linear()).angle() * 57.2958, r.iterations, r.num_inliers, r.rms_m);
  }
  const double n = static_cast<double>(times_ms.size());
  double sum_ms = 0;
  for (const double ms : times_ms) sum_ms += ms;
  std::sort(times_ms.begin(), times_ms.end());
  fmt::print("house, {:.1f} m, {:.1f} s, {} scans ({} failed): ATE {:.4f} m rms, {:.4f} m worst (z {:.4f} m), {:.3f} deg worst; {:.2f} ms/scan mean, {:.2f} p95; {:.1f} iterations\n",
             drive.length_m(), drive.duration_s(), times_ms.size(), failed, std::sqrt(square_sum_m2 / n), worst_m, worst_z_m, worst_rad * 57.29578, sum_ms / n,
             times_ms[static_cast<size_t>(0.95 * n)], iterations / n);
}
