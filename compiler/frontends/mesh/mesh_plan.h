// From a scene in metres, z up, to the plan: storeys, walls, openings and whatever else a LiDAR sees.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/frontends/mesh/mesh_scene.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

[[nodiscard]] PlanIr MakePlan(const MeshScene& scene, const MeshOptions& options, DiagnosticSink& sink);

}  // namespace plumb::compiler
