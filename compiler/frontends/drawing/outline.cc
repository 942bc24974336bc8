#include "compiler/frontends/drawing/outline.h"

#include <algorithm>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kStraight = 0.01;  // sine of the angle between edges of one side
constexpr double kSquareTurn = 0.85;  // sine of a turn at the end of a wall

}  // namespace

Outline::Outline(const WallMass& mass) : mass_(mass), side_of_edge_(mass.map.edges().size(), kNone) {
  std::vector<bool> seen(mass.map.num_half_edges(), false);
  for (uint32_t start = 0; start < mass.map.num_half_edges(); ++start) {
    if (seen[start] || !mass.IsBoundary(start)) continue;
    std::vector<uint32_t> loop;
    for (uint32_t h = start; !seen[h]; h = NextBoundary(h)) {
      seen[h] = true;
      loop.push_back(h);
    }
    AddLoop(loop);
  }
}

uint32_t Outline::NextBoundary(uint32_t half_edge) const {
  uint32_t h = mass_.map.Next(half_edge);
  while (!mass_.IsBoundary(h)) h = mass_.map.Next(h ^ 1u);
  return h;
}

void Outline::AddLoop(const std::vector<uint32_t>& loop) {
  const LineMap& map = mass_.map;
  const auto goes_on = [&](uint32_t h, uint32_t next) {
    const Eigen::Vector2d d = (map.ToPoint(h) - map.FromPoint(h)).normalized(), e = (map.ToPoint(next) - map.FromPoint(next)).normalized();
    // Steps along an arc stay apart, however fine they are.
    if (mass_.circle_of[h / 2] != kNone || mass_.circle_of[next / 2] != kNone) return false;
    return d.dot(e) > 0 && std::abs(Cross(d, e)) < kStraight && mass_.is_curved[h / 2] == mass_.is_curved[next / 2];
  };
  size_t first = 0;
  while (first < loop.size() && goes_on(loop[(first + loop.size() - 1) % loop.size()], loop[first])) ++first;
  const auto begin = static_cast<uint32_t>(sides_.size());
  for (size_t k = 0; k < loop.size(); ++k) {
    const uint32_t h = loop[(first + k) % loop.size()];
    const bool extends = sides_.size() > begin && goes_on(loop[(first + k - 1) % loop.size()], h);
    if (!extends) {
      Side side;
      side.a = map.FromPoint(h);
      side.source = map.edges()[h / 2].source;
      side.curved = mass_.is_curved[h / 2];
      side.circle = mass_.circle_of[h / 2];
      sides_.push_back(side);
    }
    sides_.back().b = map.ToPoint(h);
    side_of_edge_[h / 2] = static_cast<uint32_t>(sides_.size() - 1);
  }
  const auto count = static_cast<uint32_t>(sides_.size()) - begin;
  for (uint32_t k = 0; k < count; ++k) {
    sides_[begin + k].prev = begin + (k + count - 1) % count;
    sides_[begin + k].next = begin + (k + 1) % count;
  }
}

std::optional<SideHit> Outline::Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double max_m) const {
  const auto hit = mass_.map.Cast(origin, direction, max_m, [&](uint32_t e) { return side_of_edge_[e] != kNone; });
  if (!hit) return std::nullopt;
  return SideHit{hit->t_m, side_of_edge_[hit->edge]};
}

std::vector<uint32_t> Outline::SidesIn(const Eigen::AlignedBox2d& box) const {
  std::vector<uint32_t> out;
  mass_.map.VisitEdges(box, [&](uint32_t e) {
    if (side_of_edge_[e] != kNone) out.push_back(side_of_edge_[e]);
  });
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

double Outline::DistanceTo(const Eigen::Vector2d& p, double max_m) const {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(max_m);
  double best_m = max_m;
  for (const uint32_t s : SidesIn({p - reach, p + reach})) best_m = std::min(best_m, DistanceToLine(p, sides_[s].a, sides_[s].b));
  return best_m;
}

bool Outline::IsEnd(uint32_t side) const {
  const Side& s = sides_[side];
  const Eigen::Vector2d d = s.along();
  return Cross(sides_[s.prev].along(), d) > kSquareTurn && Cross(d, sides_[s.next].along()) > kSquareTurn;
}

}  // namespace plumb::compiler
