// Where in an A-Graph file what stands, and which bytes its checksums cover. For reader and writer alone: includes the generated header.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "schema/agraph.h"
#include "schema/agraph_generated.h"
#include "schema/files.h"

namespace plumb {

// The mesh's items are the same bytes in memory and in a file.
static_assert(std::endian::native == std::endian::little, "the numbers in a file are little-endian");
static_assert(sizeof(Eigen::Vector3f) == sizeof(fb::Vec3f) && sizeof(Triangle) == sizeof(fb::Triangle));

inline constexpr size_t kNoField = ~size_t{0};

// Where the checksum stands in the file; kNoField if it has none.
[[nodiscard]] size_t ChecksumField(const fb::AGraph& graph, std::span<const uint8_t> file);

// The checksum of 1.x: of the file but for the 8 bytes at `field`, where it stands.
[[nodiscard]] uint64_t FileChecksum(std::span<const uint8_t> file, size_t field);
// That since 2.0: also without the mesh's vertices and triangles.
[[nodiscard]] uint64_t StructureChecksum(const fb::AGraph& graph, std::span<const uint8_t> file, size_t field);
[[nodiscard]] uint64_t MeshChecksum(std::span<const uint8_t> vertices, std::span<const uint8_t> triangles);

// The mesh's items, by what a file's offsets say before anything of it was checked; empty where they make no sense, and for files of 1.x,
// whose checksum covers the mesh.
struct MeshPlace {
  size_t vertices = 0, vertices_size = 0, triangles = 0, triangles_size = 0;  // bytes: from where, how many; within the file
};
// Reads a few bytes of it.
[[nodiscard]] MeshPlace FindMesh(const SparseFile& file);
// All of the file but the mesh's items. False: it cannot be read, or was cut short.
[[nodiscard]] bool ReadAllBut(const MeshPlace& mesh, SparseFile& file);

// Of all items of a vector; empty if there is none.
template <class Item>
std::span<const uint8_t> BytesOf(const flatbuffers::Vector<const Item*>* items) {
  if (items == nullptr) return {};
  return {items->Data(), size_t{items->size()} * sizeof(Item)};
}

}  // namespace plumb
