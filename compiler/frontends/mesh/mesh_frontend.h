// The mesh frontend: OBJ, PLY, STL, glTF and COLLADA in, the plan as the sections of the mesh show it out.
//
// Upright faces are grouped to planes; two that face away from each other are a wall, one alone is a wall of stated thickness. Walls go on
// under lintels, over sills and across gaps between ends in one line; what is left open there is a doorway or, with a sill, a window. All
// triangles stay in the plan.
#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

// None: the mesh cannot be read within the limits, or has no triangles or coordinates that are no numbers, and an error says so. Same bytes
// and options, same result.
[[nodiscard]] std::optional<PlanIr> ReadMesh(const Source& source, DiagnosticSink& diagnostics, const MeshOptions& options = {});

}  // namespace plumb::compiler
