#include "compiler/frontends/ifc/ifc_grid.h"

#include <gtest/gtest.h>

#include "compiler/frontends/ifc/ifc_placement.h"
#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Axis A along x at y = 1, axis B along y at x = 5; the grid stands at (100, 0, 2), turned by a quarter to the left.
constexpr const char* kGrid =
    "#20=IFCCARTESIANPOINT((0.,1.));\n#21=IFCCARTESIANPOINT((10.,1.));\n#22=IFCPOLYLINE((#20,#21));\n#23=IFCGRIDAXIS('A',#22,.T.);\n"
    "#24=IFCCARTESIANPOINT((5.,2.));\n#25=IFCCARTESIANPOINT((5.,10.));\n#26=IFCPOLYLINE((#24,#25));\n#27=IFCGRIDAXIS('B',#26,.T.);\n"
    "#30=IFCGRID('grid000000000000000030',$,$,$,$,#31,$,(#23),(#27),$,$);\n#31=IFCLOCALPLACEMENT($,#32);\n"
    "#32=IFCAXIS2PLACEMENT3D(#33,$,#34);\n#33=IFCCARTESIANPOINT((100.,0.,2.));\n#34=IFCDIRECTION((0.,1.,0.));\n";

class GridTest : public ::testing::Test {
 protected:
  // The placement #40.
  Isometry3d Place(const std::string& data) {
    text_ = test::IfcText(data + "#10=IFCX(#40);");
    model_ = IfcModel::Open(text_, diagnostics_);
    EXPECT_TRUE(model_);
    return PlacementReader(*model_).ObjectPlacement(model_->Get(model_->file().Find(10))[0]);
  }

  std::string text_;
  DiagnosticSink diagnostics_;
  std::optional<IfcModel> model_;
};

TEST_F(GridTest, StandsWhereTheAxesMeetInTheFrameOfTheGrid) {
  const Isometry3d T = Place(std::string(kGrid) + "#40=IFCGRIDPLACEMENT(#41,$);\n#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),$);\n");
  EXPECT_TRUE(diagnostics_.all().empty());
  EXPECT_TRUE(T.translation().isApprox(Vector3d(99, 5, 2)));
  EXPECT_TRUE(T.linear().col(0).isApprox(Vector3d(0, 1, 0)));  // along A, which the grid has turned
}

TEST_F(GridTest, OffsetsAreToTheLeftOfTheAxesAndUp) {
  const Isometry3d T =
      Place(std::string(kGrid) + "#40=IFCGRIDPLACEMENT(#41,$);\n#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),(0.5,2.,3.));\n");
  EXPECT_TRUE(T.translation().isApprox(Vector3d(100 - 1.5, 3, 5)));
}

TEST_F(GridTest, AnAxisAgainstItsCurveTurnsTheFrame) {
  std::string data = kGrid;
  data.replace(data.find("#22,.T."), 7, "#22,.F.");
  const Isometry3d T = Place(data + "#40=IFCGRIDPLACEMENT(#41,$);\n#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),(0.5,0.));\n");
  EXPECT_TRUE(T.translation().isApprox(Vector3d(100 - 0.5, 5, 2)));
  EXPECT_TRUE(T.linear().col(0).isApprox(Vector3d(0, -1, 0)));
}

TEST_F(GridTest, ReferenceIsAnotherMeetingOrADirection) {
  const std::string here = std::string(kGrid) + "#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),$);\n";
  const Isometry3d toward = Place(here + "#40=IFCGRIDPLACEMENT(#41,#42);\n#42=IFCVIRTUALGRIDINTERSECTION((#23,#27),(3.,-3.));\n");
  EXPECT_TRUE(toward.linear().col(0).isApprox(Vector3d(-1, 1, 0).normalized()));
  const Isometry3d along = Place(here + "#40=IFCGRIDPLACEMENT(#41,#42);\n#42=IFCDIRECTION((0.,-1.,0.));\n");
  EXPECT_TRUE(along.linear().col(0).isApprox(Vector3d(1, 0, 0)));
}

TEST_F(GridTest, StatedParentComesFirstFromIfc4x3On) {
  const std::string data = std::string(kGrid) + "#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),$);\n";
  EXPECT_TRUE(Place(data + "#40=IFCGRIDPLACEMENT($,#41,$);\n").translation().isApprox(Vector3d(99, 5, 2)));
  const Isometry3d T = Place(data + "#40=IFCGRIDPLACEMENT(#43,#41,$);\n#43=IFCLOCALPLACEMENT($,$);\n");
  EXPECT_TRUE(T.translation().isApprox(Vector3d(5, 1, 0)));
}

TEST_F(GridTest, CurvedAxesMeetOnTheirArc) {
  std::string data = kGrid;
  data.replace(data.find("#26=IFCPOLYLINE((#24,#25))"), 26, "#26=IFCCIRCLE(#28,2.)");
  const Isometry3d T = Place(data +
                             "#28=IFCAXIS2PLACEMENT2D(#29,$);\n#29=IFCCARTESIANPOINT((0.,1.));\n#40=IFCGRIDPLACEMENT(#41,$);\n"
                             "#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),(0.,-1.));\n");
  // A circle of 2 m, run through to the left, and 1 m to the right of it.
  EXPECT_NEAR((T.translation() - Vector3d(99, 3, 2)).norm(), 0, 1e-3);
}

TEST_F(GridTest, AxesThatDoNotMeetAreSaid) {
  const Isometry3d T = Place(std::string(kGrid) + "#40=IFCGRIDPLACEMENT(#41,$);\n#41=IFCVIRTUALGRIDINTERSECTION((#23,#23),(0.,1.));\n");
  EXPECT_TRUE(T.translation().isApprox(Vector3d(100, 0, 2)));
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kUnsupportedPlacement);
}

TEST_F(GridTest, AGridThatStandsOnItselfIsACycle) {
  std::string data = kGrid;
  data.replace(data.find("$,$,$,$,#31"), 11, "$,$,$,$,#40");
  (void)Place(data + "#40=IFCGRIDPLACEMENT(#41,$);\n#41=IFCVIRTUALGRIDINTERSECTION((#23,#27),$);\n");
  ASSERT_FALSE(diagnostics_.all().empty());
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kReferenceCycle);
}

}  // namespace
}  // namespace plumb::compiler
