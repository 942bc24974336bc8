#include "compiler/frontends/ifc/ifc_frontend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

struct Result {
  std::optional<PlanIr> plan;
  DiagnosticSink diagnostics;
  [[nodiscard]] bool Has(DiagnosticKind kind) const {
    return std::any_of(diagnostics.all().begin(), diagnostics.all().end(), [&](const Diagnostic& d) { return d.kind == kind; });
  }
};

Result Read(const std::string& text, const IfcOptions& options = {}) {
  Result result;
  const Source source{.path = "test.ifc", .bytes = text, .sha256 = "00", .format = DetectFormat(text)};
  result.plan = ReadIfc(source, result.diagnostics, options);
  return result;
}

// A storey at 3 m with a wall of 5 x 0.3 x 2.5 m along x from (10, 20), a door in it with leaf, and a space.
const char* const kScene = R"(
#10=IFCBUILDINGSTOREY('storey0000000000000001',$,'Ground',$,$,#11,$,$,.ELEMENT.,3.);
#11=IFCLOCALPLACEMENT($,#12);
#12=IFCAXIS2PLACEMENT3D(#13,$,$);
#13=IFCCARTESIANPOINT((10.,20.,3.));
#14=IFCBUILDINGSTOREY('storey0000000000000002',$,'Cellar',$,$,$,$,$,.ELEMENT.,-2.5);
#15=IFCRELCONTAINEDINSPATIALSTRUCTURE('rel0000000000000000001',$,$,$,(#20,#50),#10);
#16=IFCRELAGGREGATES('rel0000000000000000002',$,$,$,#10,(#70));
#20=IFCWALLSTANDARDCASE('wall000000000000000001',$,'W\X\FC',$,$,#21,#22,$);
#21=IFCLOCALPLACEMENT(#11,#23);
#22=IFCPRODUCTDEFINITIONSHAPE($,$,(#24,#34));
#23=IFCAXIS2PLACEMENT3D(#33,$,$);
#24=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#25));
#25=IFCEXTRUDEDAREASOLID(#26,$,#29,2.5);
#26=IFCRECTANGLEPROFILEDEF(.AREA.,$,#27,5.,0.3);
#27=IFCAXIS2PLACEMENT2D(#28,$);
#28=IFCCARTESIANPOINT((2.5,0.));
#29=IFCDIRECTION((0.,0.,1.));
#33=IFCCARTESIANPOINT((0.,0.,0.));
#34=IFCSHAPEREPRESENTATION($,'Axis','Curve2D',(#35));
#35=IFCPOLYLINE((#36,#37));
#36=IFCCARTESIANPOINT((0.,0.));
#37=IFCCARTESIANPOINT((5.,0.));
#40=IFCOPENINGELEMENT('opening000000000000001',$,'O',$,$,#41,#42,$);
#41=IFCLOCALPLACEMENT(#21,#43);
#42=IFCPRODUCTDEFINITIONSHAPE($,$,(#44));
#43=IFCAXIS2PLACEMENT3D(#48,$,$);
#44=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#45));
#45=IFCEXTRUDEDAREASOLID(#46,$,#29,2.);
#46=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,0.3);
#47=IFCRELVOIDSELEMENT('rel0000000000000000003',$,$,$,#20,#40);
#48=IFCCARTESIANPOINT((2.,0.,0.));
#50=IFCDOOR('door000000000000000001',$,'D',$,$,#51,#52,$,2.,0.9);
#51=IFCLOCALPLACEMENT(#41,$);
#52=IFCPRODUCTDEFINITIONSHAPE($,$,(#54));
#54=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#55));
#55=IFCEXTRUDEDAREASOLID(#56,$,#29,2.);
#56=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,0.9,0.05);
#57=IFCRELFILLSELEMENT('rel0000000000000000004',$,$,$,#40,#50);
#60=IFCRELASSOCIATESMATERIAL('rel0000000000000000005',$,$,$,(#20),#61);
#61=IFCMATERIALLAYERSETUSAGE(#62,.AXIS2.,.POSITIVE.,0.);
#62=IFCMATERIALLAYERSET((#63,#64),$);
#63=IFCMATERIALLAYER($,0.2,$);
#64=IFCMATERIALLAYER($,0.1,$);
#65=IFCRELDEFINESBYPROPERTIES('rel0000000000000000006',$,$,$,(#20),#66);
#66=IFCPROPERTYSET('pset000000000000000001',$,'Pset_WallCommon',$,(#67));
#67=IFCPROPERTYSINGLEVALUE('IsExternal',$,IFCBOOLEAN(.T.),$);
#70=IFCSPACE('space00000000000000001',$,'1',$,$,#21,#72,'Office',.ELEMENT.,.INTERNAL.,$);
#72=IFCPRODUCTDEFINITIONSHAPE($,$,(#74));
#74=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#75));
#75=IFCEXTRUDEDAREASOLID(#76,$,#29,2.4);
#76=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,3.,4.);
)";

