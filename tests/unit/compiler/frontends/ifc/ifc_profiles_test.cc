#include "compiler/frontends/ifc/ifc_profiles.h"

#include <cmath>
#include <numbers>

#include "tests/unit/compiler/frontends/ifc/ifc_reader_fixture.h"

namespace plumb::compiler {
namespace {

constexpr double kPi = std::numbers::pi;

struct Case {
  std::string profile;
  double area_m2;
  double tolerance = 1e-9;
};

class ProfileReaderTest : public IfcReaderTest {
 protected:
  // Outer ring less the others.
  static double AreaOf(const Profile& profile) {
    double sum = 0;
    for (size_t r = 0; r < profile.area.size(); ++r) sum += (r == 0 ? 1 : -1) * std::abs(SignedArea(profile.area[r]));
    return sum;
  }
};

TEST_F(ProfileReaderTest, AreasOfParameterizedProfiles) {
  const Case cases[] = {
      {"IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,0.3)", 1.2},
      {"IFCRECTANGLEPROFILEDEF(.AREA.,$,#20,4.,0.3)", 1.2},
      {"IFCRECTANGLEHOLLOWPROFILEDEF(.AREA.,$,$,4.,3.,0.5,$,$)", 12 - 6},
      {"IFCCIRCLEPROFILEDEF(.AREA.,$,$,1.)", kPi, 0.02},
      {"IFCCIRCLEHOLLOWPROFILEDEF(.AREA.,$,$,1.,0.5)", kPi * 0.75, 0.02},
      {"IFCELLIPSEPROFILEDEF(.AREA.,$,$,2.,1.)", 2 * kPi, 0.02},
      {"IFCTRAPEZIUMPROFILEDEF(.AREA.,$,$,4.,2.,1.,0.5)", 3},
      {"IFCISHAPEPROFILEDEF(.AREA.,$,$,2.,4.,0.5,0.25,$)", 2 * 2 * 0.25 + 3.5 * 0.5},
      {"IFCLSHAPEPROFILEDEF(.AREA.,$,$,3.,2.,0.5,$,$,$)", 3 * 0.5 + 1.5 * 0.5},
      {"IFCLSHAPEPROFILEDEF(.AREA.,$,$,3.,$,0.5,$,$,$)", 3 * 0.5 + 2.5 * 0.5},
      {"IFCTSHAPEPROFILEDEF(.AREA.,$,$,3.,2.,0.5,0.25,$,$,$,$,$)", 2 * 0.25 + 2.75 * 0.5},
      {"IFCUSHAPEPROFILEDEF(.AREA.,$,$,3.,2.,0.5,0.25,$,$,$)", 3 * 0.5 + 2 * 1.5 * 0.25},
      {"IFCCSHAPEPROFILEDEF(.AREA.,$,$,3.,2.,0.1,0.5,$)", 3 * 0.1 + 2 * (1.9 * 0.1 + 0.4 * 0.1)},
      {"IFCZSHAPEPROFILEDEF(.AREA.,$,$,3.,2.,0.5,0.25,$,$)", 3 * 0.5 + 2 * 1.5 * 0.25},
  };
  for (const Case& c : cases) {
    Open("#10=" + c.profile + ";\n#20=IFCAXIS2PLACEMENT2D(#21,#22);\n#21=IFCCARTESIANPOINT((3.,4.));\n#22=IFCDIRECTION((1.,1.));");
    EXPECT_NEAR(AreaOf(profiles_->Read(Get(10))), c.area_m2, std::max(c.tolerance * c.area_m2, 1e-9)) << c.profile;
    EXPECT_TRUE(diagnostics_.all().empty()) << c.profile;
  }
}

TEST_F(ProfileReaderTest, ABandAlongAnArcEndsSquareToItAndHasItsArcs) {
  Open(
      "#10=IFCCENTERLINEPROFILEDEF(.CURVE.,$,#11,0.2);\n#11=IFCTRIMMEDCURVE(#12,(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(3."
      "14159265358979)),"
      ".T.,.PARAMETER.);\n#12=IFCCIRCLE(#13,4.1);\n#13=IFCAXIS2PLACEMENT2D(#14,$);\n#14=IFCCARTESIANPOINT((0.,0.));");
  const Profile profile = profiles_->Read(Get(10));
  ASSERT_EQ(profile.area.size(), 1u);
  double least_m = 1;
  for (const Eigen::Vector2d& p : profile.area[0]) {
    least_m = std::min(least_m, p.y());
    EXPECT_NEAR(std::abs(p.norm() - 4.1), 0.1, 1e-4);
  }
  EXPECT_NEAR(least_m, 0, 1e-9);
  ASSERT_EQ(profile.arcs.size(), 2u);
  EXPECT_NEAR(profile.arcs[0].radius_m, 4, 1e-12);
  EXPECT_NEAR(profile.arcs[1].radius_m, 4.2, 1e-12);
}

TEST_F(ProfileReaderTest, PositionMovesAndTurns) {
  Open(
      "#10=IFCRECTANGLEPROFILEDEF(.AREA.,$,#20,4.,2.);\n#20=IFCAXIS2PLACEMENT2D(#21,#22);\n#21=IFCCARTESIANPOINT((3.,4.));\n#22="
      "IFCDIRECTION((0.,1.));");
  Eigen::AlignedBox2d box;
  const Profile profile = profiles_->Read(Get(10));
  for (const Eigen::Vector2d& p : profile.area[0]) box.extend(p);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector2d(2, 2)));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector2d(4, 6)));
}

