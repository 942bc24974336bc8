#include "compiler/frontends/drawing/line_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/cell_lists.h"

namespace plumb::compiler {
namespace {

// Makes points within a radius one: the earliest.
class PointWelder {
 public:
  explicit PointWelder(double radius_m) : radius_m_(radius_m), cells_(radius_m) {}

  uint32_t FindOrAdd(const Eigen::Vector2d& p) {
    auto found = static_cast<uint32_t>(points_.size());
    cells_.ForEachNear(p, [&](uint32_t i) {
      if (i < found && (points_[i] - p).squaredNorm() <= radius_m_ * radius_m_) found = i;
    });
    if (found < points_.size()) return found;
    cells_.Add(p);
    points_.push_back(p);
    return found;
  }
  std::vector<Eigen::Vector2d>& points() { return points_; }

 private:
  double radius_m_;
  std::vector<Eigen::Vector2d> points_;
  CellLists cells_;
};

struct Segment {
  uint32_t a, b, source;
};

// Where a segment is cut.
struct Stop {
  uint32_t segment, vertex;
};

// Cuts the lines where they cross or touch.
class Splitter {
 public:
  Splitter(std::span<const MapLine> lines, double join_m, size_t max_vertices)
      : join_m_(join_m), max_vertices_(max_vertices), welder_(join_m) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const MapLine& line : lines) {
      const uint32_t a = welder_.FindOrAdd(line.a), b = welder_.FindOrAdd(line.b);
      if (a == b) continue;
      segments_.push_back({a, b, line.source});
      Eigen::AlignedBox2d box(welder_.points()[a]);
      box.extend(welder_.points()[b]);
      box.min().array() -= join_m;
      box.max().array() += join_m;
      boxes.push_back(box);
    }
    tree_ = BoxTree<2>(boxes);
    boxes_ = std::move(boxes);
  }

  // False: too many crossings.
  bool Run() {
    std::vector<uint32_t> near;
    for (uint32_t i = 0; i < segments_.size(); ++i) {
      near.clear();
      tree_.ForEachIn(boxes_[i], [&](uint32_t j) {
        if (j > i) near.push_back(j);
      });
      std::sort(near.begin(), near.end());
      for (const uint32_t j : near) Cut(i, j);
      if (welder_.points().size() + cuts_.size() > max_vertices_) return false;
    }
    return true;
  }

  std::vector<LineMap::Edge> Edges() {
    std::vector<LineMap::Edge> out;
    std::vector<std::pair<double, uint32_t>> stops;
    std::stable_sort(cuts_.begin(), cuts_.end(), [](const Stop& x, const Stop& y) { return x.segment < y.segment; });
    auto cut = cuts_.begin();
    for (size_t i = 0; i < segments_.size(); ++i) {
      stops.clear();
      const Segment& s = segments_[i];
      const Eigen::Vector2d a = Point(s.a), d = Point(s.b) - a;
      stops.emplace_back(0.0, s.a);
      for (; cut != cuts_.end() && cut->segment == i; ++cut)
        stops.emplace_back(d.dot(Point(cut->vertex) - a) / d.squaredNorm(), cut->vertex);
      stops.emplace_back(1.0, s.b);
      std::sort(stops.begin(), stops.end());
      for (size_t k = 0; k + 1 < stops.size(); ++k) {
        if (stops[k].second != stops[k + 1].second) out.push_back({stops[k].second, stops[k + 1].second, s.source});
      }
    }
    const auto key = [](const LineMap::Edge& e) { return std::minmax(e.a, e.b); };
    std::stable_sort(out.begin(), out.end(), [&](const auto& x, const auto& y) { return key(x) < key(y); });
    out.erase(std::unique(out.begin(), out.end(), [&](const auto& x, const auto& y) { return key(x) == key(y); }), out.end());
    return out;
  }

  std::vector<Eigen::Vector2d> TakePoints() { return std::move(welder_.points()); }

 private:
  const Eigen::Vector2d& Point(uint32_t v) { return welder_.points()[v]; }

  // Whether the vertex lies within the segment, not at its ends.
  bool LiesOn(uint32_t vertex, const Segment& s) {
    if (vertex == s.a || vertex == s.b) return false;
    const Eigen::Vector2d a = Point(s.a), d = Point(s.b) - a, p = Point(vertex) - a;
    const double length = d.norm(), along = p.dot(d) / length;
    return along > 0 && along < length && std::abs(Cross(d, p)) / length <= join_m_;
  }

