#include "tools/plumb/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;

class Inputs : public ::testing::Test {
 protected:
  void Write(const std::string& name, std::string_view text) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, text));
  }
  InputKind Kind(const std::string& name) { return KindOf(folder_ / name); }

  test::TemporaryFolder folder_;
};

TEST_F(Inputs, AreToldByNamesAndFirstBytes) {
  Write("a.agraph", std::string_view("\x10\0\0\0PLAG", 8));
  Write("cut.agraph", "");
  Write("step.txt", "ISO-10303-21;");
  Write("house.ifc.gz", "");
  Write("notes.txt", "notes");
  Write("rec/scans/1.pcd", "");
  Write("run/run.json", "{}");
  EXPECT_EQ(Kind("a.agraph"), InputKind::kAGraph);
  EXPECT_EQ(Kind("cut.agraph"), InputKind::kOther);
  EXPECT_EQ(Kind("step.txt"), InputKind::kPlan);
  EXPECT_EQ(Kind("house.ifc.gz"), InputKind::kPlan);
  EXPECT_EQ(Kind("notes.txt"), InputKind::kOther);
  EXPECT_EQ(Kind("rec/"), InputKind::kRecording);
  EXPECT_EQ(Kind("rec/scans"), InputKind::kScans);
  EXPECT_EQ(Kind("run"), InputKind::kRun);
  EXPECT_EQ(Kind("."), InputKind::kFolder);
  EXPECT_EQ(Kind("none"), InputKind::kMissing);
}

TEST_F(Inputs, ThatMayBeWhatIsWantedAreLeftToItsReader) {
  Write("cut.agraph", "");
  Write("both/scans/1.pcd", "");
  Write("both/run.json", "{}");
  EXPECT_TRUE(CheckInputs({{folder_ / "cut.agraph", InputKind::kAGraph}}));
  EXPECT_TRUE(CheckInputs({{folder_ / "cut.agraph", InputKind::kPlan}}));
  EXPECT_TRUE(CheckInputs({{folder_ / "both", InputKind::kRecording}}));
  EXPECT_TRUE(CheckInputs({{folder_ / "both", InputKind::kRun}}));
  EXPECT_TRUE(CheckInputs({{folder_.path(), InputKind::kRecording}}));
}

TEST_F(Inputs, OfAnotherKindAreRefusedWithAHint) {
  Write("clouds/1.pcd", "");
  Write("run/run.json", R"({"version":1,"plumb":"","plan":{"path":"","source":"","source_sha256":""},"recording":"/tour","options":{},
    "summary":{"scans":1,"localized_scans":0,"time_to_localize_s":null,"duration_s":0,"keyframes":0,"deviated_walls":0,"range_bias_m":0,
    "ms_per_scan":0,"last_reason":""}})");
  const auto clouds = CheckInputs({{folder_ / "clouds", InputKind::kRecording}});
  ASSERT_FALSE(clouds);
  EXPECT_EQ(clouds.error().code, ErrorCode::kBadOption);
  EXPECT_THAT(clouds.error().message, HasSubstr("move them into `" + (folder_ / "clouds/scans") + "`"));
  EXPECT_THAT(CheckInputs({{folder_ / "run", InputKind::kRecording}}).error().message, HasSubstr("the recording `/tour`"));
  EXPECT_EQ(CheckInputs({{folder_ / "none", InputKind::kRun}}).error().code, ErrorCode::kFileNotFound);
}

}  // namespace
}  // namespace plumb::tools
