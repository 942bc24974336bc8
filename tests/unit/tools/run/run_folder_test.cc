#include "tools/run/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "schema/files.h"
#include "tests/support/temporary_folder.h"
#include "tools/run/ply.h"
#include "tools/run/run_info.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Verdicts, ReadBackAsWritten) {
  const std::vector<VerdictRow> rows = {
      {1700000000.123456, "searching", 0}, {1700000000.223456, "ambiguous", 3}, {1700000000.323456, "localized", 1}};
  const std::string csv = VerdictsToCsv(rows);
  EXPECT_THAT(csv, StartsWith("t,verdict,hypotheses\n1700000000.123456001,searching,0\n"));
  const auto read = ParseVerdicts(csv, "verdicts.csv");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 3u);
  EXPECT_EQ((*read)[1].verdict, "ambiguous");
  EXPECT_EQ((*read)[1].hypotheses, 3);
  EXPECT_EQ((*read)[2].stamp_s, rows[2].stamp_s);
}

TEST(Verdicts, NameTheBadLine) {
  EXPECT_FALSE(ParseVerdicts("", "v.csv"));
  EXPECT_FALSE(ParseVerdicts("stamp,verdict\n", "v.csv"));
  for (const char* line : {"1.0,found,1", "1.0,lost", "x,lost,1", "1.0,lost,1,2"}) {
    const auto read = ParseVerdicts("t,verdict,hypotheses\n0.5,lost,0\n" + std::string(line) + "\n", "v.csv");
    ASSERT_FALSE(read) << line;
    EXPECT_THAT(read.error().message, HasSubstr("v.csv:3"));
  }
}

TEST(Deviations, ReadsTheFileOfTheDesign) {
  const auto d = ParseDeviations(
      R"({"version":1,"gauge":"fewest walls","surfaces":[{"id":17,"wall_id":4,"wall_guid":"2O2Fr$t4X7Zf8NOew3FLOH","storey":"EG",
    "normal":[1,0,0],"status":"deviated","translation_m":0.203,"sigma_translation_m":0.004,"rotation_deg":0.4,"sigma_rotation_deg":0.1,
    "tilt_deg":0.0,"p_deviated":0.999,"observed_m2":6.1,"points":8123},{"id":18,"wall_guid":null,"status":"unobserved","unjudged":"uncertain","translation_m":null}],
    "rooms":[{"id":3,"name":"Bad","guid":null,"translation_m":[0.1,-0.2],"rotation_deg":1.0,"sigma_m":0.005,"status":"as_planned"}],"unplanned":[]})",
      "deviations.json");
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_EQ(d->gauge, "fewest walls");
  ASSERT_EQ(d->surfaces.size(), 2u);
  EXPECT_EQ(d->surfaces[0].id, SurfaceId(17));
  EXPECT_EQ(d->surfaces[0].wall, WallId(4));
  EXPECT_FALSE(d->surfaces[1].wall.valid());
  EXPECT_EQ(d->surfaces[0].translation_m, 0.203);
  EXPECT_EQ(d->surfaces[0].points, 8123);
  EXPECT_EQ(d->surfaces[1].translation_m, 0);
  EXPECT_EQ(d->surfaces[1].unjudged, "uncertain");
  EXPECT_EQ(d->surfaces[0].unjudged, "");
  EXPECT_EQ(d->rooms.at(0).translation_m.y(), -0.2);
}

TEST(Deviations, RefuseOtherFiles) {
  EXPECT_FALSE(ParseDeviations("[]", "d.json"));
  EXPECT_FALSE(ParseDeviations(R"({"version":2,"surfaces":[],"rooms":[]})", "d.json"));
  EXPECT_FALSE(ParseDeviations(R"({"version":1,"surfaces":[{"id":-1,"status":3}],"rooms":[]})", "d.json"));
}

