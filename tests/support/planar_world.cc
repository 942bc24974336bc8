#include "tests/support/planar_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace plumb::test {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double Normal(std::mt19937_64& rng) {
  const double u = (static_cast<double>(rng() >> 11) + 0.5) * 0x1p-53, v = static_cast<double>(rng() >> 11) * 0x1p-53;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

}  // namespace

void PlanarWorld::AddBox(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi) {
  const Eigen::Vector2d a(hi.x(), lo.y()), b(lo.x(), hi.y());
  AddWall(lo, a);
  AddWall(a, hi);
  AddWall(hi, b);
  AddWall(b, lo);
}

runtime::Scan PlanarWorld::Sweep(const runtime::Pose2& pose, double stamp_s, uint64_t seed, const PlanarLaserOptions& options) const {
  runtime::Scan scan;
  scan.stamp_s = stamp_s;
  std::mt19937_64 rng(seed * 0x9e3779b97f4a7c15u + 1);
  for (int i = 0; i < options.beams; ++i) {
    const double angle_rad = options.fov_rad * (static_cast<double>(i) / (options.beams - 1) - 0.5);
    const Eigen::Vector2d local(std::cos(angle_rad), std::sin(angle_rad)), d = pose.Rotation() * local;
    double range_m = options.max_range_m;
    for (const auto& [from, to] : walls_) {
      const Eigen::Vector2d along = to - from, off = from - pose.t_m;
      const double det = Cross(d, along);
      if (std::abs(det) < 1e-12) continue;
      const double t_m = Cross(off, along) / det, s = Cross(off, d) / det;
      if (t_m > 0 && s >= 0 && s <= 1) range_m = std::min(range_m, t_m);
    }
    if (range_m >= options.max_range_m) continue;
    const Eigen::Vector2d p = local * (range_m + options.noise_m * Normal(rng));
    scan.points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0f);
    scan.ring.push_back(0);
  }
  return scan;
}

PlanarWorld MakeLoopWorld() {
  PlanarWorld world;
  // The room, its door in the wall x = 4 from y = -1 to 0.
  world.AddWall({-4, -3}, {4, -3});
  world.AddWall({-4, 3}, {4, 3});
  world.AddWall({-4, -3}, {-4, 3});
  world.AddWall({4, -3}, {4, -1});
  world.AddWall({4, 0}, {4, 3});
  world.AddBox({-3.5, 1.8}, {-2, 2.6});
  world.AddBox({1, -2.8}, {2.2, -2.1});
  world.AddBox({-0.4, 2.2}, {0.3, 2.8});
  // The corridor, 2 m wide, round the block; niches tell its parts apart.
  world.AddBox({6.2, -1}, {16.2, 7});
  world.AddWall({4.2, -1}, {4.2, -3});
  world.AddWall({4.2, -3}, {18.2, -3});
  world.AddWall({18.2, -3}, {18.2, 9});
  world.AddWall({18.2, 9}, {4.2, 9});
  world.AddWall({4.2, 9}, {4.2, 0});
  world.AddBox({9, -3}, {9.6, -2.7});
  world.AddBox({17.8, 2}, {18.2, 3.1});
  world.AddBox({12, 8.6}, {12.9, 9});
  world.AddBox({4.2, 4.5}, {4.5, 5.2});
  return world;
}

std::vector<runtime::Pose2> LoopDrive(double step_m) {
  constexpr double kMaxTurn_rad = 0.35;
  const std::vector<Eigen::Vector2d> way = {{-2, 0},   {3, -0.5}, {5.2, -0.5}, {5.2, -2}, {17.2, -2}, {17.2, 8},   {5.2, 8},  {5.2, -0.5},
                                            {3, -0.5}, {-2, 0},   {-2, -1.5},  {2.5, 1},  {3, -0.5},  {5.2, -0.5}, {5.2, -2}, {12, -2}};
  std::vector<runtime::Pose2> poses;
  double yaw_rad = 0;
  for (size_t i = 0; i + 1 < way.size(); ++i) {
    const Eigen::Vector2d leg = way[i + 1] - way[i];
    const double turn_rad = runtime::WrapYaw(std::atan2(leg.y(), leg.x()) - yaw_rad);
    const int turns = static_cast<int>(std::ceil(std::abs(turn_rad) / kMaxTurn_rad)),
              steps = static_cast<int>(std::ceil(leg.norm() / step_m));
    for (int k = 1; k <= turns; ++k) poses.push_back({way[i], runtime::WrapYaw(yaw_rad + turn_rad * k / turns)});
    yaw_rad = runtime::WrapYaw(yaw_rad + turn_rad);
    for (int k = 1; k <= steps; ++k) poses.push_back({way[i] + leg * k / steps, yaw_rad});
  }
  return poses;
}

}  // namespace plumb::test
