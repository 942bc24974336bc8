// Files that no honest program writes: each is refused with an error that says why, soon and in little memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "compiler/frontends/ifc/ifc_frontend.h"
#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

// A wall of 4 m x 0.2 m x 3 m in a storey; #20 is its placement, #22 a point of it, #32 its solid, #33 the profile.
std::string Wall(const std::string& placement = "#20=IFCLOCALPLACEMENT($,#21);",
                 const std::string& solid = "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
                 const std::string& profile = "#33=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,0.2);") {
  return "#10=IFCWALL('wall000000000000000001',$,'w',$,$,#20,#30,$,$);\n" + placement +
         "\n#21=IFCAXIS2PLACEMENT3D(#22,$,$);\n#22=IFCCARTESIANPOINT((0.,0.,0.));\n"
         "#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#31));\n#31=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#32));\n" +
         solid + "\n" + profile +
         "\n#34=IFCDIRECTION((0.,0.,1.));\n"
         "#50=IFCBUILDINGSTOREY('storey0000000000000001',$,'s',$,$,$,$,$,.ELEMENT.,0.);\n"
         "#51=IFCRELCONTAINEDINSPATIALSTRUCTURE('rel0000000000000000001',$,$,$,(#10),#50);\n";
}

class HostileIfc : public ::testing::Test {
 protected:
  std::optional<PlanIr> Read(const std::string& text) {
    diagnostics_ = DiagnosticSink();
    const Source source{.path = "test.ifc", .bytes = text, .sha256 = "00", .format = DetectFormat(text)};
    return ReadIfc(source, diagnostics_, options_);
  }
  // Refused, and by that kind of error.
  void ExpectRefused(const std::string& text, DiagnosticKind kind) {
    EXPECT_FALSE(Read(text)) << text.substr(0, 2000);
    const auto& all = diagnostics_.all();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) { return d.kind == kind; }));
    EXPECT_TRUE(diagnostics_.has_errors());
    EXPECT_LT(all.size(), 20000u);
  }

  DiagnosticSink diagnostics_;
  IfcOptions options_;
};

TEST_F(HostileIfc, TheWallItselfIsRead) {
  const auto plan = Read(test::IfcText(Wall()));
  ASSERT_TRUE(plan);
  EXPECT_NEAR(Volume(plan->elements.at(0).body), 4 * 0.2 * 3, 1e-9);
}

TEST_F(HostileIfc, TruncatedAnywhereIsRefused) {
  const std::string text = test::IfcText(Wall());
  const size_t data_end = text.rfind("ENDSEC");
  for (size_t size = text.find("#10="); size < data_end; size += 7) {
    EXPECT_FALSE(Read(text.substr(0, size))) << size;
    EXPECT_TRUE(diagnostics_.has_errors()) << size;
  }
}

TEST_F(HostileIfc, OtherSchemasAreRefused) {
  for (const char* schema : {"IFC5", "AP214", "CONFIG_CONTROL_DESIGN", ""})
    ExpectRefused(test::IfcText(Wall(), schema), DiagnosticKind::kUnknownSchema);
}

TEST_F(HostileIfc, NumbersThatAreNoneAreRefused) {
  for (const char* number : {"NAN", "-INF", "1.E999", "1.E308", "-1.#IND"}) {
    const std::string x(number);
    ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34," + x + ");")),
                  DiagnosticKind::kNumberNotFinite);
    ExpectRefused(
        test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#23);\n#23=IFCAXIS2PLACEMENT3D(#24,$,$);\n#24=IFCCARTESIANPOINT((0.," + x + ",0.));")),
        DiagnosticKind::kNumberNotFinite);
    ExpectRefused(
        test::IfcText(Wall(
            "#20=IFCLOCALPLACEMENT($,#21);",
            "#32=IFCTRIANGULATEDFACESET(#40,$,$,((1,2,3)),$);\n#40=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(0.," + x + ",0.)));")),
        DiagnosticKind::kNumberNotFinite);
  }
}

