// Last stage: what the A-Graph says beside its nodes (triangles, provenance, diagnostics), in the plan frame.
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

// Makes graph.mesh of the bodies of plan.elements, which it takes; triangle.element is the position there. Vertices of an element that fall
// on the same single-precision point are one, degenerate triangles go. Sets graph.origin: the plan's, moved to the middle of the triangles
// if those lie far from it.
void EmitMesh(PlanIr& plan, AGraph& graph);

// Adds the plan's origin to every pose, polygon and plane: from PlanIr's frame to the plan frame. graph.mesh stays.
void MoveToPlanFrame(const PlanIr& plan, AGraph& graph);

// Source, tool version, options and the counts of diagnostics.
void EmitProvenance(const PlanIr& plan, const std::vector<Option>& options, const DiagnosticSink& sink, AGraph& graph);

}  // namespace plumb::compiler
