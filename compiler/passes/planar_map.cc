#include "compiler/passes/planar_map.h"

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "compiler/passes/polygon.h"
#include "compiler/passes/snap.h"

namespace plumb::compiler {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Traits = CGAL::Arr_consolidated_curve_data_traits_2<CGAL::Arr_segment_traits_2<Kernel>, uint32_t>;  // data: index of the SnapSegment

// Winding number per footprint; footprints with 0 are left out.
using Windings = std::map<uint32_t, int>;

struct FaceLabel {
  Windings windings;
  uint32_t index = kNoIndex;
};

using Arrangement = CGAL::Arrangement_2<Traits, CGAL::Arr_extended_dcel<Traits, uint32_t, char, FaceLabel>>;
using Halfedge = Arrangement::Halfedge_const_handle;

SnapGraph OutlinesOf(const Floor& floor) {
  SnapGraph graph;
  for (uint32_t f = 0; f < floor.footprints.size(); ++f) {
    if (!floor.footprints[f].bounds_rooms) continue;
    for (const Ring& ring : floor.footprints[f].rings) {
      const auto first = static_cast<uint32_t>(graph.vertices.size()), size = static_cast<uint32_t>(ring.size());
      graph.vertices.insert(graph.vertices.end(), ring.begin(), ring.end());
      for (uint32_t i = 0; i < size; ++i) graph.segments.push_back({first + i, first + (i + 1) % size, f});
    }
  }
  return graph;
}

class MapBuilder {
 public:
  MapBuilder(Floor& floor, double snap_radius_m) : floor_(floor), graph_(Snap(OutlinesOf(floor), snap_radius_m)) {}

  void Run() {
    Insert();
    RemoveAntennas();
    LabelFaces();
    ExtractVertices();
    ExtractFaces();
  }

 private:
  void Insert() {
    std::vector<Traits::Curve_2> curves;
    const auto point = [this](uint32_t v) { return Kernel::Point_2(graph_.vertices[v].x(), graph_.vertices[v].y()); };
    for (uint32_t i = 0; i < graph_.segments.size(); ++i) {
      const SnapSegment& s = graph_.segments[i];
      if (graph_.vertices[s.from] == graph_.vertices[s.to]) continue;
      curves.emplace_back(Kernel::Segment_2(point(s.from), point(s.to)), i);
    }
    CGAL::insert(arrangement_, curves.begin(), curves.end());
  }

  // Edges with the same face on both sides bound nothing.
  void RemoveAntennas() {
    for (bool changed = true; changed;) {
      changed = false;
      for (auto e = arrangement_.edges_begin(); e != arrangement_.edges_end();) {
        const Arrangement::Halfedge_handle here = e->twin()->twin();
        ++e;
        if (here->face() != here->twin()->face()) continue;
        arrangement_.remove_edge(here);
        changed = true;
      }
    }
  }

  // How much the winding numbers on the left of `edge` exceed those on its right.
  Windings StepOver(Halfedge edge) const {
    Windings out;
    const bool edge_forward = edge->direction() == CGAL::ARR_LEFT_TO_RIGHT;
    for (const uint32_t i : edge->curve().data()) {
      const SnapSegment& s = graph_.segments[i];
      const bool forward = LexicographicallyLess(graph_.vertices[s.from], graph_.vertices[s.to]);
      out[s.footprint] += forward == edge_forward ? 1 : -1;
    }
    return out;
  }

