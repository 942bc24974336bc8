#include "runtime/rooms/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/rooms/border_tracing.h"

namespace plumb::runtime {
namespace {

constexpr double kOnWall_m = 0.15;  // of a border from the wall that it follows
constexpr double kPastEnd_m = 0.1;  // beyond the wall's ends
constexpr double kFacingCos = 0.75;
constexpr int kSmoothing = 4;         // steps either side that tell a border's direction
constexpr double kShortRun_m = 0.16;  // shorter ones are noise
constexpr double kTolerance_m = 0.08;
constexpr double kCornerSin = 0.26, kCornerReach_m = 0.35;
constexpr double kMinHole_m2 = 0.05;
constexpr double kMaxAreaChange = 0.25;  // by putting the outline onto walls; more is a mistake

constexpr int kUnseen = -1, kSeen = -2, kNeighbour = -3;  // what is not on a wall

// Steps that follow one wall, or none.
struct Run {
  int on = kUnseen;  // index of the wall, or one of the above
  size_t first = 0, count = 0;
};

class OutlineTracer {
 public:
  OutlineTracer(const FreeSpace& space, const Regions& regions, int32_t region, const Eigen::Vector2i& lo, const Eigen::Vector2i& hi)
      : space_(space), regions_(regions), region_(region), lo_(lo), hi_(hi) {
    Eigen::AlignedBox2d box(Corner(lo), Corner(hi + Eigen::Vector2i(1, 1)));
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kOnWall_m);
    box = Eigen::AlignedBox2d(box.min() - margin, box.max() + margin);
    for (const WallPiece& wall : space.walls) {
      if (box.intersects(Eigen::AlignedBox2d(wall.start.cwiseMin(wall.end), wall.start.cwiseMax(wall.end)))) walls_.push_back(wall);
    }
  }

  Outline Trace() {
    Outline outline;
    double best_m2 = 0;
    for (const Border& border : TraceBorders(space_.grid, regions_.label, region_, lo_, hi_)) {
      const std::vector<Run> runs = RunsOf(border);
      Count(border, runs, outline.longest_unseen_m);
      const Polygon2 polygon = PolygonOf(border, runs);
      const double area_m2 = SignedArea(polygon);
      if (area_m2 > best_m2) {
        best_m2 = area_m2;
        outline.polygon = polygon;
      } else if (area_m2 <= -kMinHole_m2) {
        outline.holes.push_back(polygon);
      }
    }
    outline.covered_ratio = border_steps_ > 0 ? static_cast<double>(wall_steps_) / static_cast<double>(border_steps_) : 0;
    outline.surfaces.assign(surfaces_.begin(), surfaces_.end());
    return outline;
  }

 private:
  [[nodiscard]] Eigen::Vector2d Corner(const Eigen::Vector2i& c) const {
    return space_.grid.origin + space_.grid.cell_m * c.cast<double>();
  }

  // What the step is on: a wall if one is near and faces the region.
  [[nodiscard]] int WhatIsAt(const Border& border, size_t i) const {
    const size_t n = border.size();
    const Eigen::Vector2d ahead = Corner(border[(i + kSmoothing) % n].from), behind = Corner(border[(i + n - kSmoothing % n) % n].from);
    const Eigen::Vector2d along = (ahead - behind).normalized(), inwards(-along.y(), along.x());
    const Eigen::Vector2d p = Corner(border[i].from) + 0.5 * space_.grid.cell_m * StepOf(border[i].direction).cast<double>();
    int best = kUnseen;
    double best_m = kOnWall_m;
    for (size_t w = 0; w < walls_.size(); ++w) {
      const WallPiece& wall = walls_[w];
      const double off_m = std::abs(wall.normal().dot(p - wall.start));
      if (off_m > best_m || wall.normal().dot(inwards) < kFacingCos) continue;
      const double at_m = wall.along().dot(p - wall.start);
      if (at_m < -kPastEnd_m || at_m > wall.length_m() + kPastEnd_m) continue;
      best_m = off_m;
      best = static_cast<int>(w);
    }
    return best != kUnseen ? best : BeyondStep(border[i]);
  }

