// What a diagnostic means, at length: what `plumb explain` prints.
#pragma once

#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.h"

namespace plumb::compiler {

// Whole sentences, except for the example.
struct Explanation {
  std::string_view fact;     // what was found, and what the compiler does about it
  std::string_view why;      // what it means to a robot
  std::string_view example;  // a smallest case
  std::string_view mend;     // what to change in the plan, or how to go on
};

[[nodiscard]] const Explanation& ExplanationOf(DiagnosticKind kind);

// "PL2301 WallWithoutBody, a warning", then fact, rule, why, example and mend, a paragraph each, wrapped at 100 columns.
[[nodiscard]] std::string ExplanationText(DiagnosticKind kind);

}  // namespace plumb::compiler