  void AddCut(uint32_t segment, uint32_t vertex) {
    if (vertex == segments_[segment].a || vertex == segments_[segment].b) return;
    cuts_.push_back({segment, vertex});
  }

  void Cut(uint32_t i, uint32_t j) {
    const Segment s = segments_[i], t = segments_[j];
    bool touches = s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
    for (const uint32_t v : {t.a, t.b}) {
      if (LiesOn(v, s)) AddCut(i, v), touches = true;
    }
    for (const uint32_t v : {s.a, s.b}) {
      if (LiesOn(v, t)) AddCut(j, v), touches = true;
    }
    if (touches) return;
    const Eigen::Vector2d a = Point(s.a), d = Point(s.b) - a, c = Point(t.a), e = Point(t.b) - c;
    const double det = Cross(d, e);
    if (det == 0) return;
    const double u = Cross(c - a, e) / det, w = Cross(c - a, d) / det;
    if (!(u > 0 && u < 1 && w > 0 && w < 1)) return;
    const uint32_t v = welder_.FindOrAdd(a + u * d);
    AddCut(i, v);
    AddCut(j, v);
  }

  double join_m_;
  size_t max_vertices_;
  PointWelder welder_;
  std::vector<Segment> segments_;
  std::vector<Stop> cuts_;
  std::vector<Eigen::AlignedBox2d> boxes_;
  BoxTree<2> tree_;
};

}  // namespace

std::optional<LineMap> LineMap::Build(std::span<const MapLine> lines, double join_m, size_t max_vertices) {
  Splitter splitter(lines, join_m, max_vertices);
  if (!splitter.Run()) return std::nullopt;
  LineMap out;
  out.edges_ = splitter.Edges();
  out.vertices_ = splitter.TakePoints();
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const Edge& e : out.edges_) {
    Eigen::AlignedBox2d box(out.vertices_[e.a]);
    box.extend(out.vertices_[e.b]);
    boxes.push_back(box);
    out.box_.extend(box);
  }
  out.tree_ = BoxTree<2>(std::move(boxes));
  out.TraceFaces();
  return out;
}

void LineMap::TraceFaces() {
  const auto count = static_cast<uint32_t>(2 * edges_.size());
  degree_.assign(vertices_.size(), 0);
  for (uint32_t h = 0; h < count; ++h) ++degree_[From(h)];
  std::vector<uint32_t> first(vertices_.size() + 1, 0), leaving(count);  // half-edges by the vertex that they leave
  std::partial_sum(degree_.begin(), degree_.end(), first.begin() + 1);
  std::vector<uint32_t> at(first.begin(), first.end() - 1);
  for (uint32_t h = 0; h < count; ++h) leaving[at[From(h)]++] = h;
  next_.assign(count, 0);
  std::vector<std::pair<double, uint32_t>> fan;
  for (size_t v = 0; v < vertices_.size(); ++v) {
    fan.clear();
    for (const uint32_t h : std::span(leaving).subspan(first[v], degree_[v])) {
      const Eigen::Vector2d d = ToPoint(h) - FromPoint(h);
      fan.emplace_back(std::atan2(d.y(), d.x()), h);
    }
    std::sort(fan.begin(), fan.end());
    // Arriving by the twin of one leaves by the one clockwise of it, so that the face stays on the left.
    for (size_t k = 0; k < fan.size(); ++k) next_[fan[k].second ^ 1u] = fan[(k + fan.size() - 1) % fan.size()].second;
  }
  std::vector<uint32_t> loops;
  std::vector<double> areas;
  face_.assign(count, kNone);
  for (uint32_t start = 0; start < count; ++start) {
    if (face_[start] != kNone) continue;
    double twice = 0;
    const Eigen::Vector2d origin = FromPoint(start);
    uint32_t h = start;
    do {
      face_[h] = static_cast<uint32_t>(loops.size());  // the loop; PlaceHoles() turns it into the face
      twice += Cross(FromPoint(h) - origin, ToPoint(h) - origin);
      h = next_[h];
    } while (h != start);
    loops.push_back(start);
    areas.push_back(0.5 * twice);
  }
  PlaceHoles(loops, areas);
}

