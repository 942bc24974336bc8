#include "compiler/diagnostics/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace plumb::compiler {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

Report MakeReport() {
  Report report;
  report.source_path = "plans/my house.ifc";
  report.outcome = Outcome::kFindings;
  report.answer = "no robot should localize in this before 1 finding is mended (0 rooms)";
  const auto add = [&](DiagnosticKind kind, SourceLocation where, const char* message, const char* hint) {
    report.diagnostics.push_back({kind, SeverityOf(kind), std::move(where), message, hint});
  };
  add(DiagnosticKind::kWallWithoutBody, {991, 123, "2O2Fr$t4X7Zf8NOew3FLOH", "IfcWall", 5}, "the wall has no body", "draw it");
  add(DiagnosticKind::kNowhereToLocalize, {}, "nothing \"here\"", "");
  add(DiagnosticKind::kFillingInferred, {17, 40, "", "IfcDoor", 1}, "a door \xff", "");
  add(DiagnosticKind::kWallWithoutBody, {992, 124, "", "IfcWall", 1}, "another one", "");
  return report;
}

TEST(Report, TextHasPlaceHintAndAnswer) {
  EXPECT_EQ(ReportToString(MakeReport(), ReportFormat::kText),
            "plans/my house.ifc: error: nothing \"here\" [PL7120]\n"
            "plans/my house.ifc:17:1: remark: a door \xff [PL2304]\n"
            "    at: #40 IfcDoor\n"
            "plans/my house.ifc:991:5: warning: the wall has no body [PL2301]\n"
            "    at: #123 IfcWall 2O2Fr$t4X7Zf8NOew3FLOH\n"
            "    hint: draw it\n"
            "plans/my house.ifc:992:1: warning: another one [PL2301]\n"
            "    at: #124 IfcWall\n"
            "1 error, 2 warnings\n"
            "plans/my house.ifc: no robot should localize in this before 1 finding is mended (0 rooms)\n");
}

TEST(Report, JsonSaysTheSame) {
  const Json json = Json::parse(ReportToString(MakeReport(), ReportFormat::kJson));
  EXPECT_EQ(json["source"], "plans/my house.ifc");
  EXPECT_EQ(json["exit_status"], 1);
  EXPECT_EQ(json["errors"], 1);
  EXPECT_EQ(json["warnings"], 2);
  ASSERT_EQ(json["diagnostics"].size(), 4u);
  const Json& wall = json["diagnostics"][2];
  EXPECT_EQ(wall["code"], "PL2301");
  EXPECT_EQ(wall["severity"], "warning");
  EXPECT_EQ(wall["hint"], "draw it");
  EXPECT_EQ(wall["location"],
            Json({{"line", 991}, {"column", 5}, {"step_id", 123}, {"guid", "2O2Fr$t4X7Zf8NOew3FLOH"}, {"type", "IfcWall"}}));
  EXPECT_EQ(json["diagnostics"][0]["location"], Json::object());
}

// What sarif-schema-2.1.0.json asks for in every object that is used, its enumerations, and its ranges.
TEST(Report, SarifHasWhatTheSchemaRequires) {
  const Json sarif = Json::parse(ReportToString(MakeReport(), ReportFormat::kSarif));
  EXPECT_EQ(sarif.at("version"), "2.1.0");
  EXPECT_THAT(sarif.at("$schema").get<std::string>(), HasSubstr("sarif-schema-2.1.0.json"));
  ASSERT_EQ(sarif.at("runs").size(), 1u);
  const Json& run = sarif.at("runs")[0];
  const Json& driver = run.at("tool").at("driver");
  EXPECT_FALSE(driver.at("name").get<std::string>().empty());
  const Json& rules = driver.at("rules");
  std::vector<std::string> ids;
  for (const Json& rule : rules) {
    ids.push_back(rule.at("id"));
    for (const char* text : {"shortDescription", "fullDescription", "help"})
      EXPECT_FALSE(rule.at(text).at("text").get<std::string>().empty());
    EXPECT_THAT(rule.at("defaultConfiguration").at("level").get<std::string>(), ::testing::AnyOf("none", "note", "warning", "error"));
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"PL2301", "PL2304", "PL7120"}));
  EXPECT_EQ(run.at("invocations")[0].at("executionSuccessful"), true);
  EXPECT_EQ(run.at("invocations")[0].at("exitCode"), 1);
  EXPECT_EQ(run.at("artifacts")[0].at("location").at("uri"), "plans/my%20house.ifc");
  ASSERT_EQ(run.at("results").size(), 4u);
  for (const Json& result : run.at("results")) {
    EXPECT_EQ(ids.at(result.at("ruleIndex").get<size_t>()), result.at("ruleId"));
    EXPECT_THAT(result.at("level").get<std::string>(), ::testing::AnyOf("none", "note", "warning", "error"));
    EXPECT_FALSE(result.at("message").at("text").get<std::string>().empty());
    for (const Json& location : result.at("locations")) {
      const Json& physical = location.at("physicalLocation");
      EXPECT_EQ(physical.at("artifactLocation").at("index"), 0);
      EXPECT_GE(physical.value("region", Json({{"startLine", 1}})).at("startLine").get<int>(), 1);
    }
  }
  const Json& wall = run["results"][2];
  EXPECT_EQ(wall["locations"][0]["physicalLocation"]["region"], Json({{"startLine", 991}, {"startColumn", 5}}));
  EXPECT_EQ(wall["locations"][0]["logicalLocations"][0]["name"], "2O2Fr$t4X7Zf8NOew3FLOH");
  EXPECT_FALSE(run["results"][0]["locations"][0]["physicalLocation"].contains("region"));
}

TEST(Report, SarifOfAnUnusableFileIsNoSuccess) {
  Report report = MakeReport();
  report.outcome = Outcome::kBadInput;
  const Json run = Json::parse(ReportToString(report, ReportFormat::kSarif))["runs"][0];
  EXPECT_EQ(run["invocations"][0]["executionSuccessful"], false);
  EXPECT_EQ(run["invocations"][0]["exitCode"], 2);
  report.diagnostics.clear();
  EXPECT_EQ(Json::parse(ReportToString(report, ReportFormat::kSarif))["runs"][0]["results"], Json::array());
}

TEST(DiagnosticsToText, ListsAFewOfEachKind) {
  const std::vector<Diagnostic> many(5, Diagnostic{DiagnosticKind::kWallWithoutBody, Severity::kWarning, {}, "m", ""});
  EXPECT_EQ(DiagnosticsToText(many, "p", 2),
            "p: warning: m [PL2301]\np: warning: m [PL2301]\n    and 3 more of PL2301 WallWithoutBody\n0 errors, 5 warnings\n");
}

}  // namespace
}  // namespace plumb::compiler
