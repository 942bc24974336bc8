// Plans that are not the building's must never be accepted.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::OnTour;
using test::UprightPose;

SGraph HouseMap(const test::Tour& tour, uint64_t seed) {
  test::Random random(seed);
  const double yaw_deg = random.Uniform(-180, 180), x_m = random.Uniform(-20, 20), y_m = random.Uniform(-20, 20);
  return MakeSyntheticMap(test::MakeHouse(), OnTour(tour, UprightPose(yaw_deg, x_m, y_m, 0), seed));
}

const std::vector<test::Tour> kTours{test::kFromA, test::kFromB, test::kFromC, test::kWholeHouse, {{2.5, 4.7}, {1.0, 5.0}}};

void ExpectNeverUnique(const AGraph& plan, uint64_t seed) {
  const Matcher matcher(plan);
  for (const test::Tour& tour : kTours) {
    const MatchResult result = matcher.Match(HouseMap(tour, seed++));
    EXPECT_NE(result.verdict, MatchResult::Verdict::kUnique) << "tour of " << tour.size() << ", seed " << seed - 1;
  }
}

TEST(WrongPlan, MirroredIsNeverAccepted) {
  for (uint64_t seed : {1, 20, 40}) ExpectNeverUnique(test::Mirrored(test::MakeHouse()), seed);
}

TEST(WrongPlan, ThreePercentTooLargeOrSmallIsNeverAccepted) {
  for (uint64_t seed : {1, 20}) {
    ExpectNeverUnique(test::Scaled(test::MakeHouse(), 1.03), seed);
    ExpectNeverUnique(test::Scaled(test::MakeHouse(), 1 / 1.03), seed);
  }
}

TEST(WrongPlan, AnotherBuildingIsNeverAccepted) {
  for (uint64_t seed = 1; seed <= 6; ++seed) ExpectNeverUnique(test::MakeRandomPlan(seed, 4, 3), 10 * seed);
}

TEST(WrongPlan, ALargeBuildingWithManyRoomsIsNeverAccepted) {
  for (uint64_t seed = 1; seed <= 2; ++seed) ExpectNeverUnique(test::MakeRandomPlan(seed, 12, 8), 10 * seed);
}

}  // namespace
}  // namespace plumb::runtime
