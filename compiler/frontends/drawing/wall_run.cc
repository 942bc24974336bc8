#include <algorithm>
#include <cmath>

#include "compiler/frontends/drawing/curved_walls.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/wall_runs.h"

namespace plumb::compiler {
namespace {

constexpr double kSagitta_m = 5e-4;  // of steps along round walls

// From one angle to another in steps at fixed angles, so that parts of one wall share their corners.
void AppendSteps(const Circle& circle, double step_rad, double from_rad, double to_rad, std::vector<Eigen::Vector2d>& out) {
  const double sign = to_rad > from_rad ? 1 : -1, slack_rad = 0.1 * step_rad;
  out.push_back(PointAt(circle, from_rad));
  double k = sign * std::floor(sign * from_rad / step_rad) + sign;
  for (; sign * (to_rad - k * step_rad) > slack_rad; k += sign) {
    if (sign * (k * step_rad - from_rad) > slack_rad) out.push_back(PointAt(circle, k * step_rad));
  }
  out.push_back(PointAt(circle, to_rad));
}

}  // namespace

Eigen::Vector2d WallRun::At(double s, double t) const {
  if (!curve) return s * along + t * Perp(along);
  return PointAt({curve->center, curve->radius_m - t}, zero_rad + s / curve->radius_m);
}

double WallRun::S(const Eigen::Vector2d& p) const {
  if (!curve) return along.dot(p);
  const double middle_rad = zero_rad + 0.5 * (start_m + end_m) / curve->radius_m;
  return (Nearest(AngleAt(*curve, p), middle_rad) - zero_rad) * curve->radius_m;
}

double WallRun::T(const Eigen::Vector2d& p) const { return curve ? curve->radius_m - (p - curve->center).norm() : Cross(along, p); }

bool WallRun::Holds(const Eigen::Vector2d& p, double slack_m) const {
  const double s = S(p), t = T(p);
  const double u = thickness_m() > 0 ? std::clamp((t - right_m) / thickness_m(), 0.0, 1.0) : 0;
  const auto at = [u](const Cut& cut) { return cut.right_m + u * (cut.left_m - cut.right_m); };
  return s >= start_m + at(start_cut) - slack_m && s <= end_m - at(end_cut) + slack_m && t >= right_m - slack_m && t <= left_m + slack_m;
}

std::vector<Eigen::Vector2d> WallRun::Part(double from_m, double to_m) const {
  if (curve) return Layer(from_m, to_m, right_m, left_m);
  return {At(std::max(from_m, start_m + start_cut.right_m), right_m), At(std::min(to_m, end_m - end_cut.right_m), right_m),
          At(std::min(to_m, end_m - end_cut.left_m), left_m), At(std::max(from_m, start_m + start_cut.left_m), left_m)};
}

std::vector<Eigen::Vector2d> WallRun::Layer(double from_m, double to_m, double right_of_m, double left_of_m) const {
  if (!curve) return {At(from_m, right_of_m), At(to_m, right_of_m), At(to_m, left_of_m), At(from_m, left_of_m)};
  const double from_rad = zero_rad + from_m / curve->radius_m, to_rad = zero_rad + to_m / curve->radius_m;
  const double step_rad = 2 * std::acos(1 - kSagitta_m / (curve->radius_m - right_m));
  std::vector<Eigen::Vector2d> out;
  AppendSteps({curve->center, curve->radius_m - right_of_m}, step_rad, from_rad, to_rad, out);
  AppendSteps({curve->center, curve->radius_m - left_of_m}, step_rad, to_rad, from_rad, out);
  return out;
}

std::vector<Arc> WallRun::Arcs() const {
  if (!curve) return {};
  const double from_rad = zero_rad + start_m / curve->radius_m, to_rad = zero_rad + end_m / curve->radius_m;
  return {{curve->center, curve->radius_m - right_m, from_rad, to_rad - from_rad},
          {curve->center, curve->radius_m - left_m, to_rad, from_rad - to_rad}};
}

}  // namespace plumb::compiler
