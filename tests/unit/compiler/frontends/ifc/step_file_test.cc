#include "compiler/frontends/ifc/step_file.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

class StepFileTest : public ::testing::Test {
 protected:
  const StepFile& Index(std::string text) {
    text_ = std::move(text);
    file_ = StepFile::Index(text_, diagnostics_);
    EXPECT_TRUE(file_);
    return *file_;
  }
  std::vector<DiagnosticKind> Kinds() const {
    std::vector<DiagnosticKind> kinds;
    for (const Diagnostic& d : diagnostics_.all()) kinds.push_back(d.kind);
    return kinds;
  }

  std::string text_;
  DiagnosticSink diagnostics_;
  std::optional<StepFile> file_;
};

TEST_F(StepFileTest, FindsInstancesTypesAndLines) {
  const StepFile& file = Index(test::IfcText("#10=IFCWALL('a',#11);\n#11 = IFCDIRECTION ((0.,0.,1.));#12=IFCWALL('b',$);"));
  EXPECT_TRUE(diagnostics_.all().empty());
  EXPECT_EQ(file.schema_name(), "IFC4");
  ASSERT_EQ(file.size(), 7u);
  const uint32_t wall = file.Find(10), direction = file.Find(11);
  EXPECT_EQ(file.type_name(file.type(wall)), "IFCWALL");
  EXPECT_EQ(file.type_name(file.type(direction)), "IFCDIRECTION");
  EXPECT_EQ(file.id(direction), 11u);
  EXPECT_EQ(file.Line(wall), 12u);
  EXPECT_EQ(file.Line(direction), 13u);
  EXPECT_EQ(file.InstancesOf(file.type(wall)).size(), 2u);
  EXPECT_EQ(file.Arguments(wall)[1].Reference(), 11u);
  EXPECT_EQ(file.Find(99), StepFile::kNone);
}

// Reading the rest of the file for each of them would take minutes.
TEST_F(StepFileTest, ManyStatementsWithoutAnEndCostLinearTime) {
  std::string text = "ISO-10303-21;\nDATA;\n";
  for (int i = 1; i <= 500000; ++i) text += "#" + std::to_string(i) + "=A(\n";
  const StepFile& file = Index(text);
  ASSERT_EQ(file.size(), 499999u);  // the last one is cut off
  size_t arguments = 0;
  for (uint32_t i = 0; i < file.size(); ++i) arguments += file.Arguments(i).size();
  EXPECT_LE(arguments, 2u * file.size());
}

TEST_F(StepFileTest, StringsAndCommentsHideWhatLooksLikeInstances) {
  const StepFile& file =
      Index(test::IfcText("#10=IFCLABELED('; #99=IFCWALL(', 'it''s;');\n/* #98=IFCWALL('c'); */\n#11=IFCWALL(/* ; */ 'x');"));
  EXPECT_TRUE(diagnostics_.all().empty());
  EXPECT_EQ(file.Find(99), StepFile::kNone);
  EXPECT_EQ(file.Find(98), StepFile::kNone);
  EXPECT_EQ(file.Arguments(file.Find(10))[1].Text(), "it's;");
  EXPECT_EQ(file.Arguments(file.Find(11))[0].Text(), "x");
}

TEST_F(StepFileTest, InstancesOverSeveralLines) {
  const StepFile& file = Index(test::IfcText("#10=\r\nIFCWALL(\r\n'a',\r\n#11\r\n)\r\n;"));
  EXPECT_EQ(file.Arguments(file.Find(10))[1].Reference(), 11u);
}

TEST_F(StepFileTest, SparseAndHugeIdsAreFound) {
  const StepFile& file = Index(test::IfcText("#4000000000000=IFCWALL('a');\n#900000=IFCWALL('b');"));
  EXPECT_EQ(file.Arguments(file.Find(4000000000000))[0].Text(), "a");
  EXPECT_EQ(file.Arguments(file.Find(900000))[0].Text(), "b");
  EXPECT_EQ(file.Find(900001), StepFile::kNone);
}

TEST_F(StepFileTest, CrowdedAndDisorderedIdsAreFound) {
  std::string data;
  for (int i = 299; i >= 0; --i) data += "#" + std::to_string(1000000 + 3 * i) + "=IFCWALL('" + std::to_string(i) + "');\n";
  data += "#12=IFCWALL('low');\n#18446744073709551615=IFCWALL('high');\n#1000300=IFCWALL('again');";
  const StepFile& file = Index(test::IfcText(data));
  for (int i = 0; i < 300; ++i) {
    const uint64_t id = 1000000 + 3 * static_cast<uint64_t>(i);
    ASSERT_NE(file.Find(id), StepFile::kNone) << id;
    EXPECT_EQ(file.Arguments(file.Find(id))[0].Text(), std::to_string(i));
    EXPECT_EQ(file.Find(id + 1), StepFile::kNone);
  }
  EXPECT_EQ(file.Arguments(file.Find(12))[0].Text(), "low");
  EXPECT_EQ(file.Arguments(file.Find(18446744073709551615u))[0].Text(), "high");
  EXPECT_EQ(file.Find(11), StepFile::kNone);
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kDuplicateInstance});
}

TEST_F(StepFileTest, NotAStepFileIsAnError) {
  EXPECT_FALSE(StepFile::Index("solid cube", diagnostics_));
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kStepSyntax});
}

