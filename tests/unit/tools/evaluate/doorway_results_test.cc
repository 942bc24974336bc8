#include "tools/evaluate/doorway_results.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

DoorwayEntry Entry(uint32_t id, const std::string& status, double shift_m, double width_deviation_m) {
  DoorwayEntry d;
  d.id = DoorwayId(id);
  d.status = status;
  d.shift_m = shift_m;
  d.width_deviation_m = width_deviation_m;
  d.sigma_shift_m = d.sigma_width_m = 0.005;
  return d;
}

TEST(CompareDoorways, TellsFoundMissedFalseAndUnobservedApart) {
  Truth truth;
  truth.doorways = {{DoorwayId(0), "A", 0.1, 0, 5000},  {DoorwayId(1), "B", 0, -0.05, 5000}, {DoorwayId(2), "C", 0, 0, 5000},
                    {DoorwayId(3), "D", 0.2, 0, 10},    {DoorwayId(4), "E", 0.2, 0, 5000},   {DoorwayId(5), "F", 0.2, 0, 5000},
                    {DoorwayId(6), "G", 0.02, 0, 5000}};
  Deviations reported;
  reported.doorways = {Entry(0, "deviated", 0.104, 0.002), Entry(1, "as_planned", 0, -0.01), Entry(2, "deviated", 0.05, 0),
                       Entry(3, "unobserved", 0, 0),       Entry(4, "unobserved", 0, 0),     Entry(5, "deviated", 0.1, 0),
                       Entry(6, "deviated", 0.025, 0)};
  const DoorwayScore score = CompareDoorways(truth, reported, 200, true);
  const auto outcome = [&](const std::string& guid) {
    for (const DoorwayResult& r : score.results) {
      if (r.guid == guid) return std::string(WallOutcomeName(r.outcome));
    }
    return std::string("none");
  };
  EXPECT_EQ(outcome("A"), "found");
  EXPECT_EQ(outcome("B"), "missed");
  EXPECT_EQ(outcome("C"), "false");
  EXPECT_EQ(outcome("D"), "unobserved");
  EXPECT_EQ(outcome("E"), "unjudged");
  EXPECT_EQ(outcome("F"), "inaccurate");
  EXPECT_EQ(outcome("G"), "none");  // between as planned and deviated
  EXPECT_EQ(score.measured, 5u);
  EXPECT_DOUBLE_EQ(score.precision, 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.recall, 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.max_error_m, 0.1);
  EXPECT_DOUBLE_EQ(score.coverage, 0.7);
}

TEST(CompareDoorways, ARunThatNeverLocalizedMissesNothing) {
  Truth truth;
  truth.doorways = {{DoorwayId(0), "A", 0.1, 0, 5000}};
  const DoorwayScore score = CompareDoorways(truth, {}, 200, false);
  EXPECT_EQ(score.Count(WallOutcome::kUnobserved), 1u);
  EXPECT_EQ(score.recall, 1);
}

TEST(ParseTruth, ReadsDoorways) {
  const auto truth = ParseTruth(
      R"({"version": 1, "walls": [], "doorways": [{"id": 3, "guid": "D", "shift_m": 0.1, "width_deviation_m": -0.05, "rays_through": 70}]})", "t");
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->doorways.size(), 1u);
  EXPECT_EQ(truth->doorways[0].id, DoorwayId(3));
  EXPECT_EQ(truth->doorways[0].width_deviation_m, -0.05);
}

}  // namespace
}  // namespace plumb::tools
