#include "compiler/geometry/stitch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// What lies within a distance of an edge, and a little more, so that rounding takes nothing away.
class EdgeZone {
 public:
  EdgeZone(const Vector3d& start, const Vector3d& edge, double distance_m)
      : middle_(start + 0.5 * edge), half_(0.5 * edge), reach_(half_.cwiseAbs()), margin_m_(2 * distance_m) {}

  // By separating axes: the box's own, and those across one of them and the edge.
  [[nodiscard]] bool Meets(const Eigen::AlignedBox3d& box) const {
    const Vector3d h = 0.5 * (box.max() - box.min()) + Vector3d::Constant(margin_m_), d = 0.5 * (box.min() + box.max()) - middle_;
    if (std::abs(d.x()) > h.x() + reach_.x() || std::abs(d.y()) > h.y() + reach_.y() || std::abs(d.z()) > h.z() + reach_.z()) return false;
    return std::abs(half_.y() * d.z() - half_.z() * d.y()) <= h.y() * reach_.z() + h.z() * reach_.y() &&
           std::abs(half_.z() * d.x() - half_.x() * d.z()) <= h.z() * reach_.x() + h.x() * reach_.z() &&
           std::abs(half_.x() * d.y() - half_.y() * d.x()) <= h.x() * reach_.y() + h.y() * reach_.x();
  }

 private:
  Vector3d middle_, half_, reach_;
  double margin_m_;
};

class EdgeSplitter {
 public:
  EdgeSplitter(const std::vector<Vector3d>& points, double tolerance_m)
      : points_(points), tolerance_m_(tolerance_m), tree_(BoxesOf(points)) {}

  // Appends the corners inside the edge from a to b, in that order.
  void AppendInside(int a, int b, std::vector<int>& ring) {
    const Vector3d& p = points_[static_cast<size_t>(a)];
    const Vector3d edge = points_[static_cast<size_t>(b)] - p;
    const double length2 = edge.squaredNorm();
    found_.clear();
    const EdgeZone zone(p, edge, tolerance_m_);
    tree_.ForEach([&zone](const Eigen::AlignedBox3d& box) { return zone.Meets(box); }, [&](uint32_t i) {
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

  const std::vector<Vector3d>& points_;
  double tolerance_m_;
  BoxTree<3> tree_;
  std::vector<std::pair<double, int>> found_;  // kept for its memory
};

// For each edge of each ring, in their order: whether other edges run along it as often the one way as the other. Such edges
// fit as they are.
std::vector<bool> Balanced(const std::vector<std::vector<int>>& rings) {
  struct Edge {
    int low, high;
    uint32_t number;
    bool forward;
  };
  std::vector<Edge> edges;
  for (const std::vector<int>& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const int a = ring[i], b = ring[(i + 1) % ring.size()];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<uint32_t>(edges.size()), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::vector<bool> out(edges.size());
  for (size_t i = 0, j = 0; i < edges.size(); i = j) {
    int net = 0;
    for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j) net += edges[j].forward ? 1 : -1;
    for (size_t k = i; k < j; ++k) out[edges[k].number] = net == 0;
  }
  return out;
}

}  // namespace

Solid StitchPolygons(const std::vector<Ring3>& polygons, double tolerance_m) {
  Corners corners = Weld(polygons, tolerance_m);
  const std::vector<bool> balanced = Balanced(corners.rings);
  EdgeSplitter splitter(corners.points, tolerance_m);
  Solid solid;
  std::vector<int> full;
  size_t edge = 0;
  for (const std::vector<int>& ring : corners.rings) {
    full.clear();
    for (size_t i = 0; i < ring.size(); ++i) {
      full.push_back(ring[i]);
      if (!balanced[edge++]) splitter.AppendInside(ring[i], ring[(i + 1) % ring.size()], full);
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
