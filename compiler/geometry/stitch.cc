#include "compiler/geometry/stitch.h"

#include <algorithm>
#include <utility>

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
  EdgeSplitter(const std::vector<Vector3d>& points, double tolerance_m) : points_(points), tolerance_m_(tolerance_m) {
    // Along the longest extent, where edges overlap the fewest other corners.
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : points) box.extend(p);
    if (!box.isEmpty()) box.sizes().maxCoeff(&axis_);
    order_.resize(points.size());
    for (size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
    std::sort(order_.begin(), order_.end(), [&](int a, int b) { return Along(a) != Along(b) ? Along(a) < Along(b) : a < b; });
  }

  // Appends the corners inside the edge from a to b, in that order.
  void AppendInside(int a, int b, std::vector<int>& ring) const {
    const Vector3d& p = points_[static_cast<size_t>(a)];
    const Vector3d edge = points_[static_cast<size_t>(b)] - p;
    const double length2 = edge.squaredNorm();
    const double low = std::min(Along(a), Along(b)) - tolerance_m_, high = std::max(Along(a), Along(b)) + tolerance_m_;
    std::vector<std::pair<double, int>> found;
    auto it = std::lower_bound(order_.begin(), order_.end(), low, [&](int i, double x) { return Along(i) < x; });
    for (; it != order_.end() && Along(*it) <= high; ++it) {
      if (*it == a || *it == b) continue;
      const Vector3d to = points_[static_cast<size_t>(*it)] - p;
      const double t = to.dot(edge);
      if (t <= 0 || t >= length2) continue;
      if ((to - edge * (t / length2)).squaredNorm() <= tolerance_m_ * tolerance_m_) found.emplace_back(t, *it);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [t, i] : found) ring.push_back(i);
  }

 private:
  double Along(int i) const { return points_[static_cast<size_t>(i)][axis_]; }

  const std::vector<Vector3d>& points_;
  double tolerance_m_;
  Eigen::Index axis_ = 0;
  std::vector<int> order_;
};

}  // namespace

Solid StitchPolygons(const std::vector<Ring3>& polygons, double tolerance_m) {
  Corners corners = Weld(polygons, tolerance_m);
  const EdgeSplitter splitter(corners.points, tolerance_m);
  Solid solid;
  for (const std::vector<int>& ring : corners.rings) {
    std::vector<int> full;
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