  void LabelFaces() {
    std::deque<Arrangement::Face_handle> open = {arrangement_.unbounded_face()};
    std::set<const void*> known = {&*arrangement_.unbounded_face()};  // membership only, never walked in order
    while (!open.empty()) {
      const Arrangement::Face_handle face = open.front();
      open.pop_front();
      const auto visit = [&](Arrangement::Ccb_halfedge_circulator first) {
        auto edge = first;
        do {
          const Arrangement::Face_handle across = edge->twin()->face();
          if (!known.insert(&*across).second) continue;
          Windings windings = face->data().windings;
          for (const auto& [footprint, step] : StepOver(edge)) {
            if ((windings[footprint] -= step) == 0) windings.erase(footprint);
          }
          across->set_data({std::move(windings), kNoIndex});
          open.push_back(across);
        } while (++edge != first);
      };
      for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb) visit(*ccb);
      for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb) visit(*ccb);
    }
  }

  void ExtractVertices() {
    std::vector<std::pair<Eigen::Vector2d, Arrangement::Vertex_handle>> vertices;
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

  std::vector<BoundaryEdge> Boundary(Arrangement::Ccb_halfedge_const_circulator first) const {
    std::vector<BoundaryEdge> out;
    auto edge = first;
    do {
      BoundaryEdge b;
      b.from = edge->source()->data();
      b.to = edge->target()->data();
      b.face = edge->twin()->face()->data().index;
      for (const uint32_t i : edge->curve().data()) b.footprints.push_back(graph_.segments[i].footprint);
      std::sort(b.footprints.begin(), b.footprints.end());
      b.footprints.erase(std::unique(b.footprints.begin(), b.footprints.end()), b.footprints.end());
      out.push_back(std::move(b));
    } while (++edge != first);
    const auto least = std::min_element(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    std::rotate(out.begin(), least, out.end());
    return out;
  }

  void ExtractFaces() {
    std::vector<Arrangement::Face_handle> order;
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) order.push_back(f);
    // A face is told by the two least vertices of its outer boundary: the directed edge that leaves the least one has one face on its left.
    const auto key = [](Arrangement::Face_const_handle f) {
      std::pair<uint32_t, uint32_t> least(0, 0);
      if (f->is_unbounded()) return least;
      least = {kNoIndex, kNoIndex};
      auto edge = f->outer_ccb();
      do {
        least = std::min(least, {edge->source()->data() + 1, edge->target()->data() + 1});
      } while (++edge != f->outer_ccb());
      return least;
    };
    std::vector<std::pair<std::pair<uint32_t, uint32_t>, Arrangement::Face_handle>> keyed;
    for (const auto& f : order) keyed.emplace_back(key(f), f);
    std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (uint32_t i = 0; i < keyed.size(); ++i) keyed[i].second->data().index = i;

    floor_.faces.clear();
    for (const auto& [least, f] : keyed) {
      FloorFace face;
      for (const auto& [footprint, winding] : f->data().windings) face.cover.push_back(footprint);
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
  SnapGraph graph_;
  Arrangement arrangement_;
};

}  // namespace

std::string PlanarMapOptions::Check() const {
  if (!(snap_radius_m > 0 && snap_radius_m <= 0.05)) return fmt::format("PlanarMapOptions.snap_radius_m = {}; must be in (0, 0.05]", snap_radius_m);
  return {};
}

Expected<void> BuildPlanarMap(Floor& floor, const PlanarMapOptions& options) {
  try {
    MapBuilder(floor, options.snap_radius_m).Run();
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kInternal, fmt::format("the arrangement of the level at {:.3f} m failed: {}", floor.level.base_z_m, e.what()));
  }
  return {};
}

std::vector<Ring> FaceRings(const Floor& floor, const FloorFace& face) {
  std::vector<Ring> out;
  const auto append = [&](const std::vector<BoundaryEdge>& edges) {
    Ring ring;
    for (const BoundaryEdge& e : edges) ring.push_back(floor.vertices[e.from]);
    out.push_back(std::move(ring));
  };
  if (face.bounded()) append(face.outer);
  for (const auto& hole : face.holes) append(hole);
  return out;
}

FaceLocator::FaceLocator(const Floor& floor) {
  for (size_t i = 1; i < floor.faces.size(); ++i) {
    std::vector<Ring> rings = FaceRings(floor, floor.faces[i]);
    const Eigen::AlignedBox2d box = BoundingBox(rings);
    entries_.push_back({std::move(rings), box});
  }
}

uint32_t FaceLocator::FaceAt(const Eigen::Vector2d& p) const {
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].box.contains(p) && WindingNumber(entries_[i].rings, p) != 0) return static_cast<uint32_t>(i + 1);
  }
  return 0;
}

}  // namespace plumb::compiler