std::string Scene() { return test::IfcText(kScene); }

std::string Without(std::string text, const std::string& line_start) {
  const size_t at = text.find("\n" + line_start);
  EXPECT_NE(at, std::string::npos);
  text.erase(at, text.find('\n', at + 1) - at);
  return text;
}

TEST(ReadIfc, WallWithADoorAndASpace) {
  const Result result = Read(Scene());
  ASSERT_TRUE(result.plan);
  EXPECT_TRUE(result.diagnostics.all().empty()) << DiagnosticsToText(result.diagnostics.all(), "scene");
  const PlanIr& plan = *result.plan;
  EXPECT_EQ(plan.source_format, "IFC4");
  ASSERT_EQ(plan.storeys.size(), 2u);
  EXPECT_EQ(plan.storeys[0].name, "Cellar");
  EXPECT_EQ(plan.storeys[0].elevation_m, -2.5);
  EXPECT_EQ(plan.storeys[1].elevation_m, 3);
  EXPECT_EQ(plan.storeys[1].guid, "storey0000000000000001");

  ASSERT_EQ(plan.elements.size(), 2u);
  const PlanElement& wall = plan.elements[0];
  EXPECT_EQ(wall.kind, ElementKind::kWall);
  EXPECT_EQ(wall.name, "Wü");
  EXPECT_EQ(wall.type, "IfcWallStandardCase");
  EXPECT_EQ(wall.guid, "wall000000000000000001");
  EXPECT_EQ(wall.location.step_id, 20u);
  EXPECT_EQ(wall.location.line, 20u);
  EXPECT_EQ(wall.storey, 1u);
  EXPECT_TRUE(wall.external);
  EXPECT_NEAR(*wall.thickness_m, 0.3, 1e-12);
  ASSERT_TRUE(wall.axis);
  EXPECT_TRUE(wall.axis->first.isApprox(Eigen::Vector2d(10, 20)));
  EXPECT_TRUE(wall.axis->second.isApprox(Eigen::Vector2d(15, 20)));
  EXPECT_TRUE(IsClosed(wall.uncut));
  EXPECT_NEAR(Volume(wall.uncut), 5 * 0.3 * 2.5, 1e-9);
  EXPECT_NEAR(Volume(wall.body), 5 * 0.3 * 2.5 - 1 * 0.3 * 2, 1e-9);
  EXPECT_TRUE(Bounds(wall.uncut).min().isApprox(Eigen::Vector3d(10, 19.85, 3)));

  ASSERT_EQ(plan.openings.size(), 1u);
  EXPECT_EQ(plan.openings[0].wall, 0u);
  EXPECT_EQ(plan.openings[0].filling, 1u);
  EXPECT_EQ(plan.openings[0].width_m, 0.9);
  EXPECT_EQ(plan.openings[0].height_m, 2.0);
  EXPECT_NEAR(Volume(plan.openings[0].body), 0.6, 1e-9);

  ASSERT_EQ(plan.spaces.size(), 1u);
  EXPECT_EQ(plan.spaces[0].long_name, "Office");
  EXPECT_EQ(plan.spaces[0].storey, 1u);
  EXPECT_NEAR(Volume(plan.spaces[0].body), 28.8, 1e-9);
}

TEST(ReadIfc, SameBytesSameResult) {
  const Result a = Read(Scene()), b = Read(Scene());
  ASSERT_EQ(a.plan->elements.size(), b.plan->elements.size());
  for (size_t i = 0; i < a.plan->elements.size(); ++i) {
    EXPECT_EQ(a.plan->elements[i].body.vertices, b.plan->elements[i].body.vertices);
    EXPECT_EQ(a.plan->elements[i].body.triangles, b.plan->elements[i].body.triangles);
  }
}

