#include "compiler/geometry/stitch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

// The vertices of all polygons, welded: a solid whose triangles are only a means to carry the corners' numbers.
struct Corners {
  std::vector<Vector3d> points;
  std::vector<std::vector<int>> rings;
};

Corners Weld(const std::vector<Ring3>& polygons, double tolerance_m) {
  Corners out;
  VertexWelder welder(tolerance_m);
  for (const Ring3& polygon : polygons) {
    std::vector<int> ring;
    for (const Vector3d& p : polygon) {
      const int v = welder.FindOrAdd(p);
      if (ring.empty() || ring.back() != v) ring.push_back(v);
    }
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() >= 3) out.rings.push_back(std::move(ring));
  }
  out.points = welder.Take();
  return out;
}

class EdgeSplitter {
 public:
  EdgeSplitter(const std::vector<Vector3d>& points, double tolerance_m) : points_(points), tolerance_m_(tolerance_m), tree_(BoxesOf(points)) {}

  // Appends the corners inside the edge from a to b, in that order.
  void AppendInside(int a, int b, std::vector<int>& ring) {
    const Vector3d& p = points_[static_cast<size_t>(a)];
    const Vector3d edge = points_[static_cast<size_t>(b)] - p;
    const double length2 = edge.squaredNorm();
    found_.clear();
    tree_.ForEach([&](const Eigen::AlignedBox3d& box) { return PassesNear(p, edge, box); }, [&](uint32_t i) {
      const int corner = static_cast<int>(i);
      if (corner == a || corner == b) return;
      const Vector3d to = points_[i] - p;
      const double t = to.dot(edge);
      if (t <= 0 || t >= length2) return;
      if ((to - edge * (t / length2)).squaredNorm() <= tolerance_m_ * tolerance_m_) found_.emplace_back(t, corner);
    });
    std::sort(found_.begin(), found_.end());
    for (const auto& [t, i] : found_) ring.push_back(i);
  }

 private:
  static std::vector<Eigen::AlignedBox3d> BoxesOf(const std::vector<Vector3d>& points) {
    std::vector<Eigen::AlignedBox3d> out;
    out.reserve(points.size());
    for (const Vector3d& p : points) out.emplace_back(p);
    return out;
  }

  // Whether p + t edge for some t in [0, 1] lies in the box and a margin, which is twice the tolerance so that rounding takes none away.
  [[nodiscard]] bool PassesNear(const Vector3d& p, const Vector3d& edge, const Eigen::AlignedBox3d& box) const {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box.min()[axis] - 2 * tolerance_m_ - p[axis], high = box.max()[axis] + 2 * tolerance_m_ - p[axis];
      if (std::abs(edge[axis]) <= tolerance_m_ / 2) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const double s = low / edge[axis], t = high / edge[axis];
      enter = std::max(enter, std::min(s, t));
      leave = std::min(leave, std::max(s, t));
      if (enter > leave) return false;
    }
    return true;
  }

  const std::vector<Vector3d>& points_;
  double tolerance_m_;
  BoxTree<3> tree_;
  std::vector<std::pair<double, int>> found_;  // kept for its memory
};

}  // namespace

Solid StitchPolygons(const std::vector<Ring3>& polygons, double tolerance_m) {
  Corners corners = Weld(polygons, tolerance_m);
  EdgeSplitter splitter(corners.points, tolerance_m);
  Solid solid;
  std::vector<int> full;
  for (const std::vector<int>& ring : corners.rings) {
    full.clear();
    for (size_t i = 0; i < ring.size(); ++i) {
      full.push_back(ring[i]);
      splitter.AppendInside(ring[i], ring[(i + 1) % ring.size()], full);
    }
    if (full.size() == 3) {
      solid.triangles.emplace_back(full[0], full[1], full[2]);
      continue;
    }
    Ring3 points;
    for (const int v : full) points.push_back(corners.points[static_cast<size_t>(v)]);
    Solid face;
    if (!AppendFace(std::vector<Ring3>{points}, face)) continue;  // a sliver: its neighbours meet through its corners
    for (const Eigen::Vector3i& t : face.triangles) {
      if (t.maxCoeff() >= static_cast<int>(full.size())) continue;  // on a sliver whose sides cross within the tolerance
      solid.triangles.emplace_back(full[static_cast<size_t>(t[0])], full[static_cast<size_t>(t[1])], full[static_cast<size_t>(t[2])]);
    }
  }
  solid.vertices = std::move(corners.points);
  return solid;
}

}  // namespace plumb::compiler
