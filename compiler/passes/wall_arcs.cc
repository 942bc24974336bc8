#include "compiler/passes/wall_arcs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <span>

#include "compiler/geometry/circle.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

double Turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - b;
  return std::atan2(Cross(u, v), u.dot(v));
}

// Outlines of walls as the planar map has them, each wall on the left: edges by wall, in the order of the map.
std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> OutlinesOf(const Floor& floor) {
  std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> out;
  const auto covers = [&](const FloorFace& face, uint32_t wall) {
    return std::any_of(face.cover.begin(), face.cover.end(), [&](uint32_t f) { return floor.footprints[f].wall == wall; });
  };
  const auto add = [&](const FloorFace& face, const std::vector<BoundaryEdge>& edges) {
    for (const BoundaryEdge& edge : edges) {
      for (size_t i = 0; i < edge.footprints.size() && edge.bridge == kNoIndex; ++i) {
        const uint32_t wall = floor.footprints[edge.footprints[i]].wall;
        if (wall != kNoIndex && covers(face, wall) && !covers(floor.faces[edge.face], wall)) out[wall].emplace_back(edge.from, edge.to);
      }
    }
  };
  for (const FloorFace& face : floor.faces) {
    add(face, face.outer);
    for (const auto& hole : face.holes) add(face, hole);
  }
  return out;
}

// Chains of edges end to end, without corners on a line. Where several edges leave one vertex, chains end there.
class Chains {
 public:
  Chains(const std::vector<Eigen::Vector2d>& vertices, const std::vector<std::pair<uint32_t, uint32_t>>& edges) : vertices_(vertices) {
    for (const auto& [from, to] : edges) {
      ++leaving_[from], ++entering_[to];
      next_[from] = to;
    }
  }

  // Each with its corners in order; closed ones begin where they end.
  std::vector<std::vector<Eigen::Vector2d>> All(double straight_rad) {
    std::vector<std::vector<Eigen::Vector2d>> out;
    const auto passes = [&](uint32_t v) { return leaving_[v] == 1 && entering_[v] == 1; };
    for (const auto& [from, to] : next_) {
      if (leaving_[from] == 1 && !passes(from)) out.push_back(From(from, passes, straight_rad));
    }
    for (const auto& [from, to] : next_) {
      if (passes(from) && !used_.contains(from)) out.push_back(Turned(From(from, passes, straight_rad)));
    }
    return out;
  }

 private:
  template <class Passes>
  std::vector<Eigen::Vector2d> From(uint32_t start, const Passes& passes, double straight_rad) {
    std::vector<Eigen::Vector2d> out;
    uint32_t v = start;
    do {
      Append(vertices_[v], straight_rad, out);
      used_[v] = true;
      v = next_[v];
    } while (v != start && passes(v));
    Append(vertices_[v], straight_rad, out);
    return out;
  }

  static void Append(const Eigen::Vector2d& p, double straight_rad, std::vector<Eigen::Vector2d>& out) {
    if (out.size() > 1 && std::abs(Turn(out[out.size() - 2], out.back(), p)) < straight_rad) out.pop_back();
    out.push_back(p);
  }

  // A closed chain may have been begun in the middle of an arc: it begins at its sharpest corner instead.
  static std::vector<Eigen::Vector2d> Turned(std::vector<Eigen::Vector2d> closed) {
    if (closed.size() < 4) return closed;
    closed.pop_back();
    const size_t n = closed.size();
    size_t sharpest = 0;
    double most = -1;
    for (size_t i = 0; i < n; ++i) {
      const double turn = std::abs(Turn(closed[(i + n - 1) % n], closed[i], closed[(i + 1) % n]));
      if (turn > most + 1e-6) most = turn, sharpest = i;
    }
    std::rotate(closed.begin(), closed.begin() + static_cast<std::ptrdiff_t>(sharpest), closed.end());
    closed.push_back(closed.front());
    return closed;
  }

  const std::vector<Eigen::Vector2d>& vertices_;
  std::map<uint32_t, uint32_t> next_, leaving_, entering_;
  std::map<uint32_t, bool> used_;
};

class ArcFinder {
 public:
  ArcFinder(const WallArcOptions& options, std::vector<Arc>& arcs) : options_(options), arcs_(arcs) {}