TEST_F(StepFileTest, TruncationKeepsWhatIsWhole) {
  std::string text = test::IfcText("#10=IFCWALL('a');\n#11=IFCWALL('b',$,$);");
  text.resize(text.find("#11=") + 12);
  const StepFile& file = Index(text);
  EXPECT_NE(file.Find(10), StepFile::kNone);
  EXPECT_EQ(file.Find(11), StepFile::kNone);
  EXPECT_FALSE(file.is_whole());
  ASSERT_EQ(Kinds(), std::vector{DiagnosticKind::kFileCutOff});
  EXPECT_EQ(diagnostics_.all()[0].location.line, 13u);
}

TEST_F(StepFileTest, TruncationInsideAString) {
  std::string text = test::IfcText("#10=IFCWALL('a');\n#11=IFCWALL('bbbbb');");
  text.resize(text.find("bbbbb") + 2);
  const StepFile& file = Index(text);
  EXPECT_NE(file.Find(10), StepFile::kNone);
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kFileCutOff});
}

TEST_F(StepFileTest, AFileThatEndsBehindItsDataSectionIsWhole) {
  std::string text = test::IfcText("#10=IFCWALL('a');");
  text.resize(text.find("END-ISO"));
  EXPECT_TRUE(Index(text).is_whole());
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kStepSyntax});
}

TEST_F(StepFileTest, AFileThatEndsBetweenInstancesIsCutOff) {
  std::string text = test::IfcText("#10=IFCWALL('a');\n#11=IFCWALL('b');");
  text.resize(text.find("#11"));
  EXPECT_FALSE(Index(text).is_whole());
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kFileCutOff});
}

TEST_F(StepFileTest, MissingSemicolonLosesNoInstance) {
  const StepFile& file = Index(test::IfcText("#10=IFCWALL('a')\n#11=IFCWALL('b');\n#12=IFCWALL('c');"));
  for (const uint64_t id : {10u, 11u, 12u}) EXPECT_NE(file.Find(id), StepFile::kNone) << id;
  ASSERT_EQ(Kinds(), std::vector{DiagnosticKind::kStepSyntax});
  EXPECT_EQ(diagnostics_.all()[0].location.line, 12u);
}

TEST_F(StepFileTest, MissingQuoteLosesOneInstanceAtMost) {
  const StepFile& file = Index(test::IfcText("#10=IFCWALL('a);\n#11=IFCWALL('b');\n#12=IFCWALL('c');"));
  EXPECT_NE(file.Find(11), StepFile::kNone);
  EXPECT_NE(file.Find(12), StepFile::kNone);
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kStepSyntax});
}

TEST_F(StepFileTest, GarbageBetweenInstancesIsPassedOver) {
  const StepFile& file =
      Index(test::IfcText("#10=IFCWALL('a');\n\x01\x02garbage;\n#=IFCWALL('x');\n#11 IFCWALL('b');\n#12=IFCWALL;\n#13=IFCWALL('d');"));
  EXPECT_NE(file.Find(10), StepFile::kNone);
  EXPECT_NE(file.Find(13), StepFile::kNone);
  EXPECT_EQ(file.Find(12), StepFile::kNone);
  EXPECT_EQ(diagnostics_.all().size(), 4u);
}

TEST_F(StepFileTest, DuplicateIdsAreReportedAndTheFirstHolds) {
  const StepFile& file = Index(test::IfcText("#10=IFCWALL('a');\n#10=IFCWALL('b');"));
  EXPECT_EQ(file.Arguments(file.Find(10))[0].Text(), "a");
  EXPECT_EQ(Kinds(), std::vector{DiagnosticKind::kDuplicateInstance});
}

TEST_F(StepFileTest, SyntaxErrorsAreCapped) {
  std::string data;
  for (int i = 0; i < 1000; ++i) data += "?;\n";
  Index(test::IfcText(data));
  EXPECT_LE(diagnostics_.all().size(), 50u);
}

TEST_F(StepFileTest, LinesOfFilesWithCarriageReturnsOnly) {
  std::string text = test::IfcText("#10=IFCWALL('a');");
  std::replace(text.begin(), text.end(), '\n', '\r');
  const StepFile& file = Index(text);
  EXPECT_EQ(file.Line(file.Find(10)), 12u);
}

// Any damage to a file is survived: bytes changed, cut out and doubled.
TEST_F(StepFileTest, SurvivesRandomDamage) {
  const std::string whole =
      test::IfcText("#10=IFCWALL('a''b',#11,(1.,2.),IFCLABEL('c'),.T.);\n/* c */#11=IFCDIRECTION((0.,1.));\n#12=IFCX((((#10))),$,*);");
  std::mt19937_64 rng(3);
  for (int round = 0; round < 3000; ++round) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) {
      const size_t at = 20 + rng() % (text.size() - 20);
      switch (rng() % 3) {
        case 0: text[at] = "#=();',/*\n\0\xff$."[rng() % 14]; break;
        case 1: text.erase(at, rng() % 9); break;
        default: text.insert(at, text.substr(rng() % text.size(), rng() % 9)); break;
      }
    }
    DiagnosticSink sink;
    const auto file = StepFile::Index(text, sink);
    if (!file) continue;
    for (uint32_t i = 0; i < file->size(); ++i) {
      const StepArguments args = file->Arguments(i);
      for (size_t a = 0; a < args.size(); ++a) {
        (void)args[a].Real();
        (void)args[a].Text();
        for (const StepValue v : args[a].Items()) (void)v.kind();
      }
      EXPECT_GE(file->Line(i), 1u);
    }
  }
}

}  // namespace
}  // namespace plumb::compiler
