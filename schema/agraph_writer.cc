#include "schema/agraph_writer.h"

#include <flatbuffers/flatbuffers.h>

#include <array>
#include <span>

#include "schema/agraph_generated.h"
#include "schema/agraph_layout.h"
#include "schema/files.h"

namespace plumb {
namespace {

using Builder = flatbuffers::FlatBufferBuilder;

fb::Vec2 Pack(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }
fb::Vec3 Pack(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

flatbuffers::Offset<fb::Ring> Pack(Builder& b, const Ring& ring) {
  std::vector<fb::Vec2> points;
  points.reserve(ring.size());
  for (const auto& p : ring) points.push_back(Pack(p));
  return fb::CreateRing(b, b.CreateVectorOfStructs(points));
}

flatbuffers::Offset<fb::DoorLeaf> Pack(Builder& b, const DoorLeaf& l) {
  return fb::CreateDoorLeaf(b, static_cast<fb::LeafOperation>(l.operation), static_cast<fb::Jamb>(l.jamb),
                            static_cast<fb::DoorwaySide>(l.opens_to), l.width_m);
}

// Packs each item with `pack` into a vector of tables.
template <class Items, class Function>
auto PackAll(Builder& b, const Items& items, Function pack) {
  std::vector<decltype(pack(items.front()))> offsets;
  offsets.reserve(items.size());
  for (const auto& item : items) offsets.push_back(pack(item));
  return b.CreateVector(offsets);
}

template <class Tag>
auto PackIds(Builder& b, const std::vector<Id<Tag>>& ids) {
  std::vector<uint32_t> values;
  values.reserve(ids.size());
  for (Id<Tag> id : ids) values.push_back(id.value);
  return b.CreateVector(values);
}

auto Str(Builder& b, const std::string& s) { return b.CreateSharedString(s); }

auto PackStoreys(Builder& b, const AGraph& g) {
  return PackAll(b, g.storeys, [&](const Storey& s) {
    const auto guid = Str(b, s.guid);
    const auto name = Str(b, s.name);
    return fb::CreateStorey(b, guid, name, s.elevation_m, s.height_m);
  });
}

auto PackWalls(Builder& b, const AGraph& g) {
  return PackAll(b, g.walls, [&](const Wall& w) {
    const fb::Vec2 start = Pack(w.axis_start), end = Pack(w.axis_end);
    const auto guid = Str(b, w.guid);
    const auto name = Str(b, w.name);
    const auto type = Str(b, w.type);
    return fb::CreateWall(b, guid, name, type, w.storey.value, &start, &end, w.thickness_m, w.z_min_m, w.z_max_m, w.external);
  });
}

auto PackSurfaces(Builder& b, const AGraph& g) {
  return PackAll(b, g.surfaces, [&](const Surface& s) {
    flatbuffers::Offset<fb::Arc> arc;
    if (s.arc) {
      const fb::Vec2 center = Pack(s.arc->center);
      arc = fb::CreateArc(b, &center, s.arc->radius_m, s.arc->start_rad, s.arc->sweep_rad);
    }
    const fb::Vec3 normal = Pack(s.normal);
    const fb::Vec2 start = Pack(s.start), end = Pack(s.end);
    return fb::CreateSurface(b, s.wall.value, s.storey.value, s.room.value, &normal, s.d_m, &start, &end, s.z_min_m, s.z_max_m, arc);
  });
}

auto PackRooms(Builder& b, const AGraph& g) {
  return PackAll(b, g.rooms, [&](const Room& r) {
    const auto guid = Str(b, r.guid), name = Str(b, r.name);
    const auto polygon = Pack(b, r.polygon);
    const auto holes = PackAll(b, r.holes, [&](const Ring& ring) { return Pack(b, ring); });
    const auto surfaces = PackIds(b, r.surfaces);
    const fb::Vec3 center = Pack(r.center);
    return fb::CreateRoom(b, guid, name, r.storey.value, polygon, holes, r.area_m2, &center, r.yaw_rad, r.floor_z_m, r.ceiling_z_m,
                          surfaces);
  });
}

auto PackDoorways(Builder& b, const AGraph& g) {
  return PackAll(b, g.doorways, [&](const Doorway& d) {
    const fb::Vec3 position = Pack(d.position);
    const auto guid = Str(b, d.guid);
    const auto name = Str(b, d.name);
    flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fb::DoorLeaf>>> leaves;
    if (!d.leaves.empty()) leaves = PackAll(b, d.leaves, [&](const DoorLeaf& l) { return Pack(b, l); });
    return fb::CreateDoorway(b, guid, name, d.storey.value, d.wall.value, d.room_a.value, d.room_b.value, &position, d.yaw_rad, d.width_m,
                             d.height_m, d.has_leaf, leaves);
  });
}

auto PackWindows(Builder& b, const AGraph& g) {
  return PackAll(b, g.windows, [&](const Window& w) {
    const fb::Vec3 position = Pack(w.position);
    const auto guid = Str(b, w.guid);
    const auto name = Str(b, w.name);
    return fb::CreateWindow(b, guid, name, w.storey.value, w.wall.value, &position, w.yaw_rad, w.width_m, w.height_m);
  });
}

auto PackColumns(Builder& b, const AGraph& g) {
  return PackAll(b, g.columns, [&](const Column& c) {
    const auto outline = Pack(b, c.outline);
    const auto guid = Str(b, c.guid);
    const auto name = Str(b, c.name);
    return fb::CreateColumn(b, guid, name, c.storey.value, outline, c.z_min_m, c.z_max_m);
  });
}

auto PackOpenBoundaries(Builder& b, const AGraph& g) {
  return PackAll(b, g.open_boundaries, [&](const OpenBoundary& o) {
    const fb::Vec2 start = Pack(o.start), end = Pack(o.end);
    return fb::CreateOpenBoundary(b, o.storey.value, o.room_a.value, o.room_b.value, &start, &end);
  });
}

auto PackFactors(Builder& b, const AGraph& g) {
  return PackAll(b, g.factors, [&](const Factor& f) {
    const auto variables = b.CreateVector(f.variables);
    return fb::CreateFactor(b, static_cast<fb::FactorKind>(f.kind), variables);
  });
}

auto PackElements(Builder& b, const AGraph& g) {
  return PackAll(b, g.elements, [&](const Element& e) {
    const auto guid = Str(b, e.guid);
    const auto name = Str(b, e.name);
    const auto type = Str(b, e.type);
    return fb::CreateElement(b, guid, name, type, static_cast<fb::ElementKind>(e.kind), static_cast<fb::Material>(e.material),
                             e.storey.value, e.wall.value, e.doorway.value);
  });
}

constexpr uint64_t kNotYet = 1;  // a checksum's place; 0 would be left out

// Only room for it: Pieces puts the graph's own mesh there.
auto PackMesh(Builder& b, const Mesh& mesh) {
  fb::Vec3f* vertices_room = nullptr;
  fb::Triangle* triangles_room = nullptr;
  const auto vertices = b.CreateUninitializedVectorOfStructs(mesh.vertices.size(), &vertices_room);
  const auto triangles = b.CreateUninitializedVectorOfStructs(mesh.triangles.size(), &triangles_room);
  return fb::CreateMesh(b, vertices, triangles, kNotYet);
}

auto PackAliases(Builder& b, const AGraph& g) {
  return PackAll(b, g.aliases, [&](const Alias& a) {
    const fb::Vec3 translation = Pack(a.translation);
    const auto rooms = PackIds(b, a.rooms);
    const auto twins = PackIds(b, a.twins);
    const auto differences = PackIds(b, a.differences);
    return fb::CreateAlias(b, a.yaw_rad, &translation, a.overlap_ratio, a.from_storey.value, a.to_storey.value, rooms, twins, a.tolerance_m,
                           a.section_length_m, a.closed, differences);
  });
}

auto PackLookAlikes(Builder& b, const AGraph& g) {
  return PackAll(b, g.look_alikes, [&](const LookAlikes& l) { return fb::CreateLookAlikes(b, PackIds(b, l.rooms)); });
}

auto PackDiagnostics(Builder& b, const AGraph& g) {
  return PackAll(b, g.diagnostics, [&](const DiagnosticCount& d) {
    const auto code = Str(b, d.code);
    return fb::CreateDiagnosticCount(b, code, static_cast<fb::Severity>(d.severity), d.count);
  });
}

auto PackOptions(Builder& b, const AGraph& g) {
  return PackAll(b, g.options, [&](const Option& o) {
    const auto name = Str(b, o.name);
    const auto value = Str(b, o.value);
    return fb::CreateOption(b, name, value);
  });
}

// Room for all: a builder that has to grow would touch the room for the mesh.
size_t ExpectedBytes(const AGraph& g) {
  return (1 << 20) + g.mesh.vertices.size() * sizeof(fb::Vec3f) + g.mesh.triangles.size() * sizeof(fb::Triangle);
}

using Bytes = std::span<const uint8_t>;

template <class Item>
Bytes AsInFile(const std::vector<Item>& items) {
  return {reinterpret_cast<const uint8_t*>(items.data()), items.size() * sizeof(Item)};
}

// The file as it is written, one piece after the other. The mesh, most of a large one, is not copied into the builder: its pages there are
// never touched, and so take no memory.
std::array<Bytes, 5> Pieces(const AGraph& g, Bytes packed) {
  const fb::Mesh& mesh = *fb::GetAGraph(packed.data())->mesh();
  const Bytes triangles = BytesOf(mesh.triangles()), vertices = BytesOf(mesh.vertices());  // later is further in front
  return {Bytes(packed.data(), triangles.data()), AsInFile(g.mesh.triangles), Bytes(triangles.data() + triangles.size(), vertices.data()),
          AsInFile(g.mesh.vertices), Bytes(vertices.data() + vertices.size(), packed.data() + packed.size())};
}

// The result is in the builder.
Bytes Pack(const AGraph& g, Builder& b) {
  // Sequenced statements: the order of evaluation of call arguments, and so the bytes, would differ between compilers.
  // The builder puts what comes first at the end: all but the mesh is one piece at the beginning of the file.
  const auto mesh = PackMesh(b, g.mesh);
  const auto tool_version = Str(b, g.tool_version);
  const auto source_path = Str(b, g.source_path);
  const auto source_format = Str(b, g.source_format);
  const auto source_sha256 = Str(b, g.source_sha256);
  const auto options = PackOptions(b, g);
  const auto storeys = PackStoreys(b, g);
  const auto walls = PackWalls(b, g);
  const auto surfaces = PackSurfaces(b, g);
  const auto rooms = PackRooms(b, g);
  const auto doorways = PackDoorways(b, g);
  const auto windows = PackWindows(b, g);
  const auto columns = PackColumns(b, g);
  const auto factors = PackFactors(b, g);
  const auto elements = PackElements(b, g);
  const auto aliases = PackAliases(b, g);
  const auto diagnostics = PackDiagnostics(b, g);
  const auto open_boundaries = PackOpenBoundaries(b, g);
  const auto look_alikes = PackLookAlikes(b, g);
  const fb::Vec3 origin = Pack(g.origin);
  const auto true_north = g.true_north_rad ? flatbuffers::Optional<double>(*g.true_north_rad) : flatbuffers::nullopt;
  b.Finish(fb::CreateAGraph(b, kSchemaMajor, kSchemaMinor, tool_version, source_path, source_format, source_sha256, options, &origin,
                            storeys, walls, surfaces, rooms, doorways, windows, columns, factors, elements, mesh, aliases, diagnostics,
                            open_boundaries, look_alikes, true_north, kNotYet),
           fb::AGraphIdentifier());
  fb::AGraph* graph = fb::GetMutableAGraph(b.GetBufferPointer());
  graph->mutable_mesh()->mutate_checksum(MeshChecksum(AsInFile(g.mesh.vertices), AsInFile(g.mesh.triangles)));
  const Bytes file(b.GetBufferPointer(), b.GetSize());
  graph->mutate_checksum(StructureChecksum(*graph, file, ChecksumField(*graph, file)));
  return file;
}

}  // namespace

std::vector<uint8_t> WriteAGraph(const AGraph& graph) {
  Builder b(ExpectedBytes(graph));
  const Bytes packed = Pack(graph, b);
  std::vector<uint8_t> out;
  out.reserve(packed.size());
  for (const Bytes piece : Pieces(graph, packed)) out.insert(out.end(), piece.begin(), piece.end());
  return out;
}

Expected<void> WriteAGraphFile(const AGraph& graph, const std::string& path) {
  Builder b(ExpectedBytes(graph));
  return WriteFileAtomically(path, Pieces(graph, Pack(graph, b)));
}

}  // namespace plumb
