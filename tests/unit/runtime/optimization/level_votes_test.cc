#include "runtime/optimization/level_votes.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

LevelVote Vote(bool floor, double error_m, double share = 1) {
  LevelVote vote;
  vote.floor = floor;
  vote.error_m = error_m;
  vote.share = share;
  return vote;
}

TEST(LevelVotes, EachRoomsFloorHasOneVoteInHoweverManyPieces) {
  const AGraph house = test::MakeHouse();
  test::Drive drive = test::DriveThroughHouse(house);
  std::vector<Eigen::Isometry3d> T_map_kf;
  for (const Keyframe& k : drive.map.keyframes) T_map_kf.push_back(k.T_map_kf);
  const auto floors = [&] {
    std::vector<Match> matches;
    for (const Match& m : MatchSurfaces(drive.map, house, drive.T_plan_map, {})) {
      if (!m.plan_surface.valid()) matches.push_back(m);
    }
    return matches;
  };
  const std::vector<Match> before = floors();
  ASSERT_FALSE(before.empty());
  MapSurface piece = drive.map.surfaces[before.front().map_surface];
  piece.id = static_cast<uint32_t>(drive.map.surfaces.size());
  drive.map.surfaces.push_back(piece);
  const std::vector<Match> matches = floors();
  ASSERT_EQ(matches.size(), before.size() + 1);
  const std::vector<LevelVote> votes = LevelVotes(drive.map, house, matches, T_map_kf, drive.T_plan_map);
  ASSERT_EQ(votes.size(), matches.size());
  std::map<RoomId, double> shares;
  for (const LevelVote& v : votes) {
    shares[matches[v.match].room] += v.share;
    EXPECT_TRUE(v.floor);
    EXPECT_EQ(v.planned_z_m, house.rooms[matches[v.match].room.index()].floor_z_m);
    EXPECT_NEAR(v.error_m, 0, 0.02);
  }
  for (const auto& [room, share] : shares) EXPECT_NEAR(share, 1, 1e-12) << "room " << room.value;
  EXPECT_NEAR(votes.front().share, 0.5, 1e-12);
}

// One floor through all rooms was matched to one of them; in the others a step was seen besides.
TEST(LevelVotes, AFloorThatGoesOnThroughRoomsHasTheVotesOfAllOfThem) {
  const AGraph house = test::MakeHouse();
  test::Drive drive = test::DriveThroughHouse(house);
  std::vector<Eigen::Isometry3d> T_map_kf;
  for (const Keyframe& k : drive.map.keyframes) T_map_kf.push_back(k.T_map_kf);
  std::vector<Match> matches;
  for (const Match& m : MatchSurfaces(drive.map, house, drive.T_plan_map, {})) {
    if (!m.plan_surface.valid()) matches.push_back(m);
  }
  ASSERT_EQ(matches.size(), house.rooms.size());
  MapSurface& floor = drive.map.surfaces[matches.front().map_surface];
  for (size_t i = 1; i < matches.size(); ++i) {
    MapSurface& step = drive.map.surfaces[matches[i].map_surface];
    floor.observations.insert(floor.observations.end(), step.observations.begin(), step.observations.end());
    for (Observation& o : step.observations) o.stats.C = 0.01 * o.stats.Transformed(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.1))).C;
  }
  const std::vector<LevelVote> votes = LevelVotes(drive.map, house, matches, T_map_kf, drive.T_plan_map);
  ASSERT_EQ(votes.size(), matches.size());
  EXPECT_NEAR(votes.front().share, static_cast<double>(house.rooms.size()), 0.05);
  EXPECT_NEAR(ConsensusHeight(votes, 0.015), 0, 0.02);
}

TEST(ConsensusHeight, FollowsTheMajorityOfTheFloors) {
  EXPECT_EQ(ConsensusHeight({}, 0.015), 0);
  EXPECT_NEAR(ConsensusHeight({Vote(true, 0.01), Vote(true, 0.011), Vote(true, 0.2)}, 0.015), 0.01, 0.002);
  EXPECT_NEAR(ConsensusHeight({Vote(true, 0.2, 0.2), Vote(true, 0.0, 0.8)}, 0.015), 0, 1e-12)
      << "a bench is a small piece of its room's floor";
}

TEST(ConsensusHeight, AFloorCountsForMoreThanSomeCeilings) {
  EXPECT_NEAR(ConsensusHeight({Vote(false, -0.2), Vote(true, 0), Vote(false, -0.2), Vote(false, -0.2)}, 0.015), 0, 1e-12);
  EXPECT_NEAR(ConsensusHeight({Vote(false, -0.2), Vote(false, -0.2), Vote(false, 0)}, 0.015), -0.2, 1e-12) << "where no floor is seen";
}

}  // namespace
}  // namespace plumb::runtime
