#include "tests/support/synthetic_lidar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace plumb::test {
namespace {

// Standard normal by Box and Muller: std::normal_distribution differs between libraries.
double Normal(std::mt19937_64& rng) {
  const double u = (static_cast<double>(rng() >> 11) + 0.5) * 0x1p-53, v = static_cast<double>(rng() >> 11) * 0x1p-53;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

// 0 to 1 with no velocity at both ends.
double SmoothStep(double x) { return x * x * (3 - 2 * x); }

}  // namespace

SyntheticLidar::SyntheticLidar(const AGraph& graph, const SyntheticLidarOptions& options)
    : options_(options), origin_(graph.origin), caster_(graph.mesh) {}

runtime::Scan SyntheticLidar::Sweep(const PoseAt& pose_at, double stamp_s) const {
  runtime::Scan scan;
  scan.stamp_s = stamp_s;
  std::mt19937_64 rng(options_.seed * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(std::llround(stamp_s * 1e6)));
  for (int a = 0; a < options_.azimuths; ++a) {
    const double time_s = options_.period_s * a / options_.azimuths;
    const Eigen::Isometry3d T = pose_at(stamp_s + time_s);
    const double azimuth_rad = -2 * std::numbers::pi * a / options_.azimuths;
    for (int r = 0; r < options_.rings; ++r) {
      const double elevation_rad = options_.half_fov_rad * (options_.rings > 1 ? 2.0 * r / (options_.rings - 1) - 1 : 0);
      const Eigen::Vector3d d(std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
                              std::sin(elevation_rad));
      runtime::Ray ray;
      ray.origin = (T.translation() - origin_).cast<float>();
      ray.direction = (T.linear() * d).cast<float>();
      ray.max_range_m = static_cast<float>(options_.max_range_m);
      const runtime::RayHit hit = caster_.Cast(ray);
      if (!hit.hit()) continue;
      scan.points.push_back((d * (hit.range_m + options_.noise_m * Normal(rng))).cast<float>());
      scan.ring.push_back(static_cast<uint16_t>(r));
      if (options_.with_time) scan.time_s.push_back(static_cast<float>(time_s));
    }
  }
  return scan;
}

Drive::Drive(const std::vector<Eigen::Vector2d>& points, double height_m, double speed_mps, double turn_radps) : height_m_(height_m) {
  constexpr double kSmoothing = 1.5;  // a smooth step's top speed is 1.5 times its mean
  double t_s = 0, yaw_rad = 0;
  for (size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d along = points[i] - points[i - 1];
    const double heading_rad = std::atan2(along.y(), along.x());
    const double turn_rad = i == 1 ? 0 : std::remainder(heading_rad - yaw_rad, 2 * std::numbers::pi);
    if (i == 1) yaw_rad = heading_rad;
    if (std::abs(turn_rad) > 1e-9) {
      const double end_s = t_s + kSmoothing * std::abs(turn_rad) / turn_radps;
      legs_.push_back({t_s, end_s, points[i - 1], points[i - 1], yaw_rad, yaw_rad + turn_rad});
      t_s = end_s;
      yaw_rad += turn_rad;
    }
    const double end_s = t_s + kSmoothing * along.norm() / speed_mps;
    legs_.push_back({t_s, end_s, points[i - 1], points[i], yaw_rad, yaw_rad});
    t_s = end_s;
  }
}

Eigen::Isometry3d Drive::At(double t_s) const {
  const auto leg = std::find_if(legs_.begin(), legs_.end() - 1, [&](const Leg& l) { return t_s < l.end_s; });
  const double x = SmoothStep(std::clamp((t_s - leg->start_s) / (leg->end_s - leg->start_s), 0.0, 1.0));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << leg->from + x * (leg->to - leg->from), height_m_;
  T.linear() =
      Eigen::AngleAxisd(leg->yaw_from_rad + x * (leg->yaw_to_rad - leg->yaw_from_rad), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

double Drive::length_m() const {
  double length_m = 0;
  for (const Leg& leg : legs_) length_m += (leg.to - leg.from).norm();
  return length_m;
}

Drive HouseDrive(int rounds, double height_m) {
  std::vector<Eigen::Vector2d> points = {{1, 1.2}};
  for (int i = 0; i < rounds; ++i) {
    for (const Eigen::Vector2d& p : std::initializer_list<Eigen::Vector2d>{{2.45, 2.0},
                                                                           {2.45, 4.8},
                                                                           {4.0, 5.0},
                                                                           {2.45, 4.6},
                                                                           {2.45, 2.4},
                                                                           {4.0, 2.75},
                                                                           {6.5, 2.75},
                                                                           {7.5, 4.8},
                                                                           {7.2, 1.2},
                                                                           {6.0, 2.75},
                                                                           {4.0, 2.75},
                                                                           {1, 1.2}}) {
      points.push_back(p);
    }
  }
  return Drive(points, height_m);
}

}  // namespace plumb::test
