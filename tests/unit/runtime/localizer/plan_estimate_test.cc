#include "runtime/localizer/plan_estimate.h"

#include <gtest/gtest.h>

namespace plumb::runtime {
namespace {

Match MatchOf(uint32_t map_surface, uint32_t plan_surface) {
  Match match;
  match.map_surface = map_surface;
  match.plan_surface = SurfaceId(plan_surface);
  match.mistaken = {0, 2};
  return match;
}

// A surface may be matched to the faces of several walls, and its part may split again.
TEST(FollowSplits, GivesBothPartsTheMatchesOfTheWhole) {
  std::vector<Match> matches = {MatchOf(1, 10), MatchOf(3, 11), MatchOf(3, 12), MatchOf(5, 13)};
  FollowSplits({{3, 0}, {0, 6}}, &matches);
  std::vector<std::pair<uint32_t, size_t>> pairs;
  for (const Match& m : matches) pairs.emplace_back(m.map_surface, m.plan_surface.index());
  const std::vector<std::pair<uint32_t, size_t>> expected = {{0, 11}, {0, 12}, {1, 10}, {3, 11}, {3, 12}, {5, 13}, {6, 11}, {6, 12}};
  EXPECT_EQ(pairs, expected);
  for (const Match& m : matches) {
    const bool whole = m.map_surface == 1 || m.map_surface == 5;
    EXPECT_EQ(m.mistaken.empty(), !whole) << "views of surface " << m.map_surface << " are numbered anew if it was split";
  }
}

TEST(FollowSplits, LeavesMatchesOfWhatWasNotSplit) {
  std::vector<Match> matches = {MatchOf(1, 10), MatchOf(2, 11)};
  FollowSplits({{7, 8}}, &matches);
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].map_surface, 1u);
  EXPECT_EQ(matches[1].map_surface, 2u);
}

}  // namespace
}  // namespace plumb::runtime
