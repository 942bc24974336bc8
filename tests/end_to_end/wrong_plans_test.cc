// One drive through a cluttered floor, given plans that are not the building's: its mirror image, 3 % larger, another house. Never a fix.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/program.h"

namespace plumb {
namespace {

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class WrongPlans : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::ProgramFolder>("wrong_plans");
    ASSERT_EQ(folder_->Plumb("compile '" PLUMB_SOURCE_DIR "/plans/office_floor/plan.svg' -q -o built.agraph"), 0);
    ASSERT_EQ(folder_->Plumb("simulate built.agraph --seed 2 --deviate 25% --translation 0.2 --rotation 0:5 --clutter 12 --noise 0.02 "
                             "--duration 45 --max-duration 45 -q -o rec/"),
              0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static void ExpectNoFix(const std::string& source) {
    ASSERT_EQ(folder_->Plumb("compile '" + source + "' -q -o other.agraph"), 0);
    EXPECT_EQ(folder_->Plumb("localize other.agraph rec/ -q -o other/"), 1);
    EXPECT_EQ(folder_->Json("other/run.json").at("summary").at("localized_scans"), 0);
  }

  // The floor's drawing with one place of its text changed.
  static void ExpectNoFixIn(const std::string& from, const std::string& to) {
    const auto drawing = ReadFileText(PLUMB_SOURCE_DIR "/plans/office_floor/plan.svg");
    ASSERT_TRUE(drawing);
    const std::string path = (*folder_ / "changed.svg").string();
    ASSERT_TRUE(WriteFileAtomically(path, std::string_view(Replaced(*drawing, from, to))));
    ExpectNoFix(path);
  }

  static std::unique_ptr<test::ProgramFolder> folder_;
};

std::unique_ptr<test::ProgramFolder> WrongPlans::folder_;

// Else the others prove nothing.
TEST_F(WrongPlans, TheRightOneIsFound) {
  ASSERT_EQ(folder_->Plumb("localize built.agraph rec/ -q -o run/"), 0);
  EXPECT_EQ(folder_->Plumb("evaluate run/ --truth rec/ --json run/evaluation.json --require-localized-within 30"), 0);
  EXPECT_EQ(folder_->Json("run/evaluation.json").at("wrong_fixes"), 0);
}

TEST_F(WrongPlans, ItsMirrorImageIsNot) {
  ExpectNoFixIn("<g class=\"Model\">", "<g class=\"Model\" transform=\"matrix(-1 0 0 1 2600 0)\">");
}

TEST_F(WrongPlans, ThreePercentLargerIsNot) { ExpectNoFixIn("width=\"2600cm\" height=\"1600cm\"", "width=\"2678cm\" height=\"1648cm\""); }

TEST_F(WrongPlans, AnotherHouseIsNot) { ExpectNoFix(PLUMB_SOURCE_DIR "/plans/house/plan.ifc"); }

}  // namespace
}  // namespace plumb
