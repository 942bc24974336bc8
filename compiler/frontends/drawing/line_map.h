// A planar map of drawn lines in double precision: where they meet, the faces between them, and what a ray across them hits first.
// Made for drawings, where ends miss each other by less than the pen's width; the exact map of the passes comes later and needs solids.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {

struct MapLine {
  Eigen::Vector2d a, b;
  uint32_t source = 0;  // the caller's number
};

struct RayHit {
  double t_m = 0;
  uint32_t edge = 0;
  bool on_left = true;  // the ray comes from the edge's left side
  double lean = 0;      // how much later a ray meets the edge that runs 1 m farther to the left
  // Of two edges that leave the vertex that is hit, the one that the ray would meet first a hair to its left.
  [[nodiscard]] bool IsBefore(const RayHit& other) const { return std::tie(t_m, lean, edge) < std::tie(other.t_m, other.lean, other.edge); }
};

class LineMap {
 public:
  struct Edge {
    uint32_t a = 0, b = 0;  // vertices
    uint32_t source = 0;    // of the first line that runs there
  };

  // Points closer than `join_m` become one, ends that near to a line lie on it. None: they end, meet and cross in more than
  // `max_vertices` places.
  [[nodiscard]] static std::optional<LineMap> Build(std::span<const MapLine> lines, double join_m, size_t max_vertices);

  [[nodiscard]] const std::vector<Eigen::Vector2d>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }

  // Half-edge 2e runs from a to b of edge e, 2e + 1 back. Its face is on its left; face 0 is the outside.
  [[nodiscard]] uint32_t From(uint32_t h) const { return h % 2 == 0 ? edges_[h / 2].a : edges_[h / 2].b; }
  [[nodiscard]] uint32_t To(uint32_t h) const { return From(h ^ 1u); }
  [[nodiscard]] const Eigen::Vector2d& FromPoint(uint32_t h) const { return vertices_[From(h)]; }
  [[nodiscard]] const Eigen::Vector2d& ToPoint(uint32_t h) const { return vertices_[To(h)]; }
  [[nodiscard]] uint32_t Next(uint32_t h) const { return next_[h]; }  // along the boundary of its face
  [[nodiscard]] uint32_t FaceOf(uint32_t h) const { return face_[h]; }
  [[nodiscard]] uint32_t num_half_edges() const { return static_cast<uint32_t>(next_.size()); }
  [[nodiscard]] uint32_t num_faces() const { return num_faces_; }
  [[nodiscard]] uint32_t DegreeOf(uint32_t vertex) const { return degree_[vertex]; }
  [[nodiscard]] double AreaOf(uint32_t face) const { return area_m2_[face]; }  // without its holes
  // One half-edge of every boundary of the face: the outer one first, then holes.
  [[nodiscard]] const std::vector<uint32_t>& LoopsOf(uint32_t face) const { return loops_[face]; }
  // Beside the middle of its longest side, halfway to what is across but no farther than 2 cm: lines that met
  // others lie some millimetres beside where they were drawn. None: the face has no inside.
  [[nodiscard]] std::optional<Eigen::Vector2d> PointIn(uint32_t face) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> RingAt(uint32_t half_edge) const;

  // The first edge for which keep(edge) holds on the way from `origin` along the unit vector `direction`.
  template <class Keep>
  [[nodiscard]] std::optional<RayHit> Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double max_m,
                                           const Keep& keep) const;
  [[nodiscard]] uint32_t FaceAt(const Eigen::Vector2d& p) const;
  // Calls visit(edge) for edges whose boxes meet `box`, in no order that matters.
  template <class Visit>
  void VisitEdges(const Eigen::AlignedBox2d& box, const Visit& visit) const;

 private:
  void TraceFaces();
  void PlaceHoles(const std::vector<uint32_t>& loops, const std::vector<double>& areas);
  [[nodiscard]] std::optional<RayHit> HitEdge(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, uint32_t edge) const;

  std::vector<Eigen::Vector2d> vertices_;
  std::vector<Edge> edges_;
  std::vector<uint32_t> next_, face_, degree_;
  std::vector<double> area_m2_;
  std::vector<std::vector<uint32_t>> loops_;
  uint32_t num_faces_ = 1;
  Eigen::AlignedBox2d box_;
  BoxTree<2> tree_;
};

template <class Visit>
void LineMap::VisitEdges(const Eigen::AlignedBox2d& box, const Visit& visit) const {
  tree_.ForEachIn(box, [&](uint32_t e) { visit(e); });
}

template <class Keep>
std::optional<RayHit> LineMap::Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double max_m, const Keep& keep) const {
  // Most rays hit something near: far edges are looked at only where they do not.
  constexpr double kNear_m = 2, kGrowth = 4;
  std::optional<RayHit> best;
  for (double reach_m = std::min(kNear_m, max_m);; reach_m = std::min(kGrowth * reach_m, max_m)) {
    Eigen::AlignedBox2d box(origin);
    box.extend(origin + reach_m * direction);
    VisitEdges(box, [&](uint32_t e) {
      const std::optional<RayHit> hit = HitEdge(origin, direction, e);
      if (!hit || hit->t_m > reach_m || !keep(e)) return;
      if (!best || hit->IsBefore(*best)) best = hit;
    });
    if (best || reach_m >= max_m) return best;
  }
}

}  // namespace plumb::compiler
