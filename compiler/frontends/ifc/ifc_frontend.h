// The IFC frontend: a STEP file of IFC2X to IFC4X3 in, the plan as drawn out.
//
// What becomes what: every product with a body but spaces, openings and annotations is a PlanElement; walls and curtain walls made of parts
// are one element with the whole's GlobalId; proxies that act as walls keep their kind but have an uncut body, as walls do; every
// IfcRelVoidsElement is a PlanOpening, and so is every door and window without one; panes of glass are elements of their own. Bodies have
// their openings cut, `uncut` has not. Whatever cannot be read is a diagnostic with its instance, never a crash, and the rest of the plan
// is still read.
#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

// None: the file is no IFC in STEP syntax of a known release, or it leaves no plan to trust (it is cut off, contains itself, holds numbers
// that are none, unfolds beyond the limits), and an error says so. Same bytes and options, same result.
[[nodiscard]] std::optional<PlanIr> ReadIfc(const Source& source, DiagnosticSink& diagnostics);
[[nodiscard]] std::optional<PlanIr> ReadIfc(const Source& source, DiagnosticSink& diagnostics, const IfcOptions& options);

}  // namespace plumb::compiler
