#include "compiler/frontends/ifc/ifc_shape.h"

#include <cmath>
#include <numbers>

#include "tests/unit/compiler/frontends/ifc/ifc_reader_fixture.h"

namespace plumb::compiler {
namespace {

constexpr double kPi = std::numbers::pi;

class ShapeReaderTest : public IfcReaderTest {
 protected:
  static double VolumeOf(const ShapeParts& parts) {
    double sum = 0;
    for (const ShapePart& part : parts) {
      EXPECT_TRUE(IsClosed(part.solid));
      sum += Volume(part.solid);
    }
    return sum;
  }
};

// A box of 4 x 2 x 3 about the z axis as #10, its parts up to #19.
const std::string kBox =
    "#10=IFCEXTRUDEDAREASOLID(#11,$,#12,3.);\n#11=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,2.);\n#12=IFCDIRECTION((0.,0.,1.));\n"
    "#13=IFCCARTESIANPOINT((0.,0.,0.));\n#14=IFCCARTESIANPOINT((0.,0.,2.));\n#15=IFCDIRECTION((0.,1.,0.));\n#16=IFCDIRECTION((1.,0.,0.));\n"
    "#17=IFCDIRECTION((0.,0.,-1.));\n";

TEST_F(ShapeReaderTest, ExtrusionWithPosition) {
  const ShapeParts parts = ReadItem(kBox + "#20=IFCEXTRUDEDAREASOLID(#11,#21,#12,3.);\n#21=IFCAXIS2PLACEMENT3D(#14,#16,#15);", "#20");
  EXPECT_NEAR(VolumeOf(parts), 24, 1e-9);
  const auto box = Bounds(parts[0].solid);  // profile x along y, profile y along z, extruded along x
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(0, -2, 1)));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(3, 2, 3)));
}

TEST_F(ShapeReaderTest, HalfSpaceTakesTheSideOfItsAgreement) {
  const std::string cut =
      "#20=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#10,#21);\n#21=IFCHALFSPACESOLID(#22,FLAG);\n#22=IFCPLANE(#23);\n#23=IFCAXIS2PLACEMENT3D(#"
      "14,#12,#16);\n";
  for (const auto& [flag, volume] : {std::pair(".F.", 16.0), std::pair(".T.", 8.0)}) {
    std::string text = kBox + cut;
    text.replace(text.find("FLAG"), 4, flag);
    const ShapeParts parts = ReadItem(text, "#20", "Clipping");
    EXPECT_NEAR(VolumeOf(parts), volume, 1e-9) << flag;  // plane at z = 2: .F. takes away what is above
  }
}

TEST_F(ShapeReaderTest, PolygonalBoundedHalfSpaceCutsOnlyInItsBoundary) {
  const ShapeParts parts = ReadItem(
      kBox +
          "#20=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#10,#21);\n#21=IFCPOLYGONALBOUNDEDHALFSPACE(#22,.F.,#24,#30);\n#22=IFCPLANE(#23);\n"
          "#23=IFCAXIS2PLACEMENT3D(#14,#12,#16);\n#24=IFCAXIS2PLACEMENT3D(#13,#12,#16);\n#30=IFCPOLYLINE((#31,#32,#33,#34,#31));\n"
          "#31=IFCCARTESIANPOINT((0.,-5.));\n#32=IFCCARTESIANPOINT((1.,-5.));\n#33=IFCCARTESIANPOINT((1.,5.));\n#34=IFCCARTESIANPOINT((0.,"
          "5.));",
      "#20", "Clipping");
  EXPECT_NEAR(VolumeOf(parts), 24 - 1 * 2 * 1, 1e-9);
}