TEST_F(ProfileReaderTest, ArbitraryWithVoidsAndDerived) {
  const std::string points =
      "#30=IFCPOLYLINE((#31,#32,#33,#34,#31));\n#31=IFCCARTESIANPOINT((0.,0.));\n#32=IFCCARTESIANPOINT((4.,0.));\n#33=IFCCARTESIANPOINT((4."
      ",3.));\n"
      "#34=IFCCARTESIANPOINT((0.,3.));\n#40=IFCCIRCLE(#41,1.);\n#41=IFCAXIS2PLACEMENT2D(#42,$);\n#42=IFCCARTESIANPOINT((2.,1.5));\n"
      "#50=IFCCARTESIANTRANSFORMATIONOPERATOR2D($,$,#31,2.);";
  Open(
      "#10=IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$,#30,(#40));\n#11=IFCDERIVEDPROFILEDEF(.AREA.,$,#10,#50,$);\n#12=IFCMIRROREDPROFILEDEF(."
      "AREA.,$,#10,$,$);\n" +
      points);
  const Profile profile = profiles_->Read(Get(10));
  EXPECT_NEAR(AreaOf(profile), 12 - kPi, 0.02);
  ASSERT_EQ(profile.arcs.size(), 1u);
  EXPECT_EQ(profile.arcs[0].radius_m, 1);
  const Profile doubled = profiles_->Read(Get(11));
  EXPECT_NEAR(AreaOf(doubled), 4 * (12 - kPi), 0.08);
  EXPECT_NEAR(doubled.arcs[0].radius_m, 2, 1e-12);
  const Profile mirrored = profiles_->Read(Get(12));
  EXPECT_NEAR(mirrored.arcs[0].center.x(), -2, 1e-12);
  EXPECT_LT(mirrored.arcs[0].sweep_rad, 0);
}

TEST_F(ProfileReaderTest, CenterLineGetsItsThickness) {
  Open(
      "#10=IFCCENTERLINEPROFILEDEF(.CURVE.,$,#30,0.2);\n#30=IFCPOLYLINE((#31,#32,#33));\n#31=IFCCARTESIANPOINT((0.,0.));\n#32="
      "IFCCARTESIANPOINT((4.,0.));\n"
      "#33=IFCCARTESIANPOINT((4.,3.));");
  EXPECT_NEAR(AreaOf(profiles_->Read(Get(10))), 7 * 0.2, 1e-9);
}

TEST_F(ProfileReaderTest, AClosedCenterLineGoesAllRound) {
  const std::string corners =
      "#30=IFCPOLYLINE((#31,#32,#33,#34,#31));\n#31=IFCCARTESIANPOINT((0.,0.));\n#32=IFCCARTESIANPOINT((10.,0.));\n#33="
      "IFCCARTESIANPOINT((10.,8.));\n#34=IFCCARTESIANPOINT((0.,8.));\n#35=IFCPOLYLINE((#31,#34,#33,#32,#31));\n"
      "#40=IFCCIRCLE(#41,4.);\n#41=IFCAXIS2PLACEMENT2D(#31,$);\n";
  Open(corners +
       "#10=IFCCENTERLINEPROFILEDEF(.AREA.,$,#30,0.3);\n#11=IFCCENTERLINEPROFILEDEF(.AREA.,$,#35,0.3);\n"
       "#12=IFCCENTERLINEPROFILEDEF(.AREA.,$,#40,0.3);\n#13=IFCCENTERLINEPROFILEDEF(.AREA.,$,#40,9.);\n");
  for (const uint64_t id : {10u, 11u}) {
    const Profile profile = profiles_->Read(Get(id));
    ASSERT_EQ(profile.area.size(), 2u);
    EXPECT_NEAR(std::abs(SignedArea(profile.area[0])), 10.3 * 8.3, 1e-9);
    EXPECT_NEAR(std::abs(SignedArea(profile.area[1])), 9.7 * 7.7, 1e-9);
  }
  const Profile round = profiles_->Read(Get(12));
  ASSERT_EQ(round.area.size(), 2u);
  for (size_t side = 0; side < 2; ++side) {
    for (const Eigen::Vector2d& p : round.area[side]) EXPECT_NEAR(p.norm(), side == 0 ? 4.15 : 3.85, 1e-4);
  }
  EXPECT_EQ(round.arcs.size(), 2u);
  EXPECT_EQ(profiles_->Read(Get(13)).area.size(), 1u);
}

TEST_F(ProfileReaderTest, ACenterLineThereAndBackIsOpen) {
  Open(
      "#10=IFCCENTERLINEPROFILEDEF(.AREA.,$,#30,0.2);\n#30=IFCPOLYLINE((#31,#32,#31));\n#31=IFCCARTESIANPOINT((0.,0.));\n#32="
      "IFCCARTESIANPOINT((4.,0.));");
  EXPECT_NEAR(AreaOf(profiles_->Read(Get(10))), 4 * 0.2, 1e-9);
}

TEST_F(ProfileReaderTest, BadMeasuresAndUnknownTypesAreDiagnostics) {
  Open(
      "#10=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,-4.,0.3);\n#11=IFCSOMEPROFILEDEF(.AREA.,$,$,1.);\n#12=IFCCOMPOSITEPROFILEDEF(.AREA.,$,(#12),$)"
      ";");
  for (const uint64_t id : {10u, 11u, 12u}) EXPECT_TRUE(profiles_->Read(Get(id)).area.empty());
  ASSERT_EQ(diagnostics_.all().size(), 3u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kUnsupportedGeometry);
  EXPECT_EQ(diagnostics_.all()[1].kind, DiagnosticKind::kUnsupportedGeometry);
  EXPECT_EQ(diagnostics_.all()[2].kind, DiagnosticKind::kReferenceCycle);
}

}  // namespace
}  // namespace plumb::compiler
