#include "runtime/deviations/face_grid.h"

#include <gtest/gtest.h>

#include "runtime/coupling/wall_frame.h"
#include "tests/unit/runtime/deviations/built_house.h"

namespace plumb::runtime {
namespace {

constexpr double kCell_m = 0.25, kMargin_m = 0.15;

// Solid cells of wall-across, which runs along x and ends at wall-middle (x = 5), from x = `from_m` on.
int SolidBeyond(const AGraph& plan, const std::vector<FaceGrid>& grids, double from_m) {
  int solid = 0;
  for (const FaceGrid& g : grids) {
    if (plan.walls[g.wall.index()].guid != "wall-across") continue;
    for (size_t i = 0; i < g.cells.size(); ++i) {
      const Eigen::Vector2d at = g.panel.start + g.MiddleOf(static_cast<int>(i) % g.columns) * g.panel.along;
      solid += g.cells[i].solid && at.x() > from_m ? 1 : 0;
    }
  }
  return solid;
}

// wall-middle, of which so much was seen, stands `x_m` further along x than planned.
JointResult MiddleStandsAt(const AGraph& plan, double x_m, double observed_m2) {
  WallEstimate wall;
  wall.wall = WallId(test::WallOf(plan, "wall-middle"));
  const WallFrame frame = WallFrames(plan)[wall.wall.index()];
  wall.reference = frame.reference;
  wall.observed_m2 = observed_m2;
  wall.deviation.offset_m = x_m * frame.normal.x();
  JointResult out;
  out.walls.push_back(wall);
  return out;
}

TEST(LeaveOutCutEnds, AWallEndsWhereTheNextOneWasBuilt) {
  const AGraph plan = test::MakeHouse();
  const std::vector<FaceGrid> planned = MakeFaceGrids(plan, kCell_m, kMargin_m);
  ASSERT_GT(SolidBeyond(plan, planned, 4.1), 0);
  std::vector<FaceGrid> cut = planned;
  LeaveOutCutEnds(plan, MiddleStandsAt(plan, -0.9, 5), 0.5, cut);
  EXPECT_EQ(SolidBeyond(plan, cut, 4.1), 0);
  EXPECT_EQ(SolidBeyond(plan, cut, 0), SolidBeyond(plan, planned, 0) - SolidBeyond(plan, planned, 3.8));
}

TEST(LeaveOutCutEnds, OneThatWasBuiltFartherOffOrIsNotKnownCutsNothing) {
  const AGraph plan = test::MakeHouse();
  const std::vector<FaceGrid> planned = MakeFaceGrids(plan, kCell_m, kMargin_m);
  std::vector<FaceGrid> away = planned, unknown = planned;
  LeaveOutCutEnds(plan, MiddleStandsAt(plan, 0.9, 5), 0.5, away);
  LeaveOutCutEnds(plan, MiddleStandsAt(plan, -0.9, 0.1), 0.5, unknown);
  EXPECT_EQ(SolidBeyond(plan, away, 0), SolidBeyond(plan, planned, 0));
  EXPECT_GT(SolidBeyond(plan, planned, 4.1), 0) << "there is something to cut";
  EXPECT_EQ(SolidBeyond(plan, unknown, 0), SolidBeyond(plan, planned, 0));
}

}  // namespace
}  // namespace plumb::runtime
