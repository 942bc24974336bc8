#include "compiler/diagnostics/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/explanation.h"

namespace plumb::compiler {
namespace {

using Json = nlohmann::ordered_json;

std::string Dump(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

size_t CountOf(const Report& report, Severity severity) {
  return static_cast<size_t>(std::count_if(report.diagnostics.begin(), report.diagnostics.end(),
                                           [severity](const Diagnostic& d) { return d.severity == severity; }));
}

std::string ToText(const Report& report) {
  std::string out = DiagnosticsToText(report.diagnostics, report.source_path, std::numeric_limits<size_t>::max());
  return out + report.source_path + ": " + report.answer + "\n";
}

Json LocationJson(const SourceLocation& at) {
  Json out = Json::object();
  if (!at.file.empty()) out["file"] = at.file;
  if (at.line != 0) out["line"] = at.line;
  if (at.column != 0) out["column"] = at.column;
  if (at.step_id != 0) out["step_id"] = at.step_id;
  if (!at.guid.empty()) out["guid"] = at.guid;
  if (!at.type.empty()) out["type"] = at.type;
  return out;
}

std::string ToJson(const Report& report) {
  Json out;
  out["source"] = report.source_path;
  out["answer"] = report.answer;
  out["exit_status"] = static_cast<int>(report.outcome);
  out["errors"] = CountOf(report, Severity::kError);
  out["warnings"] = CountOf(report, Severity::kWarning);
  out["diagnostics"] = Json::array();
  for (const Diagnostic* d : SortedDiagnostics(report.diagnostics)) {
    Json entry;
    entry["code"] = CodeOf(d->kind);
    entry["name"] = NameOf(d->kind);
    entry["severity"] = SeverityName(d->severity);
    entry["message"] = d->message;
    if (!d->hint.empty()) entry["hint"] = d->hint;
    entry["location"] = LocationJson(d->location);
    out["diagnostics"].push_back(std::move(entry));
  }
  return Dump(out);
}

const char* SarifLevel(Severity severity) {
  if (severity == Severity::kError) return "error";
  return severity == Severity::kWarning ? "warning" : "note";
}

// A URI reference (RFC 3986) of a path.
std::string PathToUri(const std::string& path) {
  std::string out = path.starts_with("/") ? "file://" : "";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

Json SarifRule(DiagnosticKind kind) {
  const Explanation& explanation = ExplanationOf(kind);
  Json rule;
  rule["id"] = CodeOf(kind);
  rule["name"] = NameOf(kind);
  rule["shortDescription"]["text"] = RuleOf(kind);
  rule["fullDescription"]["text"] = fmt::format("{} {}", explanation.fact, explanation.why);
  rule["help"]["text"] = explanation.mend;
  rule["defaultConfiguration"]["level"] = SarifLevel(SeverityOf(kind));
  return rule;
}

Json SarifLocation(const Report& report, const SourceLocation& at) {
  Json out;
  Json& artifact = out["physicalLocation"]["artifactLocation"];
  artifact["uri"] = PathToUri(at.file.empty() ? report.source_path : at.file);
  if (at.file.empty() || at.file == report.source_path) artifact["index"] = 0;
  if (at.line != 0) out["physicalLocation"]["region"]["startLine"] = at.line;
  if (at.line != 0 && at.column != 0) out["physicalLocation"]["region"]["startColumn"] = at.column;
  if (at.step_id == 0 && at.guid.empty()) return out;
  Json logical;
  logical["name"] = at.guid.empty() ? fmt::format("#{}", at.step_id) : at.guid;
  logical["fullyQualifiedName"] = at.ToString();
  logical["kind"] = "object";
  out["logicalLocations"] = Json::array({std::move(logical)});
  return out;
}

std::string ToSarif(const Report& report) {
  std::map<DiagnosticKind, size_t> rule_index;
  for (const Diagnostic& d : report.diagnostics) rule_index[d.kind] = 0;
  Json rules = Json::array();
  for (auto& [kind, index] : rule_index) {
    index = rules.size();
    rules.push_back(SarifRule(kind));
  }
  Json results = Json::array();
  for (const Diagnostic* d : SortedDiagnostics(report.diagnostics)) {
    Json result;
    result["ruleId"] = CodeOf(d->kind);
    result["ruleIndex"] = rule_index.at(d->kind);
    result["level"] = SarifLevel(d->severity);
    result["message"]["text"] = d->hint.empty() ? d->message : fmt::format("{}; hint: {}", d->message, d->hint);
    result["locations"] = Json::array({SarifLocation(report, d->location)});
    result["properties"]["severity"] = SeverityName(d->severity);
    results.push_back(std::move(result));
  }
  Json run;
  run["tool"]["driver"] = {{"name", "plumb"}, {"semanticVersion", PLUMB_VERSION}, {"rules", std::move(rules)}};
  run["artifacts"] = Json::array({{{"location", {{"uri", PathToUri(report.source_path)}}}}});
  const bool did_its_work = report.outcome == Outcome::kFine || report.outcome == Outcome::kFindings;
  run["invocations"] = Json::array({{{"executionSuccessful", did_its_work}, {"exitCode", static_cast<int>(report.outcome)}}});
  run["results"] = std::move(results);
  run["properties"]["answer"] = report.answer;
  Json out;
  out["$schema"] = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";
  out["version"] = "2.1.0";
  out["runs"] = Json::array({std::move(run)});
  return Dump(out);
}

}  // namespace

std::string ReportToString(const Report& report, ReportFormat format) {
  switch (format) {
    case ReportFormat::kJson: return ToJson(report);
    case ReportFormat::kSarif: return ToSarif(report);
    case ReportFormat::kText: break;
  }
  return ToText(report);
}

}  // namespace plumb::compiler
