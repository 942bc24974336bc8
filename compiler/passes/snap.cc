#include "compiler/passes/snap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/weld.h"

namespace plumb::compiler {
namespace {

constexpr int kMaxRounds = 8;
constexpr double kOnSegment_m = 1e-9;  // closer than this a vertex lies on the segment: splitting does not move it

// A vertex to be put into an edge, `t` of the way along.
struct Split {
  uint32_t edge;
  double t;
  uint32_t vertex;
};

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();
  Eigen::Vector2d at;
};

SnapGraph WeldVertices(const SnapGraph& graph, double radius_m) {
  Welded welded = Weld(graph.vertices, radius_m);
  SnapGraph out;
  out.vertices = std::move(welded.points);
  for (SnapSegment s : graph.segments) {
    s.from = welded.index[s.from];
    s.to = welded.index[s.to];
    if (s.from != s.to) out.segments.push_back(s);
  }
  return out;
}

// The segments without those that run along another one, either way: walls drawn over each other cost no more than one.
struct Edges {
  std::vector<SnapSegment> each;     // in the order and the direction of their first segments
  std::vector<uint32_t> of_segment;  // edge by segment
};

Edges EdgesOf(const SnapGraph& graph) {
  std::vector<std::pair<std::pair<uint32_t, uint32_t>, uint32_t>> order;
  for (uint32_t i = 0; i < graph.segments.size(); ++i) order.push_back({std::minmax({graph.segments[i].from, graph.segments[i].to}), i});
  std::sort(order.begin(), order.end());
  std::vector<uint32_t> first_of(order.size());
  for (size_t i = 0; i < order.size(); ++i) {
    const bool known = i > 0 && order[i].first == order[i - 1].first;
    first_of[order[i].second] = known ? first_of[order[i - 1].second] : order[i].second;
  }
  Edges out;
  for (uint32_t i = 0; i < graph.segments.size(); ++i) {
    if (first_of[i] == i) {
      out.of_segment.push_back(static_cast<uint32_t>(out.each.size()));
      out.each.push_back(graph.segments[i]);
    } else {
      out.of_segment.push_back(out.of_segment[first_of[i]]);
    }
  }
  return out;
}

void ApplySplits(const Edges& edges, std::vector<Split>& splits, SnapGraph& graph) {
  std::sort(splits.begin(), splits.end(),
            [](const Split& a, const Split& b) { return std::tie(a.edge, a.t, a.vertex) < std::tie(b.edge, b.t, b.vertex); });
  std::vector<size_t> first(edges.each.size() + 1, 0);
  for (const Split& split : splits) ++first[split.edge + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<SnapSegment> out;
  for (uint32_t i = 0; i < graph.segments.size(); ++i) {
    const uint32_t edge = edges.of_segment[i], end = graph.segments[i].to;
    const size_t count = first[edge + 1] - first[edge];
    const bool forward = edges.each[edge].from == graph.segments[i].from;
    SnapSegment piece = graph.segments[i];
    for (size_t k = 0; k < count; ++k) {
      const uint32_t vertex = splits[forward ? first[edge] + k : first[edge + 1] - 1 - k].vertex;
      if (vertex == piece.from || vertex == end) continue;
      piece.to = vertex;
      out.push_back(piece);
      piece.from = vertex;
    }
    piece.to = end;
    if (piece.from != piece.to) out.push_back(piece);
  }
  graph.segments = std::move(out);
}

Eigen::AlignedBox2d BoxOf(const SnapGraph& graph, const SnapSegment& s, double margin_m) {
  Eigen::AlignedBox2d box(graph.vertices[s.from]);
  box.extend(graph.vertices[s.to]);
  box.min().array() -= margin_m;
  box.max().array() += margin_m;
  return box;
}

// Vertices near the inside of a segment. True if anything changed.
bool SplitAtVertices(SnapGraph& graph, double radius_m) {
  std::vector<Eigen::AlignedBox2d> points;
  points.reserve(graph.vertices.size());
  for (const Eigen::Vector2d& v : graph.vertices) points.emplace_back(v);
  const BoxTree<2> tree(std::move(points));
  const Edges edges = EdgesOf(graph);
  std::vector<Split> splits;
  std::vector<Nearest> nearest(graph.vertices.size());
  for (uint32_t i = 0; i < edges.each.size(); ++i) {
    const SnapSegment& s = edges.each[i];
    const Eigen::Vector2d a = graph.vertices[s.from], along = graph.vertices[s.to] - a;
    const double length = along.norm();
    const Eigen::AlignedBox2d zone = BoxOf(graph, s, radius_m);
    // Of a box beside the line through the segment no corner is near it.
    const auto meets = [&](const Eigen::AlignedBox2d& box) {
      const Eigen::Vector2d half = 0.5 * box.sizes();
      return box.intersects(zone) && std::abs(Cross(along, box.center() - a)) <=
                                         half.x() * std::abs(along.y()) + half.y() * std::abs(along.x()) + 2 * radius_m * length;
    };
    tree.ForEach(meets, [&](uint32_t v) {
      if (v == s.from || v == s.to) return;
      const Eigen::Vector2d w = graph.vertices[v] - a;
      const double t = w.dot(along) / (length * length), distance = std::abs(Cross(along, w)) / length;
      if (!(distance <= radius_m && t > 0 && t < 1)) return;
      splits.push_back({i, t, v});
      if (distance < nearest[v].distance_m) nearest[v] = {distance, a + t * along};
    });
  }
  for (size_t v = 0; v < nearest.size(); ++v) {
    if (std::isfinite(nearest[v].distance_m) && nearest[v].distance_m > kOnSegment_m) graph.vertices[v] = nearest[v].at;
  }
  ApplySplits(edges, splits, graph);
  return !splits.empty();
}

// Calls visit(i, j) for each pair of edges whose boxes meet, sorted by where they begin along x.
template <class Visit>
void ForEachMeeting(const SnapGraph& graph, const std::vector<SnapSegment>& edges, const Visit& visit) {
  std::vector<Eigen::AlignedBox2d> boxes;
  boxes.reserve(edges.size());
  for (const SnapSegment& s : edges) boxes.push_back(BoxOf(graph, s, kOnSegment_m));
  std::vector<uint32_t> order(edges.size()), rank(edges.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return boxes[a].min().x() < boxes[b].min().x(); });
  for (uint32_t r = 0; r < order.size(); ++r) rank[order[r]] = r;
  const BoxTree<2> tree(boxes);
  std::vector<uint32_t> later;  // by rank
  for (const uint32_t i : order) {
    later.clear();
    tree.ForEachIn(boxes[i], [&](uint32_t j) {
      if (rank[j] > rank[i]) later.push_back(rank[j]);
    });
    std::sort(later.begin(), later.end());
    for (const uint32_t r : later) visit(i, order[r]);
  }
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Have at most an end in common: exactly, in the vertices as they are.
bool MeetAtEndsOnly(const SnapGraph& graph, const SnapSegment& s, const SnapSegment& r) {
  const auto point = [&graph](uint32_t v) { return Kernel::Point_2(graph.vertices[v].x(), graph.vertices[v].y()); };
  const bool from_is_common = s.from == r.from || s.from == r.to, to_is_common = s.to == r.from || s.to == r.to;
  if (!from_is_common && !to_is_common)
    return !CGAL::do_intersect(Kernel::Segment_2(point(s.from), point(s.to)), Kernel::Segment_2(point(r.from), point(r.to)));
  const uint32_t common = from_is_common ? s.from : s.to, a = from_is_common ? s.to : s.from, b = r.from == common ? r.to : r.from;
  return CGAL::orientation(point(common), point(a), point(b)) != CGAL::COLLINEAR ||
         CGAL::angle(point(a), point(common), point(b)) == CGAL::OBTUSE;
}

// Segments that cross away from their ends. True if anything changed.
bool SplitAtCrossings(SnapGraph& graph) {
  const Edges edges = EdgesOf(graph);
  graph.is_planar = true;
  std::vector<Split> splits;
  std::map<std::pair<double, double>, uint32_t> crossing_vertices;  // the same point for every pair that crosses there
  ForEachMeeting(graph, edges.each, [&](uint32_t i, uint32_t j) {
    const SnapSegment &s = edges.each[i], &r = edges.each[j];
    graph.is_planar = graph.is_planar && MeetAtEndsOnly(graph, s, r);
    if (s.from == r.from || s.from == r.to || s.to == r.from || s.to == r.to) return;
    const Eigen::Vector2d a = graph.vertices[s.from], u = graph.vertices[s.to] - a, v = graph.vertices[r.to] - graph.vertices[r.from],
                          w = graph.vertices[r.from] - a;
    const double det = Cross(u, v);
    if (det == 0) return;
    const double t = Cross(w, v) / det, q = Cross(w, u) / det;
    if (!(t > 0 && t < 1 && q > 0 && q < 1)) return;  // also where one is not a number
    const Eigen::Vector2d p = a + t * u;
    const auto [it, fresh] = crossing_vertices.emplace(std::make_pair(p.x(), p.y()), static_cast<uint32_t>(graph.vertices.size()));
    if (fresh) graph.vertices.push_back(p);
    splits.push_back({i, t, it->second});
    splits.push_back({j, q, it->second});
  });
  ApplySplits(edges, splits, graph);
  return !splits.empty();
}

}  // namespace

SnapGraph Snap(const SnapGraph& graph, double radius_m) {
  SnapGraph out = WeldVertices(graph, radius_m);
  for (int round = 0; round < kMaxRounds; ++round) {
    const bool touched = SplitAtVertices(out, radius_m);
    const bool crossed = SplitAtCrossings(out);
    if (!touched && !crossed) return out;
    out = WeldVertices(out, radius_m);
  }
  return out;  // not looked at since
}

}  // namespace plumb::compiler