TEST_F(HostileIfc, CyclesAreRefused) {
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT(#20,#21);")), DiagnosticKind::kReferenceCycle);
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT(#23,#21);\n#23=IFCLOCALPLACEMENT(#20,#21);")), DiagnosticKind::kReferenceCycle);
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCBOOLEANRESULT(.DIFFERENCE.,#32,#32);")),
                DiagnosticKind::kReferenceCycle);
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);",
                                   "#32=IFCBOOLEANRESULT(.DIFFERENCE.,#35,#32);\n#35=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);")),
                DiagnosticKind::kReferenceCycle);
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCMAPPEDITEM(#35,$);\n#35=IFCREPRESENTATIONMAP(#21,#31);")),
                DiagnosticKind::kReferenceCycle);
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
                                   "#33=IFCMIRROREDPROFILEDEF(.AREA.,$,#33,$,$);")),
                DiagnosticKind::kReferenceCycle);
}

// Every composite curve holds the next one twice: 2^32 parts without a bound, and a cycle at the end of each.
TEST_F(HostileIfc, CurvesThatUnfoldWithoutEndAreRefused) {
  std::string profile = "#33=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#100);\n";
  for (int i = 0; i < 200; i += 2) {
    profile += fmt::format("#{0}=IFCCOMPOSITECURVE((#{1},#{1}),.F.);\n#{1}=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#{2});\n", 100 + i,
                           101 + i, i < 198 ? 102 + i : 100);
  }
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);", profile)),
                DiagnosticKind::kPlanTooComplex);
}

TEST_F(HostileIfc, PolygonsOfMillionsOfCornersAreRefused) {
  std::string list = "#40=IFCCARTESIANPOINTLIST2D((";
  for (int i = 0; i < 200000; ++i) list += fmt::format("{}({},{})", i > 0 ? "," : "", i % 1000, i * 7919 % 997);
  list += "));\n";
  ExpectRefused(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
                                   "#33=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#41);\n#41=IFCINDEXEDPOLYCURVE(#40,$,.F.);\n" + list)),
                DiagnosticKind::kPlanTooComplex);
  std::string references = "#41=IFCPOLYLINE((#42";
  for (int i = 0; i < 200000; ++i) references += i % 2 == 0 ? ",#43" : ",#42";
  ExpectRefused(test::IfcText(Wall(
                    "#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
                    "#33=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#41);\n#42=IFCCARTESIANPOINT((0.,0.));\n#43=IFCCARTESIANPOINT((1.,0.));\n" +
                        references + "));\n")),
                DiagnosticKind::kPlanTooComplex);
}

// Crossing itself some hundred million times, it has no inside; the wall is left out and the rest read.
TEST_F(HostileIfc, PolygonsThatCrossThemselvesEverywhereEndSoon) {
  std::string list = "#40=IFCCARTESIANPOINTLIST2D((";
  for (int i = 0; i < 20000; ++i) list += fmt::format("{}({},{})", i > 0 ? "," : "", i * 7907 % 1009, i * 7919 % 997);
  list += "));\n";
  const auto plan =
      Read(test::IfcText(Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
                              "#33=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#41);\n#41=IFCINDEXEDPOLYCURVE(#40,$,.F.);\n" + list)));
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->elements.empty());
}

TEST_F(HostileIfc, PlansOfTooManyTrianglesAreRefused) {
  options_.max_triangles = 1000;
  std::string more;
  for (int i = 0; i < 100; ++i) more += fmt::format("#{}=IFCFURNITURE('furniture{:013d}',$,'f',$,$,#20,#30,$,$);\n", 100 + i, i);
  ExpectRefused(test::IfcText(Wall() + more), DiagnosticKind::kPlanTooComplex);
}

// Every cut leaves more triangles to the next one.
TEST_F(HostileIfc, WallsOfTooManyOpeningsAreRefused) {
  std::string more =
      "#60=IFCPRODUCTDEFINITIONSHAPE($,$,(#61));\n#61=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#62));\n"
      "#62=IFCEXTRUDEDAREASOLID(#63,$,#34,2.);\n#63=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,0.01,0.3);\n";
  for (int i = 0; i < 100; ++i) {
    more += fmt::format(
        "#{0}=IFCOPENINGELEMENT('hole{1:018d}',$,'o',$,$,#{2},#60,$,$);\n#{2}=IFCLOCALPLACEMENT($,#{3});\n"
        "#{3}=IFCAXIS2PLACEMENT3D(#{4},$,$);\n#{4}=IFCCARTESIANPOINT((0.{1:02d},0.,0.5));\n"
        "#{5}=IFCRELVOIDSELEMENT('void{1:018d}',$,$,$,#10,#{0});\n",
        1000 + 10 * i, i, 1001 + 10 * i, 1002 + 10 * i, 1003 + 10 * i, 1004 + 10 * i);
  }
  options_.max_cut_triangles = 100000000;
  EXPECT_TRUE(Read(test::IfcText(Wall() + more)));
  options_.max_cut_triangles = 1000;
  ExpectRefused(test::IfcText(Wall() + more), DiagnosticKind::kPlanTooComplex);
}

