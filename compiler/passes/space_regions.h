// Parts of a planar map that no wall divides, and which of the spaces that share them they belong to. Private to planar_map.cc.
#pragma once

#include <CGAL/number_utils.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "compiler/passes/face_labels.h"
#include "compiler/passes/floor_outlines.h"

namespace plumb::compiler {

// `Arrangement` is CGAL's, with a FaceLabel on each face. `is_virtual(halfedge)`: no wall's outline and no bridge runs there.
template <class Arrangement, class IsVirtual>
class SpaceRegions {
 public:
  // All must outlive it.
  SpaceRegions(const OutlineNumbers& numbers, double max_strip_width_m, const IsVirtual& is_virtual, Arrangement& arrangement)
      : numbers_(numbers), max_strip_width_m_(max_strip_width_m), is_virtual_(is_virtual), arrangement_(arrangement) {}

  // Fills FaceLabel::region and space.
  void Run() {
    FindRegions();
    AssignSpaces();
    while (AdoptStrips()) {
    }
  }

 private:
  using Face = typename Arrangement::Face_handle;
  using Circulator = typename Arrangement::Ccb_halfedge_circulator;

  bool IsFree(typename Arrangement::Face_const_handle f) const {
    const Windings& windings = f->data().windings;
    return !f->is_unbounded() && (windings.empty() || numbers_.IsDivider(windings.front().first));
  }

  static double AreaOf(Face face) {
    double twice = 0;
    ForEachEdge<Circulator>(face, [&twice](Circulator edge) {
      const auto &a = edge->source()->point(), &b = edge->target()->point();
      twice += CGAL::to_double(a.x()) * CGAL::to_double(b.y()) - CGAL::to_double(b.x()) * CGAL::to_double(a.y());
    });
    return 0.5 * twice;
  }

  void FindRegions() {
    uint32_t regions = 0;
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) {
      if (!IsFree(f) || f->data().region != kNoIndex) continue;
      std::vector<Face> open = {f};
      f->data().region = regions;
      while (!open.empty()) {
        const Face face = open.back();
        open.pop_back();
        ForEachEdge<Circulator>(face, [&](Circulator edge) {
          const Face across = edge->twin()->face();
          if (!IsFree(across) || !is_virtual_(edge) || across->data().region != kNoIndex) return;
          across->data().region = regions;
          open.push_back(across);
        });
      }
      ++regions;
    }
  }

  // A divider divides only the region that holds most of it: spaces drawn to the middle of walls do not cut up the rooms next door.
  void AssignSpaces() {
    std::map<std::pair<uint32_t, uint32_t>, double> area;  // by divider and region
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) {
      for (const auto& [outline, winding] : f->data().windings) {
        if (IsFree(f) && numbers_.IsDivider(outline)) area[{outline, f->data().region}] += AreaOf(f);
      }
    }
    std::map<uint32_t, std::pair<double, uint32_t>> home;  // divider to area and region
    for (const auto& [key, size] : area) home[key.first] = std::max(home[key.first], {size, key.second});
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) {
      if (!IsFree(f)) continue;
      for (const auto& [outline, winding] : f->data().windings) {
        if (f->data().space == kNoIndex && home[outline].second == f->data().region) f->data().space = outline;
      }
    }
  }

  // Narrow parts without space (between a space and the wall, between two spaces) join the space with the longest common border.
  bool AdoptStrips() {
    bool changed = false;
    for (auto f = arrangement_.faces_begin(); f != arrangement_.faces_end(); ++f) {
      if (!IsFree(f) || f->data().space != kNoIndex) continue;
      double perimeter = 0;
      std::map<uint32_t, double> border;
      ForEachEdge<Circulator>(f, [&](Circulator edge) {
        const double length = std::sqrt(CGAL::to_double(CGAL::squared_distance(edge->source()->point(), edge->target()->point())));
        const Face across = edge->twin()->face();
        perimeter += length;
        if (is_virtual_(edge) && across->data().region == f->data().region && across->data().space != kNoIndex)
          border[across->data().space] += length;
      });
      if (border.empty() || 2 * AreaOf(f) > max_strip_width_m_ * perimeter) continue;
      f->data().space =
          std::max_element(border.begin(), border.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
      changed = true;
    }
    return changed;
  }

  const OutlineNumbers& numbers_;
  const double max_strip_width_m_;
  const IsVirtual& is_virtual_;
  Arrangement& arrangement_;
};

}  // namespace plumb::compiler
