#include "schema/agraph_reader.h"

#include <flatbuffers/flatbuffers.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <new>
#include <string_view>
#include <utility>

#include "schema/agraph_check.h"
#include "schema/agraph_generated.h"
#include "schema/agraph_layout.h"
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

  void Leaves(const flatbuffers::Vector<flatbuffers::Offset<fb::DoorLeaf>>* leaves, std::vector<DoorLeaf>& out) {
    if (leaves == nullptr || !Spend(size_t{leaves->size()} * sizeof(DoorLeaf))) return;
    out.reserve(leaves->size());
    for (const fb::DoorLeaf* l : *leaves) {
      out.push_back({static_cast<LeafOperation>(l->operation()), static_cast<Jamb>(l->jamb()), static_cast<DoorwaySide>(l->opens_to()),
                     l->width_m()});
    }
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
  ReadAll(in.storeys(), out.storeys, [&](const fb::Storey& s) {
    return Storey{copy.Str(s.guid()), copy.Str(s.name()), s.elevation_m(), s.height_m()};
  });
  ReadAll(in.walls(), out.walls, [&](const fb::Wall& w) {
    return Wall{copy.Str(w.guid()), copy.Str(w.name()), copy.Str(w.type()), StoreyId(w.storey()), Vec(w.axis_start()),
                Vec(w.axis_end()),  w.thickness_m(),    w.z_min_m(),        w.z_max_m(),          w.external()};
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
    Doorway doorway{copy.Str(d.guid()), copy.Str(d.name()), StoreyId(d.storey()), WallId(d.wall()), RoomId(d.room_a()), RoomId(d.room_b()),
                    Vec(d.position()),  d.yaw_rad(),        d.width_m(),          d.height_m(),     d.has_leaf(),       {}};
    copy.Leaves(d.leaves(), doorway.leaves);
    return doorway;
  });
  ReadAll(in.windows(), out.windows, [&](const fb::Window& w) {
    return Window{copy.Str(w.guid()), copy.Str(w.name()), StoreyId(w.storey()), WallId(w.wall()),
                  Vec(w.position()),  w.yaw_rad(),        w.width_m(),          w.height_m()};
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
  ReadAll(in.aliases(), out.aliases, [&](const fb::Alias& a) {
    Alias alias{a.yaw_rad(),
                Vec(a.translation()),
                a.overlap_ratio(),
                StoreyId(a.from_storey()),
                StoreyId(a.to_storey()),
                {},
                {},
                a.tolerance_m(),
                a.section_length_m(),
                a.closed(),
                {}};
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

Error Damaged(const char* how) { return {ErrorCode::kAGraphDamaged, std::string("the A-Graph is damaged: ") + how}; }
Error Contradiction(const std::string& fault) { return {ErrorCode::kAGraphInconsistent, "the A-Graph contradicts itself: " + fault}; }

// Written since schema 1.1; that of 1.x covers the mesh, too.
bool ChecksumHolds(const fb::AGraph& in, std::span<const uint8_t> bytes) {
  const size_t field = ChecksumField(in, bytes);
  if (field == kNoField) return in.schema_major() == 1 && in.schema_minor() == 0;
  return in.checksum() == (in.schema_major() == 1 ? FileChecksum(bytes, field) : StructureChecksum(in, bytes, field));
}

Expected<AGraph> ConvertStructure(const fb::AGraph& in, size_t file_bytes) {
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
  if (std::string fault = FindFault(out); !fault.empty()) return tl::unexpected<Error>(Contradiction(fault));
  return out;
}

// Copies bytes of the file, which start `from` that place on; false: they are gone.
using CopyBytes = std::function<bool(std::span<uint8_t> out, size_t from)>;

template <class Item, class FileItem>
bool CopyItems(const flatbuffers::Vector<const FileItem*>* items, const uint8_t* file, const CopyBytes& copy, std::vector<Item>& out) {
  const std::span<const uint8_t> bytes = BytesOf(items);
  if (bytes.empty()) return true;
  out.resize(items->size());
  return copy({reinterpret_cast<uint8_t*>(out.data()), bytes.size()}, static_cast<size_t>(bytes.data() - file));
}

template <class Item>
std::span<const uint8_t> BytesIn(const std::vector<Item>& items) {
  return {reinterpret_cast<const uint8_t*>(items.data()), items.size() * sizeof(Item)};
}

// `file`: of which only the mesh's items need not be there.
Expected<Mesh> ReadMesh(const uint8_t* file, size_t elements, const CopyBytes& copy) {
  Mesh out;
  const fb::AGraph& in = *fb::GetAGraph(file);
  const fb::Mesh* mesh = in.mesh();
  if (mesh == nullptr) return out;
  if (!CopyItems(mesh->vertices(), file, copy, out.vertices) || !CopyItems(mesh->triangles(), file, copy, out.triangles))
    return tl::unexpected<Error>(Damaged("its triangles cannot be read, or it was cut short since it was opened"));
  if (in.schema_major() > 1 && MeshChecksum(BytesIn(out.vertices), BytesIn(out.triangles)) != mesh->checksum())
    return tl::unexpected<Error>(Damaged("the checksum of its triangles does not hold: bytes were changed since it was written"));
  if (std::string fault = FindMeshFault(out, elements); !fault.empty()) return tl::unexpected<Error>(Contradiction(fault));
  return out;
}

Expected<void> Verify(std::span<const uint8_t> bytes) {
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), fb::AGraphIdentifier())) {
    const bool is_step = std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).starts_with("ISO-10303-21");
    return Fail(ErrorCode::kNotAnAGraph,
                is_step ? "an IFC plan, not yet an A-Graph: `plumb compile` makes one of it"
                        : "not an A-Graph (the file identifier `PLAG` is missing); of a plan, `plumb compile` makes one");
  }
  // Limits bound the verifier's work; the table limit grows with the file since a table takes at least 8 bytes.
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), 64, static_cast<flatbuffers::uoffset_t>(bytes.size() / 8 + 1));
  if (!fb::VerifyAGraphBuffer(verifier)) return tl::unexpected<Error>(Damaged("an offset points outside the file"));
  const fb::AGraph& in = *fb::GetAGraph(bytes.data());
  if (in.schema_major() > kSchemaMajor) {
    return Fail(ErrorCode::kAGraphTooNew, fmt::format("the A-Graph has schema {}.{}; this version reads up to {}.x", in.schema_major(),
                                                      in.schema_minor(), kSchemaMajor));
  }
  if (!ChecksumHolds(in, bytes))
    return tl::unexpected<Error>(Damaged("its checksum does not hold: bytes were changed since it was written"));
  if (in.schema_major() == 0) return tl::unexpected<Error>(Damaged("it has no schema version"));
  return {};
}

