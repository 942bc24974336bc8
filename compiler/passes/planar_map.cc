#include "compiler/passes/planar_map.h"

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <new>
#include <utility>
#include <vector>

#include "compiler/passes/face_locator.h"
#include "compiler/passes/floor_outlines.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/snap.h"
#include "compiler/passes/space_regions.h"

namespace plumb::compiler {
namespace {

// Of outlines that meet in vertices only no crossing is constructed: doubles do. Predicates on points are exact; slopes about a vertex are
// compared by rounded lines, which the snapping's radius keeps far apart.
using PlanarKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CrossingKernel = CGAL::Exact_predicates_exact_constructions_kernel;

template <class Kernel>
class MapBuilder {
 public:
  MapBuilder(Floor& floor, const PlanarMapOptions& options, SnapGraph graph)
      : floor_(floor), options_(options), numbers_(floor), graph_(std::move(graph)) {}

  void Run() {
    Insert();
    RemoveAntennas();
    LabelFaces();
    if (!floor_.dividers.empty()) Divide();
    ExtractVertices();
    ExtractFaces();
  }

 private:
  using SegmentTraits = CGAL::Arr_segment_traits_2<Kernel>;
  using Traits = CGAL::Arr_consolidated_curve_data_traits_2<SegmentTraits, uint32_t>;  // data: number of the run
  using Arrangement = CGAL::Arrangement_2<Traits, CGAL::Arr_extended_dcel<Traits, uint32_t, char, FaceLabel>>;
  using Vertex = typename Arrangement::Vertex_handle;
  using Face = typename Arrangement::Face_handle;
  using Circulator = typename Arrangement::Ccb_halfedge_circulator;
  using ConstHalfedge = typename Arrangement::Halfedge_const_handle;

  struct Piece {
    uint32_t left, right, segment;
    auto operator<=>(const Piece&) const = default;
  };

  // Segments over each other make one curve: to find out in exact arithmetic that they are the same takes most of the time otherwise.
  void Insert() {
    const auto less = [this](uint32_t a, uint32_t b) { return LexicographicallyLess(graph_.vertices[a], graph_.vertices[b]); };
    std::vector<Piece> order;
    order.reserve(graph_.segments.size());
    for (uint32_t i = 0; i < graph_.segments.size(); ++i) {
      const SnapSegment& s = graph_.segments[i];
      if (graph_.vertices[s.from] == graph_.vertices[s.to]) continue;
      order.push_back(less(s.from, s.to) ? Piece{s.from, s.to, i} : Piece{s.to, s.from, i});
    }
    std::sort(order.begin(), order.end());
    std::vector<typename Kernel::Point_2> points;
    points.reserve(graph_.vertices.size());
    for (const Eigen::Vector2d& v : graph_.vertices) points.emplace_back(v.x(), v.y());
    std::vector<typename Traits::X_monotone_curve_2> curves;
    for (size_t i = 0; i < order.size(); ++i) {
      run_segments_.push_back(order[i].segment);
      if (i > 0 && order[i].left == order[i - 1].left && order[i].right == order[i - 1].right) continue;
      curves.emplace_back(typename SegmentTraits::X_monotone_curve_2(points[order[i].left], points[order[i].right]),
                          static_cast<uint32_t>(run_begin_.size()));
      run_begin_.push_back(static_cast<uint32_t>(i));
    }
    run_begin_.push_back(static_cast<uint32_t>(order.size()));
    if (graph_.is_planar)
      CGAL::insert_non_intersecting_curves(arrangement_, curves.begin(), curves.end());
    else
      CGAL::insert(arrangement_, curves.begin(), curves.end());
  }

  template <class Visit>
  void ForEachSegment(ConstHalfedge edge, const Visit& visit) const {
    for (const uint32_t run : edge->curve().data()) {
      for (uint32_t i = run_begin_[run]; i < run_begin_[run + 1]; ++i) visit(graph_.segments[run_segments_[i]]);
    }
  }