  [[nodiscard]] int BeyondStep(const BorderStep& step) const {
    const Eigen::Vector2i outside = OutsideOf(step);
    const FloorGrid& grid = space_.grid;
    bool seen = false;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = outside.x() + dx, y = outside.y() + dy;
        if (!grid.Contains(x, y)) continue;
        const size_t i = grid.Index(x, y);
        if (regions_.label[i] >= 0 && regions_.label[i] != region_) return kNeighbour;
        seen = seen || space_.cells[i] == CellState::kHit || space_.cells[i] == CellState::kWall;
      }
    }
    return seen ? kSeen : kUnseen;
  }

  // Cyclic; starts where one run ends, if there are several.
  [[nodiscard]] std::vector<Run> RunsOf(const Border& border) const {
    const size_t n = border.size();
    std::vector<int> on(n);
    for (size_t i = 0; i < n; ++i) on[i] = WhatIsAt(border, i);
    size_t start = 0;
    while (start < n && on[start] == on[(start + n - 1) % n]) ++start;
    if (start == n) return {{on[0], 0, n}};
    std::vector<Run> runs;
    for (size_t k = 0; k < n; ++k) {
      const size_t i = (start + k) % n;
      if (runs.empty() || runs.back().on != on[i]) runs.push_back({on[i], i, 0});
      ++runs.back().count;
    }
    return WithoutNoise(std::move(runs), n);
  }

  // A short run between two others becomes part of the one before.
  [[nodiscard]] std::vector<Run> WithoutNoise(std::vector<Run> runs, size_t num_steps) const {
    const auto least = static_cast<size_t>(kShortRun_m / space_.grid.cell_m);
    std::vector<Run> out;
    for (const Run& run : runs) {
      if (!out.empty() && (run.on == out.back().on || run.count < least)) {
        out.back().count += run.count;
      } else {
        out.push_back(run);
      }
    }
    if (out.size() > 1 && (out.front().on == out.back().on || out.front().count < least)) {
      out.back().count += out.front().count;
      out.erase(out.begin());
    }
    if (out.size() == 1) out.front().count = num_steps;
    return out;
  }

  void Count(const Border& border, const std::vector<Run>& runs, double& longest_unseen_m) {
    for (const Run& run : runs) {
      if (run.on == kNeighbour) continue;
      border_steps_ += run.count;
      if (run.on >= 0) {
        wall_steps_ += run.count;
        surfaces_.insert(walls_[static_cast<size_t>(run.on)].surface);
      }
      if (run.on != kUnseen) continue;
      const Eigen::Vector2d from = Corner(border[run.first].from), to = Corner(border[(run.first + run.count) % border.size()].from);
      longest_unseen_m =
          std::max(longest_unseen_m, run.count == border.size() ? static_cast<double>(run.count) * space_.grid.cell_m : (to - from).norm());
    }
  }

  [[nodiscard]] Eigen::Vector2d OnWall(int on, const Eigen::Vector2d& p) const {
    const WallPiece& wall = walls_[static_cast<size_t>(on)];
    return p - wall.normal().dot(p - wall.start) * wall.normal();
  }

  // Where two runs meet: the corner of two walls, or the place on each.
  void AddJoint(int before, int after, const Eigen::Vector2d& at, Polygon2* out) const {
    if (before >= 0 && after >= 0) {
      const WallPiece &a = walls_[static_cast<size_t>(before)], &b = walls_[static_cast<size_t>(after)];
      const double sine = a.along().x() * b.along().y() - a.along().y() * b.along().x();
      if (std::abs(sine) > kCornerSin) {
        const Eigen::Vector2d corner = a.start + a.along() * (b.normal().dot(b.start - a.start) / b.normal().dot(a.along()));
        if ((corner - at).norm() <= kCornerReach_m) {
          out->push_back(corner);
          return;
        }
      }
    }
    if (before >= 0) out->push_back(OnWall(before, at));
    if (after >= 0) out->push_back(OnWall(after, at));
  }

  // The corners within a run that is on no wall, so that none is off by more than the tolerance (Douglas and Peucker 1973).
  void AddSimplified(const Polygon2& way, size_t from, size_t to, Polygon2* out) const {
    double worst_m = kTolerance_m;
    size_t worst = from;
    const Eigen::Vector2d along = way[to] - way[from];
    for (size_t i = from + 1; i < to; ++i) {
      const Eigen::Vector2d step = way[i] - way[from];
      const double t = along.squaredNorm() > 0 ? std::clamp(step.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
      const double off_m = (step - t * along).norm();
      if (off_m <= worst_m) continue;
      worst_m = off_m;
      worst = i;
    }
    if (worst == from) return;
    AddSimplified(way, from, worst, out);
    out->push_back(way[worst]);
    AddSimplified(way, worst, to, out);
  }

  [[nodiscard]] Polygon2 WayOf(const Border& border, size_t first, size_t count) const {
    Polygon2 way;
    for (size_t k = 0; k <= count; ++k) way.push_back(Corner(border[(first + k) % border.size()].from));
    return way;
  }

  [[nodiscard]] Polygon2 Simplified(const Border& border) const {
    const Polygon2 way = WayOf(border, 0, border.size());
    Polygon2 out = {way.front()};
    AddSimplified(way, 0, way.size() - 1, &out);
    return out;
  }

  [[nodiscard]] Polygon2 PolygonOf(const Border& border, const std::vector<Run>& runs) const {
    const Polygon2 plain = Simplified(border);
    if (runs.size() == 1) return plain;
    Polygon2 out;
    for (size_t r = 0; r < runs.size(); ++r) {
      const Run &run = runs[r], &before = runs[(r + runs.size() - 1) % runs.size()];
      const Polygon2 way = WayOf(border, run.first, run.count);
      if (run.on < 0 && before.on < 0) out.push_back(way.front());
      AddJoint(before.on, run.on, way.front(), &out);
      if (run.on < 0) AddSimplified(way, 0, way.size() - 1, &out);
    }
    const double area_m2 = SignedArea(plain);
    return std::abs(SignedArea(out) - area_m2) <= kMaxAreaChange * std::abs(area_m2) ? out : plain;
  }

  const FreeSpace& space_;
  const Regions& regions_;
  int32_t region_;
  Eigen::Vector2i lo_, hi_;
  std::vector<WallPiece> walls_;  // near the region
  std::set<uint32_t> surfaces_;
  size_t border_steps_ = 0, wall_steps_ = 0;
};

}  // namespace

