// The program's subcommands for plans, as a user or a script runs them: exit status, formats that agree, files that are whole or not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "schema/files.h"
#include "tests/compile/program_fixture.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::Not;
using Program = test::ProgramFixture;
using Json = nlohmann::json;

TEST_F(Program, SimulateTakesAStoreyByName) {
  const std::string simulate = "simulate house.agraph --duration 1 --max-duration 1 --deviate 0 -q -o ";
  EXPECT_EQ(Plumb(simulate + "named --storey 'ground floor'").status, 0);
  EXPECT_EQ(Plumb(simulate + "any --storey -1").status, 0);
  const Outcome attic = Plumb(simulate + "attic --storey attic");
  EXPECT_EQ(attic.status, 2);
  EXPECT_THAT(attic.err, HasSubstr("attic"));
}

TEST_F(Program, StoreysAreOfTheirDrawingsHoweverThePathsAreWritten) {
  for (const char* name : {"ground.dxf", "upper.dxf"}) fs::copy_file(fs::path(PLUMB_SOURCE_DIR "/plans/house") / name, folder_ / name);
  const std::string compile = "compile ./ground.dxf upper.dxf --storey EG=ground.dxf@0 --storey OG=./upper.dxf@2.8 -o two.agraph";
  ASSERT_EQ(Plumb(compile).status, 0);
  EXPECT_THAT(Plumb("inspect two.agraph").out, HasSubstr("ground.dxf + ./upper.dxf"));
  const auto hash = [&] { return Json::parse(Plumb("inspect two.agraph --json").out).at("source").at("sha256").get<std::string>(); };
  const std::string before = hash();
  Write("upper.dxf", "999\nanother issue\n" + Read("upper.dxf"));
  ASSERT_EQ(Plumb(compile).status, 0);
  EXPECT_NE(hash(), before) << "the second drawing is another";
  EXPECT_EQ(Plumb("compile --storey EG=ground.dxf@0 --storey OG=upper.dxf@2.8 -o two.agraph").status, 0) << "the drawings are named";
  EXPECT_EQ(Plumb("compile -o two.agraph").status, 2);
}

TEST_F(Program, APlanWithAPlusInItsNameIsNotWrittenOver) {
  fs::copy_file(PLUMB_SOURCE_DIR "/plans/house/ground.dxf", folder_ / "a + b.dxf");
  const std::string drawing = Read("a + b.dxf");
  ASSERT_EQ(Plumb("compile 'a + b.dxf' -o plus.agraph").status, 0);
  EXPECT_EQ(Plumb("inspect plus.agraph --svg 'a + b.dxf'").status, 2);
  EXPECT_EQ(Read("a + b.dxf"), drawing);
}

TEST_F(Program, DoctorTellsOfASimulationThatWasBrokenOff) {
  ASSERT_EQ(Plumb("simulate house.agraph --duration 1 --max-duration 1 --deviate 0 -q -o whole").status, 0);
  EXPECT_EQ(Plumb("doctor whole").status, 0);
  Write("whole/truth.json", "{\"version\": 1, \"incomplete\": true}\n");
  const Outcome broken_off = Plumb("doctor whole");
  EXPECT_EQ(broken_off.status, 1);
  EXPECT_THAT(broken_off.out, HasSubstr("broken off"));
}

TEST_F(Program, RulesThatKnowNoLayerOfADrawingNameThoseThatDo) {
  const std::string compile = "compile '" PLUMB_SOURCE_DIR "/plans/house/ground.dxf' -o rules.agraph --layers ";
  EXPECT_THAT(Plumb(compile + "french").err, HasSubstr("the set `german` knows"));
  EXPECT_THAT(Plumb(compile + "german").err, Not(HasSubstr("knows those")));
}

