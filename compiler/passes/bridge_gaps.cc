#include "compiler/passes/bridge_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "compiler/geometry/box_tree.h"
#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr std::array<double, 3> kFreePlaces = {0.05, 0.5, 0.95};  // along a bridge, that nothing may cover
constexpr size_t kFootprintsPerBridge = 20;                       // and more: to look about the bridges alone costs less than a second map

// A corner of an outline and the edge that leaves it.
struct Corner {
  Eigen::Vector2d at, next;
  uint32_t footprint, ring;
};

// Rings drawn several times count once: no gap leads from one to the other, and gaps to a third are the same.
std::vector<Corner> CornersOf(const Floor& floor) {
  const auto less = [](const Ring& a, const Ring& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), LexicographicallyLess);
  };
  std::set<Ring, decltype(less)> known(less);
  std::vector<Corner> out;
  uint32_t ring_number = 0;
  for (uint32_t f = 0; f < floor.footprints.size(); ++f) {
    if (!floor.footprints[f].bounds_rooms) continue;
    for (const Ring& ring : floor.footprints[f].rings) {
      if (!known.insert(ring).second) continue;
      for (size_t i = 0; i < ring.size(); ++i) out.push_back({ring[i], ring[(i + 1) % ring.size()], f, ring_number});
      ++ring_number;
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Corner& a, const Corner& b) { return LexicographicallyLess(a.at, b.at); });
  return out;
}

// What covers a point.
class Cover {
 public:
  explicit Cover(const Floor& floor) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const Footprint& f : floor.footprints) {
      if (!f.bounds_rooms) continue;
      rings_.push_back(&f.rings);
      boxes.push_back(BoundingBox(f.rings));
    }
    tree_ = BoxTree<2>(std::move(boxes));
  }
  bool IsFree(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    return std::none_of(kFreePlaces.begin(), kFreePlaces.end(), [&](double t) { return Holds(from + t * (to - from)); });
  }

 private:
  bool Holds(const Eigen::Vector2d& p) const {
    bool held = false;
    tree_.ForEachIn(Eigen::AlignedBox2d(p), [&](uint32_t i) { held = held || WindingNumber(*rings_[i], p) != 0; });
    return held;
  }

  std::vector<const std::vector<Ring>*> rings_;
  BoxTree<2> tree_;
};

// Free faces as nodes: those wider than the gap are places, the slivers within gaps hang together over bridges.
class Slivers {
 public:
  Slivers(const Floor& floor, double max_gap_m) : floor_(floor), parent_(floor.faces.size()), places_(floor.faces.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const FloorFace& face : floor.faces) is_place_.push_back(IsPlace(face, max_gap_m));
    ForEachBridge([&](uint32_t, uint32_t a, uint32_t b) {
      if (!is_place_[a] && !is_place_[b]) parent_[Root(std::max(a, b))] = Root(std::min(a, b));
    });
    ForEachBridge([&](uint32_t, uint32_t a, uint32_t b) {
      if (is_place_[b] && !is_place_[a]) places_[Root(a)].insert(b);
    });
  }

  // Bridges on the way from one place to another.
  std::vector<bool> Separating() {
    std::vector<bool> out(floor_.bridges.size(), false);
    ForEachBridge([&](uint32_t bridge, uint32_t a, uint32_t b) {
      const bool both = is_place_[a] && is_place_[b], through = !is_place_[a] && places_[Root(a)].size() > 1;
      if (both || through) out[bridge] = true;
    });
    return out;
  }

 private:
  // From both sides of every bridge.
  template <class Visit>
  void ForEachBridge(const Visit& visit) const {
    for (uint32_t i = 0; i < floor_.faces.size(); ++i) {
      const FloorFace& face = floor_.faces[i];
      const auto walk = [&](const std::vector<BoundaryEdge>& ring) {
        for (const BoundaryEdge& e : ring) {
          if (e.bridge != kNoIndex && face.cover.empty() && floor_.faces[e.face].cover.empty()) visit(e.bridge, i, e.face);
        }
      };
      walk(face.outer);
      for (const auto& hole : face.holes) walk(hole);
    }
  }

  bool IsPlace(const FloorFace& face, double max_gap_m) const {
    if (!face.bounded()) return true;
    double perimeter = 0;
    for (const Ring& ring : FaceRings(floor_, face)) {
      for (size_t i = 0; i < ring.size(); ++i) perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
    }
    return 2 * face.area_m2 > max_gap_m * perimeter;
  }

  uint32_t Root(uint32_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }

  const Floor& floor_;
  std::vector<uint32_t> parent_;
  std::vector<std::set<uint32_t>> places_;
  std::vector<bool> is_place_;
};

std::vector<Bridge> Kept(const std::vector<Bridge>& bridges, const std::vector<bool>& keep) {
  std::vector<Bridge> out;
  for (size_t b = 0; b < keep.size(); ++b) {
    if (keep[b]) out.push_back(bridges[b]);
  }
  return out;
}

