#include "compiler/passes/section.h"

#include <algorithm>
#include <map>

#include "compiler/passes/polygon.h"
#include "compiler/passes/weld.h"

namespace plumb::compiler {
namespace {

constexpr double kWeldRadius_m = 1e-5;  // rounding of coordinates written with five decimals
constexpr double kCollinear_m = 2e-5;
constexpr double kMinRingArea_m2 = 1e-6;

using Segment = std::pair<uint32_t, uint32_t>;

// Where the edge from below to above meets the plane: the same bits for every triangle at that edge.
Eigen::Vector2d Crossing(const Eigen::Vector3d& below, const Eigen::Vector3d& above, double z_m) {
  const double t = (z_m - below.z()) / (above.z() - below.z());
  return below.head<2>() + t * (above - below).head<2>();
}

// Pairs of points; the solid is on the left of the way from the first to the second.
std::vector<Eigen::Vector2d> CutTriangles(const Solid& solid, double z_m) {
  std::vector<Eigen::Vector2d> ends;
  for (const Eigen::Vector3i& t : solid.triangles) {
    Eigen::Vector2d from, to;
    int crossings = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = solid.vertices[static_cast<size_t>(t[k])], &q = solid.vertices[static_cast<size_t>(t[(k + 1) % 3])];
      const bool p_above = p.z() >= z_m, q_above = q.z() >= z_m;
      if (p_above == q_above) continue;
      // Seen from outside, the left edge goes down and the right one up.
      (p_above ? from : to) = p_above ? Crossing(q, p, z_m) : Crossing(p, q, z_m);
      ++crossings;
    }
    if (crossings != 2) continue;
    ends.push_back(from);
    ends.push_back(to);
  }
  return ends;
}

// Drops what goes there and back again, as between touching parts of one solid.
std::vector<Segment> WithoutOpposites(std::vector<Segment> segments) {
  std::map<Segment, int> net;
  for (const Segment& s : segments) {
    if (s.first < s.second) ++net[s];
    if (s.first > s.second) --net[{s.second, s.first}];
  }
  std::vector<Segment> out;
  for (const auto& [s, count] : net) {
    for (int k = 0; k < std::abs(count); ++k) out.push_back(count > 0 ? s : Segment(s.second, s.first));
  }
  return out;
}

// Closed loops of vertices, each vertex at most once in a loop; false if some segments lead nowhere.
// `directed`: segments are walked from first to second only.
bool ChainLoops(const std::vector<Segment>& segments, size_t vertices, bool directed, std::vector<std::vector<uint32_t>>& loops) {
  std::vector<std::vector<uint32_t>> leaving(vertices);
  for (uint32_t i = 0; i < segments.size(); ++i) {
    leaving[segments[i].first].push_back(i);
    if (!directed) leaving[segments[i].second].push_back(i);
  }
  std::vector<bool> used(segments.size(), false);
  const auto next_from = [&](uint32_t v) -> uint32_t {
    for (uint32_t i : leaving[v]) {
      if (!used[i]) return i;
    }
    return kNoIndex;
  };
  std::vector<uint32_t> place(vertices, kNoIndex);  // position in the path
  for (uint32_t start = 0; start < segments.size(); ++start) {
    std::vector<uint32_t> path;
    uint32_t at = segments[start].first;
    for (uint32_t segment = used[start] ? kNoIndex : start; segment != kNoIndex; segment = next_from(at)) {
      used[segment] = true;
      place[at] = static_cast<uint32_t>(path.size());
      path.push_back(at);
      at = segments[segment].first == at ? segments[segment].second : segments[segment].first;
      if (place[at] == kNoIndex) continue;
      loops.emplace_back(path.begin() + place[at], path.end());
      const size_t keep = place[at];
      for (size_t k = keep; k < path.size(); ++k) place[path[k]] = kNoIndex;
      path.resize(keep);
    }
    for (uint32_t v : path) place[v] = kNoIndex;
    if (!path.empty()) return false;
  }
  return true;
}

// Without directions to go by: a ring inside an odd number of others is a hole.
void OrientByNesting(std::vector<Ring>& rings) {
  for (size_t i = 0; i < rings.size(); ++i) {
    bool hole = false;
    for (size_t j = 0; j < rings.size(); ++j) {
      if (j != i && WindingNumber(std::span(&rings[j], 1), rings[i][0]) != 0) hole = !hole;
    }
    if ((SignedArea(rings[i]) < 0) != hole) std::reverse(rings[i].begin(), rings[i].end());
  }
}

}  // namespace

Section CutSolid(const Solid& solid, double z_m) {
  const std::vector<Eigen::Vector2d> ends = CutTriangles(solid, z_m);
  const Welded welded = Weld(ends, kWeldRadius_m);
  std::vector<Segment> segments;
  for (size_t i = 0; i + 1 < ends.size(); i += 2) segments.emplace_back(welded.index[i], welded.index[i + 1]);
  segments = WithoutOpposites(std::move(segments));

  Section out;
  std::vector<std::vector<uint32_t>> loops;
  bool directed = true;
  if (!ChainLoops(segments, welded.points.size(), true, loops)) {
    loops.clear();
    directed = false;
    out.closed = ChainLoops(segments, welded.points.size(), false, loops);
  }
  if (!out.closed) {
    if (Ring box = LeastRectangle(welded.points); box.size() == 4) out.rings.push_back(std::move(box));
    return out;
  }
  for (const auto& loop : loops) {
    Ring ring;
    for (uint32_t v : loop) ring.push_back(welded.points[v]);
    ring = Simplified(ring, kCollinear_m);
    if (ring.size() >= 3 && std::abs(SignedArea(ring)) >= kMinRingArea_m2) out.rings.push_back(std::move(ring));
  }
  if (!directed) OrientByNesting(out.rings);
  // A solid that is inside out has all its rings the wrong way round.
  double area = 0;
  for (const Ring& ring : out.rings) area += SignedArea(ring);
  if (area < 0) {
    for (Ring& ring : out.rings) std::reverse(ring.begin(), ring.end());
  }
  return out;
}

}  // namespace plumb::compiler
