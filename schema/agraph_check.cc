#include "schema/agraph_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {
namespace {

// Collects the first fault.
class Checker {
 public:
  explicit Checker(const AGraph& graph) : graph_(graph) {}

  std::string Run() {
    Finite("origin", 0, graph_.origin);
    for (size_t i = 0; i < graph_.storeys.size(); ++i) Finite("storey", i, graph_.storeys[i].elevation_m, graph_.storeys[i].height_m);
    CheckWallsAndSurfaces();
    CheckRooms();
    CheckOpenings();
    CheckElements();
    CheckRest();
    return fault_;
  }

 private:
  void Fault(const char* what, size_t i, const std::string& why) {
    if (fault_.empty()) fault_ = fmt::format("{} {}: {}", what, i, why);
  }
  void Number(const char* what, size_t i, double v) {
    if (!std::isfinite(v)) Fault(what, i, "a number is not finite");
  }
  template <class Derived>
  void Number(const char* what, size_t i, const Eigen::MatrixBase<Derived>& v) {
    if (!v.allFinite()) Fault(what, i, "a coordinate is not finite");
  }
  template <class... Values>
  void Finite(const char* what, size_t i, const Values&... values) {
    (Number(what, i, values), ...);
  }
  template <class Tag>
  void Reference(const char* what, size_t i, Id<Tag> id, size_t size, bool may_be_none) {
    if (id.valid() ? id.index() >= size : !may_be_none) {
      Fault(what, i, fmt::format("refers to entry {} of a table with {}", id.value, size));
    }
  }
  template <class Tag>
  void References(const char* what, size_t i, const std::vector<Id<Tag>>& ids, size_t size) {
    for (Id<Tag> id : ids) Reference(what, i, id, size, false);
  }
  void CheckRing(const char* what, size_t i, const Ring& ring) {
    for (const auto& p : ring) Finite(what, i, p);
    if (ring.size() < 3) Fault(what, i, fmt::format("a ring has {} points; it needs 3", ring.size()));
  }
  void CheckWallsAndSurfaces() {
    if (graph_.true_north_rad) Finite("true north", 0, *graph_.true_north_rad);
    const size_t storeys = graph_.storeys.size();
    for (size_t i = 0; i < graph_.walls.size(); ++i) {
      const Wall& w = graph_.walls[i];
      Finite("wall", i, w.axis_start, w.axis_end, w.thickness_m, w.z_min_m, w.z_max_m);
      Reference("wall", i, w.storey, storeys, true);
    }
    for (size_t i = 0; i < graph_.surfaces.size(); ++i) {
      const Surface& s = graph_.surfaces[i];
      Finite("surface", i, s.normal, s.d_m, s.start, s.end, s.z_min_m, s.z_max_m);
      if (s.arc) {
        constexpr double kFullCircle_rad = 2 * std::numbers::pi + 1e-6;
        Finite("surface", i, s.arc->center, s.arc->radius_m, s.arc->start_rad, s.arc->sweep_rad);
        if (!(s.arc->radius_m > 0) || std::abs(s.arc->sweep_rad) > kFullCircle_rad) Fault("surface", i, "the arc is no part of a circle");
      }
      if (std::abs(s.normal.norm() - 1) > 1e-6) Fault("surface", i, "the normal is no unit vector");
      Reference("surface", i, s.wall, graph_.walls.size(), false);
      Reference("surface", i, s.storey, storeys, true);
      Reference("surface", i, s.room, graph_.rooms.size(), true);
    }
  }
  void CheckRooms() {
    for (size_t i = 0; i < graph_.rooms.size(); ++i) {
      const Room& r = graph_.rooms[i];
      Finite("room", i, r.area_m2, r.center, r.yaw_rad, r.floor_z_m, r.ceiling_z_m);
      CheckRing("room", i, r.polygon);
      for (const Ring& hole : r.holes) CheckRing("room", i, hole);
      Reference("room", i, r.storey, graph_.storeys.size(), true);
      References("room", i, r.surfaces, graph_.surfaces.size());
    }
  }
  void CheckOpenings() {
    const size_t storeys = graph_.storeys.size(), walls = graph_.walls.size();
    for (size_t i = 0; i < graph_.doorways.size(); ++i) {
      const Doorway& d = graph_.doorways[i];
      Finite("doorway", i, d.position, d.yaw_rad, d.width_m, d.height_m);
      Reference("doorway", i, d.storey, storeys, true);
      Reference("doorway", i, d.wall, walls, true);
      Reference("doorway", i, d.room_a, graph_.rooms.size(), true);
      Reference("doorway", i, d.room_b, graph_.rooms.size(), true);
      if (d.leaves.size() > 2) Fault("doorway", i, "it has more than two leaves");
      for (const DoorLeaf& l : d.leaves) CheckLeaf(i, l);
    }
    for (size_t i = 0; i < graph_.windows.size(); ++i) {
      const Window& w = graph_.windows[i];
      Finite("window", i, w.position, w.yaw_rad, w.width_m, w.height_m);
      Reference("window", i, w.storey, storeys, true);
      Reference("window", i, w.wall, walls, true);
    }
    for (size_t i = 0; i < graph_.columns.size(); ++i) {
      const Column& c = graph_.columns[i];
      Finite("column", i, c.z_min_m, c.z_max_m);
      CheckRing("column", i, c.outline);
      Reference("column", i, c.storey, storeys, true);
    }
    for (size_t i = 0; i < graph_.open_boundaries.size(); ++i) {
      const OpenBoundary& b = graph_.open_boundaries[i];
      Finite("open boundary", i, b.start, b.end);
      Reference("open boundary", i, b.storey, storeys, true);
      Reference("open boundary", i, b.room_a, graph_.rooms.size(), false);
      Reference("open boundary", i, b.room_b, graph_.rooms.size(), false);
    }
  }
  void CheckLeaf(size_t doorway, const DoorLeaf& l) {
    Finite("doorway", doorway, l.width_m);
    if (l.operation > LeafOperation::kFixed || l.jamb > Jamb::kRight || l.opens_to > DoorwaySide::kRoomB)
      Fault("doorway", doorway, "how its leaf opens is unknown");
    if (l.width_m < 0) Fault("doorway", doorway, "the width of its leaf is negative");
  }
  void CheckElements() {
    for (size_t i = 0; i < graph_.elements.size(); ++i) {
      const Element& e = graph_.elements[i];
      if (e.kind > ElementKind::kGround || e.material > Material::kGlass) Fault("element", i, "its kind or material is unknown");
      Reference("element", i, e.storey, graph_.storeys.size(), true);
      Reference("element", i, e.wall, graph_.walls.size(), true);
      Reference("element", i, e.doorway, graph_.doorways.size(), true);
    }
  }
  void CheckRest() {
    for (size_t i = 0; i < graph_.aliases.size(); ++i) CheckAlias(i);
    for (size_t i = 0; i < graph_.look_alikes.size(); ++i) References("look-alikes", i, graph_.look_alikes[i].rooms, graph_.rooms.size());
    for (size_t i = 0; i < graph_.factors.size(); ++i) CheckFactor(i);
    for (size_t i = 0; i < graph_.diagnostics.size(); ++i) {
      if (graph_.diagnostics[i].severity > Severity::kError) Fault("diagnostic", i, "its severity is unknown");
    }
  }
  void CheckAlias(size_t i) {
    const Alias& a = graph_.aliases[i];
    Finite("alias", i, a.yaw_rad, a.translation, a.overlap_ratio, a.tolerance_m, a.section_length_m);
    Reference("alias", i, a.from_storey, graph_.storeys.size(), true);
    Reference("alias", i, a.to_storey, graph_.storeys.size(), true);
    References("alias", i, a.rooms, graph_.rooms.size());
    References("alias", i, a.twins, graph_.rooms.size());
    References("alias", i, a.differences, graph_.elements.size());
    if (a.rooms.size() != a.twins.size()) Fault("alias", i, "it has not one twin for each room");
  }
  void CheckFactor(size_t i) {
    const Factor& f = graph_.factors[i];
    const auto table = [&](size_t k) -> size_t {
      switch (f.kind) {
        case FactorKind::kWallSurfaces: return k == 0 ? graph_.walls.size() : graph_.surfaces.size();
        case FactorKind::kRoomSurfaces: return k == 0 ? graph_.rooms.size() : graph_.surfaces.size();
        case FactorKind::kDoorwayRooms: return k == 0 ? graph_.doorways.size() : graph_.rooms.size();
        case FactorKind::kStoreyRoom: return k == 0 ? graph_.storeys.size() : graph_.rooms.size();
      }
      return 0;
    };
    for (size_t k = 0; k < f.variables.size(); ++k) {
      if (f.variables[k] >= table(k)) Fault("factor", i, "refers to a variable that is not there");
    }
  }

  const AGraph& graph_;
  std::string fault_;
};

}  // namespace

std::string FindFault(const AGraph& graph) { return Checker(graph).Run(); }

std::string FindMeshFault(const Mesh& mesh, size_t elements) {
  const size_t vertices = mesh.vertices.size();
  const auto vertex = std::find_if_not(mesh.vertices.begin(), mesh.vertices.end(), [](const Eigen::Vector3f& v) { return v.allFinite(); });
  if (vertex != mesh.vertices.end()) return fmt::format("mesh vertex {}: a coordinate is not finite", vertex - mesh.vertices.begin());
  const auto triangle = std::find_if_not(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return t.a < vertices && t.b < vertices && t.c < vertices && t.element < elements;
  });
  if (triangle == mesh.triangles.end()) return {};
  return fmt::format("triangle {}: refers to a vertex or element that is not there", triangle - mesh.triangles.begin());
}

}  // namespace plumb
