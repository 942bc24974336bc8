#include "compiler/frontends/drawing/arc_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kOnArc = 1e-6;       // share of the radius
constexpr double kMaxStep_rad = 0.2;  // no source takes longer ones
constexpr double kStepShare = 0.51;   // of an arc, which has two steps or more: its chord is none
constexpr double kMaxParts = 256;

double AngleOf(const Arc& arc, const Vector2d& p) { return std::atan2(p.y() - arc.center.y(), p.x() - arc.center.x()); }

// From a to b along the arc, signed; 0: this side is no step of it.
double StepAlong(const Arc& arc, const Vector2d& a, const Vector2d& b) {
  for (const Vector2d& p : {a, b}) {
    if (std::abs((p - arc.center).norm() - arc.radius_m) > kOnArc * arc.radius_m) return 0;
  }
  const double from_rad = AngleOf(arc, a), step_rad = std::remainder(AngleOf(arc, b) - from_rad, 2 * std::numbers::pi);
  const double middle_rad = arc.start_rad + 0.5 * arc.sweep_rad,
               off_rad = std::remainder(from_rad + 0.5 * step_rad - middle_rad, 2 * std::numbers::pi);
  const bool is_step = std::abs(step_rad) <= std::min(kMaxStep_rad, kStepShare * std::abs(arc.sweep_rad));
  return is_step && std::abs(off_rad) <= 0.5 * std::abs(arc.sweep_rad) ? step_rad : 0;
}

// What lies between a and b.
void AppendSteps(const Arc& arc, const Vector2d& a, double step_rad, double sagitta_m, std::vector<Vector2d>& out) {
  const double finest_rad = 2 * std::acos(std::max(0.0, 1 - sagitta_m / arc.radius_m));
  if (!(finest_rad > 0)) return;
  const int parts = static_cast<int>(std::ceil(std::min(kMaxParts, std::abs(step_rad) / finest_rad)));
  const double from_rad = AngleOf(arc, a);
  for (int k = 1; k < parts; ++k) {
    const double angle = from_rad + step_rad * k / parts;
    out.push_back(arc.center + arc.radius_m * Vector2d(std::cos(angle), std::sin(angle)));
  }
}

}  // namespace

void RefineArcSteps(double sagitta_m, Drawing& drawing) {
  for (DrawnPath& path : drawing.paths) {
    if (path.arcs.empty()) continue;
    std::vector<Vector2d> points;
    for (size_t i = 0; i < path.points.size(); ++i) {
      points.push_back(path.points[i]);
      if (i + 1 == path.points.size() && !path.closed) break;
      const Vector2d& next = path.points[(i + 1) % path.points.size()];
      for (const Arc& arc : path.arcs) {
        const double step_rad = StepAlong(arc, path.points[i], next);
        if (step_rad == 0) continue;
        AppendSteps(arc, path.points[i], step_rad, sagitta_m, points);
        break;
      }
    }
    path.points = std::move(points);
  }
}

}  // namespace plumb::compiler