TEST_F(Program, ValidateSaysTheSameInEveryFormat) {
  for (const auto& [input, expected] : {std::pair(std::string("house.agraph"), 0),
                                        {golden_ + "PL7010.ifc'", 0},
                                        {golden_ + "PL7103.ifc'", 1},  // one room that a half turn maps onto itself
                                        {golden_ + "PL7120.ifc'", 1},
                                        {golden_ + "PL2002.ifc'", 2},
                                        {golden_ + "PL2009.ifc'", 2},
                                        {golden_ + "PL8002.agraph'", 2},
                                        {std::string("missing.ifc"), 2}}) {
    const Outcome text = Plumb("validate " + input), json = Plumb("validate --format json " + input),
                  sarif = Plumb("validate --format sarif " + input);
    EXPECT_EQ(text.status, expected) << input << text.out << text.err;
    EXPECT_EQ(json.status, expected) << input;
    EXPECT_EQ(sarif.status, expected) << input;
    const Json report = Json::parse(json.out), run = Json::parse(sarif.out)["runs"][0];
    EXPECT_EQ(report["exit_status"], expected);
    EXPECT_EQ(run["invocations"][0]["exitCode"], expected);
    EXPECT_THAT(text.out, HasSubstr(report["answer"].get<std::string>()));
    ASSERT_EQ(report["diagnostics"].size(), run["results"].size());
    for (size_t i = 0; i < report["diagnostics"].size(); ++i) {
      EXPECT_EQ(report["diagnostics"][i]["code"], run["results"][i]["ruleId"]);
      EXPECT_THAT(text.out, HasSubstr("[" + report["diagnostics"][i]["code"].get<std::string>() + "]"));
    }
  }
}

// 150 walls across 150 others are 22,500 rooms: more than fits into what the test leaves the program.
TEST_F(Program, PlanThatNeedsTooMuchMemoryIsBadInput) {
  std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='310m' height='310m' viewBox='0 0 310 310'><g id='Walls'>\n";
  for (int i = 0; i <= 150; ++i) {
    svg += "<rect x='" + std::to_string(2 * i) + "' y='0' width='0.2' height='301'/>\n";
    svg += "<rect x='0' y='" + std::to_string(2 * i) + "' width='301' height='0.2'/>\n";
  }
  Write("grid.svg", svg + "</g></svg>\n");
  const Outcome outcome = Plumb("compile grid.svg --scale 1 -o grid.agraph", "ulimit -v 120000");
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("[PL1005]"));
  EXPECT_FALSE(fs::exists(folder_ / "grid.agraph"));
}

TEST_F(Program, StrictMakesFindingsOfWarnings) {
  EXPECT_EQ(Plumb("validate --strict " + golden_ + "PL7103.ifc'").status, 1);
  EXPECT_EQ(Plumb("validate --strict house.agraph").status, 0);
}

TEST_F(Program, ADoorwayThatJoinsNothingIsToldOfOnce) {
  for (const char* code : {"PL7022", "PL7023"}) {
    const Outcome compiled = Plumb("compile " + golden_ + code + ".ifc' -o a.agraph");
    EXPECT_THAT(compiled.err, HasSubstr(code));
    EXPECT_THAT(compiled.err, Not(HasSubstr("PL7105")));
    EXPECT_THAT(Plumb("validate a.agraph").out, HasSubstr("PL7105")) << "the A-Graph is all that is known there";
  }
}

TEST_F(Program, ExplainKnowsEveryCodeItLists) {
  const Outcome list = Plumb("explain");
  EXPECT_EQ(list.status, 0);
  EXPECT_THAT(list.out, HasSubstr("PL2301 warning  WallWithoutBody"));
  EXPECT_THAT(Plumb("explain PL2301").out, HasSubstr("\nwhy "));
  const Outcome unknown = Plumb("explain WallWithoutBodi");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean `WallWithoutBody`?"));
}

