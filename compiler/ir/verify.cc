#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {
namespace {

// Above this the first fault of a kind says it all.
constexpr size_t kMaxFaults = 100;

class Faults {
 public:
  template <class... Args>
  void Require(bool ok, fmt::format_string<Args...> format, Args&&... args) {
    if (!ok && faults_.size() < kMaxFaults) faults_.push_back(fmt::format(format, std::forward<Args>(args)...));
  }
  [[nodiscard]] std::vector<std::string> Take() { return std::move(faults_); }

 private:
  std::vector<std::string> faults_;
};

bool InRangeOrNone(uint32_t index, size_t size) { return index == kNoIndex || index < size; }

void VerifySolid(Faults& faults, const char* owner, size_t i, const char* part, const Solid& solid) {
  const bool finite = std::all_of(solid.vertices.begin(), solid.vertices.end(), [](const auto& v) { return v.allFinite(); });
  faults.Require(finite, "{} {}: a vertex of its {} is not finite", owner, i, part);
  const int size = static_cast<int>(solid.vertices.size());
  const bool in_range = std::all_of(solid.triangles.begin(), solid.triangles.end(),
                                    [size](const auto& t) { return t.minCoeff() >= 0 && t.maxCoeff() < size; });
  faults.Require(in_range, "{} {}: a triangle of its {} has no such vertex", owner, i, part);
}

void VerifyElement(Faults& faults, const PlanIr& plan, size_t i) {
  const PlanElement& e = plan.elements[i];
  faults.Require(InRangeOrNone(e.storey, plan.storeys.size()), "element {}: storey {} of {}", i, e.storey, plan.storeys.size());
  VerifySolid(faults, "element", i, "body", e.body);
  VerifySolid(faults, "element", i, "uncut solid", e.uncut);
  faults.Require(!e.thickness_m || (std::isfinite(*e.thickness_m) && *e.thickness_m > 0), "element {}: its thickness is not positive", i);
  faults.Require(!e.axis || (e.axis->first.allFinite() && e.axis->second.allFinite()), "element {}: its axis is not finite", i);
  for (const PlanLeaf& leaf : e.leaves) {
    faults.Require(leaf.to_jamb.allFinite() && leaf.opens_to.allFinite() && std::isfinite(leaf.width_m) && leaf.width_m >= 0,
                   "element {}: a leaf is not finite or less than nothing wide", i);
  }
  for (const Arc& arc : e.arcs) {
    const bool ok = arc.center.allFinite() && arc.radius_m > 0 && std::isfinite(arc.radius_m + arc.start_rad + arc.sweep_rad);
    faults.Require(ok, "element {}: an arc is not finite or has no radius", i);
  }
}

void VerifyOpening(Faults& faults, const PlanIr& plan, size_t i) {
  const PlanOpening& o = plan.openings[i];
  faults.Require(InRangeOrNone(o.wall, plan.elements.size()), "opening {}: wall {} of {}", i, o.wall, plan.elements.size());
  faults.Require(InRangeOrNone(o.filling, plan.elements.size()), "opening {}: filling {} of {}", i, o.filling, plan.elements.size());
  VerifySolid(faults, "opening", i, "body", o.body);
  faults.Require(!o.width_m || (std::isfinite(*o.width_m) && *o.width_m > 0), "opening {}: its width is not positive", i);
  faults.Require(!o.height_m || (std::isfinite(*o.height_m) && *o.height_m > 0), "opening {}: its height is not positive", i);
}

// The closed chain of a face's boundary and the mutual reference of neighbours.
void VerifyBoundary(Faults& faults, const Floor& floor, size_t face, const std::vector<BoundaryEdge>& ring) {
  faults.Require(ring.size() >= 2, "face {}: a boundary has {} edges", face, ring.size());
  for (size_t k = 0; k < ring.size(); ++k) {
    const BoundaryEdge& edge = ring[k];
    faults.Require(edge.from < floor.vertices.size() && edge.to < floor.vertices.size(), "face {}: an edge has no such vertex", face);
    faults.Require(edge.from != edge.to, "face {}: an edge has no length", face);
    faults.Require(edge.to == ring[(k + 1) % ring.size()].from, "face {}: its boundary is not closed", face);
    faults.Require(edge.face < floor.faces.size(), "face {}: neighbour {} of {}", face, edge.face, floor.faces.size());
    faults.Require(!edge.footprints.empty() || !floor.dividers.empty(), "face {}: an edge belongs to no footprint", face);
    faults.Require(InRangeOrNone(edge.bridge, floor.bridges.size()), "face {}: bridge {} of {}", face, edge.bridge, floor.bridges.size());
    for (uint32_t f : edge.footprints)
      faults.Require(f < floor.footprints.size(), "face {}: footprint {} of {}", face, f, floor.footprints.size());
  }
}

void VerifyFloor(Faults& faults, const FloorIr& ir, const PlanIr& plan, const Floor& floor) {
  const Level& level = floor.level;
  faults.Require(level.first_storey <= level.last_storey && level.last_storey < plan.storeys.size(), "level: storeys {} to {} of {}",
                 level.first_storey, level.last_storey, plan.storeys.size());
  for (size_t i = 0; i < floor.footprints.size(); ++i) {
    const Footprint& f = floor.footprints[i];
    faults.Require(f.element < plan.elements.size(), "footprint {}: element {} of {}", i, f.element, plan.elements.size());
    faults.Require((f.kind == FootprintKind::kWall) == (f.wall != kNoIndex), "footprint {}: a wall without index or a column with one", i);
    faults.Require(InRangeOrNone(f.wall, ir.walls.size()), "footprint {}: wall {} of {}", i, f.wall, ir.walls.size());
    for (const Ring& ring : f.rings) faults.Require(ring.size() >= 3, "footprint {}: a ring has {} points", i, ring.size());
  }
  for (size_t i = 0; i < floor.dividers.size(); ++i) {
    faults.Require(floor.dividers[i].space < plan.spaces.size(), "divider {}: space {} of {}", i, floor.dividers[i].space,
                   plan.spaces.size());
  }
  for (size_t i = 0; i < floor.bridges.size(); ++i) {
    const Bridge& b = floor.bridges[i];
    faults.Require(b.footprint_a < floor.footprints.size() && b.footprint_b < floor.footprints.size(), "bridge {}: no such footprint", i);
  }
  faults.Require(!floor.cut_heights_m.empty() && std::is_sorted(floor.cut_heights_m.begin(), floor.cut_heights_m.end()),
                 "the heights of the cuts are not sorted");
  for (const auto& v : floor.vertices) faults.Require(v.allFinite(), "a vertex of the map is not finite");
  faults.Require(!floor.faces.empty(), "the map has no faces");
  for (size_t i = 0; i < floor.faces.size(); ++i) {
    const FloorFace& face = floor.faces[i];
    faults.Require(face.bounded() == (i != 0), "face {}: only the first face is unbounded", i);
    faults.Require(face.bounded() || face.cover.empty(), "the unbounded face is covered by a wall");
    faults.Require(std::is_sorted(face.cover.begin(), face.cover.end()), "face {}: its cover is not sorted", i);
    for (uint32_t f : face.cover) faults.Require(f < floor.footprints.size(), "face {}: footprint {} of {}", i, f, floor.footprints.size());
    if (face.bounded()) VerifyBoundary(faults, floor, i, face.outer);
    for (const auto& hole : face.holes) VerifyBoundary(faults, floor, i, hole);
  }
}

}  // namespace