double SignedArea(const Polygon2& polygon) {
  double twice = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

Eigen::Vector2d AreaCentroid(const Polygon2& polygon) {
  if (polygon.empty()) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d& zero = polygon.front();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double twice = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - zero, b = polygon[(i + 1) % polygon.size()] - zero;
    const double cross = a.x() * b.y() - a.y() * b.x();
    twice += cross;
    sum += cross * (a + b) / 3;
  }
  return twice == 0 ? zero : Eigen::Vector2d(zero + sum / twice);
}

std::vector<Outline> TraceOutlines(const FreeSpace& space, const Regions& regions) {
  const auto count = static_cast<size_t>(regions.count);
  const FloorGrid& grid = space.grid;
  std::vector<Eigen::Vector2i> lo(count, {grid.width, grid.height}), hi(count, {-1, -1});
  for (size_t i = 0; i < regions.label.size(); ++i) {
    if (regions.label[i] < 0) continue;
    const auto r = static_cast<size_t>(regions.label[i]);
    const Eigen::Vector2i cell(grid.X(i), grid.Y(i));
    lo[r] = lo[r].cwiseMin(cell);
    hi[r] = hi[r].cwiseMax(cell);
  }
  std::vector<Outline> outlines;
  for (size_t r = 0; r < count; ++r) outlines.push_back(OutlineTracer(space, regions, static_cast<int32_t>(r), lo[r], hi[r]).Trace());
  return outlines;
}

}  // namespace plumb::runtime
