#include "runtime/matching/graph/graph_search.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"
#include "tests/support/synthetic_map.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

const Eigen::Isometry3d kPlanFromMap = test::UprightPose(137, 4, -2, 0.6);

// Seen from all rooms.
const SGraph& MappedHouse() {
  static const SGraph kMapped = [] {
    test::SyntheticMapOptions options;
    options.positions = {{1, 1}, {2.5, 1.7}, {4, 2.5}, {2.45, 3.5}, {2.4, 4.5}, {4, 5}, {1, 5}, {5, 2.75}, {6, 2.7}, {7, 1.5}, {7, 4.5}};
    options.T_plan_map = kPlanFromMap;
    SGraph map = test::MakeSyntheticMap(test::MakeHouse(), options);
    for (MapSurface& s : map.surfaces) {
      s.observations.emplace_back();
      if (s.kind == SurfaceKind::kWall) test::FillCells(s);
    }
    return map;
  }();
  return kMapped;
}

// The house with the same rooms once more, upstairs.
AGraph TwoAlikeStoreys() {
  AGraph plan = test::MakeHouse();
  const size_t rooms = plan.rooms.size(), surfaces = plan.surfaces.size();
  plan.storeys.push_back(plan.storeys.front());
  for (size_t i = 0; i < rooms; ++i) {
    Room room = plan.rooms[i];
    room.storey = StoreyId(1);
    room.floor_z_m += 3;
    room.ceiling_z_m += 3;
    for (SurfaceId& id : room.surfaces) id = SurfaceId(id.index() + surfaces);
    plan.rooms.push_back(room);
  }
  for (size_t i = 0; i < surfaces; ++i) {
    plan.surfaces.push_back(plan.surfaces[i]);
    plan.surfaces.back().storey = StoreyId(1);
  }
  return plan;
}

TEST(GraphSearch, FindsTheMapInThePlan) {
  AGraph house = test::MakeHouse();
  house.origin = {4, 2, 1};
  const MatchResult result = GraphSearch(house).Match(MappedHouse());
  ASSERT_EQ(result.verdict, MatchResult::Verdict::kUnique) << result.reason;
  ASSERT_EQ(result.hypotheses.size(), 1u);
  const Eigen::Isometry3d off = kPlanFromMap.inverse() * result.hypotheses[0].T_plan_map;
  EXPECT_LT(off.translation().norm(), 0.05);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01);
  EXPECT_EQ(result.hypotheses[0].storey, StoreyId(0));
  EXPECT_GE(result.hypotheses[0].consistent_planes, 10);
}

TEST(GraphSearch, CallsStoreysWithTheSameRoomsAmbiguous) {
  const MatchResult result = GraphSearch(TwoAlikeStoreys()).Match(MappedHouse());
  EXPECT_EQ(result.verdict, MatchResult::Verdict::kAmbiguous);
  EXPECT_NE(result.reason.find("storeys"), std::string::npos) << result.reason;
}

TEST(GraphSearch, FindsNothingInAPlanWithoutRoomsOrWithOtherOnes) {
  EXPECT_EQ(GraphSearch(AGraph()).Match(MappedHouse()).reason, "the plan has no rooms");
  AGraph scaled = test::MakeHouse();
  for (Surface& s : scaled.surfaces) {
    s.start *= 1.3;
    s.end *= 1.3;
    s.d_m *= 1.3;
  }
  for (Room& r : scaled.rooms) {
    r.center *= 1.3;
    r.area_m2 *= 1.69;
  }
  EXPECT_EQ(GraphSearch(scaled).Match(MappedHouse()).verdict, MatchResult::Verdict::kSearching);
  EXPECT_EQ(GraphSearch(test::MakeHouse()).Match(SGraph()).verdict, MatchResult::Verdict::kSearching);
}

}  // namespace
}  // namespace plumb::runtime
