// Rooms of a map that the runtime has made itself, on a simulated drive, against rooms of plans.
#include "runtime/matching/graph/graph_search.h"

#include <gtest/gtest.h>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

struct Mapped {
  SGraph map;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
};

const Mapped& MappedHouse() {
  static const Mapped kMapped = [] {
    test::SyntheticLidarOptions lidar_options;
    lidar_options.azimuths = 900;
    const test::SyntheticLidar lidar(test::MakeHouse(), lidar_options);
    const test::Drive drive = test::HouseDrive();
    Odometry odometry;
    Mapper mapper;
    Mapped out;
    for (double t = 0; t + 0.1 < drive.duration_s(); t += 0.1) {
      const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s); }, t), std::nullopt);
      if (t == 0) out.T_plan_map = drive.At(0) * r.T_odom_lidar.inverse();
      mapper.AddScan(r.deskewed, r.T_odom_lidar);
    }
    mapper.Flush();
    out.map = mapper.graph();
    return out;
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
  const MatchResult result = GraphSearch(house).Match(MappedHouse().map);
  ASSERT_EQ(result.verdict, MatchResult::Verdict::kUnique) << result.reason;
  ASSERT_EQ(result.hypotheses.size(), 1u);
  const Eigen::Isometry3d off = MappedHouse().T_plan_map.inverse() * result.hypotheses[0].T_plan_map;
  EXPECT_LT(off.translation().norm(), 0.05);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01);
  EXPECT_EQ(result.hypotheses[0].storey, StoreyId(0));
  EXPECT_GE(result.hypotheses[0].consistent_planes, 10);
}

TEST(GraphSearch, CallsStoreysWithTheSameRoomsAmbiguous) {
  const MatchResult result = GraphSearch(TwoAlikeStoreys()).Match(MappedHouse().map);
  EXPECT_EQ(result.verdict, MatchResult::Verdict::kAmbiguous);
  EXPECT_NE(result.reason.find("storeys"), std::string::npos) << result.reason;
}

TEST(GraphSearch, FindsNothingInAPlanWithoutRoomsOrWithOtherOnes) {
  EXPECT_EQ(GraphSearch(AGraph()).Match(MappedHouse().map).reason, "the plan has no rooms");
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
  EXPECT_EQ(GraphSearch(scaled).Match(MappedHouse().map).verdict, MatchResult::Verdict::kSearching);
  EXPECT_EQ(GraphSearch(test::MakeHouse()).Match(SGraph()).verdict, MatchResult::Verdict::kSearching);
}

}  // namespace
}  // namespace plumb::runtime