// As long as they lie apart, their number is no matter: a facade may have hundreds.
TEST_F(HostileIfc, FiveHundredWindowsInAWallAreCutSoon) {
  constexpr int kWindows = 500;
  std::string text =
      Wall("#20=IFCLOCALPLACEMENT($,#21);", "#32=IFCEXTRUDEDAREASOLID(#33,$,#34,3.);",
           "#33=IFCRECTANGLEPROFILEDEF(.AREA.,$,#35,750.,0.3);\n#35=IFCAXIS2PLACEMENT2D(#36,$);\n#36=IFCCARTESIANPOINT((375.,0.));");
  text +=
      "#60=IFCPRODUCTDEFINITIONSHAPE($,$,(#61));\n#61=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#62));\n"
      "#62=IFCEXTRUDEDAREASOLID(#63,$,#34,1.2);\n#63=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.,0.5);\n";
  for (int i = 0; i < kWindows; ++i) {
    text += fmt::format(
        "#{0}=IFCOPENINGELEMENT('hole{1:018d}',$,'o',$,$,#{2},#60,$,$);\n#{2}=IFCLOCALPLACEMENT($,#{3});\n"
        "#{3}=IFCAXIS2PLACEMENT3D(#{4},$,$);\n#{4}=IFCCARTESIANPOINT(({6},0.,0.9));\n"
        "#{5}=IFCRELVOIDSELEMENT('void{1:018d}',$,$,$,#10,#{0});\n",
        1000 + 10 * i, i, 1001 + 10 * i, 1002 + 10 * i, 1003 + 10 * i, 1004 + 10 * i, 1 + 1.5 * i);
  }
  const auto start = std::chrono::steady_clock::now();
  const auto plan = Read(test::IfcText(text));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  ASSERT_TRUE(plan);
  EXPECT_TRUE(diagnostics_.all().size() < 5u);
  const Solid& body = plan->elements.at(0).body;
  EXPECT_TRUE(IsClosed(body));
  EXPECT_NEAR(Volume(body), (750 * 3 - kWindows * 1.2) * 0.3, 1e-6);
  EXPECT_LT(body.triangles.size(), 100u * kWindows);
}

TEST_F(HostileIfc, MissingReferencesAreCounted) {
  std::string references;
  for (int i = 0; i < 100000; ++i) references += fmt::format("{}#{}", i > 0 ? "," : "", 1000 + i);
  EXPECT_TRUE(Read(test::IfcText(Wall() + "#60=IFCRELAGGREGATES('rel0000000000000000002',$,$,$,#10,(" + references + "));")));
  EXPECT_LE(diagnostics_.all().size(), 5001u);
}

// Without an index, openings times walls.
TEST_F(HostileIfc, ManyOpeningsAndDoorsTakeNoSquareOfTime) {
  std::string more;
  for (int i = 0; i < 20000; ++i) {
    more += fmt::format(
        "#{0}=IFCDOOR('door{1:018d}',$,'d',$,$,#{2},#30,$,2.,1.);\n#{2}=IFCLOCALPLACEMENT($,#{3});\n#{3}=IFCAXIS2PLACEMENT3D(#{4},$,$);\n"
        "#{4}=IFCCARTESIANPOINT(({1}.,0.,0.));\n#{5}=IFCOPENINGELEMENT('hole{1:018d}',$,'o',$,$,#{2},#30,$,$);\n"
        "#{6}=IFCRELVOIDSELEMENT('void{1:018d}',$,$,$,#10,#{5});\n",
        1000 + 10 * i, i, 1001 + 10 * i, 1002 + 10 * i, 1003 + 10 * i, 1004 + 10 * i, 1005 + 10 * i);
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(Read(test::IfcText(Wall() + more)));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace
}  // namespace plumb::compiler