TEST_F(ShapeReaderTest, BooleansOfSolids) {
  const std::string other = "#20=IFCEXTRUDEDAREASOLID(#21,$,#12,3.);\n#21=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,10.);\n";
  EXPECT_NEAR(VolumeOf(ReadItem(kBox + other + "#30=IFCBOOLEANRESULT(.DIFFERENCE.,#10,#20);", "#30", "CSG")), 18, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(kBox + other + "#30=IFCBOOLEANRESULT(.INTERSECTION.,#10,#20);", "#30", "CSG")), 6, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(kBox + "#30=IFCCSGSOLID(#31);\n#31=IFCBOOLEANRESULT(.DIFFERENCE.,#10,#32);\n#32=IFCBLOCK(#33,1.,1.,9.);\n"
                                       "#33=IFCAXIS2PLACEMENT3D(#13,$,$);",
                                "#30", "CSG")),
              21, 1e-9);
}

TEST_F(ShapeReaderTest, RevolvedTaperedAndDisk) {
  EXPECT_NEAR(VolumeOf(ReadItem("#10=IFCREVOLVEDAREASOLID(#11,$,#12,3.14159265358979);\n#11=IFCRECTANGLEPROFILEDEF(.AREA.,$,#14,1.,1.);\n"
                                "#12=IFCAXIS1PLACEMENT(#13,#16);\n#13=IFCCARTESIANPOINT((0.,0.,0.));\n#14=IFCAXIS2PLACEMENT2D(#15,$);\n"
                                "#15=IFCCARTESIANPOINT((2.,0.));\n#16=IFCDIRECTION((0.,1.,0.));",
                                "#10")),
              2 * kPi, 0.02);
  EXPECT_NEAR(VolumeOf(ReadItem(kBox + "#20=IFCEXTRUDEDAREASOLIDTAPERED(#11,$,#12,3.,#21);\n#21=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,2.,1.);",
                                "#20", "AdvancedSweptSolid")),
              14, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(kBox + "#20=IFCSWEPTDISKSOLID(#21,0.1,$,$,$);\n#21=IFCPOLYLINE((#13,#14));", "#20", "AdvancedSweptSolid")),
              2 * 0.5 * 16 * std::sin(kPi / 8) * 0.01, 1e-9);  // as many sides as keep within 2 mm of it
}

// A tetrahedron with one face turned the wrong way.
TEST_F(ShapeReaderTest, BrepWithATurnedFaceIsMended) {
  const ShapeParts parts = ReadItem(
      "#10=IFCFACETEDBREP(#11);\n#11=IFCCLOSEDSHELL((#21,#22,#23,#24));\n#12=IFCCARTESIANPOINT((0.,0.,0.));\n#13=IFCCARTESIANPOINT((1.,0.,"
      "0.));\n"
      "#14=IFCCARTESIANPOINT((0.,1.,0.));\n#15=IFCCARTESIANPOINT((0.,0.,1.));\n"
      "#21=IFCFACE((#31));\n#22=IFCFACE((#32));\n#23=IFCFACE((#33));\n#24=IFCFACE((#34));\n"
      "#31=IFCFACEOUTERBOUND(#41,.F.);\n#32=IFCFACEOUTERBOUND(#42,.T.);\n#33=IFCFACEOUTERBOUND(#43,.T.);\n#34=IFCFACEOUTERBOUND(#44,.T.);\n"
      "#41=IFCPOLYLOOP((#12,#14,#13));\n#42=IFCPOLYLOOP((#12,#13,#15));\n#43=IFCPOLYLOOP((#13,#14,#15));\n#44=IFCPOLYLOOP((#14,#12,#15));",
      "#10", "Brep");
  EXPECT_NEAR(VolumeOf(parts), 1.0 / 6, 1e-12);
}

