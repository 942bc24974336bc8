#include "tools/evaluate/wall_changes.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

SurfaceEntry Entry(const std::string& wall, const std::string& status) {
  SurfaceEntry s;
  s.wall_guid = wall;
  s.status = status;
  return s;
}

std::vector<Eigen::Vector2d> Box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

TEST(CompareMissing, TellsFoundMissedUnobservedAndFalseApart) {
  Truth truth;
  truth.missing = {{"A", 5000}, {"B", 5000}, {"C", 20}};
  const Deviations reported{
      "", {Entry("A", "missing"), Entry("A", "missing"), Entry("B", "as_planned"), Entry("C", "unobserved"), Entry("D", "missing")}, {}};
  const auto results = CompareMissing(truth, reported, 200, true);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_EQ(results[0].guid, "A");
  EXPECT_EQ(results[1].outcome, WallOutcome::kMissed);
  EXPECT_EQ(results[2].outcome, WallOutcome::kUnobserved);
  EXPECT_EQ(results[3].outcome, WallOutcome::kFalse);
  EXPECT_EQ(results[3].guid, "D");
  EXPECT_EQ(Recall(results), 0.5);
  EXPECT_EQ(Precision(results), 0.5);
}

TEST(CompareMissing, WallsWithoutGuidsAreToldApartById) {
  Truth truth;
  truth.missing = {{"", 5000, WallId(1)}, {"", 5000, WallId(2)}};
  Deviations reported{"", {Entry("", "missing"), Entry("", "missing"), Entry("", "missing")}, {}};
  reported.surfaces[0].wall = WallId(1);
  reported.surfaces[1].wall = reported.surfaces[2].wall = WallId(3);
  const auto results = CompareMissing(truth, reported, 200, true);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].outcome, WallOutcome::kFound);
  EXPECT_EQ(results[0].wall, WallId(1));
  EXPECT_EQ(results[1].outcome, WallOutcome::kMissed);
  EXPECT_EQ(results[1].wall, WallId(2));
  EXPECT_EQ(results[2].outcome, WallOutcome::kFalse);
  EXPECT_EQ(results[2].wall, WallId(3));
}

TEST(CompareUnplanned, IsFoundIfHalfOfItsLengthIsCoveredWithinTenCentimetres) {
  Truth truth;
  truth.unplanned = {{Box(0, 0, 2, 0.1), 1000}};
  const auto outcome = [&](const std::vector<Eigen::Vector2d>& polygon) {
    Deviations reported;
    reported.unplanned = {{polygon, 2.5, RoomId()}};
    return CompareUnplanned(truth, reported, 200, true);
  };
  EXPECT_EQ(outcome(Box(0.9, 0.08, 2, 0.2)).front().outcome, WallOutcome::kFound);  // 3 cm off, and more than half of it
  EXPECT_EQ(outcome(Box(1.2, 0, 2, 0.1)).front().outcome, WallOutcome::kMissed);    // too short
  EXPECT_EQ(outcome(Box(1.2, 0, 2, 0.1)).size(), 1u);                               // but not made up
  EXPECT_EQ(outcome(Box(0, 0.2, 2, 0.3)).front().outcome, WallOutcome::kMissed);    // 15 cm off
  ASSERT_EQ(outcome(Box(0, 0.2, 2, 0.3)).size(), 2u);
  EXPECT_EQ(outcome(Box(0, 0.2, 2, 0.3)).back().outcome, WallOutcome::kFalse);
  truth.unplanned[0].points = 10;
  EXPECT_EQ(outcome(Box(5, 5, 7, 5.1)).front().outcome, WallOutcome::kUnobserved);
}

TEST(CompareUnplanned, APolygonCoversWhatIsInsideIt) {
  Truth truth;
  truth.unplanned = {{Box(0, 0, 2, 0.1), 1000}};
  Deviations reported;
  reported.unplanned = {{Box(-1, -1, 3, 1), 2.5, RoomId()}};  // no side of it within ten centimetres
  EXPECT_EQ(CompareUnplanned(truth, reported, 200, true).front().outcome, WallOutcome::kFound);
}

TEST(CompareChanges, ARunThatNeverLocalizedMissesNothing) {
  Truth truth;
  truth.missing = {{"A", 5000}};
  truth.unplanned = {{Box(0, 0, 2, 0.1), 5000}};
  for (const auto& results : {CompareMissing(truth, {}, 200, false), CompareUnplanned(truth, {}, 200, false)}) {
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].outcome, WallOutcome::kUnobserved);
    EXPECT_EQ(Recall(results), 1);
  }
}

TEST(ParseTruth, ReadsMissingAndUnplannedWalls) {
  const auto truth = ParseTruth(R"({"version":1,"walls":[],"missing":[{"wall_guid":"A","wall_id":3,"wall_name":"w","rays_through":77}],
    "unplanned":[{"polygon":[[0,0],[1,0],[1,0.1]],"height_m":2.5,"points":99}]})",
                                "truth.json");
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->missing.size(), 1u);
  EXPECT_EQ(truth->missing[0].guid, "A");
  EXPECT_EQ(truth->missing[0].rays_through, 77);
  EXPECT_EQ(truth->missing[0].wall, WallId(3));
  ASSERT_EQ(truth->unplanned.size(), 1u);
  EXPECT_EQ(truth->unplanned[0].points, 99);
  EXPECT_FALSE(ParseTruth(R"({"version":1,"walls":[],"unplanned":[{"polygon":[[0,0]],"height_m":2.5,"points":9}]})", "truth.json"));
}

}  // namespace
}  // namespace plumb::tools
