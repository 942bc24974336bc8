#include "compiler/passes/polygon.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace plumb::compiler {
namespace {

struct Edge {
  Eigen::Vector2d a, b;
  int region;  // 0 or 1
};

void AppendEdges(std::span<const Ring> rings, int region, std::vector<Edge>& out) {
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) out.push_back({ring[i], ring[(i + 1) % ring.size()], region});
  }
}

double Low(const Edge& e) { return std::min(e.a.y(), e.b.y()); }
double High(const Edge& e) { return std::max(e.a.y(), e.b.y()); }

bool BesideEachOther(const Edge& e, const Edge& f) {
  return std::max(e.a.x(), e.b.x()) < std::min(f.a.x(), f.b.x()) || std::max(f.a.x(), f.b.x()) < std::min(e.a.x(), e.b.x());
}

constexpr size_t kMaxHeights = 1 << 14;  // beyond: hostile; evenly spread rows stand in

// Heights at which the order of the edges along x may change: ends and crossings. `edges` by their low ends.
std::vector<double> EventHeights(const std::vector<Edge>& edges) {
  std::vector<double> out;
  for (const Edge& e : edges) out.push_back(e.a.y());
  size_t i = 0;
  for (; i < edges.size() && out.size() < kMaxHeights; ++i) {
    const Eigen::Vector2d u = edges[i].b - edges[i].a;
    for (size_t j = i + 1; j < edges.size() && Low(edges[j]) <= High(edges[i]); ++j) {
      if (BesideEachOther(edges[i], edges[j])) continue;
      const Eigen::Vector2d v = edges[j].b - edges[j].a, w = edges[j].a - edges[i].a;
      const double det = Cross(u, v);
      if (det == 0) continue;
      const double s = Cross(w, v) / det, t = Cross(w, u) / det;
      if (s > 0 && s < 1 && t > 0 && t < 1) out.push_back(edges[i].a.y() + s * u.y());
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (i == edges.size()) return out;
  const double low = out.front(), step = (out.back() - low) / static_cast<double>(kMaxHeights - 1);
  out.resize(kMaxHeights);
  for (size_t k = 0; k < kMaxHeights; ++k) out[k] = low + step * static_cast<double>(k);
  return out;
}

// Length along y of the part that is inside both regions.
double WidthAt(const std::vector<Edge>& edges, double y) {
  struct Crossing {
    double x;
    int region, step;
  };
  std::vector<Crossing> crossings;
  for (const Edge& e : edges) {
    if ((e.a.y() <= y) == (e.b.y() <= y)) continue;
    const double x = e.a.x() + (e.b.x() - e.a.x()) * (y - e.a.y()) / (e.b.y() - e.a.y());
    crossings.push_back({x, e.region, e.a.y() <= y ? 1 : -1});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& l, const Crossing& r) { return l.x < r.x; });
  int winding[2] = {0, 0};
  double width = 0, last_x = 0;
  for (const Crossing& c : crossings) {
    if (winding[0] != 0 && winding[1] != 0) width += c.x - last_x;
    winding[c.region] += c.step;
    last_x = c.x;
  }
  return width;
}

}  // namespace

std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), LexicographicallyLess);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  const auto extend = [&hull](const Eigen::Vector2d& p, size_t keep) {
    while (hull.size() > keep && Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const auto& p : points) extend(p, 1);
  const size_t lower = hull.size();
  for (size_t i = points.size() - 1; i-- > 0;) extend(points[i], lower);
  hull.pop_back();
  return hull;
}

Eigen::Vector2d Centroid(std::span<const Ring> rings) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), mean = Eigen::Vector2d::Zero();
  double area = 0;
  size_t count = 0;
  if (rings.empty() || rings[0].empty()) return mean;
  const Eigen::Vector2d base = rings[0][0];
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d p = ring[i] - base, q = ring[(i + 1) % ring.size()] - base;
      const double cross = Cross(p, q);
      sum += cross * (p + q) / 6;
      area += cross / 2;
      mean += p;
      ++count;
    }
  }
  return base + (std::abs(area) > 1e-12 ? Eigen::Vector2d(sum / area) : Eigen::Vector2d(mean / static_cast<double>(count)));
}

int WindingNumber(std::span<const Ring> rings, const Eigen::Vector2d& p) {
  int winding = 0;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
      const double side = Cross(b - a, p - a);
      if (a.y() <= p.y() && side > 0) ++winding;
      if (b.y() <= p.y() && side < 0) --winding;
    }
  }
  return winding;
}

