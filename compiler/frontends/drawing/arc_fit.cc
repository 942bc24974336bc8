#include "compiler/frontends/drawing/arc_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/circle.h"

namespace plumb::compiler {
namespace {

constexpr double kMinShare = 0.25;  // of a closed line's length that arcs must have to be told
constexpr double kAllCurved = 0.9;  // ... to be all of it
constexpr double kMinSweep_rad = 0.3;
constexpr double kTurnsBack_rad = 2.8;
constexpr size_t kFine = 12;  // steps
constexpr double kOffArc_m = 0.01;

double TurnAt(std::span<const Eigen::Vector2d> p, size_t i) {
  const Eigen::Vector2d a = p[i] - p[i - 1], b = p[i + 1] - p[i];
  return std::atan2(Cross(a, b), a.dot(b));
}

// The arc through all of the points, each within a share of the radius of it.
std::optional<Arc> FitArc(std::span<const Eigen::Vector2d> points, const ArcFitOptions& options) {
  const std::optional<Circle> circle = FitCircle(points);
  if (!circle) return std::nullopt;
  Arc out;
  out.center = circle->center;
  out.radius_m = circle->radius_m;
  if (!(out.radius_m > 0) || !std::isfinite(out.radius_m)) return std::nullopt;
  const double max_off = std::min(options.max_off, options.max_off_share * out.radius_m);
  for (const auto& p : points) {
    if (std::abs((p - out.center).norm() - out.radius_m) > max_off) return std::nullopt;
  }
  const Eigen::Vector2d start = points[0] - out.center;
  out.start_rad = std::atan2(start.y(), start.x());
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d a = points[i] - out.center, b = points[i + 1] - out.center;
    out.sweep_rad += std::atan2(Cross(a, b), a.dot(b));
  }
  return std::abs(out.sweep_rad) < kMinSweep_rad ? std::nullopt : std::optional(out);
}

// The last point up to which the line turns steadily to one side.
size_t EndOfRun(std::span<const Eigen::Vector2d> p, size_t first, const ArcFitOptions& options) {
  size_t last = first + 1;
  double side = 0;
  while (last + 1 < p.size()) {
    const double turn = TurnAt(p, last), here = (p[last] - p[last - 1]).norm(), next = (p[last + 1] - p[last]).norm();
    const bool alike = next < options.max_step_ratio * here && here < options.max_step_ratio * next;
    if (!alike || std::abs(turn) > options.max_turn_rad || turn == 0 || turn * side < 0) break;
    side = turn;
    ++last;
  }
  return last;
}

double LengthOf(std::span<const Eigen::Vector2d> points) {
  double out = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) out += (points[i + 1] - points[i]).norm();
  return out;
}

void AddPart(const DrawnPath& path, size_t first, size_t last, const Arc* arc, std::vector<DrawnPath>& out) {
  if (first >= last) return;
  DrawnPath part = path;
  part.points.assign(path.points.begin() + static_cast<std::ptrdiff_t>(first), path.points.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  part.curved = arc != nullptr;
  if (arc != nullptr) part.arcs.push_back(*arc);
  out.push_back(std::move(part));
}

// All the way round from its sharpest corner, so that no arc is begun in its middle.
std::vector<Eigen::Vector2d> RingFromCorner(const std::vector<Eigen::Vector2d>& closed) {
  const size_t n = closed.size();
  size_t sharpest = 0;
  double most_rad = -1;
  for (size_t i = 0; i < n; ++i) {
    const std::array<Eigen::Vector2d, 3> here = {closed[(i + n - 1) % n], closed[i], closed[(i + 1) % n]};
    if (const double turn_rad = std::abs(TurnAt(here, 1)); turn_rad > most_rad + 1e-6) most_rad = turn_rad, sharpest = i;
  }
  std::vector<Eigen::Vector2d> out = closed;
  std::rotate(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(sharpest), out.end());
  out.push_back(out.front());
  return out;
}

// Between two points of the line.
void AddRunsBetween(std::span<const Eigen::Vector2d> points, size_t begin, size_t end, const ArcFitOptions& options, std::vector<ArcRun>& out) {
  // Coordinates of few digits make the steps of a fine line turn to and fro: all of it may be an arc all the same.
  if (end - begin >= kFine) {
    if (const auto arc = FitArc(points.subspan(begin, end - begin + 1), options)) return out.push_back({begin, end, *arc});
  }
  for (size_t first = begin; first + options.min_steps <= end;) {
    const size_t last = std::min(end, EndOfRun(points, first, options));
    if (last - first >= options.min_steps) {
      if (const auto arc = FitArc(points.subspan(first, last - first + 1), options)) out.push_back({first, last, *arc});
    }
    first = last;
  }
}

}  // namespace

std::vector<ArcRun> FindArcRuns(std::span<const Eigen::Vector2d> points, const ArcFitOptions& options) {
  std::vector<ArcRun> out;
  for (size_t begin = 0; begin + 1 < points.size();) {
    // Up to where the line turns back: the swings of two leaves are often one line.
    size_t end = begin + 1;
    while (end + 1 < points.size() && std::abs(TurnAt(points, end)) < kTurnsBack_rad) ++end;
    AddRunsBetween(points, begin, end, options, out);
    begin = end;
  }
  return out;
}

std::vector<DrawnPath> SplitAtArcs(DrawnPath path, const ArcFitOptions& options) {
  std::vector<DrawnPath> out;
  if (path.closed) {
    std::vector<Eigen::Vector2d> ring = path.points;
    ring.push_back(path.points.front());
    double curved = 0;
    for (const ArcRun& run : FindArcRuns(ring, options)) {
      path.arcs.push_back(run.arc);
      curved += std::abs(run.arc.sweep_rad) * run.arc.radius_m;
    }
    const double length = LengthOf(ring);
    if (curved < kMinShare * length) path.arcs.clear();
    path.curved = curved > kAllCurved * length;
    out.push_back(std::move(path));
    return out;
  }
  size_t at = 0;
  for (const ArcRun& run : FindArcRuns(path.points, options)) {
    AddPart(path, at, run.first, nullptr, out);
    AddPart(path, run.first, run.last, &run.arc, out);
    at = run.last;
  }
  if (at == 0) {
    out.push_back(std::move(path));
    return out;
  }
  AddPart(path, at, path.points.size() - 1, nullptr, out);
  return out;
}

void FitArcs(Drawing& drawing) {
  ArcFitOptions options;
  options.max_off = kOffArc_m;
  for (DrawnPath& path : drawing.paths) {
    const bool may_be_wall = path.role == LineRole::kWall || path.role == LineRole::kColumn || path.role == LineRole::kAny;
    if (!may_be_wall || !path.arcs.empty() || path.points.size() <= options.min_steps) continue;
    for (const ArcRun& run : FindArcRuns(path.closed ? RingFromCorner(path.points) : path.points, options)) path.arcs.push_back(run.arc);
  }
}

}  // namespace plumb::compiler
