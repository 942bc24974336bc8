// What runs in the child process: assimp, and the form in which its result comes back. Private to mesh_loader.cc.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontends/mesh/mesh_scene.h"
#include "schema/error.h"

namespace plumb::compiler {

// `hint`: the ending of the format's name for assimp ("obj"); `folder`: where buffers that a glTF names may lie. Loads assimp; throws
// whatever it does, and what it has read stays in memory: for a process that ends thereafter.
[[nodiscard]] Expected<std::vector<MeshObject>> ReadWithAssimp(std::string_view bytes, const std::string& hint, const std::string& folder,
                                                               size_t max_triangles);

[[nodiscard]] std::string EncodeObjects(const std::vector<MeshObject>& objects);
// Trusts nothing: counts, indices and numbers are checked. Errors: kFileUnreadable.
[[nodiscard]] Expected<std::vector<MeshObject>> DecodeObjects(std::string_view bytes);

}  // namespace plumb::compiler
