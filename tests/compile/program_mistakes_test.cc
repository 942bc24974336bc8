// What people give the program by mistake, and what it says then.
#include <gmock/gmock.h>

#include "tests/compile/program_fixture.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::Not;

class Mistakes : public test::ProgramFixture {
 protected:
  void SetUp() override {
    ProgramFixture::SetUp();
    ASSERT_EQ(Plumb("simulate house.agraph --duration 1 --max-duration 1 --deviate 0 -q -o rec").status, 0);
  }
  // That it is refused as bad input, with these words, and leaves nothing.
  void ExpectRefused(const std::string& arguments, const std::string& words) {
    const std::vector<std::string> before = Files();
    const Outcome outcome = Plumb(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(Files(), before) << arguments;
  }
};

TEST_F(Mistakes, AWordThatIsNoSubcommandIsNamed) {
  ExpectRefused("inspct house.agraph", "there is no subcommand `inspct`; did you mean `inspect`?");
  ExpectRefused("frobnicate", "there is no subcommand `frobnicate`; there are compile, validate, inspect, simulate, localize");
  ExpectRefused("--quiet", "a subcommand is required: compile, ");
}

TEST_F(Mistakes, HelpIsGivenHoweverItIsAskedFor) {
  for (const char* asked : {"help inspect", "inspect --help", "help localize", "help"}) {
    const Outcome help = Plumb(asked);
    EXPECT_EQ(help.status, 0) << asked;
    EXPECT_THAT(help.out, HasSubstr("Usage: plumb ")) << asked;
  }
}

TEST_F(Mistakes, HintsThatThePlanDoesNotHaveAreRefused) {
  ExpectRefused("localize house.agraph rec -o run --near 100,2",
                "--near 100.00,2.00; must be in the plan, which reaches from -0.30,-0.30 to 9.");
  ExpectRefused("localize house.agraph rec -o run --room Z", "--room Z: the plan has no such room, but `A`, ");
}

TEST_F(Mistakes, ThingsOfAnotherKindAreNamedWithTheCommandThatWasMeant) {
  Write("plan.ifc", "ISO-10303-21;\n");
  Write("tour.bag", "#ROSBAG V2.0\n");
  ExpectRefused("localize rec house.agraph -o run",
                "`rec` is a recording and `house.agraph` is an A-Graph: they are asked for the other way round");
  ExpectRefused("localize plan.ifc rec -o run",
                "`plan.ifc` is a plan, not an A-Graph; `plumb compile plan.ifc -o plan.agraph` makes an A-Graph of it");
  ExpectRefused("localize house.agraph rec/scans/ -o run", "the recording is the folder around it, `rec`");
  ExpectRefused("localize house.agraph tour.bag -o run", "bags and packets are not read");
  ExpectRefused("localize house.agraph none -o run", "there is no file or folder `none`");
  ExpectRefused("simulate plan.ifc -o other", "`plumb compile plan.ifc");
  ExpectRefused("inspect rec", "`plumb doctor rec`");
  ExpectRefused("compile house.agraph -o other.agraph", "`plumb inspect house.agraph`");
  ExpectRefused("compile rec -o other.agraph", "`plumb doctor rec`");
  ExpectRefused("validate rec", "`rec` is a recording, not a plan");
  ExpectRefused("doctor house.agraph", "`plumb validate house.agraph`");
  ExpectRefused("report rec -o report.html", "`plumb localize FILE.agraph rec -o RUN`");
  ExpectRefused("evaluate house.agraph --truth rec", "`house.agraph` is an A-Graph, not the folder of a run");
}

TEST_F(Mistakes, AStartBehindTheEndOfARecordingIsToldItsLength) {
  ExpectRefused("localize house.agraph rec -o run --start 7", "--start 7; must be within the recording, which is 0.9 s long");
}

TEST_F(Mistakes, NoEmptyFolderStaysOfWhatFails) {
  ExpectRefused("localize house.agraph rec -o deep/run --updates none/updates.jsonl", "none/updates.jsonl");
  ExpectRefused("simulate house.agraph --deviate 99 -o deep/rec", "of 99 walls can deviate");
  ExpectRefused("inspect house.agraph --nav2 deep/map --resolution 0.001 --storey 9", "no storey is `9`");
  for (const auto& scan : fs::directory_iterator(folder_ / "rec/scans")) fs::resize_file(scan.path(), 10);
  ExpectRefused("localize house.agraph rec -o deep/run", "skipped");
}

TEST_F(Mistakes, OutputsThatCannotBeWrittenAreToldBeforeTheWork) {
  ExpectRefused("compile " + golden_ + "PL7103.ifc' -o none/a.agraph", "--output none/a.agraph; there is no folder `none`");
  ExpectRefused("compile " + golden_ + "PL7103.ifc' -o rec", "--output rec; is a folder");
  ExpectRefused("simulate house.agraph -o ''", "--output: must not be empty");
}

TEST_F(Mistakes, DoctorSeesPastAMisnamedScanAndABrokenOdometry) {
  for (const char* name : {"b.pcd", "a.pcd"})
    fs::copy_file(fs::directory_iterator(folder_ / "rec/scans")->path(), folder_ / (std::string("rec/scans/") + name));
  Write("rec/odometry.tum", "1 2 3\n");
  const Outcome outcome = Plumb("doctor rec");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("scans      10, 0.9 s"));
  EXPECT_THAT(outcome.out, HasSubstr("finding: 2 scans with bad names, the first: `rec/scans/a.pcd`: "));
  EXPECT_THAT(outcome.out, HasSubstr("finding: `rec/odometry.tum` line 1"));
  EXPECT_THAT(outcome.out, HasSubstr("odometry   cannot be read\n"));
  EXPECT_THAT(outcome.out, HasSubstr("truth      yes\n"));
}

}  // namespace
}  // namespace plumb
