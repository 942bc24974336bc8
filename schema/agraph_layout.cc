#include "schema/agraph_layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "schema/checksum.h"

namespace plumb {
namespace {

using Bytes = std::span<const uint8_t>;

// What of the file lies outside the holes. These lie within it, but may overlap where the file was forged.
std::vector<Bytes> Around(Bytes file, std::array<Bytes, 3> holes) {
  std::sort(holes.begin(), holes.end(), [](Bytes a, Bytes b) { return a.data() < b.data(); });
  std::vector<Bytes> out;
  const uint8_t* from = file.data();
  for (const Bytes hole : holes) {
    if (hole.empty()) continue;
    if (hole.data() > from) out.emplace_back(from, hole.data());
    from = std::max(from, hole.data() + hole.size());
  }
  out.emplace_back(from, file.data() + file.size());
  return out;
}

// Follows the offsets of a FlatBuffer that is not in memory. Whatever lies outside the file is nothing.
class Offsets {
 public:
  explicit Offsets(const SparseFile& file) : file_(file) {}

  template <class Number>
  [[nodiscard]] std::optional<Number> Get(std::optional<size_t> at) const {
    Number number{};
    std::array<uint8_t, sizeof(Number)> bytes;
    if (!at || *at > file_.bytes().size() || !file_.ReadTo(bytes, *at)) return std::nullopt;
    std::memcpy(&number, bytes.data(), sizeof number);
    return number;
  }

  // What the offset `at` leads to.
  [[nodiscard]] std::optional<size_t> Target(std::optional<size_t> at) const {
    const auto offset = Get<uint32_t>(at);
    return offset ? std::optional(*at + *offset) : std::nullopt;
  }

  // A table's field by its place in the vtable; none if it is left out.
  [[nodiscard]] std::optional<size_t> Field(std::optional<size_t> table, size_t place) const {
    const auto back = Get<int32_t>(table);
    if (!back) return std::nullopt;
    const size_t vtable = *table - static_cast<size_t>(int64_t{*back});
    const auto size = Get<uint16_t>(vtable), offset = Get<uint16_t>(vtable + place);
    if (!size || place + 2 > *size || !offset || *offset == 0) return std::nullopt;
    return *table + *offset;
  }

  // The items of the vector that a table's field leads to: from where, and how many bytes.
  void Items(std::optional<size_t> table, size_t place, size_t item_size, size_t& from, size_t& size) const {
    const auto vector = Target(Field(table, place));
    const auto count = Get<uint32_t>(vector);
    if (!count || *count * item_size > file_.bytes().size() - std::min(file_.bytes().size(), *vector + 4)) return;
    from = *vector + 4;
    size = *count * item_size;
  }

 private:
  const SparseFile& file_;
};

}  // namespace

MeshPlace FindMesh(const SparseFile& file) {
  MeshPlace out;
  const Offsets offsets(file);
  const auto graph = offsets.Target(0);
  if (offsets.Get<uint32_t>(offsets.Field(graph, fb::AGraph::VT_SCHEMA_MAJOR)).value_or(1) < 2) return out;
  const auto mesh = offsets.Target(offsets.Field(graph, fb::AGraph::VT_MESH));
  offsets.Items(mesh, fb::Mesh::VT_VERTICES, sizeof(fb::Vec3f), out.vertices, out.vertices_size);
  offsets.Items(mesh, fb::Mesh::VT_TRIANGLES, sizeof(fb::Triangle), out.triangles, out.triangles_size);
  return out;
}

bool ReadAllBut(const MeshPlace& mesh, SparseFile& file) {
  const Bytes whole = file.bytes();
  const auto read = [&](Bytes piece) { return file.Read(static_cast<size_t>(piece.data() - whole.data()), piece.size()); };
  const auto around =
      Around(whole, {whole.subspan(mesh.vertices, mesh.vertices_size), whole.subspan(mesh.triangles, mesh.triangles_size), Bytes()});
  return std::all_of(around.begin(), around.end(), read);
}

size_t ChecksumField(const fb::AGraph& graph, Bytes file) {
  const uint8_t* field = reinterpret_cast<const flatbuffers::Table*>(&graph)->GetAddressOf(fb::AGraph::VT_CHECKSUM);
  return field == nullptr ? kNoField : static_cast<size_t>(field - file.data());
}

uint64_t FileChecksum(Bytes file, size_t field) {
  const std::array<Bytes, 2> pieces = {file.first(field), file.subspan(field + sizeof(uint64_t))};
  return Checksum(pieces, file.size());
}

uint64_t StructureChecksum(const fb::AGraph& graph, Bytes file, size_t field) {
  const fb::Mesh* mesh = graph.mesh();
  const Bytes vertices = mesh == nullptr ? Bytes() : BytesOf(mesh->vertices()),
              triangles = mesh == nullptr ? Bytes() : BytesOf(mesh->triangles());
  return Checksum(Around(file, {file.subspan(field, sizeof(uint64_t)), vertices, triangles}), file.size());
}

uint64_t MeshChecksum(Bytes vertices, Bytes triangles) {
  const std::array<Bytes, 2> pieces = {vertices, triangles};
  return Checksum(pieces, 0);
}

}  // namespace plumb
