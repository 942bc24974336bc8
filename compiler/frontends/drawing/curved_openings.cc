#include "compiler/frontends/drawing/curved_openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kMaxThickness_m = 1.0;
constexpr double kMaxGap_rad = 1.6;  // of a curved wall, that one opening takes
constexpr double kStep_rad = 0.05;
constexpr double kOff_m = 1e-4;
constexpr double kBeyondEnd_m = 0.03;
constexpr double kFacing = 0.87;  // cosine between the way along the wall and what faces its end

std::optional<DrawnOpening> InWall(const CurvedWall& wall, double from_rad, double to_rad) {
  const double slack_rad = kBeyondEnd_m / wall.middle.radius_m, shift_rad = Nearest(from_rad, wall.from_rad) - from_rad;
  for (const double turn_rad : {0.0, 2 * std::numbers::pi}) {
    const double by = shift_rad + turn_rad;
    if (from_rad + by < wall.from_rad - slack_rad || to_rad + by > wall.to_rad + slack_rad) continue;
    DrawnOpening out;
    out.curve = wall.middle;
    out.from = PointAt(wall.middle, from_rad);
    out.to = PointAt(wall.middle, to_rad);
    out.depth_m = wall.thickness_m;
    out.in_wall = true;
    return out;
  }
  return std::nullopt;
}

}  // namespace

CurvedOpenings::CurvedOpenings(const Outline& outline, const OpeningOptions& options)
    : outline_(outline), options_(options), walls_(FindCurvedWalls(outline, kMaxThickness_m)) {}

bool CurvedOpenings::IsEndOfCurve(uint32_t side) const {
  const auto& sides = outline_.sides();
  const uint32_t before = sides[sides[side].prev].circle, after = sides[sides[side].next].circle;
  if (before == kNone || after == kNone) return false;
  const auto& circles = outline_.mass().circles;
  return (circles[before].center - circles[after].center).norm() < kSameCurve_m;
}

std::optional<CurvedGap> CurvedOpenings::GapBefore(uint32_t end) const {
  const Side& s = outline_.sides()[end];
  const auto& circles = outline_.mass().circles;
  const Circle &before = circles[outline_.sides()[s.prev].circle], &after = circles[outline_.sides()[s.next].circle];
  const Circle middle{0.5 * (before.center + after.center), 0.5 * (before.radius_m + after.radius_m)};
  const double turn = before.radius_m < after.radius_m ? -1 : 1;  // the wall is on the left of its sides
  const double start_rad = AngleAt(middle, s.middle()), max_rad = std::min(kMaxGap_rad, options_.max_window_gap_m / middle.radius_m);
  for (double at_rad = kOff_m / middle.radius_m; at_rad < max_rad; at_rad += kStep_rad) {
    const Eigen::Vector2d p = PointAt(middle, start_rad + turn * at_rad);
    const Eigen::Vector2d step = PointAt(middle, start_rad + turn * (at_rad + kStep_rad)) - p;
    const std::optional<SideHit> hit = outline_.Cast(p, step.normalized(), step.norm());
    if (!hit) continue;
    if (outline_.sides()[hit->side].along().dot(Perp(step).normalized()) > -kFacing) return std::nullopt;
    CurvedGap out;
    out.far_side = hit->side;
    out.opening.from = PointAt(middle, start_rad);
    out.opening.to = p + hit->t_m * step.normalized();
    out.opening.depth_m = std::abs(before.radius_m - after.radius_m);
    out.opening.curve = middle;
    return out.opening.width_m() < options_.min_width_m ? std::nullopt : std::optional(out);
  }
  return std::nullopt;
}

bool CurvedOpenings::IsBeside(const CurvedWall& wall, const Eigen::Vector2d& p) const {
  const double near_m = 0.5 * wall.thickness_m + options_.symbol_slack_m;
  return std::abs((p - wall.middle.center).norm() - wall.middle.radius_m) < near_m;
}

std::optional<DrawnOpening> CurvedOpenings::Between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  for (const CurvedWall& wall : walls_) {
    if (!IsBeside(wall, a) || !IsBeside(wall, b)) continue;
    const double half_rad = std::asin(std::min(1.0, 0.5 * (b - a).norm() / wall.middle.radius_m));
    const double at_rad = AngleAt(wall.middle, 0.5 * (a + b));
    if (2 * half_rad > kMaxGap_rad) continue;
    if (std::optional<DrawnOpening> out = InWall(wall, at_rad - half_rad, at_rad + half_rad)) return out;
  }
  return std::nullopt;
}

std::optional<DrawnOpening> CurvedOpenings::Along(std::span<const Eigen::Vector2d> points) const {
  for (const CurvedWall& wall : walls_) {
    if (points.empty() || !std::all_of(points.begin(), points.end(), [&](const auto& p) { return IsBeside(wall, p); })) continue;
    const double near_rad = AngleAt(wall.middle, points[0]);
    std::array<Eigen::AlignedBox<double, 1>, 2> extents;  // in the inner and the outer half of the wall
    for (const auto& p : points) {
      const size_t half = (p - wall.middle.center).norm() < wall.middle.radius_m ? 0 : 1;
      extents[half].extend(Eigen::Matrix<double, 1, 1>(Nearest(AngleAt(wall.middle, p), near_rad)));
    }
    for (const size_t half : {0u, 1u}) {
      if (extents[half].isEmpty()) extents[half] = extents[1 - half];
    }
    const double from_rad = 0.5 * (extents[0].min()[0] + extents[1].min()[0]), to_rad = 0.5 * (extents[0].max()[0] + extents[1].max()[0]);
    if (to_rad - from_rad > kMaxGap_rad) continue;
    if (std::optional<DrawnOpening> out = InWall(wall, from_rad, to_rad)) return out;
  }
  return std::nullopt;
}

}  // namespace plumb::compiler