TEST(RunInfo, ReadsBackAsWritten) {
  RunInfo info;
  info.plumb_version = "0.1.0";
  info.plan_path = "/a/b.agraph";
  info.plan_source = "b \"quoted\".ifc";
  info.options = {{"tolerance", "0.02"}, {"room", "[\"5\"]"}, {"quiet", "false"}, {"near", ""}, {"updates", "\"\xe4\""}};
  info.time_to_localize_s = 4.25;
  info.scans = 1200;
  info.last_reason = "";
  info.matcher = "graph";
  const auto read = ParseRunInfo(RunInfoToJson(info), "run.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(RunInfoToJson(*read), RunInfoToJson(info));
  EXPECT_THAT(RunInfoToJson(info),
              HasSubstr("\"tolerance\": 0.02,\n  \"room\": [\n   \"5\"\n  ],\n  \"quiet\": false,\n  \"near\": null,"));
  EXPECT_EQ(read->plan_source, info.plan_source);
  EXPECT_EQ(read->time_to_localize_s, info.time_to_localize_s);
  EXPECT_EQ(read->matcher, "graph");
  EXPECT_FALSE(read->pace);
  info.time_to_localize_s = 1051.8 - 1000;  // 51.799999999999955
  EXPECT_THAT(RunInfoToJson(info), HasSubstr("\"time_to_localize_s\": 51.8,"));
  info.time_to_localize_s.reset();
  EXPECT_FALSE(ParseRunInfo(RunInfoToJson(info), "run.json")->time_to_localize_s.has_value());
}

TEST(RunInfo, SaysHowARunAtARobotsPaceKeptUp) {
  RunInfo info;
  std::vector<double> latencies_ms;
  for (int i = 0; i <= 100; ++i) latencies_ms.push_back(100 - i);
  info.pace = PaceOf(latencies_ms);
  EXPECT_EQ(info.pace->latency_p50_ms, 50);
  EXPECT_EQ(info.pace->latency_p99_ms, 99);
  info.pace->held_solves = 7;
  const auto read = ParseRunInfo(RunInfoToJson(info), "run.json");
  ASSERT_TRUE(read && read->pace);
  EXPECT_EQ(read->pace->latency_p99_ms, 99);
  EXPECT_EQ(read->pace->held_solves, 7u);
  EXPECT_EQ(PaceOf({}).latency_p50_ms, 0);
}

TEST(ReadRun, NamesTheMissingFile) {
  const auto none = ReadRun("/nonexistent");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kBadRunFolder);
  EXPECT_THAT(none.error().message, HasSubstr("verdicts.csv"));
}

TEST(ReadRun, TakesARunWithoutAFix) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  const auto write = [&](const char* name, const std::string& text) {
    ASSERT_TRUE(WriteFileAtomically((folder / name).string(), std::string_view(text)));
  };
  write("verdicts.csv", "t,verdict,hypotheses\n1.000000000,searching,0\n");
  write("deviations.json", R"({"version":1,"gauge":"","surfaces":[],"rooms":[],"unplanned":[]})");
  write("trajectory.tum", "");
  write("trajectory_smoothed.tum", "");
  const auto run = ReadRun(folder.string());
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_TRUE(run->online.empty());
  EXPECT_EQ(run->verdicts.size(), 1u);
  std::filesystem::remove(folder / "trajectory.tum");
  EXPECT_FALSE(ReadRun(folder.string()));
}

TEST(Ply, HasOneRecordOfThreeDoublesPerPoint) {
  const std::string ply = PointsToPly({{1, 2, 3}, {400000.125, -5, 6}}, "test");
  EXPECT_THAT(ply, StartsWith("ply\nformat binary_little_endian 1.0\ncomment test\nelement vertex 2\n"));
  const size_t body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size() - body, 48u);
  double x = 0;
  std::memcpy(&x, ply.data() + body + 24, sizeof x);
  EXPECT_EQ(x, 400000.125);
}

}  // namespace
}  // namespace plumb::tools