// What `convert` gives, or that the memory does not suffice for it.
template <class Function>
auto Guarded(const Function& convert) -> decltype(convert()) {
  try {
    return convert();
  } catch (const std::bad_alloc&) {
    return tl::unexpected<Error>(Damaged("it does not fit into the memory"));
  }
}

Expected<AGraph> ReadGraphWithoutMesh(std::span<const uint8_t> bytes) {
  if (Expected<void> verified = Verify(bytes); !verified) return tl::unexpected<Error>(verified.error());
  return Guarded([&] { return ConvertStructure(*fb::GetAGraph(bytes.data()), bytes.size()); });
}

// `file`: of bytes that Verify has passed.
Expected<AGraph> WithMesh(const uint8_t* file, AGraph graph, const CopyBytes& copy) {
  Expected<Mesh> mesh = Guarded([&] { return ReadMesh(file, graph.elements.size(), copy); });
  if (!mesh) return tl::unexpected<Error>(mesh.error());
  graph.mesh = std::move(*mesh);
  return graph;
}

tl::unexpected<Error> About(const std::string& path, const Error& error) { return Fail(error.code, "`" + path + "`: " + error.message); }

}  // namespace

Expected<AGraph> ReadAGraph(std::span<const uint8_t> bytes) {
  Expected<AGraph> graph = ReadGraphWithoutMesh(bytes);
  if (!graph) return graph;
  return WithMesh(bytes.data(), std::move(*graph), [&](std::span<uint8_t> out, size_t from) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), out.size(), out.begin());
    return true;
  });
}

Expected<AGraph> ReadAGraphFile(const std::string& path) {
  Expected<AGraphFile> file = AGraphFile::Open(path);
  if (!file) return tl::unexpected<Error>(file.error());
  return std::move(*file).Load();
}

Expected<AGraphFile> AGraphFile::Open(const std::string& path) {
  Expected<SparseFile> file = SparseFile::Open(path);
  if (!file) return tl::unexpected<Error>(file.error());
  if (!ReadAllBut(FindMesh(*file), *file)) return Fail(ErrorCode::kFileUnreadable, "cannot read all of `" + path + "`");
  Expected<AGraph> graph = ReadGraphWithoutMesh(file->bytes());
  if (!graph) return About(path, graph.error());
  AGraphFile out;
  out.path_ = path;
  out.graph_ = std::move(*graph);
  const fb::Mesh* mesh = fb::GetAGraph(file->bytes().data())->mesh();
  if (mesh != nullptr && mesh->triangles() != nullptr) out.triangle_count_ = mesh->triangles()->size();
  out.file_ = std::move(*file);
  return out;
}

Expected<AGraph> AGraphFile::Load() && {
  Expected<AGraph> graph =
      WithMesh(file_.bytes().data(), std::move(graph_), [&](std::span<uint8_t> out, size_t from) { return file_.ReadTo(out, from); });
  if (!graph) return About(path_, graph.error());
  return graph;
}

}  // namespace plumb
