#include "compiler/diagnostics/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace plumb::compiler {
namespace {

struct Entry {
  DiagnosticKind kind;
  Explanation explanation;
};

constexpr Entry kEntries[] = {
#define PLUMB_EXPLANATION(name, fact, why, example, mend) {DiagnosticKind::k##name, {fact, why, example, mend}},
#include "compiler/diagnostics/explanations.def"
#undef PLUMB_EXPLANATION
};

constexpr DiagnosticKind kKinds[] = {
#define PLUMB_DIAGNOSTIC(code, name, severity, rule) DiagnosticKind::k##name,
#include "compiler/diagnostics/diagnostic_kinds.def"
#undef PLUMB_DIAGNOSTIC
};

constexpr bool IsComplete() {
  if (std::size(kEntries) != std::size(kKinds)) return false;
  for (size_t i = 0; i < std::size(kKinds); ++i) {
    if (kEntries[i].kind != kKinds[i]) return false;
  }
  return true;
}
static_assert(IsComplete(), "explanations.def has the kinds of diagnostic_kinds.def, in the same order");

constexpr size_t kColumns = 100;
constexpr std::string_view kIndent = "           ";

// "why        It hides ..." with the further lines indented. Line ends in `text` are kept.
std::string Paragraph(std::string_view title, std::string_view text) {
  std::string out = fmt::format("{:<{}}", title, kIndent.size());
  size_t column = out.size();
  bool first = true;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!first && column + 1 + word.size() > kColumns) {
      out += fmt::format("\n{}", kIndent);
      column = kIndent.size();
      first = true;
    }
    if (!first) out += ' ';
    out += word;
    column += word.size() + (first ? 0 : 1);
    first = false;
    if (end < text.size() && text[end] == '\n') {
      out += fmt::format("\n{}", kIndent);
      column = kIndent.size();
      first = true;
    }
    at = end + 1;
  }
  return out + "\n";
}

}  // namespace

const Explanation& ExplanationOf(DiagnosticKind kind) {
  const auto* it =
      std::lower_bound(std::begin(kEntries), std::end(kEntries), kind, [](const Entry& e, DiagnosticKind k) { return e.kind < k; });
  return it->explanation;
}

std::string ExplanationText(DiagnosticKind kind) {
  const Explanation& e = ExplanationOf(kind);
  return fmt::format("{} {}, {} {}\n", CodeOf(kind), NameOf(kind), SeverityOf(kind) == Severity::kError ? "an" : "a",
                     SeverityName(SeverityOf(kind))) +
         Paragraph("fact", e.fact) +
         Paragraph("rule", fmt::format("{}{}.", static_cast<char>(RuleOf(kind)[0] >= 'a' ? RuleOf(kind)[0] - 'a' + 'A' : RuleOf(kind)[0]),
                                       RuleOf(kind).substr(1))) +
         Paragraph("why", e.why) + Paragraph("example", e.example) + Paragraph("mend", e.mend);
}

}  // namespace plumb::compiler
