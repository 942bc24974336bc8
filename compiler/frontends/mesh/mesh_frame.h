// Unit and up axis of a mesh: as stated, or told from its walls.
#pragma once

#include <optional>
#include <string_view>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/frontends/mesh/mesh_scene.h"

namespace plumb::compiler {

[[nodiscard]] std::optional<double> UnitFromName(std::string_view name);  // "cm": 0.01

// Turns and scales the scene to metres, z up, and says what was assumed. y-up meshes are turned by +90 degrees about x.
void MoveToPlanFrame(const MeshOptions& options, MeshScene& scene, DiagnosticSink& sink);

}  // namespace plumb::compiler
