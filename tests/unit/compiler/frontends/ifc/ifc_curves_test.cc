#include "compiler/frontends/ifc/ifc_curves.h"

#include <cmath>
#include <numbers>

#include "tests/unit/compiler/frontends/ifc/ifc_reader_fixture.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using CurveReaderTest = IfcReaderTest;
constexpr double kPi = std::numbers::pi;

TEST_F(CurveReaderTest, TrimmedCircleByAngleAndSense) {
  Open(
      "#10=IFCTRIMMEDCURVE(#11,(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(1.5707963267948966)),.T.,.PARAMETER.);\n#11=IFCCIRCLE(#12,2.);\n"
      "#12=IFCAXIS2PLACEMENT2D(#13,$);\n#13=IFCCARTESIANPOINT((1.,1.));\n"
      "#20=IFCTRIMMEDCURVE(#11,(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(1.5707963267948966)),.F.,.PARAMETER.);");
  const CurvePoints quarter = curves_->Read(Get(10));
  EXPECT_TRUE(quarter.points.front().isApprox(Vector3d(3, 1, 0)));
  EXPECT_TRUE(quarter.points.back().isApprox(Vector3d(1, 3, 0)));
  ASSERT_EQ(quarter.arcs.size(), 1u);
  EXPECT_NEAR(quarter.arcs[0].sweep_rad, kPi / 2, 1e-12);
  const CurvePoints rest = curves_->Read(Get(20));
  EXPECT_TRUE(rest.points.back().isApprox(Vector3d(1, 3, 0)));
  EXPECT_NEAR(rest.arcs[0].sweep_rad, -1.5 * kPi, 1e-12);
  for (const Vector3d& p : rest.points) EXPECT_NEAR((p - Vector3d(1, 1, 0)).norm(), 2, 1e-12);
}

TEST_F(CurveReaderTest, TrimmedByPoints) {
  Open(
      "#10=IFCTRIMMEDCURVE(#11,(#14),(#15),.T.,.CARTESIAN.);\n#11=IFCCIRCLE(#12,1.);\n#12=IFCAXIS2PLACEMENT2D(#13,$);\n#13="
      "IFCCARTESIANPOINT((0.,0.));\n"
      "#14=IFCCARTESIANPOINT((0.,1.));\n#15=IFCCARTESIANPOINT((-1.,0.));\n"
      "#20=IFCTRIMMEDCURVE(#21,(IFCPARAMETERVALUE(1.)),(IFCPARAMETERVALUE(3.)),.T.,.PARAMETER.);\n#21=IFCLINE(#13,#22);\n#22=IFCVECTOR(#23,"
      "2.);\n"
      "#23=IFCDIRECTION((0.,5.));");
  EXPECT_TRUE(curves_->Read(Get(10)).points.back().isApprox(Vector3d(-1, 0, 0)));
  const CurvePoints line = curves_->Read(Get(20));
  ASSERT_EQ(line.points.size(), 2u);
  EXPECT_TRUE(line.points[0].isApprox(Vector3d(0, 2, 0)));
  EXPECT_TRUE(line.points[1].isApprox(Vector3d(0, 6, 0)));
}

TEST_F(CurveReaderTest, CompositeJoinsSegmentsAlsoIfTheSenseIsWrong) {
  const std::string data =
      "#10=IFCCOMPOSITECURVE((#11,#12),.F.);\n#11=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#13);\n#12=IFCCOMPOSITECURVESEGMENT(."
      "CONTINUOUS.,SENSE,#14);\n"
      "#13=IFCPOLYLINE((#15,#16));\n#14=IFCPOLYLINE((#17,#16));\n#15=IFCCARTESIANPOINT((0.,0.));\n#16=IFCCARTESIANPOINT((1.,0.));\n#17="
      "IFCCARTESIANPOINT((1.,1.));";
  for (const std::string sense : {".F.", ".T."}) {
    std::string text = data;
    text.replace(text.find("SENSE"), 5, sense);
    Open(text);
    const CurvePoints curve = curves_->Read(Get(10));
    ASSERT_EQ(curve.points.size(), 3u) << sense;
    EXPECT_TRUE(curve.points.back().isApprox(Vector3d(1, 1, 0)));
  }
}

