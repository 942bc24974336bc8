// Our own plans (plans/), each drawn in several formats: all of them give one A-Graph within a centimetre.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "tests/support/same_plan.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path kPlans = fs::path(PLUMB_SOURCE_DIR) / "plans";

AGraph Result(const CompileResult& result, const std::string& what) {
  EXPECT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), what);
  return result.graph.value_or(AGraph());
}

AGraph Of(const std::string& path) {
  CompileOptions options;
  options.verify_stages = true;
  return Result(Compile((kPlans / path).string(), options), path);
}

// The house drawn storey by storey.
AGraph OfHouseStoreys(const std::string& extension) {
  return Result(CompileStoreys({{"Erdgeschoss", (kPlans / ("house/ground." + extension)).string(), 0.0},
                                {"Obergeschoss", (kPlans / ("house/upper." + extension)).string(), 2.8}},
                               {}),
                extension);
}

void ExpectSame(const AGraph& reference, const AGraph& other, const test::SamePlanOptions& options) {
  EXPECT_GT(reference.rooms.size(), 0u);
  EXPECT_GT(reference.surfaces.size(), 0u);
  for (const std::string& difference : test::PlanDifferences(reference, other, options)) ADD_FAILURE() << difference;
}

// A mesh has no names, and leaves of doors are no part of ours.
test::SamePlanOptions MeshOptions() {
  test::SamePlanOptions out;
  out.names = out.leaves = false;
  out.heights = true;
  return out;
}

TEST(SiteOffice, AsADxfDrawingIsThePlanOfTheIfc) {
  const AGraph reference = Of("site_office/plan.ifc");
  for (const Doorway& d : reference.doorways) EXPECT_EQ(d.leaves.empty(), !d.has_leaf) << d.name;
  ExpectSame(reference, Of("site_office/plan.dxf"), {.swings = true});
}

TEST(SiteOffice, AsAMeshIsThePlanOfTheIfc) { ExpectSame(Of("site_office/plan.ifc"), Of("site_office/plan.obj"), MeshOptions()); }

TEST(OfficeFloor, AsADxfDrawingIsThePlanOfTheIfc) {
  ExpectSame(Of("office_floor/plan.ifc"), Of("office_floor/plan.dxf"), {.swings = true});
}

TEST(OfficeFloor, AsAMeshIsThePlanOfTheIfc) { ExpectSame(Of("office_floor/plan.ifc"), Of("office_floor/plan.ply"), MeshOptions()); }

// The drawing is not turned, and its corner is 1 m from the sheet's; the building's x axis is (0.96, 0.28), from 7, 24 and 25.
TEST(OfficeFloor, AsAnSvgDrawingIsThePlanOfTheIfc) {
  const AGraph svg = Of("office_floor/plan.svg");
  test::SamePlanOptions options;
  options.swings = true;
  Eigen::Matrix2d turn;
  turn << 0.96, -0.28, 0.28, 0.96;
  options.T_reference_other.linear() = turn;
  options.T_reference_other.translation() = Eigen::Vector2d(-30, 12) + turn * Eigen::Vector2d(-1, 15);  // y is minus the sheet's
  ExpectSame(Of("office_floor/plan.ifc"), svg, options);
}

TEST(OfficeFloor, CurvedWallsAreArcsInEveryFormat) {
  for (const char* file : {"plan.ifc", "plan.dxf", "plan.ply", "plan.svg"}) {
    const AGraph graph = Of(std::string("office_floor/") + file);
    std::vector<double> radii_m;
    for (const Surface& s : graph.surfaces) {
      if (s.arc && s.room.valid()) radii_m.push_back(s.arc->radius_m);
    }
    std::sort(radii_m.begin(), radii_m.end());
    ASSERT_EQ(radii_m.size(), 3u) << file;  // the round room from inside and from the lounge, the round front
    EXPECT_NEAR(radii_m[0], 3.0, 0.002) << file;
    EXPECT_NEAR(radii_m[1], 3.1, 0.002) << file;
    EXPECT_NEAR(radii_m[2], 5.0, 0.002) << file;
  }
}

TEST(House, AsDxfDrawingsIsThePlanOfTheIfc) { ExpectSame(Of("house/plan.ifc"), OfHouseStoreys("dxf"), {}); }
TEST(House, AsAMeshIsThePlanOfTheIfc) { ExpectSame(Of("house/plan.ifc"), Of("house/plan.gltf"), MeshOptions()); }

TEST(House, AsSvgDrawingsIsThePlanOfTheIfc) {
  test::SamePlanOptions options;
  options.T_reference_other.translation() = Eigen::Vector2d(-1, 9.5);  // the sheet's corner; y is minus the sheet's
  ExpectSame(Of("house/plan.ifc"), OfHouseStoreys("svg"), options);
}

// The model does not tell how its doors open.
TEST(House, DoorsOpenAlikeInBothDrawings) {
  const AGraph dxf = OfHouseStoreys("dxf");
  for (const Doorway& d : dxf.doorways) EXPECT_EQ(d.leaves.size(), 1u) << d.name;
  test::SamePlanOptions options;
  options.swings = true;
  options.T_reference_other.translation() = Eigen::Vector2d(-1, 9.5);
  ExpectSame(dxf, OfHouseStoreys("svg"), options);
}

TEST(SamePlan, TellsADoorThatOpensAnotherWay) {
  const AGraph reference = Of("site_office/plan.ifc");
  AGraph other = reference;
  other.doorways[1].leaves[0].jamb = Jamb::kLeft;
  EXPECT_EQ(test::PlanDifferences(reference, other, {.swings = true}).size(), 1u);
  other = reference;
  other.doorways[1].leaves[0].opens_to = DoorwaySide::kRoomB;
  EXPECT_EQ(test::PlanDifferences(reference, other, {.swings = true}).size(), 1u);
}

// What the comparison is worth: a plan that differs by 2 cm is not the same.
TEST(SamePlan, TellsAWallThatStandsTwoCentimetresOff) {
  const AGraph reference = Of("site_office/plan.ifc");
  AGraph moved = reference;
  for (Surface& s : moved.surfaces) {
    if (s.wall != WallId(4)) continue;
    s.start += 0.02 * s.normal.head<2>();
    s.end += 0.02 * s.normal.head<2>();
  }
  EXPECT_FALSE(test::PlanDifferences(reference, moved, {}).empty());
  EXPECT_TRUE(test::PlanDifferences(reference, reference, {}).empty());
}

TEST(SamePlan, TellsAnArcOfAnotherRadiusAndADoorwayThatMoved) {
  const AGraph reference = Of("office_floor/plan.ifc");
  AGraph other = reference;
  for (Surface& s : other.surfaces) {
    if (s.arc) s.arc->radius_m += 0.02;
  }
  EXPECT_FALSE(test::PlanDifferences(reference, other, {}).empty());
  other = reference;
  other.doorways[3].position.x() += 0.02;
  EXPECT_EQ(test::PlanDifferences(reference, other, {}).size(), 1u);
}

}  // namespace
}  // namespace plumb::compiler
