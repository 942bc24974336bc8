#include "compiler/frontends/drawing/plane.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace plumb::compiler {

Eigen::AlignedBox2d BoxOf(std::span<const Eigen::Vector2d> points) {
  Eigen::AlignedBox2d box;
  for (const auto& p : points) box.extend(p);
  return box;
}

double AreaOf(std::span<const Eigen::Vector2d> ring) {
  double twice = 0;
  for (size_t i = 0; i < ring.size(); ++i) twice += Cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
  return std::abs(0.5 * twice);
}

double LengthAround(std::span<const Eigen::Vector2d> ring) {
  double length_m = 0;
  for (size_t i = 0; i < ring.size(); ++i) length_m += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return length_m;
}

double LesserSide(std::span<const Eigen::Vector2d> ring) {
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d d = ring[(i + 1) % ring.size()] - ring[i];
    if (d.squaredNorm() > longest.squaredNorm()) longest = d;
  }
  if (longest.squaredNorm() == 0) return 0;
  const Eigen::Vector2d u = longest.normalized();
  Eigen::AlignedBox2d box;
  for (const auto& p : ring) box.extend(Eigen::Vector2d(u.dot(p), Cross(u, p)));
  return box.sizes().minCoeff();
}

double DistanceToLine(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double t = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

std::vector<MapLine> MergeCollinear(std::vector<MapLine> lines, double tolerance_m) {
  // Cut pieces of one line share their ends to the bit: a piece is taken on from its end while another one goes on straight from there.
  std::multimap<std::pair<double, double>, size_t> at;
  for (size_t i = 0; i < lines.size(); ++i) {
    at.emplace(std::make_pair(lines[i].a.x(), lines[i].a.y()), i);
    at.emplace(std::make_pair(lines[i].b.x(), lines[i].b.y()), i);
  }
  std::vector<bool> used(lines.size(), false);
  std::vector<MapLine> out;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (used[i]) continue;
    used[i] = true;
    MapLine line = lines[i];
    const auto grow = [&](Eigen::Vector2d& end, const Eigen::Vector2d& other_end) {
      for (bool grown = true; grown;) {
        grown = false;
        const auto [first, last] = at.equal_range({end.x(), end.y()});
        for (auto it = first; it != last && !grown; ++it) {
          const MapLine& next = lines[it->second];
          if (used[it->second]) continue;
          const Eigen::Vector2d to = next.a == end ? next.b : next.a, d = end - other_end;
          if (d.dot(to - end) <= 0 || std::abs(Cross(d.normalized(), to - end)) > tolerance_m) continue;
          used[it->second] = grown = true;
          end = to;
        }
      }
    };
    grow(line.b, line.a);
    grow(line.a, line.b);
    out.push_back(line);
  }
  return out;
}

}  // namespace plumb::compiler
