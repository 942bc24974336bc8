#include "compiler/frontends/ifc/ifc_placement.h"

#include <gtest/gtest.h>

#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

class PlacementTest : public ::testing::Test {
 protected:
  void Open(const std::string& data) {
    text_ = test::IfcText(data);
    model_ = IfcModel::Open(text_, diagnostics_);
    ASSERT_TRUE(model_);
  }
  // Each test's #10 holds the reference to try in its first argument.
  StepValue Reference() const { return model_->Get(model_->file().Find(10))[0]; }

  std::string text_;
  DiagnosticSink diagnostics_;
  std::optional<IfcModel> model_;
};

TEST_F(PlacementTest, ChainsOfPlacementsMultiply) {
  Open(
      "#10=IFCX(#11);\n#11=IFCLOCALPLACEMENT(#12,#13);\n#12=IFCLOCALPLACEMENT($,#14);\n"
      "#13=IFCAXIS2PLACEMENT3D(#15,$,$);\n#14=IFCAXIS2PLACEMENT3D(#16,#17,#18);\n"
      "#15=IFCCARTESIANPOINT((1.,0.,0.));\n#16=IFCCARTESIANPOINT((10.,20.,3.));\n#17=IFCDIRECTION((0.,0.,1.));\n#18=IFCDIRECTION((0.,1.,0.)"
      ");");
  PlacementReader reader(*model_);
  const Eigen::Isometry3d T = reader.ObjectPlacement(Reference());
  EXPECT_TRUE((T * Vector3d::Zero()).isApprox(Vector3d(10, 21, 3)));
  EXPECT_TRUE((T * Vector3d(0, 1, 0)).isApprox(Vector3d(9, 21, 3)));
  EXPECT_TRUE(reader.ObjectPlacement(Reference()).isApprox(T));
}

TEST_F(PlacementTest, CyclesEndWithADiagnostic) {
  Open("#10=IFCX(#11);\n#11=IFCLOCALPLACEMENT(#12,$);\n#12=IFCLOCALPLACEMENT(#11,$);");
  PlacementReader reader(*model_);
  EXPECT_TRUE(reader.ObjectPlacement(Reference()).isApprox(Eigen::Isometry3d::Identity()));
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kReferenceCycle);
}

TEST_F(PlacementTest, ChainsStayWithinTheEarth) {
  Open(
      "#10=IFCX(#11);\n#11=IFCLOCALPLACEMENT(#12,#13);\n#12=IFCLOCALPLACEMENT($,#13);\n#13=IFCAXIS2PLACEMENT3D(#14,$,$);\n"
      "#14=IFCCARTESIANPOINT((9.E7,0.,0.));");
  PlacementReader reader(*model_);
  EXPECT_EQ(reader.ObjectPlacement(Reference()).translation().x(), 9e7);
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kBadAttribute);
}

TEST_F(PlacementTest, ScalesOutOfAllRangeAreOne) {
  for (const char* scale : {"0.", "1.E300", "-1.E7"}) {
    Open(std::string("#10=IFCX(#11);\n#11=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#12,") + scale +
         ",$);\n#12=IFCCARTESIANPOINT((0.,0.,0.));");
    EXPECT_TRUE(PlacementReader(*model_).Operator(Reference()).linear().isIdentity(1e-12)) << scale;
    EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kBadAttribute);
  }
}

TEST_F(PlacementTest, SkewedAndMissingDirectionsAreMadeOrthonormal) {
  Open("#10=IFCX(#11);\n#11=IFCAXIS2PLACEMENT3D(#12,#13,#13);\n#12=IFCCARTESIANPOINT((0.,0.,0.));\n#13=IFCDIRECTION((0.,2.,0.));");
  PlacementReader reader(*model_);
  const Eigen::Isometry3d T = reader.AxisPlacement(Reference());
  EXPECT_TRUE((T.linear().transpose() * T.linear()).isIdentity(1e-12));
  EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
  EXPECT_TRUE(T.linear().col(2).isApprox(Vector3d::UnitY()));
}

TEST_F(PlacementTest, ZeroDirectionsTakeTheDefault) {
  Open("#10=IFCX(#11);\n#11=IFCAXIS2PLACEMENT3D(#12,#13,$);\n#12=IFCCARTESIANPOINT((1.,2.,3.));\n#13=IFCDIRECTION((0.,0.,0.));");
  PlacementReader reader(*model_);
  EXPECT_TRUE(reader.AxisPlacement(Reference()).linear().isIdentity());
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kBadAttribute);
}

TEST_F(PlacementTest, PlacementsInThePlane) {
  Open("#10=IFCX(#11);\n#11=IFCAXIS2PLACEMENT2D(#12,#13);\n#12=IFCCARTESIANPOINT((1.,2.));\n#13=IFCDIRECTION((0.,1.));");
  PlacementReader reader(*model_);
  EXPECT_TRUE((reader.AxisPlacement(Reference()) * Vector3d(1, 0, 0)).isApprox(Vector3d(1, 3, 0)));
}

TEST_F(PlacementTest, OperatorsScaleMirrorAndMove) {
  Open(
      "#10=IFCX(#11);\n#11=IFCCARTESIANTRANSFORMATIONOPERATOR3DNONUNIFORM(#13,#14,#12,2.,$,3.,4.);\n#12=IFCCARTESIANPOINT((5.,0.,0.));\n"
      "#13=IFCDIRECTION((1.,0.,0.));\n#14=IFCDIRECTION((0.,-1.,0.));");
  PlacementReader reader(*model_);
  EXPECT_TRUE((reader.Operator(Reference()) * Vector3d(1, 1, 1)).isApprox(Vector3d(7, -3, 4)));
  EXPECT_LT(reader.Operator(Reference()).linear().determinant(), 0);
}

TEST_F(PlacementTest, UnsetIsTheIdentity) {
  Open("#10=IFCX($);");
  PlacementReader reader(*model_);
  EXPECT_TRUE(reader.ObjectPlacement(Reference()).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(reader.Operator(Reference()).isApprox(Eigen::Affine3d::Identity()));
}

}  // namespace
}  // namespace plumb::compiler