void LineMap::PlaceHoles(const std::vector<uint32_t>& loops, const std::vector<double>& areas) {
  std::vector<uint32_t> face_of_loop(loops.size(), 0), holes;
  std::vector<uint32_t> leftmost(loops.size());
  area_m2_ = {0.0};
  loops_.resize(1);
  for (uint32_t l = 0; l < loops.size(); ++l) {
    if (areas[l] > 0) {
      face_of_loop[l] = num_faces_++;
      area_m2_.push_back(areas[l]);
      loops_.push_back({loops[l]});
      continue;
    }
    holes.push_back(l);
    leftmost[l] = From(loops[l]);
    for (uint32_t h = next_[loops[l]]; h != loops[l]; h = next_[h]) {
      const Eigen::Vector2d &p = FromPoint(h), &best = vertices_[leftmost[l]];
      // Of several the upper one: from the lower ends of a row of rooms each ray would pass below all the others, as lines belong to the
      // ray at their upper end.
      if (std::make_pair(p.x(), -p.y()) < std::make_pair(best.x(), -best.y())) leftmost[l] = From(h);
    }
  }
  // From left to right: what a hole's ray to the left hits has its place already.
  std::stable_sort(holes.begin(), holes.end(),
                   [&](uint32_t x, uint32_t y) { return vertices_[leftmost[x]].x() < vertices_[leftmost[y]].x(); });
  for (const uint32_t l : holes) {
    const Eigen::Vector2d p = vertices_[leftmost[l]];
    // An edge within the loop that leaves this very vertex goes to the right, but by rounding the ray may meet its end.
    const auto other = [&](uint32_t e) {
      return face_[2 * e] != l && face_[2 * e + 1] != l && edges_[e].a != leftmost[l] && edges_[e].b != leftmost[l];
    };
    const std::optional<RayHit> hit = Cast(p, -Eigen::Vector2d::UnitX(), p.x() - box_.min().x() + 1.0, other);
    const uint32_t face = hit ? face_of_loop[face_[2 * hit->edge + (hit->on_left ? 0 : 1)]] : 0;
    face_of_loop[l] = face;
    area_m2_[face] += areas[l];
    loops_[face].push_back(loops[l]);
  }
  for (uint32_t& f : face_) f = face_of_loop[f];
}

std::optional<Eigen::Vector2d> LineMap::PointIn(uint32_t face) const {
  constexpr double kReach_m = 0.04, kOffLine_m = 1e-7;
  const uint32_t start = loops_[face][0];
  uint32_t h = start, best = kNone;
  double best_m = 0;
  do {
    const double length = (ToPoint(h) - FromPoint(h)).norm();
    if (length > best_m && face_[h ^ 1u] != face) best_m = length, best = h;
    h = next_[h];
  } while (h != start);
  if (best == kNone) return std::nullopt;
  const Eigen::Vector2d d = ToPoint(best) - FromPoint(best), n = Perp(d).normalized(), middle = FromPoint(best) + 0.5 * d;
  const auto across = Cast(middle + kOffLine_m * n, n, kReach_m, [&](uint32_t e) { return e != best / 2; });
  return middle + 0.5 * (across ? across->t_m : kReach_m) * n;
}

std::vector<Eigen::Vector2d> LineMap::RingAt(uint32_t half_edge) const {
  std::vector<Eigen::Vector2d> out;
  uint32_t h = half_edge;
  do {
    out.push_back(FromPoint(h));
    h = next_[h];
  } while (h != half_edge);
  return out;
}

std::optional<RayHit> LineMap::HitEdge(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, uint32_t edge) const {
  const Eigen::Vector2d a = vertices_[edges_[edge].a] - origin, b = vertices_[edges_[edge].b] - origin;
  const double sa = Cross(direction, a), sb = Cross(direction, b);
  // Half open, so that a ray through a vertex meets one of two edges that go on there: as if the ray ran a hair to its left.
  if ((sa <= 0) == (sb <= 0)) return std::nullopt;
  // At an end exactly there, so that edges that share it are hit at one place.
  const double t = sa == 0 ? direction.dot(a) : sb == 0 ? direction.dot(b) : direction.dot(a + (b - a) * (sa / (sa - sb)));
  if (t < 0) return std::nullopt;
  // An edge that runs from the ray's right to its left has the origin on its left.
  return RayHit{t, edge, sa <= 0, direction.dot(b - a) / (sb - sa)};
}

uint32_t LineMap::FaceAt(const Eigen::Vector2d& p) const {
  if (!box_.contains(p)) return 0;
  const std::optional<RayHit> hit = Cast(p, -Eigen::Vector2d::UnitX(), p.x() - box_.min().x() + 1.0, [](uint32_t) { return true; });
  return hit ? face_[2 * hit->edge + (hit->on_left ? 0 : 1)] : 0;
}

}  // namespace plumb::compiler