  // Edges with the same face on both sides bound nothing.
  void RemoveAntennas() {
    for (bool changed = true; changed;) {
      changed = false;
      for (auto e = arrangement_.edges_begin(); e != arrangement_.edges_end();) {
        const typename Arrangement::Halfedge_handle here = e->twin()->twin();
        ++e;
        if (here->face() != here->twin()->face()) continue;
        arrangement_.remove_edge(here);
        changed = true;
      }
    }
  }

  // Of the face on the right of `edge` after those of the one on its left.
  Windings StepOver(ConstHalfedge edge, Windings windings) const {
    const bool edge_forward = edge->direction() == CGAL::ARR_LEFT_TO_RIGHT;
    ForEachSegment(edge, [&](const SnapSegment& s) {
      if (!numbers_.Encloses(s.footprint)) return;
      const bool forward = LexicographicallyLess(graph_.vertices[s.from], graph_.vertices[s.to]);
      AddTo(windings, s.footprint, forward == edge_forward ? -1 : 1);
    });
    return windings;
  }

  void LabelFaces() {
    std::deque<Face> open = {arrangement_.unbounded_face()};
    open.front()->data().known = true;
    while (!open.empty()) {
      const Face face = open.front();
      open.pop_front();
      ForEachEdge<Circulator>(face, [&](Circulator edge) {
        const Face across = edge->twin()->face();
        if (std::exchange(across->data().known, true)) return;
        across->data().windings = StepOver(edge, face->data().windings);
        open.push_back(across);
      });
    }
  }

  // No wall's outline and no bridge runs here.
  bool IsVirtual(ConstHalfedge edge) const {
    bool is_virtual = true;
    ForEachSegment(edge, [&](const SnapSegment& s) { is_virtual &= numbers_.IsDivider(s.footprint); });
    return is_virtual;
  }

  // Gives the parts of an open plan to the spaces that share it, and takes out the dividers' edges that divide nothing.
  void Divide() {
    const auto is_virtual = [this](ConstHalfedge edge) { return IsVirtual(edge); };
    SpaceRegions<Arrangement, decltype(is_virtual)>(numbers_, options_.max_strip_width_m, is_virtual, arrangement_).Run();
    for (auto e = arrangement_.edges_begin(); e != arrangement_.edges_end();) {
      const typename Arrangement::Halfedge_handle here = e->twin()->twin();
      ++e;
      const FaceLabel &a = here->face()->data(), &b = here->twin()->face()->data();
      if (!IsVirtual(here) || (a.region != kNoIndex && a.space != b.space)) continue;
      arrangement_.remove_edge(here);
    }
    RemoveAntennas();
  }

  void ExtractVertices() {
    std::vector<std::pair<Eigen::Vector2d, Vertex>> vertices;
    for (auto v = arrangement_.vertices_begin(); v != arrangement_.vertices_end(); ++v) {
      vertices.emplace_back(Eigen::Vector2d(CGAL::to_double(v->point().x()), CGAL::to_double(v->point().y())), v);
    }
    std::stable_sort(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.second->point() < b.second->point(); });
    floor_.vertices.clear();
    for (auto& [p, v] : vertices) {
      v->set_data(static_cast<uint32_t>(floor_.vertices.size()));
      floor_.vertices.push_back(p);
    }
  }

