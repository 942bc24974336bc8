#include "tools/plumb/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>

#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Config : public ::testing::Test {
 protected:
  void SetUp() override {
    CLI::App* simulate = app_.add_subcommand("simulate");
    simulate->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)->always_capture_default();
    simulate->add_option("PLAN", plan_);
    simulate->add_option("--seed", seed_);
    simulate->add_option("--sensor", sensor_);
    simulate->add_flag("--quiet", quiet_);
    app_.add_subcommand("localize");
  }
  Expected<std::vector<std::string>> Expand(const std::string& toml) {
    EXPECT_TRUE(WriteFileAtomically(path_, std::string_view(toml)));
    return ExpandConfig(app_, {"simulate", "a.agraph", "--config", path_, "--seed", "9"});
  }

  CLI::App app_{"test"};
  std::string plan_, sensor_ = "vlp16";
  int seed_ = 1;
  bool quiet_ = false;
  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "config.toml";
};

TEST_F(Config, KeysBecomeFlagsBeforeThoseOfTheCommandLine) {
  const auto out = Expand("seed = 4\nquiet = true\n[simulate]\nsensor = \"a \\\"b\\\"\"\n[localize]\nanything = 1\n");
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_THAT(*out, ElementsAre("simulate", "--quiet=true", "--seed=4", "--sensor=a \"b\"", "a.agraph", "--config", path_, "--seed", "9"));
}

TEST_F(Config, ListsAreOptionsThatAreGivenSeveralTimes) {
  const auto out = Expand("seed = [4, 5]\nsensor = []\n");
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_THAT(*out, ElementsAre("simulate", "--seed=4", "--seed=5", "a.agraph", "--config", path_, "--seed", "9"));
}

TEST_F(Config, UnknownKeysAreErrorsWithTheNearestName) {
  const auto out = Expand("\nsede = 4\n");
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kBadOption);
  EXPECT_THAT(out.error().message, HasSubstr(":2`"));
  EXPECT_THAT(out.error().message, HasSubstr("did you mean `seed`?"));
  EXPECT_THAT(Expand("[simulat]\nseed=1\n").error().message, HasSubstr("did you mean `simulate`?"));
  EXPECT_THAT(Expand("seed = 1979-05-27\n").error().message, HasSubstr("neither a number"));
  EXPECT_THAT(Expand("seed = \n").error().message, HasSubstr("no TOML"));
}

TEST_F(Config, PrintedConfigReadsBack) {
  sensor_ = "back\\slash \"quote\"";
  app_.get_subcommand("simulate")->get_option("--sensor")->capture_default_str();
  const std::string toml = ConfigToToml(*app_.get_subcommand("simulate"));
  EXPECT_THAT(toml, HasSubstr("[simulate]\nseed = 1\n"));
  const auto out = Expand(toml);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_THAT(*out, ::testing::Contains("--sensor=" + sensor_));
  EXPECT_THAT(*out, ::testing::Contains("--quiet=false"));
}

TEST_F(Config, ValuesAreLiteralsOfTomlAndJson) {
  double speed_m_s = 0.5;
  std::vector<std::string> rooms;
  bool open = true;
  CLI::App* simulate = app_.get_subcommand("simulate");
  simulate->add_option("--speed", speed_m_s);
  simulate->add_option("--room", rooms)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
  simulate->add_option("--open", open);
  std::vector<std::string> reversed = {"7", "--room", ".5", "--speed", "05", "--seed", "simulate"};
  app_.parse(reversed);
  std::map<std::string, std::string> values;
  for (const Option& o : OptionValues(*simulate)) values[o.name] = o.value;
  EXPECT_EQ(values,
            (std::map<std::string, std::string>{
                {"seed", "5"}, {"sensor", "\"vlp16\""}, {"quiet", "false"}, {"speed", "0.5"}, {"room", "[\"7\"]"}, {"open", "true"}}));
}

}  // namespace
}  // namespace plumb::tools
