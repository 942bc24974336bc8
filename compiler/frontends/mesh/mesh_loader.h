// Reads mesh files with assimp in a child process: what a damaged file makes of it, a crash, a hang, gigabytes, ends there.
#pragma once

#include <string>

#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/frontends/mesh/mesh_scene.h"
#include "compiler/source/source.h"
#include "schema/error.h"

namespace plumb::compiler {

// Nodes' transformations are applied; one object for each node with triangles. Errors: kFileUnreadable (the reader refused it, or crashed),
// kFileTooLarge (more time, memory or triangles than allowed).
[[nodiscard]] Expected<MeshScene> LoadMesh(const Source& source, const MeshOptions& options);

}  // namespace plumb::compiler
