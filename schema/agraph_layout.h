// Which bytes of an A-Graph file its checksums cover. For reader and writer alone: includes the generated header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "schema/agraph_generated.h"

namespace plumb {

inline constexpr size_t kNoField = ~size_t{0};

// Where the checksum stands in the file; kNoField if it has none.
[[nodiscard]] size_t ChecksumField(const fb::AGraph& graph, std::span<const uint8_t> file);

// The checksum of 1.x: of the file but for the 8 bytes at `field`, where it stands.
[[nodiscard]] uint64_t FileChecksum(std::span<const uint8_t> file, size_t field);
// That since 2.0: also without the mesh's vertices and triangles.
[[nodiscard]] uint64_t StructureChecksum(const fb::AGraph& graph, std::span<const uint8_t> file, size_t field);
[[nodiscard]] uint64_t MeshChecksum(std::span<const uint8_t> vertices, std::span<const uint8_t> triangles);

// Of all items of a vector; empty if there is none.
template <class Item>
std::span<const uint8_t> BytesOf(const flatbuffers::Vector<const Item*>* items) {
  if (items == nullptr) return {};
  return {items->Data(), size_t{items->size()} * sizeof(Item)};
}

}  // namespace plumb