  void Search(const std::vector<Eigen::Vector2d>& chain) {
    for (size_t i = 0; i + options_.min_facets < chain.size();) {
      const size_t facets = Grow(std::span(chain).subspan(i));
      if (facets >= options_.min_facets && Add(std::span(chain).subspan(i, facets + 1))) {
        i += facets;
      } else {
        ++i;
      }
    }
  }

 private:
  // How many facets from the chain's first corner on follow one circle; 0 if fewer than asked for do.
  size_t Grow(std::span<const Eigen::Vector2d> chain) const {
    const double first = Turn(chain[0], chain[1], chain[2]);
    size_t facets = 0;
    for (size_t n = 2; n < chain.size(); ++n) {
      const double turn = Turn(chain[n - 2], chain[n - 1], chain[n]);
      if (turn * first <= 0 || std::abs(turn) > options_.max_turn_rad || std::abs(turn) < options_.min_turn_rad) break;
      if (n < options_.min_facets) continue;
      if (!Follows(chain.first(n + 1))) break;
      facets = n;
    }
    return facets;
  }

  bool Follows(std::span<const Eigen::Vector2d> corners) const {
    const std::optional<Circle> circle = FitCircle(corners);
    if (!circle) return false;
    for (size_t i = 0; i < corners.size(); ++i) {
      if (std::abs((corners[i] - circle->center).norm() - circle->radius_m) > options_.radial_m) return false;
      if (i == 0) continue;
      const double half = 0.5 * (corners[i] - corners[i - 1]).norm();
      if (half >= circle->radius_m) return false;
      if (circle->radius_m - std::sqrt(circle->radius_m * circle->radius_m - half * half) > options_.sagitta_m) return false;
    }
    return true;
  }

  bool Add(std::span<const Eigen::Vector2d> corners) {
    const Circle circle = *FitCircle(corners);
    const auto angle = [&](const Eigen::Vector2d& p) { return std::atan2(p.y() - circle.center.y(), p.x() - circle.center.x()); };
    Arc arc{circle.center, circle.radius_m, angle(corners.front()), 0};
    for (size_t i = 1; i < corners.size(); ++i)
      arc.sweep_rad += std::remainder(angle(corners[i]) - angle(corners[i - 1]), 2 * std::numbers::pi);
    if (std::abs(arc.sweep_rad) < options_.min_sweep_rad) return false;
    const bool known = std::any_of(arcs_.begin(), arcs_.end(), [&](const Arc& a) {
      return std::all_of(corners.begin(), corners.end(),
                         [&](const auto& p) { return std::abs((p - a.center).norm() - a.radius_m) <= options_.radial_m; });
    });
    if (!known) arcs_.push_back(arc);
    return true;
  }

  const WallArcOptions& options_;
  std::vector<Arc>& arcs_;
};

}  // namespace

std::string WallArcOptions::Check() const {
  if (!(radial_m > 0)) return fmt::format("WallArcOptions.radial_m = {}; must be positive", radial_m);
  if (!(sagitta_m > 0)) return fmt::format("WallArcOptions.sagitta_m = {}; must be positive", sagitta_m);
  if (!(max_turn_rad > 0 && max_turn_rad < std::numbers::pi / 2))
    return fmt::format("WallArcOptions.max_turn_rad = {}; must be in (0, pi / 2)", max_turn_rad);
  if (!(min_turn_rad > 0 && min_turn_rad < max_turn_rad))
    return fmt::format("WallArcOptions.min_turn_rad = {}; must be in (0, max_turn_rad)", min_turn_rad);
  if (!(min_sweep_rad > 0)) return fmt::format("WallArcOptions.min_sweep_rad = {}; must be positive", min_sweep_rad);
  if (min_facets < 3) return fmt::format("WallArcOptions.min_facets = {}; must be at least 3", min_facets);
  return {};
}

void FindWallArcs(const PlanIr& plan, const WallArcOptions& options, FloorIr& floors) {
  for (PlanWall& wall : floors.walls) wall.arcs = plan.elements[wall.elements[0]].arcs;
  for (const Floor& floor : floors.floors) {
    for (const auto& [wall, edges] : OutlinesOf(floor)) {
      ArcFinder finder(options, floors.walls[wall].arcs);
      for (const auto& chain : Chains(floor.vertices, edges).All(options.min_turn_rad)) finder.Search(chain);
    }
  }
}

}  // namespace plumb::compiler