  std::vector<BoundaryEdge> Boundary(typename Arrangement::Ccb_halfedge_const_circulator first) const {
    std::vector<BoundaryEdge> out;
    auto edge = first;
    do {
      BoundaryEdge b;
      b.from = edge->source()->data();
      b.to = edge->target()->data();
      b.face = edge->twin()->face()->data().index;
      ForEachSegment(edge, [&](const SnapSegment& s) {
        if (numbers_.IsBridge(s.footprint))
          b.bridge = std::min(b.bridge, s.footprint - numbers_.first_bridge());
        else if (!numbers_.IsDivider(s.footprint))
          b.footprints.push_back(s.footprint);
      });
      if (!b.footprints.empty()) b.bridge = kNoIndex;
      if (b.bridge != kNoIndex) b.footprints = {floor_.bridges[b.bridge].footprint_a, floor_.bridges[b.bridge].footprint_b};
      std::sort(b.footprints.begin(), b.footprints.end());
      b.footprints.erase(std::unique(b.footprints.begin(), b.footprints.end()), b.footprints.end());
      out.push_back(std::move(b));
    } while (++edge != first);
    const auto least = std::min_element(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    std::rotate(out.begin(), least, out.end());
    return out;
  }

  void ExtractFaces() {
    std::vector<Face> order;
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) order.push_back(f);
    // A face is told by the two least vertices of its outer boundary: the directed edge that leaves the least one has one face on its left.
    const auto key = [](typename Arrangement::Face_const_handle f) {
      std::pair<uint32_t, uint32_t> least(0, 0);
      if (f->is_unbounded()) return least;
      least = {kNoIndex, kNoIndex};
      auto edge = f->outer_ccb();
      do {
        least = std::min(least, {edge->source()->data() + 1, edge->target()->data() + 1});
      } while (++edge != f->outer_ccb());
      return least;
    };
    std::vector<std::pair<std::pair<uint32_t, uint32_t>, Face>> keyed;
    for (const auto& f : order) keyed.emplace_back(key(f), f);
    std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (uint32_t i = 0; i < keyed.size(); ++i) keyed[i].second->data().index = i;

    floor_.faces.clear();
    for (const auto& [least, f] : keyed) {
      FloorFace face;
      for (const auto& [outline, winding] : f->data().windings) {
        if (!numbers_.IsDivider(outline)) face.cover.push_back(outline);
      }
      if (f->data().space != kNoIndex) face.space = floor_.dividers[f->data().space - floor_.footprints.size()].space;
      if (!f->is_unbounded()) face.outer = Boundary(f->outer_ccb());
      for (auto ccb = f->inner_ccbs_begin(); ccb != f->inner_ccbs_end(); ++ccb) face.holes.push_back(Boundary(*ccb));
      std::sort(face.holes.begin(), face.holes.end(), [](const auto& a, const auto& b) { return a[0].from < b[0].from; });
      floor_.faces.push_back(std::move(face));
    }
    for (FloorFace& face : floor_.faces) {
      if (!face.bounded()) continue;
      for (const Ring& ring : FaceRings(floor_, face)) face.area_m2 += SignedArea(ring);
    }
  }

  Floor& floor_;
  const PlanarMapOptions& options_;
  OutlineNumbers numbers_;
  SnapGraph graph_;
  std::vector<uint32_t> run_begin_, run_segments_;  // segments of the graph that lie over each other, by run; positions, and the end
  Arrangement arrangement_;
};

}  // namespace

std::string PlanarMapOptions::Check() const {
  if (!(snap_radius_m > 0 && snap_radius_m <= 0.05))
    return fmt::format("PlanarMapOptions.snap_radius_m = {}; must be in (0, 0.05]", snap_radius_m);
  if (!(max_strip_width_m >= 0)) return fmt::format("PlanarMapOptions.max_strip_width_m = {}; must not be negative", max_strip_width_m);
  return {};
}

Expected<void> BuildPlanarMap(Floor& floor, const PlanarMapOptions& options) {
  try {
    SnapGraph graph = Snap(OutlinesOf(floor), options.snap_radius_m);
    if (graph.is_planar)
      MapBuilder<PlanarKernel>(floor, options, std::move(graph)).Run();
    else
      MapBuilder<CrossingKernel>(floor, options, std::move(graph)).Run();
  } catch (const std::bad_alloc&) {
    throw;  // the plan is too complex, which the compiler says
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kInternal, fmt::format("the arrangement of the level at {:.3f} m failed: {}", floor.level.base_z_m, e.what()));
  }
  return {};
}

}  // namespace plumb::compiler
