#include "compiler/passes/snap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "compiler/passes/polygon.h"
#include "compiler/passes/weld.h"

namespace plumb::compiler {
namespace {

constexpr int kMaxRounds = 8;
constexpr double kOnSegment_m = 1e-9;  // closer than this a vertex lies on the segment: splitting does not move it

// A vertex to be put into a segment, `t` of the way along.
struct Split {
  uint32_t segment;
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

void ApplySplits(SnapGraph& graph, std::vector<Split>& splits) {
  std::sort(splits.begin(), splits.end(),
            [](const Split& a, const Split& b) { return std::tie(a.segment, a.t, a.vertex) < std::tie(b.segment, b.t, b.vertex); });
  std::vector<SnapSegment> out;
  auto next = splits.begin();
  for (uint32_t i = 0; i < graph.segments.size(); ++i) {
    SnapSegment piece = graph.segments[i];
    const uint32_t end = piece.to;
    for (; next != splits.end() && next->segment == i; ++next) {
      if (next->vertex == piece.from || next->vertex == end) continue;
      piece.to = next->vertex;
      out.push_back(piece);
      piece.from = next->vertex;
    }
    piece.to = end;
    if (piece.from != piece.to) out.push_back(piece);
  }
  graph.segments = std::move(out);
}

// Vertices near the inside of a segment. True if anything changed.
bool SplitAtVertices(SnapGraph& graph, double radius_m) {
  std::vector<uint32_t> by_x(graph.vertices.size());
  for (uint32_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::sort(by_x.begin(), by_x.end(), [&](uint32_t a, uint32_t b) { return LexicographicallyLess(graph.vertices[a], graph.vertices[b]); });

  std::vector<Split> splits;
  std::vector<Nearest> nearest(graph.vertices.size());
  for (uint32_t i = 0; i < graph.segments.size(); ++i) {
    const SnapSegment& s = graph.segments[i];
    const Eigen::Vector2d a = graph.vertices[s.from], along = graph.vertices[s.to] - a;
    const double length = along.norm(), lo_x = std::min(a.x(), a.x() + along.x()) - radius_m,
                 hi_x = std::max(a.x(), a.x() + along.x()) + radius_m;
    auto it = std::lower_bound(by_x.begin(), by_x.end(), lo_x, [&](uint32_t v, double x) { return graph.vertices[v].x() < x; });
    for (; it != by_x.end() && graph.vertices[*it].x() <= hi_x; ++it) {
      const uint32_t v = *it;
      if (v == s.from || v == s.to) continue;
      const Eigen::Vector2d w = graph.vertices[v] - a;
      const double t = w.dot(along) / (length * length), distance = std::abs(Cross(along, w)) / length;
      if (!(distance <= radius_m && t > 0 && t < 1)) continue;
      splits.push_back({i, t, v});
      if (distance < nearest[v].distance_m) nearest[v] = {distance, a + t * along};
    }
  }
  for (size_t v = 0; v < nearest.size(); ++v) {
    if (std::isfinite(nearest[v].distance_m) && nearest[v].distance_m > kOnSegment_m) graph.vertices[v] = nearest[v].at;
  }
  ApplySplits(graph, splits);
  return !splits.empty();
}

// Segments that cross away from their ends. True if anything changed.
bool SplitAtCrossings(SnapGraph& graph) {
  struct Span {
    double lo, hi;
    uint32_t segment;
  };
  std::vector<Span> spans;
  for (uint32_t i = 0; i < graph.segments.size(); ++i) {
    const double a = graph.vertices[graph.segments[i].from].x(), b = graph.vertices[graph.segments[i].to].x();
    spans.push_back({std::min(a, b), std::max(a, b), i});
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return std::tie(a.lo, a.segment) < std::tie(b.lo, b.segment); });

  std::vector<Split> splits;
  std::map<std::pair<double, double>, uint32_t> crossing_vertices;  // the same point for every pair that crosses there
  for (size_t i = 0; i < spans.size(); ++i) {
    for (size_t j = i + 1; j < spans.size() && spans[j].lo <= spans[i].hi; ++j) {
      const SnapSegment s = graph.segments[spans[i].segment], r = graph.segments[spans[j].segment];
      if (s.from == r.from || s.from == r.to || s.to == r.from || s.to == r.to) continue;
      const Eigen::Vector2d a = graph.vertices[s.from], u = graph.vertices[s.to] - a, v = graph.vertices[r.to] - graph.vertices[r.from],
                            w = graph.vertices[r.from] - a;
      const double det = Cross(u, v);
      if (det == 0) continue;
      const double t = Cross(w, v) / det, q = Cross(w, u) / det;
      if (!(t > 0 && t < 1 && q > 0 && q < 1)) continue;  // also where one is not a number
      const Eigen::Vector2d p = a + t * u;
      const auto [it, fresh] = crossing_vertices.emplace(std::make_pair(p.x(), p.y()), static_cast<uint32_t>(graph.vertices.size()));
      if (fresh) graph.vertices.push_back(p);
      splits.push_back({spans[i].segment, t, it->second});
      splits.push_back({spans[j].segment, q, it->second});
    }
  }
  ApplySplits(graph, splits);
  return !splits.empty();
}

}  // namespace

SnapGraph Snap(const SnapGraph& graph, double radius_m) {
  SnapGraph out = WeldVertices(graph, radius_m);
  for (int round = 0; round < kMaxRounds; ++round) {
    const bool touched = SplitAtVertices(out, radius_m);
    const bool crossed = SplitAtCrossings(out);
    if (!touched && !crossed) break;
    out = WeldVertices(out, radius_m);
  }
  return out;
}

}  // namespace plumb::compiler
