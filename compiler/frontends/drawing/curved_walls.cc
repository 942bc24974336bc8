#include "compiler/frontends/drawing/curved_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kOff_m = 1e-4;
constexpr double kMinThickness_m = 0.02;
constexpr double kMinLengthShare = 0.5;  // of a wall's thickness
constexpr double kFacet_m = 0.02;        // what the middle of a facet may stand off its arc

// Sides along one arc, one after the other.
struct Chain {
  Circle circle;
  double from_rad = 0, to_rad = 0;  // counter-clockwise
  bool outer = false;               // the wall is on the centre's side
  uint32_t first_side = 0;
};

std::vector<Chain> FindChains(const Outline& outline, std::vector<uint32_t>& chain_of) {
  const auto& sides = outline.sides();
  const auto circle_of = [&](uint32_t s) -> const Circle& { return outline.mass().circles[sides[s].circle]; };
  const auto sweep_of = [&](uint32_t s) {
    const Eigen::Vector2d a = sides[s].a - circle_of(s).center, b = sides[s].b - circle_of(s).center;
    return std::atan2(Cross(a, b), a.dot(b));
  };
  const auto follows = [&](uint32_t s, uint32_t next) {
    return next != s && sides[s].circle != kNone && sides[next].circle != kNone && IsSameCurve(circle_of(s), circle_of(next)) && sweep_of(s) * sweep_of(next) > 0;
  };
  std::vector<Chain> out;
  chain_of.assign(sides.size(), kNone);
  for (uint32_t start = 0; start < sides.size(); ++start) {
    if (sides[start].circle == kNone || chain_of[start] != kNone) continue;
    uint32_t s = start;
    while (follows(sides[s].prev, s) && sides[s].prev != start) s = sides[s].prev;
    Chain chain{circle_of(s), AngleAt(circle_of(s), sides[s].a), 0, sweep_of(s) > 0, s};
    double sweep_rad = 0;
    for (uint32_t next = s; chain_of[next] == kNone; next = sides[next].next) {
      chain_of[next] = static_cast<uint32_t>(out.size());
      sweep_rad += sweep_of(next);
      if (!follows(next, sides[next].next)) break;
    }
    chain.to_rad = chain.from_rad + sweep_rad;
    if (!chain.outer) std::swap(chain.from_rad, chain.to_rad);
    chain.to_rad = std::min(chain.to_rad, chain.from_rad + kTurn_rad);
    out.push_back(chain);
  }
  return out;
}

Eigen::AlignedBox2d BoxAround(const Circle& circle) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kSameCurve_m);
  return {circle.center - reach, circle.center + reach};
}

}  // namespace

bool IsSameCurve(const Circle& a, const Circle& b) {
  return (a.center - b.center).norm() < kSameCurve_m && std::abs(a.radius_m - b.radius_m) < kSameCurve_m;
}

double AngleAt(const Circle& circle, const Eigen::Vector2d& p) {
  return std::atan2(p.y() - circle.center.y(), p.x() - circle.center.x());
}

Eigen::Vector2d PointAt(const Circle& circle, double angle_rad) {
  return circle.center + circle.radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

double Nearest(double angle_rad, double near_rad) { return near_rad + std::remainder(angle_rad - near_rad, kTurn_rad); }

std::vector<CurvedWall> FindCurvedWalls(const Outline& outline, double max_thickness_m) {
  std::vector<uint32_t> chain_of;
  const std::vector<Chain> chains = FindChains(outline, chain_of);
  std::vector<Eigen::AlignedBox2d> centers;
  for (const Chain& c : chains) centers.emplace_back(c.circle.center);
  const BoxTree<2> tree(std::move(centers));
  std::vector<CurvedWall> out;
  const auto add = [&](const Chain& outer, uint32_t i, double from_rad, double to_rad) {
    const Chain& inner = chains[i];
    CurvedWall wall;
    wall.middle = {0.5 * (outer.circle.center + inner.circle.center), 0.5 * (outer.circle.radius_m + inner.circle.radius_m)};
    wall.thickness_m = outer.circle.radius_m - inner.circle.radius_m;
    wall.from_rad = from_rad;
    wall.to_rad = to_rad;
    wall.source = outline.sides()[outer.first_side].source;
    if (wall.length_m() < kMinLengthShare * wall.thickness_m) return;
    // Nothing else is between them.
    const double middle_rad = 0.5 * (from_rad + to_rad);
    const Circle face{outer.circle.center, outer.circle.radius_m - kFacet_m};
    const Eigen::Vector2d in = -Eigen::Vector2d(std::cos(middle_rad), std::sin(middle_rad)), at = PointAt(face, middle_rad);
    const auto hit = outline.InWall(at) ? outline.Cast(at, in, wall.thickness_m) : std::nullopt;
    if (hit && chain_of[hit->side] == i) out.push_back(wall);
  };
  for (const Chain& outer : chains) {
    if (!outer.outer) continue;
    std::vector<uint32_t> inners;
    tree.ForEachIn(BoxAround(outer.circle), [&](uint32_t i) {
      const double thickness_m = outer.circle.radius_m - chains[i].circle.radius_m;
      if (!chains[i].outer && thickness_m > kMinThickness_m + kOff_m && thickness_m <= max_thickness_m &&
          (outer.circle.center - chains[i].circle.center).norm() < kSameCurve_m)
        inners.push_back(i);
    });
    std::sort(inners.begin(), inners.end());
    for (const uint32_t i : inners) {
      const double shift_rad = Nearest(chains[i].from_rad, outer.from_rad) - chains[i].from_rad;
      for (const double turns : {-1.0, 0.0, 1.0}) {
        const double by = shift_rad + turns * kTurn_rad;
        const double from = std::max(outer.from_rad, chains[i].from_rad + by), to = std::min(outer.to_rad, chains[i].to_rad + by);
        if (to > from) add(outer, i, from, to);
      }
    }
  }
  return out;
}

}  // namespace plumb::compiler
