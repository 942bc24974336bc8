#include "schema/agraph_layout.h"

#include <algorithm>
#include <array>
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

}  // namespace

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
  const Bytes vertices = mesh == nullptr ? Bytes() : BytesOf(mesh->vertices()), triangles = mesh == nullptr ? Bytes() : BytesOf(mesh->triangles());
  return Checksum(Around(file, {file.subspan(field, sizeof(uint64_t)), vertices, triangles}), file.size());
}

uint64_t MeshChecksum(Bytes vertices, Bytes triangles) {
  const std::array<Bytes, 2> pieces = {vertices, triangles};
  return Checksum(pieces, 0);
}

}  // namespace plumb
