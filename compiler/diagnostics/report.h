// What a check of a file came to, in the forms that people and other programs read. All of them say the same.
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"

namespace plumb::compiler {

// The program's exit status.
enum class Outcome : int { kFine = 0, kFindings = 1, kBadInput = 2, kInternal = 3 };

struct Report {
  std::string source_path;  // as given by the caller
  std::vector<Diagnostic> diagnostics;
  Outcome outcome = Outcome::kInternal;
  std::string answer;  // one sentence: can a robot localize in this, and if not, why
};

enum class ReportFormat { kText, kJson, kSarif };

// Text: the diagnostics as DiagnosticsToText has them, then the answer.
// JSON: {source, answer, exit_status, errors, warnings, diagnostics: [{code, name, severity, message, hint?, location}]}.
// SARIF 2.1.0 (OASIS): one run, a rule for every code that occurs, one result for each diagnostic.
// Bytes that are no UTF-8 become U+FFFD. Same report, same text.
[[nodiscard]] std::string ReportToString(const Report& report, ReportFormat format);

}  // namespace plumb::compiler
