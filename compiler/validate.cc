#include "compiler/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "compiler/validate_graph.h"
#include "schema/agraph_reader.h"
#include "schema/counted.h"

namespace plumb::compiler {
namespace {

constexpr std::string_view kEnding = ".agraph";

bool IsAGraph(const std::string& path) {
  if (path.ends_with(kEnding)) return true;
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  return file.read(head, sizeof head) && std::string_view(head + 4, 4) == "PLAG";
}

DiagnosticKind KindOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kFileTooLarge: return DiagnosticKind::kFileTooLarge;
    case ErrorCode::kNotAnAGraph: return DiagnosticKind::kNotAnAGraph;
    case ErrorCode::kAGraphDamaged: return DiagnosticKind::kAGraphDamaged;
    case ErrorCode::kAGraphTooNew: return DiagnosticKind::kAGraphTooNew;
    case ErrorCode::kAGraphInconsistent: return DiagnosticKind::kAGraphInconsistent;
    default: return DiagnosticKind::kFileUnreadable;
  }
}

CompileResult ReadGraph(const std::string& path) {
  CompileResult out;
  Expected<AGraph> graph = ReadAGraphFile(path);
  if (!graph) {
    out.diagnostics.Emit(KindOf(graph.error().code), {}, graph.error().message);
    return out;
  }
  out.graph = std::move(*graph);
  for (const Diagnostic& d : ValidateGraph(*out.graph)) out.diagnostics.Emit(d.kind, d.location, d.message, d.hint);
  return out;
}

std::string Contents(const AGraph& graph) {
  return Counted(graph.rooms.size(), "room") + ", " + Counted(graph.surfaces.size(), "wall surface") + ", " +
         Counted(graph.storeys.size(), "storey");
}

// Rooms that have a twin which a robot in them cannot tell them from, wherever it can drive from there.
size_t CountRoomsWithTwins(const AGraph& graph) {
  std::vector<bool> has_twin(graph.rooms.size(), false);
  for (const Alias& alias : graph.aliases) {
    if (!alias.closed) continue;
    for (const std::vector<RoomId>* rooms : {&alias.rooms, &alias.twins}) {
      for (const RoomId room : *rooms) has_twin[room.index()] = true;
    }
  }
  return static_cast<size_t>(std::count(has_twin.begin(), has_twin.end(), true));
}

// Of a plan without errors.
void Judge(const AGraph& graph, bool judge_places, size_t doubts, Report& out) {
  const size_t alike = judge_places ? CountRoomsWithTwins(graph) : 0;
  if (alike > 0 && alike == graph.rooms.size()) {
    out.outcome = Outcome::kFindings;
    out.answer = fmt::format("no robot can tell where it is in this: each room has a twin that looks alike ({})", Contents(graph));
    return;
  }
  out.answer = fmt::format("a robot can localize in this{} ({})", graph.rooms.empty() ? " by its walls alone" : "", Contents(graph));
  if (alike > 0)
    out.answer += fmt::format(", but within {} the plan looks the same from another place", Counted(alike, "room"));
  else if (doubts > 0)
    out.answer += ", but see the warnings";
}

}  // namespace

Report ReportOf(const std::string& path, const CompileResult& result, bool strict, bool judge_places) {
  Report out{path, result.diagnostics.all(), Outcome::kFine, {}};
  const size_t errors = result.diagnostics.Count(Severity::kError), warnings = strict ? result.diagnostics.Count(Severity::kWarning) : 0;
  if (result.has_internal_error()) {
    out.outcome = Outcome::kInternal;
    out.answer = "the compiler failed; nothing can be said of the plan";
  } else if (!result.graph) {
    out.outcome = Outcome::kBadInput;
    out.answer = "no robot can localize in this: it cannot be read as a plan";
  } else if (errors + warnings > 0) {
    out.outcome = Outcome::kFindings;
    out.answer = fmt::format("no robot should localize in this before {} {} mended ({})", Counted(errors + warnings, "finding"),
                             errors + warnings == 1 ? "is" : "are", Contents(*result.graph));
  } else {
    Judge(*result.graph, judge_places, result.diagnostics.Count(Severity::kWarning), out);
  }
  return out;
}

Report ValidateFile(const std::string& path, const ValidateOptions& options) {
  return ReportOf(path, IsAGraph(path) ? ReadGraph(path) : Compile(path, options.compile), options.strict, true);
}

}  // namespace plumb::compiler
