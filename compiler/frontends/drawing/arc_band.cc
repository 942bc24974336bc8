#include "compiler/frontends/drawing/arc_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

constexpr double kStep_rad = 0.05;       // along the sides, ...
constexpr double kMaxSagitta_m = 0.001;  // ... and of large circles so many more that a side is no farther off than this

ArcBand BandOf(const Arc& arc, double half_m) {
  ArcBand out;
  const double step_rad = std::min(kStep_rad, std::sqrt(8 * kMaxSagitta_m / arc.radius_m));
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep_rad) / step_rad)));
  const auto append = [&](double radius_m, int i) {
    const double angle_rad = arc.start_rad + arc.sweep_rad * i / steps;
    out.outline.push_back(arc.center + radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  };
  for (int i = 0; i <= steps; ++i) append(arc.radius_m - half_m, i);
  for (int i = steps; i >= 0; --i) append(arc.radius_m + half_m, i);
  out.sides = {arc, arc};
  out.sides[0].radius_m -= half_m;
  out.sides[1].radius_m += half_m;
  return out;
}

}  // namespace

std::vector<ArcBand> BandsAlong(const Arc& arc, double half_m, double before_m, double after_m) {
  const double sign = arc.sweep_rad < 0 ? -1 : 1;
  Arc whole = arc;
  whole.start_rad -= sign * before_m / arc.radius_m;
  whole.sweep_rad += sign * (before_m + after_m) / arc.radius_m;
  const bool in_two = std::abs(whole.sweep_rad) > std::numbers::pi;
  Arc part = whole;
  if (in_two) part.sweep_rad /= 2;
  std::vector<ArcBand> out = {BandOf(part, half_m)};
  part.start_rad += part.sweep_rad;
  if (in_two) out.push_back(BandOf(part, half_m));
  return out;
}

}  // namespace plumb::compiler