TEST_F(ShapeReaderTest, FaceSets) {
  EXPECT_NEAR(VolumeOf(ReadItem("#10=IFCTRIANGULATEDFACESET(#11,$,.T.,((1,3,2),(1,2,4),(2,3,4),(3,1,4)),$);\n"
                                "#11=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.)));",
                                "#10", "Tessellation")),
              1.0 / 6, 1e-12);
  EXPECT_NEAR(
      VolumeOf(ReadItem(
          "#10=IFCPOLYGONALFACESET(#11,.T.,(#21,#22,#23,#24,#25,#26),$);\n"
          "#11=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(1.,1.,0.),(0.,1.,0.),(0.,0.,2.),(1.,0.,2.),(1.,1.,2.),(0.,1.,2.)));\n"
          "#21=IFCINDEXEDPOLYGONALFACE((1,4,3,2));\n#22=IFCINDEXEDPOLYGONALFACE((5,6,7,8));\n#23=IFCINDEXEDPOLYGONALFACE((1,2,6,5));\n"
          "#24=IFCINDEXEDPOLYGONALFACE((2,3,7,6));\n#25=IFCINDEXEDPOLYGONALFACE((3,4,8,7));\n#26=IFCINDEXEDPOLYGONALFACE((4,1,5,8));",
          "#10", "Tessellation")),
      2, 1e-12);
  EXPECT_TRUE(
      ReadItem("#10=IFCTRIANGULATEDFACESET(#11,$,.T.,((1,3,9)),$);\n#11=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));",
               "#10", "Tessellation")
          .empty());
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kBadAttribute);
}

// A cylinder of radius 1 and height 2: two planar caps and one face over a full turn with a seam.
TEST_F(ShapeReaderTest, AdvancedBrepWithACylinder) {
  const ShapeParts parts = ReadItem(
      "#10=IFCADVANCEDBREP(#11);\n#11=IFCCLOSEDSHELL((#21,#22,#23));\n#12=IFCCARTESIANPOINT((1.,0.,0.));\n#13=IFCCARTESIANPOINT((1.,0.,2.))"
      ";\n"
      "#14=IFCVERTEXPOINT(#12);\n#15=IFCVERTEXPOINT(#13);\n#16=IFCCARTESIANPOINT((0.,0.,0.));\n#17=IFCCARTESIANPOINT((0.,0.,2.));\n"
      "#18=IFCAXIS2PLACEMENT3D(#16,$,$);\n#19=IFCAXIS2PLACEMENT3D(#17,$,$);\n"
      "#21=IFCADVANCEDFACE((#31),#41,.F.);\n#22=IFCADVANCEDFACE((#32),#42,.T.);\n#23=IFCADVANCEDFACE((#33),#43,.T.);\n"
      "#31=IFCFACEOUTERBOUND(#34,.T.);\n#32=IFCFACEOUTERBOUND(#35,.T.);\n#33=IFCFACEOUTERBOUND(#36,.T.);\n"
      "#34=IFCEDGELOOP((#51));\n#35=IFCEDGELOOP((#52));\n#36=IFCEDGELOOP((#53,#54,#55,#56));\n#41=IFCPLANE(#18);\n#42=IFCPLANE(#19);\n"
      "#43=IFCCYLINDRICALSURFACE(#18,1.);\n#51=IFCORIENTEDEDGE(*,*,#61,.F.);\n#52=IFCORIENTEDEDGE(*,*,#62,.T.);\n"
      "#53=IFCORIENTEDEDGE(*,*,#61,.T.);\n#54=IFCORIENTEDEDGE(*,*,#63,.T.);\n#55=IFCORIENTEDEDGE(*,*,#62,.F.);\n#56=IFCORIENTEDEDGE(*,*,#"
      "63,.F.);\n"
      "#61=IFCEDGECURVE(#14,#14,#71,.T.);\n#62=IFCEDGECURVE(#15,#15,#72,.T.);\n#63=IFCEDGECURVE(#14,#15,#73,.T.);\n#71=IFCCIRCLE(#18,1.);\n"
      "#72=IFCCIRCLE(#19,1.);\n#73=IFCLINE(#12,#74);\n#74=IFCVECTOR(#75,1.);\n#75=IFCDIRECTION((0.,0.,1.));",
      "#10", "AdvancedBrep");
  EXPECT_NEAR(VolumeOf(parts), 2 * kPi, 0.04);
}

