#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "compiler/frontends/drawing/curved_walls.h"
#include "compiler/frontends/drawing/openings.h"
#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {

std::string OpeningOptions::Check() const {
  if (!(min_width_m > 0)) return fmt::format("OpeningOptions.min_width_m = {}; must be positive", min_width_m);
  if (!(max_bare_gap_m >= 0)) return fmt::format("OpeningOptions.max_bare_gap_m = {}; must not be negative", max_bare_gap_m);
  return {};
}

Eigen::Vector2d DrawnOpening::middle() const {
  const Eigen::Vector2d chord = 0.5 * (from + to);
  return curve ? PointAt(*curve, AngleAt(*curve, chord)) : chord;
}

Eigen::Vector2d DrawnOpening::Local(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d offset = p - middle();
  if (!curve) return {along().dot(offset), Cross(along(), offset)};
  const double turn = Cross(from - curve->center, to - curve->center) > 0 ? 1 : -1;  // the centre is on the left if it is 1
  const double angle_rad = Nearest(AngleAt(*curve, p), AngleAt(*curve, middle())) - AngleAt(*curve, middle());
  return {turn * angle_rad * curve->radius_m, turn * (curve->radius_m - (p - curve->center).norm())};
}

bool IsSwing(const Arc& arc, const OpeningOptions& options) {
  const double sweep = std::abs(arc.sweep_rad);
  return sweep > std::numbers::pi / 6 && sweep < 2 * std::numbers::pi / 3 && arc.radius_m >= options.min_swing_radius_m &&
         arc.radius_m <= options.max_swing_radius_m;
}

}  // namespace plumb::compiler