TEST_F(CurveReaderTest, IndexedCurveWithLinesAndArcs) {
  Open(
      "#10=IFCINDEXEDPOLYCURVE(#11,(IFCLINEINDEX((1,2)),IFCARCINDEX((2,3,4)),IFCLINEINDEX((4,1))),.F.);\n"
      "#11=IFCCARTESIANPOINTLIST2D(((0.,0.),(2.,0.),(3.,1.),(2.,2.)));\n#12=IFCINDEXEDPOLYCURVE(#11,$,.F.);\n#13=IFCINDEXEDPOLYCURVE(#11,("
      "IFCLINEINDEX((1,9))),.F.);");
  std::vector<Arc> arcs;
  const Ring2 ring = curves_->ReadRing(Get(10), &arcs);
  EXPECT_NEAR(SignedArea(ring), 0.5 * 2 * 2 + kPi / 2, 0.01);  // a triangle and a half disk
  ASSERT_EQ(arcs.size(), 1u);
  EXPECT_NEAR(arcs[0].radius_m, 1, 1e-12);
  EXPECT_TRUE(arcs[0].center.isApprox(Vector2d(2, 1)));
  EXPECT_NEAR(arcs[0].sweep_rad, kPi, 1e-9);
  EXPECT_EQ(curves_->ReadRing(Get(12), nullptr).size(), 4u);
  EXPECT_TRUE(diagnostics_.all().empty());
  (void)curves_->Read(Get(13));
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kBadAttribute);
}

TEST_F(CurveReaderTest, SplineThroughItsEnds) {
  Open(
      "#10=IFCBSPLINECURVEWITHKNOTS(2,(#11,#12,#13),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.);\n#11=IFCCARTESIANPOINT((0.,0.));\n"
      "#12=IFCCARTESIANPOINT((1.,2.));\n#13=IFCCARTESIANPOINT((2.,0.));\n#20=IFCBSPLINECURVEWITHKNOTS(2,(#11,#12,#13),.U.,.F.,.F.,(3,9),(0."
      ",1.),.U.);");
  const CurvePoints curve = curves_->Read(Get(10));
  ASSERT_EQ(curve.points.size(), 33u);  // 8 steps leave 1 / 64 m, 32 keep within 2 mm
  EXPECT_TRUE(curve.points[16].isApprox(Vector3d(1, 1, 0)));  // Bezier: (p0 + 2 p1 + p2) / 4
  EXPECT_TRUE(curve.points.back().isApprox(Vector3d(2, 0, 0)));
  EXPECT_TRUE(curves_->Read(Get(20)).points.empty());
  EXPECT_EQ(diagnostics_.all().size(), 1u);
}

// The parabola y = x (2 - x), x = 2 u, of two spans, from u = 0.25 to 0.75 and back.
TEST_F(CurveReaderTest, TrimmedSplineIsThePartBetweenItsParameters) {
  Open(
      "#10=IFCBSPLINECURVEWITHKNOTS(2,(#11,#12,#13,#14),.UNSPECIFIED.,.F.,.F.,(3,1,3),(0.,0.5,1.),.UNSPECIFIED.);\n"
      "#11=IFCCARTESIANPOINT((0.,0.));\n#12=IFCCARTESIANPOINT((0.5,1.));\n#13=IFCCARTESIANPOINT((1.5,1.));\n#14=IFCCARTESIANPOINT((2.,0.));"
      "\n"
      "#20=IFCTRIMMEDCURVE(#10,(IFCPARAMETERVALUE(0.25)),(IFCPARAMETERVALUE(0.75)),.T.,.PARAMETER.);\n"
      "#21=IFCTRIMMEDCURVE(#10,(IFCPARAMETERVALUE(0.25)),(IFCPARAMETERVALUE(0.75)),.F.,.PARAMETER.);\n"
      "#30=IFCCOMPOSITECURVE((#31,#32),.F.);\n#31=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#20);\n"
      "#32=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#33);\n#33=IFCPOLYLINE((#34,#35,#36));\n#34=IFCCARTESIANPOINT((1.5,0.75));\n"
      "#35=IFCCARTESIANPOINT((1.5,0.));\n#36=IFCCARTESIANPOINT((0.5,0.75));");
  const CurvePoints curve = curves_->Read(Get(20)), back = curves_->Read(Get(21));
  EXPECT_TRUE(curve.points.front().isApprox(Vector3d(0.5, 0.75, 0)));
  EXPECT_TRUE(curve.points.back().isApprox(Vector3d(1.5, 0.75, 0)));
  for (const Vector3d& p : curve.points) EXPECT_NEAR(p.y(), p.x() * (2 - p.x()), 1e-12);
  EXPECT_TRUE(back.points.front().isApprox(curve.points.back()));
  // Under the arc 11/12, less the triangle from the end's foot to the start.
  EXPECT_NEAR(std::abs(SignedArea(curves_->ReadRing(Get(30), nullptr))), 11. / 12 - 0.375, 0.002);
  EXPECT_TRUE(diagnostics_.all().empty());
}