double OverlapArea(std::span<const Ring> a, std::span<const Ring> b) {
  std::vector<Edge> edges;
  AppendEdges(a, 0, edges);
  AppendEdges(b, 1, edges);
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& l, const Edge& r) { return Low(l) < Low(r); });
  const std::vector<double> heights = EventHeights(edges);
  double area = 0;
  std::vector<Edge> active;  // that reach into the current row
  size_t next = 0;
  // Between two events every part is a trapezoid: its mean width is the one at half height.
  for (size_t i = 1; i < heights.size(); ++i) {
    const double y = 0.5 * (heights[i - 1] + heights[i]);
    std::erase_if(active, [&](const Edge& e) { return High(e) < y; });
    for (; next < edges.size() && Low(edges[next]) <= y; ++next) {
      if (High(edges[next]) >= y) active.push_back(edges[next]);
    }
    area += WidthAt(active, y) * (heights[i] - heights[i - 1]);
  }
  return area;
}

double RegionArea(std::span<const Ring> rings) { return OverlapArea(rings, rings); }

std::vector<Eigen::Vector2d> CommonCorners(std::span<const Ring> a, std::span<const Ring> b) {
  std::vector<Eigen::Vector2d> out;
  const auto add_inside = [&out](std::span<const Ring> corners, std::span<const Ring> region) {
    for (const Ring& ring : corners) {
      std::copy_if(ring.begin(), ring.end(), std::back_inserter(out), [&](const auto& p) { return WindingNumber(region, p) != 0; });
    }
  };
  add_inside(a, b);
  add_inside(b, a);
  std::vector<Edge> edges;
  AppendEdges(a, 0, edges);
  const auto split = static_cast<std::ptrdiff_t>(edges.size());
  AppendEdges(b, 1, edges);
  for (auto e = edges.begin(); e != edges.begin() + split; ++e) {
    for (auto f = edges.begin() + split; f != edges.end(); ++f) {
      const Eigen::Vector2d u = e->b - e->a, v = f->b - f->a, w = f->a - e->a;
      const double det = Cross(u, v);
      if (det == 0) continue;
      const double s = Cross(w, v) / det, t = Cross(w, u) / det;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) out.push_back(e->a + s * u);
    }
  }
  return out;
}

Ring Simplified(const Ring& ring, double tolerance_m) {
  Ring out = ring;
  bool changed = true;
  while (changed && out.size() >= 3) {
    changed = false;
    for (size_t i = 0; i < out.size() && out.size() >= 3;) {
      const Eigen::Vector2d &before = out[(i + out.size() - 1) % out.size()], &here = out[i], &after = out[(i + 1) % out.size()];
      const bool on_line = DistanceToSegment(here, before, after) <= tolerance_m;
      const bool spike = DistanceToSegment(after, before, here) <= tolerance_m && (after - here).dot(before - here) > 0;
      if (!on_line && !spike) {
        ++i;
        continue;
      }
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  if (out.size() < 3) out.clear();
  return out;
}

double DistanceToRings(const Eigen::Vector2d& p, std::span<const Ring> rings) {
  double best = std::numeric_limits<double>::infinity();
  for (const Ring& ring : rings) best = std::min(best, DistanceToRing(ring, p));
  return best;
}

Eigen::AlignedBox2d BoundingBox(std::span<const Ring> rings) {
  Eigen::AlignedBox2d box;
  for (const Ring& ring : rings) {
    for (const auto& p : ring) box.extend(p);
  }
  return box;
}

Ring LeastRectangle(std::vector<Eigen::Vector2d> points) {
  const std::vector<Eigen::Vector2d> hull = ConvexHull(std::move(points));
  if (hull.size() < 3) return hull;
  double best = std::numeric_limits<double>::infinity();
  Ring out;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d u = (hull[(i + 1) % hull.size()] - hull[i]).normalized(), v = Rot90Ccw(u);
    Eigen::AlignedBox2d box;
    for (const auto& p : hull) box.extend(Eigen::Vector2d(u.dot(p), v.dot(p)));
    if (box.volume() >= best - 1e-9) continue;
    best = box.volume();
    const Eigen::Vector2d lo = box.min(), hi = box.max();
    out = {lo.x() * u + lo.y() * v, hi.x() * u + lo.y() * v, hi.x() * u + hi.y() * v, lo.x() * u + hi.y() * v};
  }
  return out;
}

}  // namespace plumb::compiler
