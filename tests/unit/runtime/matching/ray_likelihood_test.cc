#include "runtime/matching/ray_likelihood.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::OnTour;
using test::UprightPose;

PlanarPose At(const MapView& view, double x_m, double y_m, double yaw_rad = 0) {
  PlanarPose pose;
  pose.yaw_rad = yaw_rad;
  pose.t_m = view.center_m + Eigen::Vector2d(x_m, y_m);
  return pose;
}

MapView ViewOf(const AGraph& built, const test::Tour& tour) {
  return ViewMap(MakeSyntheticMap(built, OnTour(tour, UprightPose(0, 0, 0, 0))), MatcherOptions());
}

TEST(RayModel, HitDensityIntegratesToOne) {
  const RayModel model;
  for (double incidence : {1.0, 0.5, 0.3}) {
    double sum = 0;
    for (double z = 0; z < 12; z += 0.002) sum += 0.002 * model.HitDensity(z, 5, incidence, 0);
    EXPECT_NEAR(sum, 1.0, 1e-3);
  }
  EXPECT_EQ(model.HitDensity(5, -1, 1, 0), 0);
  EXPECT_GT(model.HitDensity(5, 5, 1, 1), model.HitDensity(5, 5, 1, 0));
  EXPECT_LT(model.HitDensity(5, 5, 1, -1), model.HitDensity(5, 5, 1, 0));
}

TEST(RangeBackground, IsADensity) {
  std::vector<MapRay> rays(500);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].range_m = 1.0 + 0.01 * static_cast<double>(i);
  const RangeBackground background(rays);
  double sum = 0, last = 0;
  for (double z = 0.005; z < 60; z += 0.01) {
    sum += 0.01 * background.Density(z);
    EXPECT_GE(background.Below(z), last);
    last = background.Below(z);
  }
  EXPECT_NEAR(sum, 1.0, 1e-3);
  EXPECT_GT(background.Density(59), 0);
}

TEST(JudgeRays, PrefersTheTruePoseToItsNeighbours) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const MapView view = ViewOf(house, test::kFromA);
  const MatcherOptions options;
  const RayEvidence truth = JudgeRays(plan, view, At(view, 0, 0), options);
  EXPECT_GT(truth.explained_ratio, 0.97);
  EXPECT_LT(truth.through_ratio, 0.002);
  EXPECT_GT(truth.log_likelihood, 50);
  for (double shift_m : {-0.3, -0.1, 0.1, 0.3}) {
    EXPECT_LT(JudgeRays(plan, view, At(view, shift_m, 0), options).log_likelihood, truth.log_likelihood - 10);
    EXPECT_LT(JudgeRays(plan, view, At(view, 0, shift_m), options).log_likelihood, truth.log_likelihood - 10);
    EXPECT_LT(JudgeRays(plan, view, At(view, 0, 0, 0.3 * shift_m), options).log_likelihood, truth.log_likelihood - 5);
  }
}

TEST(JudgeRays, ScalesAFewRaysToAll) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const MapView view = ViewOf(house, test::kFromA);
  const double all = JudgeRays(plan, view, At(view, 0, 0), MatcherOptions()).log_likelihood;
  EXPECT_NEAR(JudgeRays(plan, view, At(view, 0, 0), MatcherOptions(), 5).log_likelihood, all, 0.1 * all);
}

TEST(JudgeRays, SeesRaysGoThroughAWallThatIsNotThere) {
  const AGraph built = test::MakeGridPlan({0, 8}, {0, 5}, {});
  const AGraph planned = test::MakeGridPlan({0, 4, 8}, {0, 5}, {});
  const MapView view = ViewOf(built, {{2, 2.5}, {3, 1.5}});
  EXPECT_GT(JudgeRays(PlanIndex(planned), view, At(view, 0, 0), MatcherOptions()).through_ratio, 0.2);
  EXPECT_LT(JudgeRays(PlanIndex(built), view, At(view, 0, 0), MatcherOptions()).through_ratio, 0.002);
}