TEST_F(ShapeReaderTest, MappedItemsScaleAndKeepTheirStyle) {
  const ShapeParts parts = ReadItem(kBox +
                                        "#20=IFCMAPPEDITEM(#21,#25);\n#21=IFCREPRESENTATIONMAP(#22,#23);\n#22=IFCAXIS2PLACEMENT3D(#13,$,$);"
                                        "\n#23=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#10));\n"
                                        "#25=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#14,0.5,$);\n#30=IFCSTYLEDITEM(#10,(#31),$);\n#31="
                                        "IFCSURFACESTYLE('Glas',.BOTH.,());\n"
                                        "#40=IFCMAPPEDITEM(#21,#25);",
                                    "#20,#40", "MappedRepresentation");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(VolumeOf(parts), 6, 1e-9);
  EXPECT_EQ(parts[0].look, Look::kGlass);
  EXPECT_NEAR(Bounds(parts[1].solid).min().z(), 2, 1e-12);
}

TEST_F(ShapeReaderTest, ArcsOfACurvedWallFollowIt) {
  const ShapeParts parts = ReadItem(
      "#10=IFCEXTRUDEDAREASOLID(#11,#20,#12,3.);\n#11=IFCCIRCLEPROFILEDEF(.AREA.,$,$,2.);\n#12=IFCDIRECTION((0.,0.,1.));\n#20="
      "IFCAXIS2PLACEMENT3D(#21,$,$);\n"
      "#21=IFCCARTESIANPOINT((5.,6.,0.));",
      "#10");
  ASSERT_EQ(parts[0].arcs.size(), 1u);
  EXPECT_TRUE((parts[0].T_part_profile * Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d(5, 6, 0)));
}

TEST_F(ShapeReaderTest, CyclesAndUnknownShapesAreDiagnosticsAndBoxesStandIn) {
  EXPECT_TRUE(
      ReadItem(
          "#20=IFCMAPPEDITEM(#21,$);\n#21=IFCREPRESENTATIONMAP($,#23);\n#23=IFCSHAPEREPRESENTATION($,'Body','MappedRepresentation',(#20));",
          "#20", "MappedRepresentation")
          .empty());
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kReferenceCycle);
  EXPECT_TRUE(ReadItem("#20=IFCBOOLEANRESULT(.DIFFERENCE.,#20,#20);", "#20", "CSG").empty());
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kReferenceCycle);

  Open(
      "#10=IFCPRODUCTDEFINITIONSHAPE($,$,(#11,#12));\n#11=IFCSHAPEREPRESENTATION($,'Box','BoundingBox',(#13));\n#12=IFCSHAPEREPRESENTATION("
      "$,'Body','Brep',(#15));\n"
      "#13=IFCBOUNDINGBOX(#14,1.,2.,3.);\n#14=IFCCARTESIANPOINT((0.,0.,0.));\n#15=IFCSECTIONEDSPINE($,$,$);");
  EXPECT_NEAR(VolumeOf(shapes_->Body(Get(10))), 6, 1e-12);
  const auto& all = diagnostics_.all();
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(all[all.size() - 2].kind, DiagnosticKind::kUnsupportedGeometry);
  EXPECT_EQ(all.back().kind, DiagnosticKind::kBoundingBoxInstead);
}

// Two children each that lead back: without a bound 2^300 items.
TEST_F(ShapeReaderTest, CyclesWithTwoChildrenEndSoon) {
  EXPECT_TRUE(ReadItem("#20=IFCMAPPEDITEM(#22,$);\n#21=IFCMAPPEDITEM(#22,$);\n#22=IFCREPRESENTATIONMAP($,#23);\n"
                       "#23=IFCSHAPEREPRESENTATION($,'Body','MappedRepresentation',(#20,#21));",
                       "#20", "MappedRepresentation")
                  .empty());
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kReferenceCycle);

  // A chain of unions whose operands are the same: 2^40 blocks of no size, then of some.
  options_.max_triangles_per_element = 5000;
  for (const char* size : {"0.", "1."}) {
    std::string data = "#100=IFCBLOCK($," + std::string(size) + ",1.,1.);\n";
    for (int i = 101; i <= 140; ++i) {
      const std::string below = "#" + std::to_string(i - 1);
      data += "#" + std::to_string(i) + "=IFCBOOLEANRESULT(.UNION.," + below + "," + below + ");\n";
    }
    EXPECT_LT(ReadItem(data, "#140", "CSG").size(), 2000u);
  }
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kTooManyTriangles);
}

