#include "tools/plumb/usage_errors.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace plumb::tools {
namespace {

class UsageErrors : public ::testing::Test {
 protected:
  void SetUp() override {
    app_.require_subcommand(1);
    CLI::App* inspect = app_.add_subcommand("inspect");
    inspect->add_option("FILE.agraph", plan_)->required();
    inspect->add_option("--resolution", resolution_m_);
    inspect->add_option("--sheet", sheet_);
    inspect->add_option("--svg", svg_)->type_name("FILE.svg")->check(NotEmpty);
    inspect->add_flag("-q,--quiet", quiet_);
    app_.add_subcommand("doctor");
  }
  std::string Of(const std::vector<std::string>& arguments) {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    try {
      app_.parse(reversed);
    } catch (const CLI::ParseError& error) {
      return UsageError(app_, error, arguments);
    }
    return "none";
  }

  CLI::App app_{"test"};
  std::string plan_, svg_;
  double resolution_m_ = 0;
  int sheet_ = 0;
  bool quiet_ = false;
};

TEST_F(UsageErrors, NameWhatIsNoSubcommand) {
  EXPECT_EQ(Of({"inspct", "a"}), "there is no subcommand `inspct`; did you mean `inspect`?");
  EXPECT_EQ(Of({"--frob", "view"}), "there is no subcommand `view`; there are inspect, doctor");
  EXPECT_EQ(Of({"--frob"}), "a subcommand is required: inspect, doctor");
}

TEST_F(UsageErrors, NameFlagsThatThereAreNot) {
  EXPECT_EQ(Of({"inspect", "a", "--resolution_m", "3"}), "`plumb inspect` has no flag `--resolution_m`; did you mean `--resolution`?");
  EXPECT_EQ(Of({"inspect", "a", "--resolutoin=3"}), "`plumb inspect` has no flag `--resolutoin`; did you mean `--resolution`?");
  EXPECT_EQ(Of({"inspect", "a", "-x"}), "`plumb inspect` has no flag `-x`");
  EXPECT_EQ(Of({"-q", "inspect", "a"}), "`-q` stands before `inspect`; flags stand behind it");
  EXPECT_EQ(Of({"inspect", "a", "b"}), "`b` is one argument too many for `plumb inspect`");
}

TEST_F(UsageErrors, SayWhatAValueMustBe) {
  EXPECT_EQ(Of({"inspect", "a", "--resolution", "fine"}), "--resolution fine; must be a number");
  EXPECT_EQ(Of({"inspect", "a", "--sheet", "1.5"}), "--sheet 1.5; must be a whole number");
  EXPECT_EQ(Of({"inspect", "a", "--svg"}), "--svg needs a value: FILE.svg");
  EXPECT_EQ(Of({"inspect", "a", "--svg", ""}), "--svg: must not be empty");
  EXPECT_EQ(Of({"inspect"}), "FILE.agraph is required");
  EXPECT_EQ(Of({"inspect", "a"}), "none");
}

}  // namespace
}  // namespace plumb::tools
