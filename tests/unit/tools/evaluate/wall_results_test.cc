#include "tools/evaluate/wall_results.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

SurfaceEntry Entry(uint32_t id, const std::string& wall, const std::string& status, double translation_m = 0, double rotation_deg = 0) {
  SurfaceEntry s;
  s.id = SurfaceId(id);
  s.wall_guid = wall;
  s.status = status;
  s.translation_m = translation_m;
  s.rotation_deg = rotation_deg;
  return s;
}

// Wall A (surfaces 0 and 1, seen from either side) is built 20 cm off, wall B (2) 10 cm, wall C (3) is where it should be.
Truth MakeTruth() {
  Truth truth;
  truth.has_walls = true;
  WallTruth a{"A", 0.20, 2, {}};
  a.surfaces[SurfaceId(0)] = {0.20, 2};
  a.surfaces[SurfaceId(1)] = {-0.20, 2};
  WallTruth b{"B", -0.10, 0, {}};
  b.surfaces[SurfaceId(2)] = {-0.10, 0};
  truth.walls = {a, b, WallTruth{"C", 0, 0, {}}};
  return truth;
}

TEST(CompareWalls, TellsFoundMissedAndFalseApart) {
  const Deviations reported{"",
                            {Entry(0, "A", "deviated", 0.19, 2.5), Entry(1, "A", "unobserved"), Entry(2, "B", "as_planned", -0.01),
                             Entry(3, "C", "deviated", 0.06)},
                            {}};
  const auto results = CompareWalls(MakeTruth(), reported, 200, 0.5);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].guid, "A");
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_NEAR(results[0].error_translation_m, 0.01, 1e-12);
  EXPECT_NEAR(results[0].error_rotation_deg, 0.5, 1e-12);
  EXPECT_EQ(results[1].guid, "B");
  EXPECT_EQ(results[1].outcome, WallOutcome::kMissed);
  EXPECT_EQ(results[2].guid, "C");
  EXPECT_EQ(results[2].outcome, WallOutcome::kFalse);
  EXPECT_NEAR(results[2].measured_translation_m, 0.06, 1e-12);
  EXPECT_EQ(results[2].error_translation_m, 0);
}

TEST(CompareWalls, TakesTheWorstReportedSideOfAWall) {
  // The far side has the other sign: its error is 3 cm, not 37.
  const Deviations reported{"", {Entry(0, "A", "deviated", 0.21, 2), Entry(1, "A", "deviated", -0.17, 2)}, {}};
  const auto results = CompareWalls(MakeTruth(), reported, 200, 0.5);
  ASSERT_GE(results.size(), 1u);
  EXPECT_EQ(results[0].surface, SurfaceId(1));
  EXPECT_NEAR(results[0].error_translation_m, 0.03, 1e-12);
  EXPECT_NEAR(results[0].true_translation_m, -0.20, 1e-12);
}

TEST(CompareWalls, TakesASideThatWasSeenBeforeOneThatWasNot) {
  SurfaceEntry seen = Entry(0, "A", "deviated", 0.21, 2), unseen = Entry(1, "A", "deviated", -0.10, 2);
  SurfaceEntry slight = Entry(3, "C", "deviated", 0.05), large = Entry(4, "C", "deviated", -0.3);
  seen.points = slight.points = 500;
  const auto results = CompareWalls(MakeTruth(), {"", {seen, unseen, slight, large}, {}}, 200, 0.5);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].guid, "A");
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_EQ(results[0].surface, SurfaceId(0));
  EXPECT_NEAR(results[0].error_translation_m, 0.01, 1e-12);
  EXPECT_EQ(results[2].outcome, WallOutcome::kFalse);
  EXPECT_EQ(results[2].surface, SurfaceId(3));
}

TEST(CompareWalls, WallsThatTheSensorDidNotSeeAreNotMissed) {
  Truth truth = MakeTruth();
  truth.surface_points = {{SurfaceId(0), 150}, {SurfaceId(1), 50}, {SurfaceId(2), 5000}};
  const Deviations reported{"", {Entry(0, "A", "as_planned"), Entry(1, "A", "unobserved"), Entry(2, "B", "unobserved")}, {}};
  const auto results = CompareWalls(truth, reported, 200, 0.5);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].guid, "B");  // the run calls it unobserved, but thousands of returns say otherwise
  EXPECT_EQ(results[0].outcome, WallOutcome::kUnjudged);
  EXPECT_EQ(results[1].guid, "A");
  EXPECT_EQ(results[1].outcome, WallOutcome::kUnobserved);
}

TEST(CompareWalls, ASliverIsNotObserved) {
  Truth truth = MakeTruth();
  truth.surface_points = {{SurfaceId(0), 5000}, {SurfaceId(1), 100}, {SurfaceId(2), 5000}};
  truth.surface_seen_m2 = {{SurfaceId(0), 0.4}, {SurfaceId(1), 3}, {SurfaceId(2), 0.6}};
  const Deviations reported{"", {Entry(0, "A", "unobserved"), Entry(1, "A", "unobserved"), Entry(2, "B", "unobserved")}, {}};
  const auto results = CompareWalls(truth, reported, 200, 0.5);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kUnjudged);
  EXPECT_EQ(results[0].guid, "B");
  EXPECT_EQ(results[1].outcome, WallOutcome::kUnobserved);
  EXPECT_EQ(results[1].guid, "A");
}

