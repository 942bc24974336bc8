#include "schema/agraph_reader.h"

#include <flatbuffers/flatbuffers.h>
#include <fmt/format.h>

#include <cmath>
#include <new>
#include <numbers>

#include "schema/agraph_generated.h"
#include "schema/checksum.h"
#include "schema/files.h"

namespace plumb {
namespace {

Eigen::Vector2d Vec(const fb::Vec2* v) { return v == nullptr ? Eigen::Vector2d::Zero() : Eigen::Vector2d(v->x(), v->y()); }
Eigen::Vector3d Vec(const fb::Vec3* v) { return v == nullptr ? Eigen::Vector3d::Zero() : Eigen::Vector3d(v->x(), v->y(), v->z()); }

// Copies strings and vectors out of the file. Many tables may share one of them, so that a small file could fill the memory; what is past
// the budget is left empty.
class Copier {
 public:
  explicit Copier(size_t file_bytes) : budget_bytes_(64 * file_bytes + (1 << 20)) {}

  [[nodiscard]] bool exhausted() const { return exhausted_; }

  std::string Str(const flatbuffers::String* s) { return s != nullptr && Spend(s->size()) ? s->str() : std::string(); }

  Ring ToRing(const fb::Ring* ring) {
    Ring out;
    if (ring == nullptr || ring->points() == nullptr || !Spend(size_t{ring->points()->size()} * sizeof(fb::Vec2))) return out;
    out.reserve(ring->points()->size());
    for (const fb::Vec2* p : *ring->points()) out.push_back(Vec(p));
    return out;
  }

  template <class Out>
  void Numbers(const flatbuffers::Vector<uint32_t>* numbers, std::vector<Out>& out) {
    if (numbers == nullptr || !Spend(size_t{numbers->size()} * sizeof(uint32_t))) return;
    out.reserve(numbers->size());
    for (uint32_t number : *numbers) out.emplace_back(number);
  }

 private:
  bool Spend(size_t bytes) {
    exhausted_ = exhausted_ || bytes > budget_bytes_;
    if (!exhausted_) budget_bytes_ -= bytes;
    return !exhausted_;
  }