// The bridges and what bounds the faces of the floor's map that they lie in, which is all that tells what they separate.
Floor FloorAbout(const std::vector<Bridge>& bridges, const Floor& floor) {
  const FaceLocator locator(floor);
  std::set<uint32_t> faces, footprints;
  for (const Bridge& b : bridges) {
    for (const double t : kFreePlaces) faces.insert(locator.FaceAt(b.from + t * (b.to - b.from)));
    footprints.insert({b.footprint_a, b.footprint_b});
  }
  for (const uint32_t f : faces) {
    const auto add = [&footprints](const std::vector<BoundaryEdge>& ring) {
      for (const BoundaryEdge& e : ring) footprints.insert(e.footprints.begin(), e.footprints.end());
    };
    add(floor.faces[f].outer);
    for (const auto& hole : floor.faces[f].holes) add(hole);
  }
  Floor out;
  out.level = floor.level;
  std::map<uint32_t, uint32_t> place;
  for (const uint32_t f : footprints) {
    place[f] = static_cast<uint32_t>(out.footprints.size());
    out.footprints.push_back(floor.footprints[f]);
  }
  for (const Bridge& b : bridges) out.bridges.push_back({b.from, b.to, place[b.footprint_a], place[b.footprint_b]});
  return out;
}

}  // namespace

std::string BridgeOptions::Check() const {
  if (!(max_gap_m >= 0 && max_gap_m <= 0.5)) return fmt::format("BridgeOptions.max_gap_m = {}; must be in [0, 0.5]", max_gap_m);
  return {};
}

std::vector<Bridge> FindBridges(const Floor& floor, double min_gap_m, double max_gap_m) {
  const std::vector<Corner> corners = CornersOf(floor);
  const Cover cover(floor);
  std::map<std::pair<uint32_t, uint32_t>, std::pair<double, Bridge>> nearest;  // by corner and outline
  std::vector<Eigen::AlignedBox2d> places;
  for (const Corner& corner : corners) places.emplace_back(corner.at);
  const BoxTree<2> tree(std::move(places));
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(max_gap_m);
  for (const Corner& edge : corners) {
    tree.ForEachIn({edge.at.cwiseMin(edge.next) - reach, edge.at.cwiseMax(edge.next) + reach}, [&](uint32_t c) {
      if (corners[c].ring == edge.ring) return;
      const Eigen::Vector2d q = NearestOnSegment(corners[c].at, edge.at, edge.next);
      const double gap = (q - corners[c].at).norm();
      if (gap > max_gap_m) return;
      const auto [known, fresh] = nearest.try_emplace({c, edge.ring});
      if (!fresh && known->second.first <= gap) return;
      known->second = {gap, {corners[c].at, q, corners[c].footprint, edge.footprint}};
    });
  }
  std::vector<Bridge> out;
  for (const auto& [key, entry] : nearest) {
    const Bridge& b = entry.second;
    if (entry.first > min_gap_m && cover.IsFree(b.from, b.to)) out.push_back(b);
  }
  return out;
}

Expected<void> BridgeGaps(const BridgeOptions& options, const PlanarMapOptions& map_options, Floor& floor) {
  std::vector<Bridge> bridges = FindBridges(floor, map_options.snap_radius_m, options.max_gap_m);
  if (const bool few = bridges.size() * kFootprintsPerBridge < floor.footprints.size(); few) {
    if (Expected<void> ok = BuildPlanarMap(floor, map_options); !ok || bridges.empty()) return ok;
    Floor about = FloorAbout(bridges, floor);
    if (Expected<void> ok = BuildPlanarMap(about, map_options); !ok) return ok;
    bridges = Kept(bridges, Slivers(about, options.max_gap_m).Separating());
    if (bridges.empty()) return {};
    floor.bridges = std::move(bridges);
    return BuildPlanarMap(floor, map_options);
  }
  floor.bridges = std::move(bridges);
  if (Expected<void> ok = BuildPlanarMap(floor, map_options); !ok || floor.bridges.empty()) return ok;
  const size_t tried = floor.bridges.size();
  floor.bridges = Kept(floor.bridges, Slivers(floor, options.max_gap_m).Separating());
  return floor.bridges.size() == tried ? Expected<void>() : BuildPlanarMap(floor, map_options);
}

void ReportBridges(const PlanIr& plan, const FloorIr& floors, DiagnosticSink& sink) {
  constexpr double kSameGap_m = 1.0;  // the corners of a wall's end are closer together
  const auto named = [](const PlanElement& e) {
    const std::string name = e.location.ToString();
    return name.empty() ? std::string("a wall") : name;
  };
  for (const Floor& floor : floors.floors) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<Eigen::Vector2d>> reported;
    for (const Bridge& b : floor.bridges) {
      const Eigen::Vector2d at = 0.5 * (b.from + b.to);
      auto& known = reported[std::minmax(b.footprint_a, b.footprint_b)];
      if (std::any_of(known.begin(), known.end(), [&](const auto& p) { return (p - at).norm() < kSameGap_m; })) continue;
      known.push_back(at);
      const PlanElement &first = plan.elements[floor.footprints[b.footprint_a].element],
                        &second = plan.elements[floor.footprints[b.footprint_b].element];
      sink.Emit(DiagnosticKind::kGapBridged, first.location,
                fmt::format("{} ends {:.3f} m from {} at ({:.2f}, {:.2f}); nobody passes there, so that they are taken to meet",
                            named(first), (b.to - b.from).norm(), named(second), at.x() + plan.origin.x(), at.y() + plan.origin.y()));
    }
  }
}

}  // namespace plumb::compiler