TEST_F(Program, OutputThatIsLostIsAnError) {
  const int status = std::system(("'" PLUMB_PROGRAM "' explain PL2301 > /dev/full 2> '" + folder_.path() + "/.err'").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_THAT(Read(".err"), HasSubstr("cannot write to standard output"));
}

TEST_F(Program, InspectWritesEveryForm) {
  const Outcome written = Plumb(
      "inspect house.agraph --svg house.svg --graphml house.graphml --nav2 map --storey 'ground floor' --sensor-height 0.5 --resolution "
      "0.1");
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_THAT(Read("house.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(Read("house.graphml"), HasSubstr("</graphml>"));
  EXPECT_THAT(Read("map/map.yaml"), HasSubstr("image: map.pgm\nmode: trinary\nresolution: 0.1\n"));
  EXPECT_THAT(Read("map/map.pgm"), ::testing::StartsWith("P5\n"));
  EXPECT_THAT(Files(), ::testing::ElementsAre("house.agraph", "house.graphml", "house.svg", "map"));  // nothing left over
  EXPECT_EQ(Json::parse(Plumb("inspect house.agraph --json").out)["rooms"].size(), 3u);
  EXPECT_THAT(Plumb("inspect house.agraph").out, HasSubstr("A - outside, 0.90 m wide"));
  const Outcome no_storey = Plumb("inspect house.agraph --svg other.svg --storey attic");
  EXPECT_EQ(no_storey.status, 2);
  EXPECT_THAT(no_storey.err, HasSubstr("`Ground floor` (0)"));
  EXPECT_FALSE(fs::exists(folder_ / "other.svg"));
  EXPECT_EQ(Plumb("inspect house.agraph --nav2 map --resolution 0").status, 2);
}

TEST_F(Program, InspectSaysWhereItCutsBelowTheHeightAskedFor) {
  EXPECT_EQ(Plumb("inspect house.agraph --svg a.svg --section-height 2.5").err.find("ceilings"), std::string::npos);
  EXPECT_THAT(Plumb("inspect house.agraph --svg a.svg --section-height 2.6").err,
              HasSubstr("Ground floor: cut at 2.50 m, as 2.60 m is above all its rooms or walls"));
}

TEST_F(Program, FlippedBitsAreRefused) {
  const auto bytes = ReadFileBytes(folder_ / "house.agraph");
  ASSERT_TRUE(bytes);
  std::mt19937 random(11);
  for (int round = 0; round < 24; ++round) {
    std::vector<uint8_t> damaged = *bytes;
    // The head, where the format is told, as often as the rest.
    const size_t at = round % 2 == 0 ? random() % 64 : random() % damaged.size();
    damaged[at] ^= static_cast<uint8_t>(1u << (random() % 8));
    ASSERT_TRUE(WriteFileAtomically(folder_ / "damaged.agraph", damaged));
    const Outcome inspect = Plumb("inspect damaged.agraph --svg out.svg");
    EXPECT_EQ(inspect.status, 2) << "byte " << at;
    EXPECT_THAT(inspect.err, HasSubstr("damaged.agraph`: "));
    EXPECT_EQ(Plumb("validate damaged.agraph").status, 2) << "byte " << at;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out.svg"));
}

TEST_F(Program, ConfigFilesHaveTheNamesOfTheFlags) {
  Write("plumb.toml", "[inspect]\nstorey = \"0\"\nresolution = 0.2\n[validate]\nstrict = true\n");
  EXPECT_EQ(Plumb("inspect house.agraph --nav2 map --config plumb.toml").status, 0);
  EXPECT_THAT(Read("map/map.yaml"), HasSubstr("resolution: 0.2\n"));
  EXPECT_EQ(Plumb("validate --config plumb.toml " + golden_ + "PL7103.ifc'").status, 1);
  Write("loud.toml", "quiet = false\n");
  EXPECT_EQ(Plumb("inspect house.agraph --svg a.svg --config loud.toml -q").err, "");
  EXPECT_NE(Plumb("inspect house.agraph --svg a.svg --config loud.toml").err, "");
  Write("wrong.toml", "[inspect]\nresolutoin = 0.2\n");
  const Outcome wrong = Plumb("inspect house.agraph --config wrong.toml");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("`wrong.toml:2`"));
  EXPECT_THAT(wrong.err, HasSubstr("did you mean `resolution`?"));
  EXPECT_EQ(Plumb("inspect house.agraph --config none.toml").status, 2);
}

TEST_F(Program, PrintedConfigNeedsNoInputAndReadsBack) {
  for (const char* subcommand : {"compile", "validate", "inspect", "explain"}) {
    const Outcome printed = Plumb(std::string(subcommand) + " --print-config");
    EXPECT_EQ(printed.status, 0) << printed.err;
    EXPECT_THAT(printed.out, ::testing::StartsWith("[" + std::string(subcommand) + "]\n"));
  }
  Write("full.toml", Plumb("inspect --print-config --resolution 0.25").out);
  EXPECT_EQ(Plumb("inspect house.agraph --nav2 map --config full.toml").status, 0);
  EXPECT_THAT(Read("map/map.yaml"), HasSubstr("resolution: 0.25\n"));
}

TEST_F(Program, QuietLeavesResultsAndErrors) {
  EXPECT_EQ(Plumb("inspect house.agraph --svg a.svg --quiet").err, "");
  EXPECT_NE(Plumb("inspect house.agraph --quiet").out, "");
  EXPECT_THAT(Plumb("inspect missing.agraph --quiet").err, HasSubstr("missing.agraph"));
  EXPECT_EQ(Plumb("compile " + golden_ + "PL7103.ifc' -o a.agraph -q").err, "");
  EXPECT_THAT(Plumb("compile " + golden_ + "PL7103.ifc' -o a.agraph").err, ::testing::Not(HasSubstr("\r")));  // no progress bar in a file
}

TEST_F(Program, HelpHasExamplesAndUsageErrorsAreBadInput) {
  for (const char* subcommand : {"compile", "validate", "inspect", "explain"}) {
    const Outcome help = Plumb(std::string(subcommand) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Examples:\n  plumb " + std::string(subcommand)));
    EXPECT_THAT(help.out, Not(HasSubstr("=[]")));
  }
  EXPECT_EQ(Plumb("validate").status, 2);
  EXPECT_EQ(Plumb("validate house.agraph --format xml").status, 2);
  EXPECT_THAT(Plumb("inspct house.agraph").err, HasSubstr("did you mean `inspect`?"));
}

TEST_F(Program, CompileLeavesNothingHalfWritten) {
  EXPECT_EQ(Plumb("compile " + golden_ + "PL2002.ifc' -o bad.agraph").status, 2);
  EXPECT_EQ(Plumb("compile " + golden_ + "PL7103.ifc' -o no/such/folder.agraph").status, 2);
  EXPECT_THAT(Files(), ::testing::ElementsAre("house.agraph"));
  EXPECT_EQ(Plumb("compile " + golden_ + "PL7103.ifc' -o house.agraph --diagnostics-json d.json").status, 0);
  EXPECT_EQ(Json::parse(Read("d.json"))["exit_status"], 0);
  EXPECT_THAT(Files(), ::testing::ElementsAre("d.json", "house.agraph"));
}

TEST_F(Program, SimulateKeepsRecordingsThatItDidNotWrite) {
  const std::string simulate = "simulate house.agraph --duration 1 --max-duration 1 --deviate 0 -q -o mine";
  fs::create_directories(folder_ / "mine/scans");
  for (const char* file : {"mine/scans/other.pcd", "mine/odometry.tum"}) {
    Write(file, "mine");
    const Outcome refused = Plumb(simulate);
    EXPECT_EQ(refused.status, 2) << file;
    EXPECT_THAT(refused.err, HasSubstr("--force"));
    EXPECT_EQ(Read(file), "mine");
    fs::remove(folder_ / file);
  }
  Write("mine/scans/other.pcd", "mine");
  EXPECT_EQ(Plumb(simulate + " --force").status, 0);
  EXPECT_EQ(Plumb(simulate).status, 0) << "its own";
}

TEST_F(Program, LocalizeSaysAtOnceWhereItCannotWrite) {
  ASSERT_EQ(Plumb("simulate house.agraph --duration 1 --max-duration 1 --deviate 0 -q -o rec").status, 0);
  Write("file", "");
  const Outcome outcome = Plumb("localize house.agraph rec -o file/run");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("file/run"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("localizing")));
}

TEST_F(Program, CompileDoesNotWriteOverThePlan) {
  Write("plan.ifc", ReadFileText(std::string(PLUMB_SOURCE_DIR) + "/tests/compile/golden/diagnostics/PL7103.ifc").value());
  const std::string before = Read("plan.ifc");
  EXPECT_EQ(Plumb("compile plan.ifc -o plan.ifc").status, 2);
  EXPECT_EQ(Read("plan.ifc"), before);
}

}  // namespace
}  // namespace plumb
