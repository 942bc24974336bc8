// The frontend of Gazebo worlds and models (SDF): boxes, cylinders, spheres, polylines, planes and meshes with their poses, and included
// models from the world's folder and the model path. What comes of it goes the way of meshes (mesh_plan.h), one object for each link.
#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

// None: no XML, nested beyond reason, or without any shape, and an error says so. Nothing is fetched from a network; no file is read
// above the world's folder and the folders of `options.model_path`.
[[nodiscard]] std::optional<PlanIr> ReadSdf(const Source& source, DiagnosticSink& diagnostics, const MeshOptions& options = {});

}  // namespace plumb::compiler
