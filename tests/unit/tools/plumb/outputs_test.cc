#include "tools/plumb/outputs.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "schema/files.h"
#include "tests/support/temporary_folder.h"
#include "tools/plumb/flag_names.h"

namespace plumb::tools {
namespace {

TEST(CheckOutputs, RefusesWhatIsReadByWhateverPath) {
  const test::TemporaryFolder folder;
  const std::string plan = folder.path() + "/plan.svg", other = folder.path() + "/other.svg";
  ASSERT_TRUE(WriteFileAtomically(plan, std::string_view("<svg/>")));
  const std::string round = folder.path() + "/../" + std::filesystem::path(folder.path()).filename().string() + "/plan.svg";
  const auto refused = CheckOutputs({{"--output", other}, {"--svg", round}}, {plan});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--svg"), std::string::npos);
  EXPECT_TRUE(CheckOutputs({{"--output", other}, {"--svg", ""}}, {plan}));
}

TEST(CheckOutputs, RefusesFilesOfRecordingsAndRunsThatAreRead) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "rec/scans");
  for (const char* name : {"rec/truth.json", "rec/odometry.tum", "rec/notes.txt", "rec/scans/1.pcd"})
    ASSERT_TRUE(WriteFileAtomically(folder / name, std::string_view("mine")));
  for (const char* name : {"rec/truth.json", "rec/scans/../odometry.tum", "rec/scans/1.pcd", "rec/scans/new.json"})
    EXPECT_FALSE(CheckOutputs({{"--json", folder / name}}, {folder / "rec"})) << name;
  for (const char* name : {"rec/notes.txt", "rec/evaluation.json", "truth.json"})
    EXPECT_TRUE(CheckOutputs({{"--json", folder / name}}, {folder / "rec"})) << name;
}

TEST(CheckOutputs, RefusesFoldersAndFilesInNone) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(CheckOutputs({{"--output", folder.path()}}, {}));
  EXPECT_FALSE(CheckOutputs({{"--output", folder / "none/a.agraph"}}, {}));
  EXPECT_TRUE(CheckOutputs({{"--output", folder / "a.agraph"}, {"--output", "a.agraph"}}, {}));
}

TEST(OutputFolder, RemovesWhatItMadeUnlessSomethingIsInIt) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  for (const char* end : {"", "/"}) {
    { ASSERT_TRUE(OutputFolder::Make(folder / "a/b" + end)); }
    EXPECT_FALSE(fs::exists(folder / "a"));
  }
  fs::create_directories(folder / "old");
  { ASSERT_TRUE(OutputFolder::Make(folder / "old")); }
  EXPECT_TRUE(fs::exists(folder / "old")) << "it was there before";
  {
    const auto made = OutputFolder::Make(folder / "old/a/b");
    ASSERT_TRUE(made);
    ASSERT_TRUE(WriteFileAtomically(folder / "old/a/file", std::string_view("x")));
  }
  EXPECT_FALSE(fs::exists(folder / "old/a/b"));
  EXPECT_TRUE(fs::exists(folder / "old/a/file"));
  EXPECT_FALSE(OutputFolder::Make(folder / "old/a/file/c"));
}

TEST(InFlags, NamesTheFlagOfAField) {
  EXPECT_EQ(InFlags("DrawingFileOptions.scale_m = -1; must be in [0, 10000)"), "--scale -1; must be in [0, 10000)");
  EXPECT_EQ(InFlags("SimulateOptions.speed_m_s = 9; must be from 0.05 to 3"), "--speed 9; must be from 0.05 to 3");
  EXPECT_EQ(InFlags("ReplayOptions.threads = -2; must be >= 0"), "--threads -2; must be >= 0");
  EXPECT_EQ(InFlags("HeightOptions.sill_m = 3, window_top_m = 2; must be 0 < sill_m < window_top_m <= storey_m"),
            "--sill-height 3, --window-top 2; must be 0 < --sill-height < --window-top <= --storey-height");
  EXPECT_EQ(InFlags("DrawingFileOptions.scale_m = 2; must not be given besides unit = cm"),
            "--scale 2; must not be given besides --unit cm");
  EXPECT_EQ(InFlags("RoomOptions.min_width_m = -1; must not be negative"), "RoomOptions.min_width_m = -1; must not be negative");
}

}  // namespace
}  // namespace plumb::tools
