#include "compiler/frontends/drawing/strokes.h"

#include <algorithm>
#include <limits>

#include "compiler/frontends/drawing/arc_band.h"
#include "compiler/frontends/drawing/arc_fit.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/units.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

constexpr double kOffArc_m = 0.01;  // what a curve's steps may be off its arc

double LengthOf(const DrawnPath& path) {
  double out = 0;
  for (size_t i = 0; i + 1 < path.points.size(); ++i) out += (path.points[i + 1] - path.points[i]).norm();
  return out + (path.closed ? (path.points.back() - path.points.front()).norm() : 0);
}

// The least thickness of strokes that are walls where layers do not tell; infinite: none are.
double LeastWall(const Drawing& drawing, const StrokeOptions& options) {
  double thinnest = std::numeric_limits<double>::infinity(), all_m = 0, thick_m = 0;
  for (const DrawnPath& path : drawing.paths) {
    if (path.role == LineRole::kWall) return std::numeric_limits<double>::infinity();
    if (path.stroke_m > 0) thinnest = std::min(thinnest, path.stroke_m);
  }
  const double least = std::max(options.min_thickness_m, options.min_ratio * thinnest);
  for (const DrawnPath& path : drawing.paths) {
    if (path.stroke_m <= 0) continue;
    const double length = LengthOf(path);
    all_m += length;
    if (path.stroke_m >= least && path.stroke_m <= options.max_thickness_m) thick_m += length;
  }
  return thick_m > options.min_length_share * all_m ? least : std::numeric_limits<double>::infinity();
}

bool IsWide(const DrawnPath& path, const StrokeOptions& options) {
  return path.stroke_m >= options.min_thickness_m && path.stroke_m <= options.max_thickness_m && path.points.size() > 1 && !path.filled;
}

class Widener {
 public:
  explicit Widener(const std::vector<const DrawnPath*>& strokes) {
    std::vector<Eigen::AlignedBox2d> ends;
    for (const DrawnPath* path : strokes) {
      if (path->closed) continue;
      ends.emplace_back(path->points.front());
      ends.emplace_back(path->points.back());
    }
    ends_ = BoxTree<2>(std::move(ends));
  }

  // One strip for each arc and one box for each other side, longer by half of the thickness where another side or stroke goes on, so that
  // corners close.
  void AddWalls(const DrawnPath& path, std::vector<DrawnPath>& out) const {
    std::vector<Eigen::Vector2d> points = path.points;
    if (path.closed) points.push_back(points.front());
    ArcFitOptions options;
    options.max_off = kOffArc_m;
    size_t at = 0;
    for (const ArcRun& run : FindArcRuns(points, options)) {
      if (run.arc.radius_m <= path.stroke_m) continue;
      for (; at < run.first; ++at) AddBox(path, points, at, out);
      AddStrips(path, points, run, out);
      at = run.last;
    }
    for (; at + 1 < points.size(); ++at) AddBox(path, points, at, out);
  }

 private:
  // How much longer the wall is that has this point of the stroke for its end.
  double Longer_m(const DrawnPath& path, const std::vector<Eigen::Vector2d>& points, size_t end) const {
    const double half = 0.5 * path.stroke_m;
    return path.closed || (end > 0 && end + 1 < points.size()) || Meets(points[end], half) ? half : 0;
  }

  void AddBox(const DrawnPath& path, const std::vector<Eigen::Vector2d>& points, size_t i, std::vector<DrawnPath>& out) const {
    const Eigen::Vector2d d = points[i + 1] - points[i];
    if (d.norm() <= 0) return;
    const Eigen::Vector2d along = d.normalized(), side = 0.5 * path.stroke_m * Perp(along);
    const Eigen::Vector2d from = points[i] - Longer_m(path, points, i) * along, to = points[i + 1] + Longer_m(path, points, i + 1) * along;
    AddWall(path, {from - side, to - side, to + side, from + side}, {}, out);
  }

  void AddStrips(const DrawnPath& path, const std::vector<Eigen::Vector2d>& points, const ArcRun& run, std::vector<DrawnPath>& out) const {
    for (ArcBand& band : BandsAlong(run.arc, 0.5 * path.stroke_m, Longer_m(path, points, run.first), Longer_m(path, points, run.last)))
      AddWall(path, std::move(band.outline), {band.sides.begin(), band.sides.end()}, out);
  }

  static void AddWall(const DrawnPath& path, std::vector<Eigen::Vector2d> outline, std::vector<Arc> sides, std::vector<DrawnPath>& out) {
    DrawnPath wall = path;
    wall.role = LineRole::kWall;
    wall.points = std::move(outline);
    wall.closed = wall.filled = true;
    wall.curved = !sides.empty();
    wall.arcs = std::move(sides);
    out.push_back(std::move(wall));
  }

  // Another stroke's end besides the one at `p`.
  bool Meets(const Eigen::Vector2d& p, double reach) const {
    int count = 0;
    const Eigen::Vector2d r = Eigen::Vector2d::Constant(reach);
    ends_.ForEachIn({p - r, p + r}, [&](uint32_t) { ++count; });
    return count > 1;
  }

  BoxTree<2> ends_;
};

}  // namespace

void WidenStrokes(Drawing& drawing, const StrokeOptions& options) {
  const double least = LeastWall(drawing, options);
  const bool by_thickness = least < std::numeric_limits<double>::infinity();
  // Walls that are drawn by both of their sides are as thick as these lie apart.
  const double apart_m = by_thickness ? 0 : MeasureSizes(drawing).wall;
  const bool layers_tell = apart_m == 0 || apart_m > options.max_thickness_m;
  const auto is_wall = [&](const DrawnPath& path) {
    if (!IsWide(path, options)) return false;
    return by_thickness ? path.role == LineRole::kAny && path.stroke_m >= least : path.role == LineRole::kWall && layers_tell;
  };
  std::vector<const DrawnPath*> strokes;
  for (const DrawnPath& path : drawing.paths) {
    if (is_wall(path)) strokes.push_back(&path);
  }
  const Widener widener(strokes);
  std::vector<DrawnPath> out;
  for (DrawnPath& path : drawing.paths) {
    if (is_wall(path)) {
      widener.AddWalls(path, out);
      continue;
    }
    if (by_thickness && path.role == LineRole::kAny) path.role = LineRole::kOpening;
    out.push_back(std::move(path));
  }
  drawing.paths = std::move(out);
}

}  // namespace plumb::compiler
