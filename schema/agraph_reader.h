// Reads .agraph files. Bytes are untrusted: the FlatBuffers verifier runs first, then every id, number and mesh index
// is checked, so that a value that comes back needs no further checks.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb {

// Errors: kNotAnAGraph (no file identifier), kAGraphDamaged (verifier, checksum), kAGraphTooNew (a higher major version),
// kAGraphInconsistent (an id out of range, a number that is not finite, a normal that is no unit vector).
// A newer minor version loads; what it adds is ignored. Linear in the size of the file.
[[nodiscard]] Expected<AGraph> ReadAGraph(std::span<const uint8_t> bytes);

// As above; also kFileNotFound, kFileUnreadable.
[[nodiscard]] Expected<AGraph> ReadAGraphFile(const std::string& path);

}  // namespace plumb
