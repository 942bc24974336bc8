#include "compiler/diagnostics/explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace plumb::compiler {
namespace {

using ::testing::HasSubstr;

TEST(Explanation, OfEveryKindHasWholeSentencesAndFitsThePage) {
  for (const DiagnosticKind kind : AllDiagnosticKinds()) {
    const Explanation& e = ExplanationOf(kind);
    for (const std::string_view text : {e.fact, e.why, e.mend}) {
      EXPECT_GT(text.size(), 15u) << CodeOf(kind);
      EXPECT_TRUE(text[0] >= 'A' && text[0] <= 'Z') << CodeOf(kind) << ": " << text;
    }
    EXPECT_FALSE(e.example.empty()) << CodeOf(kind);
    const std::string text = ExplanationText(kind);
    EXPECT_THAT(text, ::testing::StartsWith(CodeOf(kind) + " " + std::string(NameOf(kind))));
    for (const char* title : {"\nfact ", "\nrule ", "\nwhy ", "\nexample ", "\nmend "}) EXPECT_THAT(text, HasSubstr(title)) << CodeOf(kind);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  }
}

TEST(DiagnosticKinds, AreFoundByCodeAndByName) {
  EXPECT_EQ(FindDiagnosticKind("PL2301"), DiagnosticKind::kWallWithoutBody);
  EXPECT_EQ(FindDiagnosticKind("pl2301"), DiagnosticKind::kWallWithoutBody);
  EXPECT_EQ(FindDiagnosticKind("wallwithoutbody"), DiagnosticKind::kWallWithoutBody);
  for (const char* other : {"", "PL", "PL0000", "2301", "PL23011"}) EXPECT_FALSE(FindDiagnosticKind(other)) << other;
}

}  // namespace
}  // namespace plumb::compiler
