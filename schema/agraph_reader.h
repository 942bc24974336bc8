// Reads .agraph files. Bytes are untrusted: the FlatBuffers verifier runs first, then every id, number and mesh index
// is checked, so that a value that comes back needs no further checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "schema/agraph.h"
#include "schema/error.h"
#include "schema/files.h"

namespace plumb {

// Errors: kNotAnAGraph (no file identifier), kAGraphDamaged (verifier, checksum), kAGraphTooNew (a higher major version),
// kAGraphInconsistent (an id out of range, a number that is not finite, a normal that is no unit vector).
// A newer minor version loads; what it adds is ignored. Linear in the size of the file.
[[nodiscard]] Expected<AGraph> ReadAGraph(std::span<const uint8_t> bytes);

// As above; also kFileNotFound, kFileUnreadable.
[[nodiscard]] Expected<AGraph> ReadAGraphFile(const std::string& path);

// An A-Graph whose triangles, most of a large file, are still in it. Putting another file in its place meanwhile, as WriteAGraphFile does,
// is no harm; writing to it is found when they are read.
class AGraphFile {
 public:
  // Errors as ReadAGraphFile, but those of the triangles. Linear in the size of the file without them; files of schema 1.x are read whole
  // for their checksum.
  [[nodiscard]] static Expected<AGraphFile> Open(const std::string& path);

  [[nodiscard]] const AGraph& graph() const { return graph_; }  // with an empty mesh
  [[nodiscard]] size_t triangle_count() const { return triangle_count_; }

  // The graph with its triangles. Errors: kAGraphDamaged, kAGraphInconsistent.
  [[nodiscard]] Expected<AGraph> Load() &&;

 private:
  AGraphFile() = default;

  std::string path_;
  SparseFile file_;
  AGraph graph_;
  size_t triangle_count_ = 0;
};

}  // namespace plumb