TEST(ReadIfc, DoorWithoutFillsRelationIsFoundInItsOpening) {
  const Result result = Read(Without(Scene(), "#57="));
  EXPECT_EQ(result.plan->openings[0].filling, 1u);
  EXPECT_EQ(result.plan->openings.size(), 1u);
  EXPECT_TRUE(result.Has(DiagnosticKind::kFillingInferred));
}

TEST(ReadIfc, DoorWithoutOpeningIsAnOpeningWithoutBody) {
  const Result result = Read(Without(Without(Scene(), "#57="), "#47="));
  ASSERT_EQ(result.plan->openings.size(), 1u);
  EXPECT_EQ(result.plan->openings[0].wall, kNoIndex);
  EXPECT_EQ(result.plan->openings[0].filling, 1u);
  EXPECT_TRUE(result.plan->openings[0].body.empty());
  EXPECT_TRUE(result.Has(DiagnosticKind::kFillingWithoutOpening));
  EXPECT_NEAR(Volume(result.plan->elements[0].body), 3.75, 1e-9);
}

// Revit writes walls whose bodies have their openings cut already.
TEST(ReadIfc, WallCutBeforeGetsItsUncutBodyBack) {
  std::string text = Scene();
  text.replace(text.find("(#25)"), 5, "(#80,#81)");
  text.insert(text.find("\nENDSEC;\nEND-ISO"),
              "\n#80=IFCEXTRUDEDAREASOLID(#82,$,#29,2.5);\n#81=IFCEXTRUDEDAREASOLID(#83,$,#29,2.5);\n#82=IFCRECTANGLEPROFILEDEF(.AREA.,$,#"
              "84,1.5,0.3);\n"
              "#83=IFCRECTANGLEPROFILEDEF(.AREA.,$,#85,2.5,0.3);\n#84=IFCAXIS2PLACEMENT2D(#86,$);\n#85=IFCAXIS2PLACEMENT2D(#87,$);\n"
              "#86=IFCCARTESIANPOINT((0.75,0.));\n#87=IFCCARTESIANPOINT((3.75,0.));");
  const Result result = Read(text);
  EXPECT_NEAR(Volume(result.plan->elements[0].body), 4 * 0.3 * 2.5, 1e-9);
  EXPECT_NEAR(Volume(result.plan->elements[0].uncut), 4 * 0.3 * 2.5 + 1 * 0.3 * 2, 1e-6);
  EXPECT_FALSE(result.Has(DiagnosticKind::kOpeningMissesHost));
}

TEST(ReadIfc, FarPlansAreMovedNearZero) {
  std::string text = Scene();
  text.replace(text.find("(10.,20.,3.)"), 12, "(500010.,5400020.,3.)");
  const Result result = Read(text);
  EXPECT_TRUE(result.Has(DiagnosticKind::kFarOrigin));
  EXPECT_EQ(result.plan->origin.z(), 0);
  const PlanElement& wall = result.plan->elements[0];
  EXPECT_LT(Bounds(wall.body).max().cwiseAbs().maxCoeff(), 100);
  EXPECT_TRUE((Bounds(wall.body).min() + result.plan->origin).isApprox(Eigen::Vector3d(500010, 5400019.85, 3), 1e-12));
  EXPECT_TRUE((wall.axis->first + result.plan->origin.head<2>()).isApprox(Eigen::Vector2d(500010, 5400020), 1e-12));
  EXPECT_NEAR(Volume(wall.uncut) - Volume(wall.body), 0.6, 1e-6);
}