TEST(CompareWalls, WithoutCountsTheRunSaysWhatWasObserved) {
  const Deviations reported{"", {Entry(0, "A", "unobserved"), Entry(1, "A", "as_planned"), Entry(2, "B", "unobserved")}, {}};
  const auto results = CompareWalls(MakeTruth(), reported, 200, 0.5);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kMissed);
  EXPECT_EQ(results[1].outcome, WallOutcome::kUnobserved);
}

// A drawing's walls have no guids: two of them deviate, one is accused wrongly, one stands.
TEST(CompareWalls, WallsWithoutGuidsAreToldApartById) {
  Truth truth;
  truth.has_walls = true;
  truth.walls = {{"", 0.2, 0, {{SurfaceId(0), {0.2, 0}}}, "", WallId(0)}, {"", 0.3, 0, {}, "", WallId(1)}, {"", 0, 0, {}, "", WallId(2)}};
  Deviations reported{"",
                      {Entry(0, "", "deviated", 0.2), Entry(1, "", "as_planned"), Entry(2, "", "as_planned", 0.01),
                       Entry(3, "", "deviated", 0.1), Entry(4, "", "deviated", 0.12), Entry(5, "", "as_planned")},
                      {}};
  const uint32_t walls[] = {0, 0, 1, 2, 2, 3};
  for (size_t i = 0; i < reported.surfaces.size(); ++i) reported.surfaces[i].wall = WallId(walls[i]);
  const auto results = CompareWalls(truth, reported, 200, 0.5);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_EQ(results[0].wall, WallId(0));
  EXPECT_EQ(results[1].outcome, WallOutcome::kMissed);
  EXPECT_EQ(results[1].wall, WallId(1));
  EXPECT_EQ(results[2].outcome, WallOutcome::kFalse);
  EXPECT_EQ(results[2].wall, WallId(2));
  EXPECT_EQ(results[2].surface, SurfaceId(4));
}

TEST(CompareWalls, SurfacesThatTellNoWallBelongWhereTheTruthListsThemOrToNone) {
  Truth truth;
  truth.has_walls = true;
  truth.walls = {{"", 0.2, 0, {{SurfaceId(0), {0.2, 0}}}, "", WallId(0)}};
  const Deviations reported{"", {Entry(0, "", "deviated", 0.2), Entry(1, "", "deviated", 0.1), Entry(2, "", "deviated", 0.1)}, {}};
  const auto results = CompareWalls(truth, reported, 200, 0.5);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_EQ(results[1].outcome, WallOutcome::kFalse);
  EXPECT_EQ(results[2].outcome, WallOutcome::kFalse);
}

TEST(CompareWalls, ADisplacementThatIsFarOffIsNotFound) {
  SurfaceEntry a = Entry(0, "A", "deviated", 0.26, 2), b = Entry(2, "B", "deviated", -0.15);
  b.sigma_translation_m = 0.03;
  const Deviations reported{"", {a, b}, {}};
  const auto results = CompareWalls(MakeTruth(), reported, 200, 0.5);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);  // 5 cm off, but it says that it may be
  EXPECT_EQ(results[0].guid, "B");
  EXPECT_EQ(results[1].outcome, WallOutcome::kInaccurate);
  EXPECT_NEAR(results[1].error_translation_m, 0.06, 1e-12);
}

TEST(CompareWalls, AWallThatTheRunDoesNotKnowIsUnobserved) {
  const auto results = CompareWalls(MakeTruth(), {}, 200, 0.5);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kUnobserved);
}

TEST(ParseTruth, ReadsWallsAndPointCounts) {
  const auto truth =
      ParseTruth(R"({"version":1,"walls":[{"wall_guid":"A","wall_id":5,"wall_name":"south wall","translation_m":0.2,"rotation_deg":-1.5,
    "surfaces":[{"id":7,"translation_m":-0.2,"rotation_deg":-1.5}]}],"surface_points":{"7":1234},"surface_seen_m2":{"7":2.5}})",
                 "truth.json");
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->walls.size(), 1u);
  EXPECT_EQ(truth->walls[0].name, "south wall");
  EXPECT_EQ(truth->walls[0].wall, WallId(5));
  EXPECT_EQ(truth->walls[0].surfaces.at(SurfaceId(7)).translation_m, -0.2);
  EXPECT_EQ(truth->surface_points.at(SurfaceId(7)), 1234);
  EXPECT_EQ(truth->surface_seen_m2.at(SurfaceId(7)), 2.5);
  EXPECT_TRUE(truth->walls[0].deviates());
}

TEST(ParseTruth, RefusesWhatItCannotRead) {
  EXPECT_FALSE(ParseTruth("{", "truth.json"));
  EXPECT_FALSE(ParseTruth(R"({"version":2,"walls":[]})", "truth.json"));
  EXPECT_FALSE(ParseTruth(R"({"version":1})", "truth.json"));
  EXPECT_FALSE(ParseTruth(R"({"version":1,"walls":[],"surface_points":{"x7":1}})", "truth.json"));
  EXPECT_FALSE(ParseTruth(R"({"version":1,"walls":[],"surface_seen_m2":{"x7":1}})", "truth.json"));
  EXPECT_EQ(ReadTruth("/nonexistent").error().code, ErrorCode::kNotARecording);
}

}  // namespace
}  // namespace plumb::tools
