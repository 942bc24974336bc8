#include "compiler/diagnostics/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "schema/counted.h"

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

constexpr DiagnosticKind kAllKinds[] = {
#define PLUMB_DIAGNOSTIC(code, name, severity, rule) DiagnosticKind::k##name,
#include "compiler/diagnostics/diagnostic_kinds.def"
#undef PLUMB_DIAGNOSTIC
};

bool EqualIgnoringCase(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
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
  return out;
}

std::string CodeOf(DiagnosticKind kind) { return fmt::format("PL{:04}", static_cast<unsigned>(kind)); }
std::string_view NameOf(DiagnosticKind kind) { return InfoOf(kind).name; }
std::string_view RuleOf(DiagnosticKind kind) { return InfoOf(kind).rule; }
Severity SeverityOf(DiagnosticKind kind) { return InfoOf(kind).severity; }

const char* SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kNote: return "note";
    case Severity::kRemark: return "remark";
    case Severity::kWarning: return "warning";
    case Severity::kError: return "error";
  }
  return "error";
}

std::span<const DiagnosticKind> AllDiagnosticKinds() { return kAllKinds; }

std::optional<DiagnosticKind> FindDiagnosticKind(std::string_view code_or_name) {
  for (const DiagnosticKind kind : kAllKinds) {
    if (EqualIgnoringCase(code_or_name, CodeOf(kind)) || EqualIgnoringCase(code_or_name, NameOf(kind))) return kind;
  }
  return std::nullopt;
}

void DiagnosticSink::Emit(DiagnosticKind kind, SourceLocation location, std::string message, std::string hint) {
  diagnostics_.push_back({kind, SeverityOf(kind), std::move(location), std::move(message), std::move(hint)});
}

size_t DiagnosticSink::Count(Severity severity) const {
  return static_cast<size_t>(
      std::count_if(diagnostics_.begin(), diagnostics_.end(), [&](const Diagnostic& d) { return d.severity == severity; }));
}

std::vector<DiagnosticCount> DiagnosticSink::Summary() const {
  std::map<DiagnosticKind, uint32_t> counts;
  for (const Diagnostic& d : diagnostics_) ++counts[d.kind];
  std::vector<DiagnosticCount> out;
  for (const auto& [kind, count] : counts) out.push_back({CodeOf(kind), SeverityOf(kind), count});
  return out;
}

std::vector<const Diagnostic*> SortedDiagnostics(const std::vector<Diagnostic>& diagnostics) {
  std::vector<const Diagnostic*> out;
  for (const Diagnostic& d : diagnostics) out.push_back(&d);
  std::stable_sort(out.begin(), out.end(), [](const Diagnostic* a, const Diagnostic* b) {
    return std::tie(a->location.file, a->location.line, a->location.column, a->kind) <
           std::tie(b->location.file, b->location.line, b->location.column, b->kind);
  });
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
  for (const Diagnostic* d : SortedDiagnostics(diagnostics)) {
    size_t& count = shown[d->kind];
    if (++count > max_per_kind) continue;
    const SourceLocation& at = d->location;
    fmt::format_to(write, "{}", at.file.empty() ? source_path : at.file);
    if (at.line != 0) fmt::format_to(write, ":{}", at.line);
    if (at.column != 0) fmt::format_to(write, ":{}", at.column);
    fmt::format_to(write, ": {}: {} [{}]\n", SeverityName(d->severity), d->message, CodeOf(d->kind));
    const bool is_named = (at.step_id == 0 && at.guid.empty()) || d->message.find(at.ToString()) != std::string::npos;
    if (!is_named) fmt::format_to(write, "    at: {}\n", at.ToString());
    if (!d->hint.empty()) fmt::format_to(write, "    hint: {}\n", d->hint);
    if (count == max_per_kind && total[d->kind] > max_per_kind) {
      fmt::format_to(write, "    and {} more of {} {}\n", total[d->kind] - max_per_kind, CodeOf(d->kind), NameOf(d->kind));
    }
  }
  if (errors + warnings > 0) fmt::format_to(write, "{}, {}\n", Counted(errors, "error"), Counted(warnings, "warning"));
  return out;
}

}  // namespace plumb::compiler
