#include "compiler/frontends/drawing/openings_on_walls.h"

#include <algorithm>
#include <cmath>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kAgainst = 0.96;  // cosine between a wall's face and what is drawn along it
constexpr double kMinThickness_m = 0.03, kMaxThickness_m = 1.0;

}  // namespace

std::optional<DrawnOpening> OpeningOverWall(const Outline& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d u = (b - a).normalized(), n = Perp(u), m = 0.5 * (a + b);
  // Leaves are often drawn right on the wall's face.
  for (const double off_m : {0.0, kMinThickness_m, -kMinThickness_m}) {
    const Eigen::Vector2d inside = m + off_m * n;
    if (!outline.InWall(inside)) continue;
    const auto left = outline.Cast(inside, n, kMaxThickness_m), right = outline.Cast(inside, -n, kMaxThickness_m);
    if (!left || !right || left->t_m + right->t_m < kMinThickness_m) continue;
    if (std::abs(outline.sides()[left->side].along().dot(u)) < kAgainst) continue;
    DrawnOpening out;
    const Eigen::Vector2d shift = (off_m + 0.5 * (left->t_m - right->t_m)) * n;
    out.from = a + shift;
    out.to = b + shift;
    out.depth_m = left->t_m + right->t_m;
    out.in_wall = true;
    return out;
  }
  return std::nullopt;
}

std::optional<DrawnOpening> OpeningBetweenWalls(const Outline& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double slack_m) {
  const Eigen::Vector2d u = (b - a).normalized(), m = 0.5 * (a + b);
  const double reach = 0.5 * (b - a).norm() + 2 * slack_m;
  const auto ahead = outline.Cast(m, u, reach), back = outline.Cast(m, -u, reach);
  if (!ahead || !back) return std::nullopt;
  DrawnOpening out;
  out.from = m - back->t_m * u;
  out.to = m + ahead->t_m * u;
  out.depth_m = std::clamp(outline.mass().typical_thickness_m, 0.05, 0.2);
  return out;
}

}  // namespace plumb::compiler