TEST(ReadIfc, CurtainWallOfPartsIsOneElementWithItsGlassApart) {
  const Result result = Read(test::IfcText(R"(
#10=IFCCURTAINWALL('curtain000000000000001',$,'C',$,$,$,$,$);
#11=IFCRELAGGREGATES('rel0000000000000000001',$,$,$,#10,(#20,#30,#40));
#12=IFCDIRECTION((0.,0.,1.));
#20=IFCMEMBER('member0000000000000001',$,'M',$,$,$,#21,$);
#21=IFCPRODUCTDEFINITIONSHAPE($,$,(#22));
#22=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#23));
#23=IFCEXTRUDEDAREASOLID(#24,$,#12,3.);
#24=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,0.1,0.1);
#30=IFCPLATE('plate00000000000000001',$,'P',$,$,$,#31,$);
#31=IFCPRODUCTDEFINITIONSHAPE($,$,(#32));
#32=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#33));
#33=IFCEXTRUDEDAREASOLID(#34,$,#12,3.);
#34=IFCRECTANGLEPROFILEDEF(.AREA.,$,#35,1.,0.02);
#35=IFCAXIS2PLACEMENT2D(#36,$);
#36=IFCCARTESIANPOINT((1.,0.));
#37=IFCRELASSOCIATESMATERIAL('rel0000000000000000002',$,$,$,(#30),#38);
#38=IFCMATERIAL('Glass, clear');
#40=IFCDOOR('door000000000000000001',$,'D',$,$,$,#41,$,2.,1.);
#41=IFCPRODUCTDEFINITIONSHAPE($,$,(#42));
#42=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#43));
#43=IFCEXTRUDEDAREASOLID(#44,$,#12,2.);
#44=IFCRECTANGLEPROFILEDEF(.AREA.,$,#45,1.,0.05);
#45=IFCAXIS2PLACEMENT2D(#46,$);
#46=IFCCARTESIANPOINT((2.,0.));
)"));
  const PlanIr& plan = *result.plan;
  ASSERT_EQ(plan.elements.size(), 3u);
  EXPECT_EQ(plan.elements[0].kind, ElementKind::kCurtainWall);
  EXPECT_EQ(plan.elements[0].material, Material::kOpaque);
  EXPECT_NEAR(Volume(plan.elements[0].body), 0.03, 1e-9);
  EXPECT_NEAR(Volume(plan.elements[0].uncut), 0.03 + 0.06 + 0.1, 1e-9);
  EXPECT_EQ(plan.elements[1].kind, ElementKind::kWindow);
  EXPECT_EQ(plan.elements[1].material, Material::kGlass);
  EXPECT_EQ(plan.elements[1].guid, plan.elements[0].guid);
  EXPECT_EQ(plan.elements[2].kind, ElementKind::kDoor);
  ASSERT_EQ(plan.openings.size(), 1u);
  EXPECT_EQ(plan.openings[0].wall, 0u);
  EXPECT_EQ(plan.openings[0].filling, 2u);
  EXPECT_TRUE(plan.storeys.empty());  // a matter of the passes
  EXPECT_EQ(plan.elements[0].storey, kNoIndex);
}

TEST(ReadIfc, CurtainWallOfNothingButADoorIsAWallWhereTheDoorIs) {
  const Result result = Read(test::IfcText(R"(
#10=IFCCURTAINWALL('curtain000000000000001',$,'C',$,$,$,$,$);
#11=IFCRELAGGREGATES('rel0000000000000000001',$,$,$,#10,(#40));
#12=IFCDIRECTION((0.,0.,1.));
#13=IFCCURTAINWALL('curtain000000000000002',$,'Empty',$,$,$,$,$);
#40=IFCDOOR('door000000000000000001',$,'D',$,$,$,#41,$,2.,1.);
#41=IFCPRODUCTDEFINITIONSHAPE($,$,(#42));
#42=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#43));
#43=IFCEXTRUDEDAREASOLID(#44,$,#12,2.);
#44=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,0.05);
)"));
  const PlanIr& plan = *result.plan;
  ASSERT_EQ(plan.elements.size(), 2u);
  EXPECT_EQ(plan.elements[0].kind, ElementKind::kCurtainWall);
  EXPECT_EQ(plan.elements[0].name, "C");
  EXPECT_TRUE(plan.elements[0].body.empty());
  EXPECT_NEAR(Volume(plan.elements[0].uncut), 0.1, 1e-9);
  ASSERT_EQ(plan.openings.size(), 1u);
  EXPECT_EQ(plan.openings[0].wall, 0u);
  EXPECT_EQ(plan.openings[0].filling, 1u);
  ASSERT_EQ(result.diagnostics.all().size(), 1u);  // of the empty one
  EXPECT_EQ(result.diagnostics.all()[0].kind, DiagnosticKind::kWallWithoutBody);
  EXPECT_EQ(result.diagnostics.all()[0].location.guid, "curtain000000000000002");
}

// Attributes 9 and 10 are widths and heights of doors and windows only.
TEST(ReadIfc, CurtainWallInAnOpeningIsNotAskedForItsOverallHeight) {
  std::string text = Scene();
  const std::string door = "IFCDOOR('door000000000000000001',$,'D',$,$,#51,#52,$,2.,0.9)";
  text.replace(text.find(door), door.size(), "IFCCURTAINWALL('door000000000000000001',$,'C',$,$,#51,#52,$,.NOTDEFINED.)");
  const Result result = Read(text);
  EXPECT_FALSE(result.Has(DiagnosticKind::kBadAttribute));
  ASSERT_EQ(result.plan->openings.size(), 1u);
  EXPECT_EQ(result.plan->openings[0].filling, 1u);
  EXPECT_FALSE(result.plan->openings[0].height_m);
}

TEST(ReadIfc, TrueNorthIsWhereTheContextSays) {
  EXPECT_FALSE(Read(Scene()).plan->true_north_rad);
  const Result result = Read(test::IfcText(R"(
#10=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,$,#11);
#11=IFCDIRECTION((-1.,0.));
#12=IFCBUILDING('building00000000000001',$,'B',$,$,$,$,$,.ELEMENT.,$,$,$);
)"));
  ASSERT_TRUE(result.plan && result.plan->true_north_rad);
  EXPECT_NEAR(*result.plan->true_north_rad, 3.14159265358979, 1e-12);
}

TEST(ReadIfc, PaneOfAWindowWithoutStylesIsGlass) {
  const Result result = Read(test::IfcText(R"(
#10=IFCWINDOW('window0000000000000001',$,'F',$,$,$,#11,$,1.2,1.);
#11=IFCPRODUCTDEFINITIONSHAPE($,$,(#12));
#12=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#20,#30));
#13=IFCDIRECTION((0.,1.,0.));
#14=IFCCARTESIANPOINT((0.,0.,0.));
#15=IFCAXIS2PLACEMENT3D(#14,#13,$);
#16=IFCDIRECTION((0.,0.,1.));
#20=IFCEXTRUDEDAREASOLID(#21,#15,#16,0.04);
#21=IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$,#22,(#23));
#22=IFCPOLYLINE((#24,#25,#26,#27,#24));
#23=IFCPOLYLINE((#34,#35,#36,#37,#34));
#24=IFCCARTESIANPOINT((0.,0.));
#25=IFCCARTESIANPOINT((1.,0.));
#26=IFCCARTESIANPOINT((1.,1.2));
#27=IFCCARTESIANPOINT((0.,1.2));
#30=IFCEXTRUDEDAREASOLID(#31,#15,#16,0.02);
#31=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#23);
#34=IFCCARTESIANPOINT((0.1,0.1));
#35=IFCCARTESIANPOINT((0.9,0.1));
#36=IFCCARTESIANPOINT((0.9,1.1));
#37=IFCCARTESIANPOINT((0.1,1.1));
)"));
  ASSERT_EQ(result.plan->elements.size(), 2u);
  EXPECT_EQ(result.plan->elements[0].material, Material::kOpaque);
  EXPECT_NEAR(Volume(result.plan->elements[0].body), (1.2 - 0.8) * 0.04, 1e-9);
  EXPECT_EQ(result.plan->elements[1].material, Material::kGlass);
  EXPECT_NEAR(Volume(result.plan->elements[1].body), 0.8 * 0.02, 1e-9);
}

TEST(ReadIfc, PartsTakeTheKindAndStoreyOfTheirWhole) {
  const Result result = Read(test::IfcText(R"(
#10=IFCBUILDINGSTOREY('storey0000000000000001',$,'Ground',$,$,$,$,$,.ELEMENT.,0.);
#11=IFCSTAIR('stair00000000000000001',$,'S',$,$,$,$,$,.NOTDEFINED.);
#12=IFCRELAGGREGATES('rel0000000000000000001',$,$,$,#11,(#20));
#13=IFCRELCONTAINEDINSPATIALSTRUCTURE('rel0000000000000000002',$,$,$,(#11),#10);
#20=IFCSLAB('slab000000000000000001',$,'Landing',$,$,$,#21,$,.LANDING.);
#21=IFCPRODUCTDEFINITIONSHAPE($,$,(#22));
#22=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#23));
#23=IFCEXTRUDEDAREASOLID(#24,$,#25,0.2);
#24=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,1.);
#25=IFCDIRECTION((0.,0.,1.));
)"));
  ASSERT_EQ(result.plan->elements.size(), 1u);
  EXPECT_EQ(result.plan->elements[0].kind, ElementKind::kStair);
  EXPECT_EQ(result.plan->elements[0].storey, 0u);
}

TEST(ReadIfc, WallWithoutBodyAndBadOptions) {
  const Result result = Read(test::IfcText("#10=IFCWALL('wall000000000000000001',$,'W',$,$,$,$,$);"));
  EXPECT_TRUE(result.plan->elements.empty());
  EXPECT_TRUE(result.Has(DiagnosticKind::kWallWithoutBody));
  const Result bad = Read(Scene(), {.chord_tolerance_m = -1});
  EXPECT_FALSE(bad.plan);
  EXPECT_NE(bad.diagnostics.all()[0].message.find("chord_tolerance_m"), std::string::npos);
  EXPECT_FALSE(Read("<svg/>").plan);
}

// Whatever a reference is bent to, the frontend ends with a plan.
TEST(ReadIfc, SurvivesBentReferencesAndDamage) {
  const std::string whole = Scene();
  const size_t data = whole.find("#10=");
  std::mt19937_64 rng(11);
  for (int round = 0; round < 400; ++round) {
    std::string text = whole;
    for (int k = 0; k < 4; ++k) {
      const size_t at = data + rng() % (text.size() - data);
      if (rng() % 2 == 0) {
        const size_t reference = text.find('#', at);
        if (reference != std::string::npos && reference + 3 < text.size()) {
          text[reference + 1] = static_cast<char>('1' + rng() % 7);
          text[reference + 2] = static_cast<char>('0' + rng() % 10);
        }
      } else {
        text[at] = "#=();',-9e.$*"[rng() % 13];
      }
    }
    (void)Read(text);
  }
}

TEST(IfcFrontend, ProxiesThatActAsWallsGetAnUncutBody) {
  const auto scene = [](const std::string& proxy, const std::string& more = {}) {
    std::string text = kScene;
    const size_t at = text.find("IFCWALLSTANDARDCASE('wall000000000000000001',$,'W\\X\\FC',$,$,#21,#22,$)");
    EXPECT_NE(at, std::string::npos);
    text.replace(at, text.find(';', at) - at, proxy);
    return Read(test::IfcText(text + more));
  };
  const std::string by_openings = "IFCBUILDINGELEMENTPROXY('wall000000000000000001',$,'Generic Models 7',$,$,#21,#22,$,$)";
  const Result voided = scene(by_openings);
  ASSERT_TRUE(voided.plan);
  EXPECT_EQ(voided.plan->elements.at(0).kind, ElementKind::kProxy);
  EXPECT_NEAR(Volume(voided.plan->elements[0].uncut), 5 * 0.3 * 2.5, 1e-9);
  EXPECT_TRUE(voided.Has(DiagnosticKind::kProxyAsWall));

  const std::string loose = R"(
#80=IFCBUILDINGELEMENTPROXY('proxy00000000000000001',$,'%',$,$,#21,#82,$,$);
#82=IFCPRODUCTDEFINITIONSHAPE($,$,(#24));
)";
  const auto with_name = [&](const std::string& name) {
    std::string text = loose;
    text.replace(text.find('%'), 1, name);
    const Result result = Read(test::IfcText(kScene + text));
    return result.plan && !result.plan->elements.back().uncut.empty();
  };
  EXPECT_TRUE(with_name("Glass Wall:12"));
  EXPECT_TRUE(with_name("Wand-003"));
  EXPECT_FALSE(with_name("Wallpaper"));
  EXPECT_FALSE(with_name("Billboard"));
}

TEST(IfcFrontend, AGlobalIdUsedTwiceIsSaidAndBothAreKept) {
  const Result result = Read(test::IfcText(std::string(kScene) + "#80=IFCWALL('wall000000000000000001',$,'w',$,$,#21,#82,$,$);\n"
                                                                 "#82=IFCPRODUCTDEFINITIONSHAPE($,$,(#24));\n"));
  ASSERT_TRUE(result.plan);
  EXPECT_TRUE(result.Has(DiagnosticKind::kDuplicateGlobalId));
  EXPECT_EQ(std::count_if(result.plan->elements.begin(), result.plan->elements.end(),
                          [](const PlanElement& e) { return e.kind == ElementKind::kWall; }),
            2);
}

TEST(IfcFrontend, AMapConversionToWhereThePlanStandsIsSaid) {
  const auto read = [](const std::string& eastings) {
    std::string text = kScene;
    const std::string corner = "#13=IFCCARTESIANPOINT((10.,20.,3.));";
    text.replace(text.find(corner), corner.size(), "#13=IFCCARTESIANPOINT((455000.,5430000.,3.));");
    return Read(test::IfcText(text + "#80=IFCMAPCONVERSION(#81,#82," + eastings + ",5430010.,110.,1.,0.,1.);\n"));
  };
  EXPECT_TRUE(read("455020.").Has(DiagnosticKind::kGeoreferencedTwice));
  EXPECT_FALSE(read("4550200.").Has(DiagnosticKind::kGeoreferencedTwice));
}

TEST(IfcFrontend, AMapConversionInThePropertySetOfIfc2x3IsSaid) {
  const auto read = [](const std::string& set_name, const std::string& northings) {
    std::string text = kScene;
    const std::string corner = "#13=IFCCARTESIANPOINT((10.,20.,3.));";
    text.replace(text.find(corner), corner.size(), "#13=IFCCARTESIANPOINT((455000.,5430000.,3.));");
    text += "#80=IFCPROPERTYSET('pset000000000000000080',$,'" + set_name + "',$,(#81,#82,#83));\n"
            "#81=IFCPROPERTYSINGLEVALUE('TargetCRS',$,IFCLABEL('EPSG:25832'),$);\n"
            "#82=IFCPROPERTYSINGLEVALUE('Eastings',$,IFCLENGTHMEASURE(455020.),$);\n"
            "#83=IFCPROPERTYSINGLEVALUE('Northings',$," + northings + ",$);\n";
    return Read(test::IfcText(text, "IFC2X3"));
  };
  EXPECT_TRUE(read("ePSet_MapConversion", "IFCLENGTHMEASURE(5430010.)").Has(DiagnosticKind::kGeoreferencedTwice));
  EXPECT_TRUE(read("ePset_MapConversion", "IFCREAL(5430010.)").Has(DiagnosticKind::kGeoreferencedTwice));
  EXPECT_FALSE(read("ePSet_MapConversion", "IFCLENGTHMEASURE(0.)").Has(DiagnosticKind::kGeoreferencedTwice));
  EXPECT_FALSE(read("ePSet_MapConversion", "$").Has(DiagnosticKind::kGeoreferencedTwice));
  EXPECT_FALSE(read("Other", "IFCLENGTHMEASURE(5430010.)").Has(DiagnosticKind::kGeoreferencedTwice));
}

TEST(IfcFrontend, WhatHasNoBuildingIsRefused) {
  for (const std::string data :
       {"", "#10=PRODUCT('bracket','bracket','',(#11));\n#11=PRODUCT_CONTEXT('',$,'mechanical');", "#10=FOO(1,2,3);\n#11=BAR('wall',#10);",
        "#10=IFCWALLTYPE('type000000000000000001',$,'T',$,$,$,$,$,$,.STANDARD.);"}) {
    const Result result = Read(test::IfcText(data));
    EXPECT_FALSE(result.plan) << data;
    EXPECT_TRUE(result.Has(DiagnosticKind::kNoBuilding)) << data;
  }
  EXPECT_TRUE(Read(test::IfcText("#10=IFCBUILDING('building00000000000001',$,'B',$,$,$,$,$,.ELEMENT.,$,$,$);")).plan);
  EXPECT_TRUE(Read(test::IfcText("#10=IFCSLAB('slab000000000000000001',$,'S',$,$,$,$,$,$);")).plan);
}

}  // namespace
}  // namespace plumb::compiler
