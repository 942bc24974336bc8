#include "runtime/matching/graph/affinity.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {
namespace {

constexpr double kParallelSin = 0.3;  // built walls turn by up to 15 degrees

double Gaussian(double difference, double sigma) { return std::exp(-0.5 * difference * difference / (sigma * sigma)); }

double TurnBetween(const Eigen::Vector2d& from, const Eigen::Vector2d& to) { return std::atan2(Cross(from, to), from.dot(to)); }

double TurnDifference(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j) {
  return std::abs(WrapAngle(TurnBetween(plan_i.normal, plan_j.normal) - TurnBetween(map_i.normal, map_j.normal)));
}

// Seen from wall i along its normal, wall j lies in front in one of plan and map and behind in the other.
bool SwapsSides(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j, double margin_m) {
  const double in_plan_m = plan_i.normal.dot(plan_j.foot - plan_i.foot), in_map_m = map_i.normal.dot(map_j.foot - map_i.foot);
  return std::min(std::abs(in_plan_m), std::abs(in_map_m)) > margin_m && (in_plan_m > 0) != (in_map_m > 0);
}

std::string Positive(const char* name, double value) {
  return value > 0 && std::isfinite(value) ? std::string() : fmt::format("{} = {}; must be positive", name, value);
}

}  // namespace

std::string PointConsistency::Check() const {
  for (const std::string& wrong : {Positive("PointConsistency.sigma_m", sigma_m), Positive("PointConsistency.epsilon_m", epsilon_m)}) {
    if (!wrong.empty()) return wrong;
  }
  return {};
}

std::string WallConsistency::Check() const {
  for (const std::string& wrong :
       {Positive("WallConsistency.sigma_m", sigma_m), Positive("WallConsistency.epsilon_m", epsilon_m),
        Positive("WallConsistency.sigma_rad", sigma_rad), Positive("WallConsistency.epsilon_rad", epsilon_rad)}) {
    if (!wrong.empty()) return wrong;
  }
  return {};
}

WallPoint AboutOrigin(const Eigen::Vector2d& normal, double d_m, const Eigen::Vector2d& origin) {
  return {-(normal.dot(origin) + d_m) * normal, normal};
}

double PointAffinity(const Eigen::Vector2d& plan_i, const Eigen::Vector2d& plan_j, const Eigen::Vector2d& map_i,
                     const Eigen::Vector2d& map_j, const PointConsistency& bounds) {
  const double difference_m = std::abs((plan_i - plan_j).norm() - (map_i - map_j).norm());
  return difference_m < bounds.epsilon_m ? Gaussian(difference_m, bounds.sigma_m) : 0;
}

double WallAffinity(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j,
                    const WallConsistency& bounds) {
  const double turn_rad = TurnDifference(plan_i, plan_j, map_i, map_j);
  if (turn_rad >= bounds.epsilon_rad) return 0;
  if (SwapsSides(plan_i, plan_j, map_i, map_j, bounds.epsilon_m) || SwapsSides(plan_j, plan_i, map_j, map_i, bounds.epsilon_m)) return 0;
  const double distance = PointAffinity(plan_i.foot, plan_j.foot, map_i.foot, map_j.foot, {bounds.sigma_m, bounds.epsilon_m});
  return distance * Gaussian(turn_rad, bounds.sigma_rad);
}

double WallAffinityUpToShift(const WallPoint& plan_i, const WallPoint& plan_j, const WallPoint& map_i, const WallPoint& map_j,
                             const WallConsistency& bounds) {
  if (std::abs(Cross(plan_i.normal, plan_j.normal)) < kParallelSin) return WallAffinity(plan_i, plan_j, map_i, map_j, bounds);
  const double turn_rad = TurnDifference(plan_i, plan_j, map_i, map_j);
  return turn_rad < bounds.epsilon_rad ? Gaussian(turn_rad, bounds.sigma_rad) : 0;
}

}  // namespace plumb::runtime
