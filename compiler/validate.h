// Can a robot localize in this, and if not, why: reports on plan files and A-Graph files.
#pragma once

#include <string>

#include "compiler/compile.h"
#include "compiler/diagnostics/report.h"

namespace plumb::compiler {

struct ValidateOptions {
  bool strict = false;  // warnings are findings, too
  CompileOptions compile;
};

// Reads the A-Graph at `path`, or compiles the plan, and writes nothing. Told apart by the identifier in the file; a damaged A-Graph may
// have lost it, so that the name's ending counts, too. Never throws. Outcome: kFine; kFindings (an error or, if strict, a warning; or no
// room without a twin); kBadInput (nothing that could be read or compiled); kInternal.
[[nodiscard]] Report ValidateFile(const std::string& path, const ValidateOptions& options = {});

// How a check of a plan, or what a compilation came to, is reported. A plan of which every room has a twin that looks alike compiles well,
// and yet no robot can localize in it: with `judge_places` that is a finding.
[[nodiscard]] Report ReportOf(const std::string& path, const CompileResult& result, bool strict = false, bool judge_places = false);

}  // namespace plumb::compiler