std::vector<std::string> VerifyPlanIr(const PlanIr& plan) {
  Faults faults;
  faults.Require(plan.origin.allFinite(), "the origin is not finite");
  for (size_t i = 0; i < plan.storeys.size(); ++i) {
    faults.Require(std::isfinite(plan.storeys[i].elevation_m), "storey {}: its elevation is not finite", i);
    faults.Require(i == 0 || plan.storeys[i - 1].elevation_m <= plan.storeys[i].elevation_m,
                   "storey {}: storeys are not sorted by elevation", i);
  }
  for (size_t i = 0; i < plan.elements.size(); ++i) VerifyElement(faults, plan, i);
  for (size_t i = 0; i < plan.openings.size(); ++i) VerifyOpening(faults, plan, i);
  for (size_t i = 0; i < plan.spaces.size(); ++i) {
    faults.Require(InRangeOrNone(plan.spaces[i].storey, plan.storeys.size()), "space {}: storey {} of {}", i, plan.spaces[i].storey,
                   plan.storeys.size());
    VerifySolid(faults, "space", i, "body", plan.spaces[i].body);
  }
  return faults.Take();
}

std::vector<std::string> VerifyFloorIr(const FloorIr& ir, const PlanIr& plan) {
  Faults faults;
  for (size_t i = 0; i < ir.walls.size(); ++i) {
    const PlanWall& w = ir.walls[i];
    faults.Require(!w.elements.empty(), "wall {}: it has no element", i);
    for (uint32_t e : w.elements) faults.Require(e < plan.elements.size(), "wall {}: element {} of {}", i, e, plan.elements.size());
    faults.Require(w.storey < plan.storeys.size(), "wall {}: storey {} of {}", i, w.storey, plan.storeys.size());
    faults.Require(w.z_min_m <= w.z_max_m, "wall {}: it ends below its start", i);
  }
  for (const Floor& floor : ir.floors) VerifyFloor(faults, ir, plan, floor);
  return faults.Take();
}

}  // namespace plumb::compiler
