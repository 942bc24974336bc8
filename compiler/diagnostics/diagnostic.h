// Diagnostics: what the compiler has to say about its input. Every kind has a stable code, declared in diagnostic_kinds.def.
// How they are written down: report.h. What a kind means at length: explanation.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schema/agraph.h"

namespace plumb::compiler {

// Where in the source. Fields that a format does not have stay empty or 0.
struct SourceLocation {
  uint32_t line = 0;     // 1-based line in a text file
  uint64_t step_id = 0;  // 123 for #123 (STEP)
  std::string guid;      // IfcGloballyUniqueId, DXF handle, mesh object name
  std::string type;      // IfcWallStandardCase, LWPOLYLINE, ...
  uint32_t column = 0;   // 1-based byte in the line
  std::string file = {};  // of a plan in several files; else empty

  [[nodiscard]] std::string ToString() const;  // "#123 IfcDoor 2O2Fr$t4X7Zf8NOew3FLOH"
};

enum class DiagnosticKind : uint16_t {
#define PLUMB_DIAGNOSTIC(code, name, severity, rule) k##name = code,
#include "compiler/diagnostics/diagnostic_kinds.def"
#undef PLUMB_DIAGNOSTIC
};

struct Diagnostic {
  DiagnosticKind kind{};
  Severity severity = Severity::kWarning;
  SourceLocation location;
  std::string message;  // lower case, no full stop: the observed fact first, then the rule with its threshold and unit
  std::string hint;     // at most one; may be empty
};

// Collects diagnostics in the order of emission. Severity comes from the kind.
class DiagnosticSink {
 public:
  void Emit(DiagnosticKind kind, SourceLocation location, std::string message, std::string hint = {});

  [[nodiscard]] const std::vector<Diagnostic>& all() const { return diagnostics_; }
  [[nodiscard]] size_t Count(Severity severity) const;
  [[nodiscard]] bool has_errors() const { return Count(Severity::kError) > 0; }
  // Per code, sorted by code: what goes into the file.
  [[nodiscard]] std::vector<DiagnosticCount> Summary() const;

 private:
  std::vector<Diagnostic> diagnostics_;
};

[[nodiscard]] std::string CodeOf(DiagnosticKind kind);       // "PL2103"
[[nodiscard]] std::string_view NameOf(DiagnosticKind kind);  // "WallWithoutBody"
[[nodiscard]] std::string_view RuleOf(DiagnosticKind kind);  // the rule that is broken, one sentence
[[nodiscard]] Severity SeverityOf(DiagnosticKind kind);

[[nodiscard]] const char* SeverityName(Severity severity);  // "note", "remark", "warning", "error"

// For people: `plan.ifc:991:1: warning: no doorway leads into ... [PL7103]`, below it the place as the source names it, where the
// message does not, and the hint. By line,
// then code; at most `max_per_kind` of a kind, then "and 41 more"; at the end how many errors and warnings there are.
[[nodiscard]] std::string DiagnosticsToText(const std::vector<Diagnostic>& diagnostics, const std::string& source_path,
                                            size_t max_per_kind = 3);

// In the order in which they are written down: by place in the file, then by code; equal ones keep the order of emission.
[[nodiscard]] std::vector<const Diagnostic*> SortedDiagnostics(const std::vector<Diagnostic>& diagnostics);

// Every kind, sorted by code.
[[nodiscard]] std::span<const DiagnosticKind> AllDiagnosticKinds();
// "PL2103" or "WallWithoutBody", in any case; none: there is no such kind.
[[nodiscard]] std::optional<DiagnosticKind> FindDiagnosticKind(std::string_view code_or_name);

}  // namespace plumb::compiler