  size_t budget_bytes_;
  bool exhausted_ = false;
};

// Turns a vector of tables (absent: empty) into `out` with `convert`.
template <class Table, class Out, class Function>
void ReadAll(const flatbuffers::Vector<flatbuffers::Offset<Table>>* items, std::vector<Out>& out, Function convert) {
  if (items == nullptr) return;
  out.reserve(items->size());
  for (const Table* item : *items) out.push_back(convert(*item));
}

void ReadStructure(const fb::AGraph& in, Copier& copy, AGraph& out) {
  ReadAll(in.storeys(), out.storeys, [&](const fb::Storey& s) { return Storey{copy.Str(s.guid()), copy.Str(s.name()), s.elevation_m(), s.height_m()}; });
  ReadAll(in.walls(), out.walls, [&](const fb::Wall& w) {
    return Wall{copy.Str(w.guid()), copy.Str(w.name()),    copy.Str(w.type()), StoreyId(w.storey()), Vec(w.axis_start()), Vec(w.axis_end()),
                w.thickness_m(), w.z_min_m(), w.z_max_m(), w.external()};
  });
  ReadAll(in.surfaces(), out.surfaces, [](const fb::Surface& s) {
    Surface surface{WallId(s.wall()), StoreyId(s.storey()), RoomId(s.room()), Vec(s.normal()), s.d_m(),
                    Vec(s.start()),   Vec(s.end()),         s.z_min_m(),      s.z_max_m(),     std::nullopt};
    if (const fb::Arc* a = s.arc()) surface.arc = Arc{Vec(a->center()), a->radius_m(), a->start_rad(), a->sweep_rad()};
    return surface;
  });
  ReadAll(in.rooms(), out.rooms, [&](const fb::Room& r) {
    Room room;
    room.guid = copy.Str(r.guid());
    room.name = copy.Str(r.name());
    room.storey = StoreyId(r.storey());
    room.polygon = copy.ToRing(r.polygon());
    ReadAll(r.holes(), room.holes, [&](const fb::Ring& ring) { return copy.ToRing(&ring); });
    room.area_m2 = r.area_m2();
    room.center = Vec(r.center());
    room.yaw_rad = r.yaw_rad();
    room.floor_z_m = r.floor_z_m();
    room.ceiling_z_m = r.ceiling_z_m();
    copy.Numbers(r.surfaces(), room.surfaces);
    return room;
  });
}

void ReadOpenings(const fb::AGraph& in, Copier& copy, AGraph& out) {
  ReadAll(in.doorways(), out.doorways, [&](const fb::Doorway& d) {
    return Doorway{copy.Str(d.guid()),     copy.Str(d.name()),    StoreyId(d.storey()), WallId(d.wall()), RoomId(d.room_a()), RoomId(d.room_b()),
                   Vec(d.position()), d.yaw_rad(), d.width_m(),          d.height_m(),     d.has_leaf()};
  });
  ReadAll(in.windows(), out.windows, [&](const fb::Window& w) {
    return Window{copy.Str(w.guid()), copy.Str(w.name()), StoreyId(w.storey()), WallId(w.wall()), Vec(w.position()), w.yaw_rad(), w.width_m(),
                  w.height_m()};
  });
  ReadAll(in.columns(), out.columns, [&](const fb::Column& c) {
    return Column{copy.Str(c.guid()), copy.Str(c.name()), StoreyId(c.storey()), copy.ToRing(c.outline()), c.z_min_m(), c.z_max_m()};
  });
  ReadAll(in.open_boundaries(), out.open_boundaries, [](const fb::OpenBoundary& b) {
    return OpenBoundary{StoreyId(b.storey()), RoomId(b.room_a()), RoomId(b.room_b()), Vec(b.start()), Vec(b.end())};
  });
}

void ReadRest(const fb::AGraph& in, Copier& copy, AGraph& out) {
  ReadAll(in.factors(), out.factors, [&](const fb::Factor& f) {
    Factor factor;
    factor.kind = static_cast<FactorKind>(f.kind());
    copy.Numbers(f.variables(), factor.variables);
    return factor;
  });
  ReadAll(in.elements(), out.elements, [&](const fb::Element& e) {
    return Element{copy.Str(e.guid()),
                   copy.Str(e.name()),
                   copy.Str(e.type()),
                   static_cast<ElementKind>(e.kind()),
                   static_cast<Material>(e.material()),
                   StoreyId(e.storey()),
                   WallId(e.wall()),
                   DoorwayId(e.doorway())};
  });
  if (const fb::Mesh* mesh = in.mesh()) {
    if (mesh->vertices() != nullptr) {
      out.mesh.vertices.reserve(mesh->vertices()->size());
      for (const fb::Vec3f* v : *mesh->vertices()) out.mesh.vertices.emplace_back(v->x(), v->y(), v->z());
    }
    if (mesh->triangles() != nullptr) {
      out.mesh.triangles.reserve(mesh->triangles()->size());
      for (const fb::Triangle* t : *mesh->triangles()) out.mesh.triangles.push_back({t->a(), t->b(), t->c(), t->element()});
    }
  }
  ReadAll(in.aliases(), out.aliases, [&](const fb::Alias& a) {
    Alias alias{a.yaw_rad(), Vec(a.translation()), a.overlap_ratio(), StoreyId(a.from_storey()), StoreyId(a.to_storey()), {}, {},
                a.tolerance_m(), a.section_length_m(), a.closed(), {}};
    copy.Numbers(a.rooms(), alias.rooms);
    copy.Numbers(a.twins(), alias.twins);
    copy.Numbers(a.differences(), alias.differences);
    return alias;
  });
  ReadAll(in.look_alikes(), out.look_alikes, [&](const fb::LookAlikes& l) {
    LookAlikes alike;
    copy.Numbers(l.rooms(), alike.rooms);
    return alike;
  });
  ReadAll(in.diagnostics(), out.diagnostics, [&](const fb::DiagnosticCount& d) {
    return DiagnosticCount{copy.Str(d.code()), static_cast<Severity>(d.severity()), d.count()};
  });
  ReadAll(in.options(), out.options, [&](const fb::Option& o) { return Option{copy.Str(o.name()), copy.Str(o.value())}; });
}

// Checks what the verifier cannot know: that ids point somewhere and numbers are numbers. Collects the first fault.
class Checker {
 public:
  explicit Checker(const AGraph& graph) : graph_(graph) {}