// A polyline around a square, and a parabola from (0, 0) to (2, 0).
TEST_F(CurveReaderTest, AnEdgeIsThePartOfItsCurveBetweenItsVertices) {
  Open(
      "#10=IFCPOLYLINE((#11,#12,#13,#14,#11));\n#11=IFCCARTESIANPOINT((0.,0.));\n#12=IFCCARTESIANPOINT((2.,0.));\n"
      "#13=IFCCARTESIANPOINT((2.,2.));\n#14=IFCCARTESIANPOINT((0.,2.));\n"
      "#20=IFCBSPLINECURVEWITHKNOTS(2,(#11,#21,#12),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.);\n#21=IFCCARTESIANPOINT((1.,2.));\n"
      "#30=IFCLINE(#11,$);\n#31=IFCSEAMCURVE(#10,(#32,#32),.CURVE3D.);\n#32=IFCPCURVE($,$);");
  const auto length = [](const Ring3& line) {
    double sum = 0;
    for (size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
    return sum;
  };
  const IfcInstance square = Get(10), parabola = Get(20);
  EXPECT_NEAR(length(curves_->ReadBetween(square, {1, 0, 0}, {2, 1, 0}, true)), 2, 1e-12);
  EXPECT_NEAR(length(curves_->ReadBetween(square, {1, 0, 0}, {2, 1, 0}, false)), 6, 1e-12);
  EXPECT_NEAR(length(curves_->ReadBetween(square, {2, 1, 0}, {1, 0, 0}, true)), 6, 1e-12);
  EXPECT_NEAR(length(curves_->ReadBetween(square, {1, 0, 0}, {1, 0, 0}, true)), 8, 1e-12);
  const Ring3 part = curves_->ReadBetween(parabola, {1.5, 0.75, 0}, {0.5, 0.75, 0}, true);
  EXPECT_TRUE(part.front().isApprox(Vector3d(1.5, 0.75, 0)));
  EXPECT_TRUE(part.back().isApprox(Vector3d(0.5, 0.75, 0)));
  for (const Vector3d& p : part) EXPECT_NEAR(p.y(), p.x() * (2 - p.x()), 1e-9);
  EXPECT_NEAR(length(part), 1.148, 0.002);
  EXPECT_NEAR(length(curves_->ReadBetween(Get(31), {1, 0, 0}, {2, 1, 0}, true)), 2, 1e-12);
  EXPECT_EQ(curves_->ReadBetween(Get(30), {0, 0, 0}, {1, 0, 0}, true).size(), 2u);
}

TEST_F(CurveReaderTest, CyclesAndUnknownCurvesAreDiagnostics) {
  Open("#10=IFCCOMPOSITECURVE((#11),.F.);\n#11=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#10);\n#12=IFCPCURVE($,$);");
  EXPECT_TRUE(curves_->Read(Get(10)).points.empty());
  EXPECT_TRUE(curves_->Read(Get(12)).points.empty());
  ASSERT_EQ(diagnostics_.all().size(), 2u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kReferenceCycle);
  EXPECT_EQ(diagnostics_.all()[1].kind, DiagnosticKind::kUnsupportedGeometry);
}

}  // namespace
}  // namespace plumb::compiler