// As deep as programs that cut a wall once for each of its openings make them.
TEST_F(ShapeReaderTest, LongChainsOfCutsAreNoCycle) {
  std::string data = "#100=IFCBLOCK($,1000.,1.,1.);\n#11=IFCCARTESIANPOINT((1.,0.,0.));\n#12=IFCAXIS2PLACEMENT3D(#13,$,$);\n"
                     "#13=IFCCARTESIANPOINT((999.,0.,0.));\n#14=IFCBLOCK(#12,1.,1.,1.);\n";
  for (int i = 101; i <= 600; ++i) {
    data += "#" + std::to_string(i) + "=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#" + std::to_string(i - 1) + ",#14);\n";
  }
  EXPECT_NEAR(VolumeOf(ReadItem(data, "#600", "Clipping")), 999, 1e-9);
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(ShapeReaderTest, HalfSpacesIntersectToo) {
  const std::string data =
      "#20=IFCBLOCK($,4.,2.,1.);\n#21=IFCHALFSPACESOLID(#22,.T.);\n#22=IFCPLANE(#23);\n#23=IFCAXIS2PLACEMENT3D(#24,#25,$);\n"
      "#24=IFCCARTESIANPOINT((1.,0.,0.));\n#25=IFCDIRECTION((1.,0.,0.));\n#26=IFCDIRECTION((0.,0.,1.));\n#27=IFCDIRECTION((1.,0.,0.));\n"
      "#28=IFCAXIS2PLACEMENT3D(#24,#26,#27);\n#29=IFCPOLYLINE((#30,#31,#32,#33,#30));\n#30=IFCCARTESIANPOINT((-1.,0.));\n"
      "#31=IFCCARTESIANPOINT((1.,0.));\n#32=IFCCARTESIANPOINT((1.,1.));\n#33=IFCCARTESIANPOINT((-1.,1.));\n"
      "#34=IFCPOLYGONALBOUNDEDHALFSPACE(#22,.T.,#28,#29);\n";
  // The half space is x < 1, the bounded one its part 0 < x, 0 < y < 1.
  EXPECT_NEAR(VolumeOf(ReadItem(data + "#40=IFCBOOLEANRESULT(.DIFFERENCE.,#20,#21);", "#40", "CSG")), 6, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(data + "#40=IFCBOOLEANRESULT(.INTERSECTION.,#20,#21);", "#40", "CSG")), 2, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(data + "#40=IFCBOOLEANRESULT(.DIFFERENCE.,#20,#34);", "#40", "CSG")), 7, 1e-9);
  EXPECT_NEAR(VolumeOf(ReadItem(data + "#40=IFCBOOLEANRESULT(.INTERSECTION.,#20,#34);", "#40", "CSG")), 1, 1e-9);
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(ShapeReaderTest, FarCoordinatesAndHugeAnglesAreBounded) {
  Open("#10=IFCCARTESIANPOINT((1.E300,0.,0.));\n#11=IFCCARTESIANPOINT((1.E7,0.,0.));\n#12=IFCBLOCK($,1.E300,1.,1.);");
  EXPECT_EQ(placements_->Point(Get(10)), Eigen::Vector3d::Zero());
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kNumberNotFinite);
  EXPECT_GT(placements_->Point(Get(11)).x(), 1000);
  EXPECT_EQ(model_->Length(Get(12), attribute::kBlockX), 0);
  EXPECT_EQ(ArcSegments(1, 1e300, 0.001), ArcSegments(1, 2 * kPi, 0.001));
  EXPECT_EQ(ArcSegments(1, std::nan(""), 0.001), 1);
}

