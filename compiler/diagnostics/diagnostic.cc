#include "compiler/diagnostics/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace plumb::compiler {
namespace {

struct KindInfo {
  uint16_t code;
  std::string_view name;
  Severity severity;
  std::string_view rule;
};

constexpr KindInfo kKinds[] = {
#define PLUMB_DIAGNOSTIC(code, name, severity, rule) {code, #name, Severity::severity, rule},
#include "compiler/diagnostics/diagnostic_kinds.def"
#undef PLUMB_DIAGNOSTIC
};

constexpr bool Ascending() {
  for (size_t i = 1; i < std::size(kKinds); ++i) {
    if (kKinds[i - 1].code >= kKinds[i].code) return false;
  }
  return true;
}
static_assert(Ascending(), "diagnostic_kinds.def is sorted by code, each code once");

const KindInfo& InfoOf(DiagnosticKind kind) {
  const auto* it = std::lower_bound(std::begin(kKinds), std::end(kKinds), static_cast<uint16_t>(kind),
                                    [](const KindInfo& info, uint16_t code) { return info.code < code; });
  return *it;
}

const char* SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kNote: return "note";
    case Severity::kRemark: return "remark";
    case Severity::kWarning: return "warning";
    case Severity::kError: return "error";
  }
  return "error";
}

// By place in the file, then by code; equal ones keep the order of emission.
std::vector<const Diagnostic*> Sorted(const std::vector<Diagnostic>& diagnostics) {
  std::vector<const Diagnostic*> out;
  for (const Diagnostic& d : diagnostics) out.push_back(&d);
  std::stable_sort(out.begin(), out.end(), [](const Diagnostic* a, const Diagnostic* b) {
    return std::tie(a->location.line, a->kind) < std::tie(b->location.line, b->kind);
  });
  return out;
}

}  // namespace

std::string SourceLocation::ToString() const {
  std::string out;
  const auto add = [&out](const std::string& part) {
    if (part.empty()) return;
    if (!out.empty()) out += ' ';
    out += part;
  };
  if (step_id != 0) add(fmt::format("#{}", step_id));
  add(type);
  add(guid);
  if (line != 0) add(fmt::format("(line {})", line));
  return out;
}

std::string CodeOf(DiagnosticKind kind) { return fmt::format("PL{:04}", static_cast<unsigned>(kind)); }
std::string_view NameOf(DiagnosticKind kind) { return InfoOf(kind).name; }
std::string_view RuleOf(DiagnosticKind kind) { return InfoOf(kind).rule; }
Severity SeverityOf(DiagnosticKind kind) { return InfoOf(kind).severity; }

void DiagnosticSink::Emit(DiagnosticKind kind, SourceLocation location, std::string message, std::string hint) {
  diagnostics_.push_back({kind, SeverityOf(kind), std::move(location), std::move(message), std::move(hint)});
}

size_t DiagnosticSink::Count(Severity severity) const {
  return static_cast<size_t>(std::count_if(diagnostics_.begin(), diagnostics_.end(), [&](const Diagnostic& d) { return d.severity == severity; }));
}

std::vector<DiagnosticCount> DiagnosticSink::Summary() const {
  std::map<DiagnosticKind, uint32_t> counts;
  for (const Diagnostic& d : diagnostics_) ++counts[d.kind];
  std::vector<DiagnosticCount> out;
  for (const auto& [kind, count] : counts) out.push_back({CodeOf(kind), SeverityOf(kind), count});
  return out;
}

std::string DiagnosticsToText(const std::vector<Diagnostic>& diagnostics, const std::string& source_path, size_t max_per_kind) {
  std::map<DiagnosticKind, size_t> total, shown;
  size_t errors = 0, warnings = 0;
  for (const Diagnostic& d : diagnostics) {
    ++total[d.kind];
    errors += d.severity == Severity::kError;
    warnings += d.severity == Severity::kWarning;
  }
  std::string out;
  auto write = std::back_inserter(out);
  for (const Diagnostic* d : Sorted(diagnostics)) {
    size_t& count = shown[d->kind];
    if (++count > max_per_kind) continue;
    fmt::format_to(write, "{}", source_path);
    if (d->location.line != 0) fmt::format_to(write, ":{}", d->location.line);
    fmt::format_to(write, ": {}: {} [{}]\n", SeverityName(d->severity), d->message, CodeOf(d->kind));
    if (!d->hint.empty()) fmt::format_to(write, "    hint: {}\n", d->hint);
    if (count == max_per_kind && total[d->kind] > max_per_kind) {
      fmt::format_to(write, "    and {} more of {} {}\n", total[d->kind] - max_per_kind, CodeOf(d->kind), NameOf(d->kind));
    }
  }
  if (errors + warnings > 0) fmt::format_to(write, "{} error(s), {} warning(s)\n", errors, warnings);
  return out;
}

std::string DiagnosticsToJson(const std::vector<Diagnostic>& diagnostics, const std::string& source_path) {
  nlohmann::ordered_json out;
  out["source"] = source_path;
  out["diagnostics"] = nlohmann::ordered_json::array();
  for (const Diagnostic* d : Sorted(diagnostics)) {
    nlohmann::ordered_json entry;
    entry["code"] = CodeOf(d->kind);
    entry["name"] = NameOf(d->kind);
    entry["severity"] = SeverityName(d->severity);
    entry["message"] = d->message;
    if (!d->hint.empty()) entry["hint"] = d->hint;
    nlohmann::ordered_json location;
    if (d->location.line != 0) location["line"] = d->location.line;
    if (d->location.step_id != 0) location["step_id"] = d->location.step_id;
    if (!d->location.guid.empty()) location["guid"] = d->location.guid;
    if (!d->location.type.empty()) location["type"] = d->location.type;
    entry["location"] = location.is_null() ? nlohmann::ordered_json::object() : location;
    out["diagnostics"].push_back(std::move(entry));
  }
  return out.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::compiler
