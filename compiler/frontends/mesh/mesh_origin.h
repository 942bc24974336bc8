// Meshes far from zero, as surveyors place them, moved near it: there a wall's plane is found to the millimetre whatever its direction.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/frontends/mesh/mesh_scene.h"

namespace plumb::compiler {

// The text of an OBJ file with its corners moved by minus the first one, rounded, if that lies so far from zero that single precision, in
// which meshes are read, would blur them; that offset in `origin`, in the file's own unit and axes. None: near enough.
[[nodiscard]] std::optional<std::string> ObjNearZero(std::string_view text, Eigen::Vector3d& origin);

// Moves the objects to their middle if that is far from zero for their size, and adds it to scene.origin.
void MoveSceneNearZero(MeshScene& scene);

// What single precision leaves uncertain of the farthest corner, in the scene's unit.
[[nodiscard]] double BlurOf(const MeshScene& scene);

}  // namespace plumb::compiler
