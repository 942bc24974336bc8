#include "compiler/frontends/drawing/strokes.h"

#include <algorithm>
#include <limits>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/units.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

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

  // One box for each side, longer by half of the thickness where another side or stroke goes on, so that corners close.
  void AddBoxes(const DrawnPath& path, std::vector<DrawnPath>& out) const {
    const double half = 0.5 * path.stroke_m;
    const size_t sides = path.points.size() - (path.closed ? 0 : 1);
    for (size_t i = 0; i < sides; ++i) {
      const Eigen::Vector2d a = path.points[i], b = path.points[(i + 1) % path.points.size()], d = b - a;
      if (d.norm() <= 0) continue;
      const Eigen::Vector2d along = half * d.normalized(), side = Perp(along);
      const Eigen::Vector2d from = path.closed || i > 0 || Meets(a, half) ? a - along : a;
      const Eigen::Vector2d to = path.closed || i + 1 < sides || Meets(b, half) ? b + along : b;
      DrawnPath box = path;
      box.role = LineRole::kWall;
      box.points = {from - side, to - side, to + side, from + side};
      box.closed = box.filled = true;
      box.arcs.clear();
      out.push_back(std::move(box));
    }
  }

 private:
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
      widener.AddBoxes(path, out);
      continue;
    }
    if (by_thickness && path.role == LineRole::kAny) path.role = LineRole::kOpening;
    out.push_back(std::move(path));
  }
  drawing.paths = std::move(out);
}

}  // namespace plumb::compiler