  std::string Run() {
    Finite("origin", 0, graph_.origin);
    for (size_t i = 0; i < graph_.storeys.size(); ++i) Finite("storey", i, graph_.storeys[i].elevation_m, graph_.storeys[i].height_m);
    CheckWallsAndSurfaces();
    CheckRooms();
    CheckOpenings();
    CheckMesh();
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
  void CheckMesh() {
    for (size_t i = 0; i < graph_.elements.size(); ++i) {
      const Element& e = graph_.elements[i];
      if (e.kind > ElementKind::kGround || e.material > Material::kGlass) Fault("element", i, "its kind or material is unknown");
      Reference("element", i, e.storey, graph_.storeys.size(), true);
      Reference("element", i, e.wall, graph_.walls.size(), true);
      Reference("element", i, e.doorway, graph_.doorways.size(), true);
    }
    for (size_t i = 0; i < graph_.mesh.vertices.size(); ++i) Finite("mesh vertex", i, graph_.mesh.vertices[i]);
    const size_t vertices = graph_.mesh.vertices.size();
    for (size_t i = 0; i < graph_.mesh.triangles.size(); ++i) {
      const Triangle& t = graph_.mesh.triangles[i];
      if (t.a >= vertices || t.b >= vertices || t.c >= vertices || t.element >= graph_.elements.size()) {
        Fault("triangle", i, "refers to a vertex or element that is not there");
      }
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

Error Damaged(const char* how) { return {ErrorCode::kAGraphDamaged, std::string("the A-Graph is damaged: ") + how}; }

// Written since schema 1.1.
bool ChecksumHolds(const fb::AGraph& in, std::span<const uint8_t> bytes) {
  const uint8_t* field = flatbuffers::GetRoot<flatbuffers::Table>(bytes.data())->GetAddressOf(fb::AGraph::VT_CHECKSUM);
  if (field == nullptr) return in.schema_major() == 1 && in.schema_minor() == 0;
  const auto hole = static_cast<size_t>(field - bytes.data());
  return hole % sizeof(uint64_t) == 0 && ChecksumAround(bytes, hole) == in.checksum();
}

Expected<AGraph> Convert(const fb::AGraph& in, size_t file_bytes) {
  Copier copy(file_bytes);
  AGraph out;
  out.tool_version = copy.Str(in.tool_version());
  out.source_path = copy.Str(in.source_path());
  out.source_format = copy.Str(in.source_format());
  out.source_sha256 = copy.Str(in.source_sha256());
  out.origin = Vec(in.origin());
  if (const auto north = in.true_north_rad()) out.true_north_rad = *north;
  ReadStructure(in, copy, out);
  ReadOpenings(in, copy, out);
  ReadRest(in, copy, out);
  if (copy.exhausted()) return tl::unexpected<Error>(Damaged("its tables share so much that it unfolds to many times its size"));
  if (std::string fault = Checker(out).Run(); !fault.empty()) {
    return Fail(ErrorCode::kAGraphInconsistent, "the A-Graph contradicts itself: " + fault);
  }
  return out;
}

}  // namespace

Expected<AGraph> ReadAGraph(std::span<const uint8_t> bytes) {
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), fb::AGraphIdentifier())) {
    const bool is_step = std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).starts_with("ISO-10303-21");
    return Fail(ErrorCode::kNotAnAGraph, is_step ? "an IFC plan, not yet an A-Graph: `plumb compile` makes one of it"
                                                 : "not an A-Graph: the file identifier `PLAG` is missing");
  }
  // Limits bound the verifier's work; the table limit grows with the file since a table takes at least 8 bytes.
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), 64, static_cast<flatbuffers::uoffset_t>(bytes.size() / 8 + 1));
  if (!fb::VerifyAGraphBuffer(verifier)) return tl::unexpected<Error>(Damaged("an offset points outside the file"));
  const fb::AGraph& in = *fb::GetAGraph(bytes.data());
  if (in.schema_major() > kSchemaMajor) {
    return Fail(ErrorCode::kAGraphTooNew, fmt::format("the A-Graph has schema {}.{}; this version reads up to {}.x", in.schema_major(),
                                                      in.schema_minor(), kSchemaMajor));
  }
  if (!ChecksumHolds(in, bytes)) return tl::unexpected<Error>(Damaged("its checksum does not hold: bytes were changed since it was written"));
  if (in.schema_major() == 0) return tl::unexpected<Error>(Damaged("it has no schema version"));
  try {
    return Convert(in, bytes.size());
  } catch (const std::bad_alloc&) {
    return tl::unexpected<Error>(Damaged("it does not fit into the memory"));
  }
}

Expected<AGraph> ReadAGraphFile(const std::string& path) {
  Expected<std::vector<uint8_t>> bytes = ReadFileBytes(path);
  if (!bytes) return tl::unexpected<Error>(bytes.error());
  Expected<AGraph> graph = ReadAGraph(*bytes);
  if (!graph) return Fail(graph.error().code, "`" + path + "`: " + graph.error().message);
  return graph;
}

}  // namespace plumb