TEST_F(ShapeReaderTest, RoundPrimitivesKeepWithinTheTolerance) {
  const std::string at = "#11=IFCAXIS2PLACEMENT3D(#12,$,$);\n#12=IFCCARTESIANPOINT((1.,2.,3.));";
  const auto check = [&](const std::string& item, double volume_m3, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                         double round_m2) {
    SCOPED_TRACE(item);
    const ShapeParts parts = ReadItem("#10=" + item + ";\n" + at, "#10", "CSG");
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_TRUE(IsClosed(parts[0].solid));
    EXPECT_LE(Volume(parts[0].solid), volume_m3 + 1e-9);
    EXPECT_GE(Volume(parts[0].solid), volume_m3 - round_m2 * 2 * options_.chord_tolerance_m - 1e-9);  // chords in two directions
    const Eigen::AlignedBox3d box = Bounds(parts[0].solid);
    EXPECT_LE((box.min() - low).cwiseAbs().maxCoeff(), options_.chord_tolerance_m) << box.min().transpose();
    EXPECT_LE((box.max() - high).cwiseAbs().maxCoeff(), options_.chord_tolerance_m) << box.max().transpose();
  };
  check("IFCSPHERE(#11,0.5)", kPi / 6, {0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}, kPi);
  check("IFCRIGHTCIRCULARCONE(#11,3.,0.5)", kPi / 4, {0.5, 1.5, 3}, {1.5, 2.5, 6}, kPi / 2 * std::hypot(3, 0.5));
  check("IFCRIGHTCIRCULARCYLINDER(#11,3.,0.5)", 3 * kPi / 4, {0.5, 1.5, 3}, {1.5, 2.5, 6}, 3 * kPi);
  check("IFCRECTANGULARPYRAMID(#11,2.,3.,1.5)", 3, {1, 2, 3}, {3, 5, 4.5}, 0);
  check("IFCBLOCK(#11,2.,3.,1.5)", 9, {1, 2, 3}, {3, 5, 4.5}, 0);
}

TEST_F(ShapeReaderTest, PrimitivesWithoutExtentAreDiagnosed) {
  for (const std::string item : {"IFCSPHERE($,0.)", "IFCRIGHTCIRCULARCONE($,-1.,0.5)", "IFCRECTANGULARPYRAMID($,1.,0.,1.)"}) {
    EXPECT_TRUE(ReadItem("#10=" + item + ";", "#10", "CSG").empty()) << item;
    ASSERT_FALSE(diagnostics_.all().empty()) << item;
    EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kDegenerateGeometry);
  }
}

TEST_F(ShapeReaderTest, OperatorsThatDoubleAtEachLevelAreCutOff) {
  options_.max_triangles_per_element = 5000;
  std::string data = kBox;
  uint64_t below = 10;
  for (int level = 0; level < 40; ++level) {
    const uint64_t id = 100 + 10 * static_cast<uint64_t>(level);
    const auto n = [](uint64_t i) { return std::string("#").append(std::to_string(i)); };
    for (const uint64_t item : {id, id + 1}) data.append(n(item)).append("=IFCMAPPEDITEM(").append(n(id + 2)).append(",$);\n");
    data.append(n(id + 2)).append("=IFCREPRESENTATIONMAP($,").append(n(id + 3)).append(");\n");
    data.append(n(id + 3)).append("=IFCSHAPEREPRESENTATION($,'Body','MappedRepresentation',(").append(n(below));
    if (level > 0) data.append(",").append(n(below + 1));
    data.append("));\n");
    below = id;
  }
  const ShapeParts parts = ReadItem(data, std::string("#").append(std::to_string(below)), "MappedRepresentation");
  EXPECT_LT(parts.size(), 20000u);
  EXPECT_EQ(diagnostics_.all().back().kind, DiagnosticKind::kTooManyTriangles);
}

}  // namespace
}  // namespace plumb::compiler