// A house that is furnished along its walls, by so many cupboards.
AGraph Furnished(AGraph house, int cupboards) {
  for (int i = 0; i < cupboards; ++i) {
    const double x_m = 0.3 + 0.8 * i;
    test::AddBox(house, {x_m, 0.3, 0}, {x_m + 0.6, 0.8, 2.4}, test::AddElement(house, "cupboard", ElementKind::kFurniture));
    test::AddBox(house, {x_m, 3.2, 0}, {x_m + 0.6, 3.7, 2.4}, test::AddElement(house, "cupboard", ElementKind::kFurniture));
  }
  return house;
}

TEST(JudgeRays, FurnitureHidesTheBuildingWithoutSpeakingAgainstThePlace) {
  const AGraph empty = test::MakeHouse();
  const PlanIndex plan(empty);
  const MapView view = ViewOf(Furnished(empty, 4), test::kFromA);
  const MatcherOptions options;
  const RayEvidence here = JudgeRays(plan, view, At(view, 0, 0), options);
  ASSERT_GT(here.in_front_ratio, 0.3);
  EXPECT_GT(here.log_likelihood, 2 * options.vouch_lead_nats);
  const RayEvidence beside = JudgeRays(plan, view, At(view, 0.7, 0.4), options);
  ASSERT_GT(beside.in_front_ratio, here.in_front_ratio);
  EXPECT_LT(beside.log_likelihood, 0) << "called furniture, most rays explain nothing";
}

TEST(JudgeRays, DoesNotMindWhetherADoorIsOpen) {
  const AGraph open = test::MakeHouse();
  AGraph closed = open;
  test::AddBox(closed, {4.98, 2.3, 0}, {5.02, 3.2, 2.1}, test::AddElement(closed, "leaf", ElementKind::kDoor, WallId(4), DoorwayId(1)));
  const MapView through_open = ViewOf(open, test::kFromA), at_closed = ViewOf(closed, test::kFromA);
  const PlanIndex closed_plan(closed);
  const RayEvidence e1 = JudgeRays(closed_plan, through_open, At(through_open, 0, 0), MatcherOptions());
  const RayEvidence e2 = JudgeRays(closed_plan, at_closed, At(at_closed, 0, 0), MatcherOptions());
  EXPECT_GT(e1.explained_ratio, 0.97);
  EXPECT_GT(e2.explained_ratio, 0.97);
  EXPECT_LT(e1.through_ratio, 0.002);
}

// Across y two walls tell where the room is, across x one that was left out of the rays and one that remains.
TEST(LeadOver, AsksForMoreThanOneWall) {
  const AGraph box = test::MakeGridPlan({0, 5}, {0, 4}, {});
  const PlanIndex plan(box);
  MapView view = ViewOf(box, {{2, 2}, {3, 2.5}});
  const MatcherOptions options;
  const PlanarPose truth = At(view, 0, 0), along_x[] = {At(view, 0.3, 0), At(view, -0.3, 0)}, along_y[] = {At(view, 0, 0.3)};
  EXPECT_GT(LeadOver(plan, view, truth, along_x, options), options.accept_margin_nats);
  EXPECT_LT(LeadOver(plan, view, along_x[0], {&truth, 1}, options), 0);
  std::erase_if(view.rays, [&](const MapRay& ray) { return view.center_m.x() + ray.origin.x() + ray.range_m * ray.direction.x() < 0.3; });
  EXPECT_GT(JudgeRays(plan, view, truth, options).log_likelihood - JudgeRays(plan, view, along_x[0], options).log_likelihood,
            options.accept_margin_nats);
  EXPECT_LT(LeadOver(plan, view, truth, along_x, options), 0.3 * options.accept_margin_nats);
  EXPECT_GT(LeadOver(plan, view, truth, along_y, options), options.accept_margin_nats);
}

TEST(LeadOver, IsInfiniteWithoutOthers) {
  const AGraph house = test::MakeHouse();
  const MapView view = ViewOf(house, test::kFromA);
  EXPECT_EQ(LeadOver(PlanIndex(house), view, At(view, 0, 0), {}, MatcherOptions()), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace plumb::runtime
