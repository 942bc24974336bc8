#include "compiler/frontends/ifc/ifc_doors.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/frontends/ifc/ifc_frontend.h"
#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kHalf_rad = 1.5707963;

// A door 1.2 m wide at (10, 20), its placement's axes as given.
struct Scene {
  std::string axis = "(0.,0.,1.)", x = "(1.,0.,0.)", schema = "IFC4";
  std::string operation = "$";                                                // of the door
  std::string type;                                                           // #60, an IfcDoorType or IfcDoorStyle
  std::string target = "IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#21,1.,$)";  // of the mapped plan symbol
  std::string curves;                                                         // #70 and on: of the plan symbol
  std::string symbol;                                                         // references to them

  [[nodiscard]] std::string Text() const {
    const bool old = schema == "IFC2X3";
    std::string out = fmt::format("#20=IFCDIRECTION({});\n#21=IFCCARTESIANPOINT((0.,0.,0.));\n#22=IFCDIRECTION({});\n", axis, x);
    out += "#23=IFCCARTESIANPOINT((10.,20.,0.));\n#24=IFCAXIS2PLACEMENT3D(#23,#20,#22);\n#25=IFCLOCALPLACEMENT($,#24);\n";
    out += fmt::format("#30=IFCDOOR('door000000000000000001',$,'D',$,$,#25,#31,$,2.,1.2{});\n", old ? "" : ",.DOOR.," + operation + ",$");
    out += "#31=IFCPRODUCTDEFINITIONSHAPE($,$,(#32));\n#32=IFCSHAPEREPRESENTATION($,'FootPrint','MappedRepresentation',(#33));\n";
    out += "#33=IFCMAPPEDITEM(#34,#36);\n#34=IFCREPRESENTATIONMAP(#35,#37);\n#35=IFCAXIS2PLACEMENT3D(#21,$,$);\n#36=" + target + ";\n";
    out += "#37=IFCSHAPEREPRESENTATION($,'FootPrint','GeometricCurveSet',(#38));\n#38=IFCGEOMETRICCURVESET((" + symbol + "));\n";
    if (!type.empty()) out += "#60=" + type + ";\n#61=IFCRELDEFINESBYTYPE('rel0000000000000000001',$,$,$,(#30),#60);\n";
    return test::IfcText(out + curves, schema);
  }

  // A quarter of a circle from `from_rad` on.
  Scene& AddSwing(int id, Vector2d hinge, double radius_m, double from_rad) {
    curves += fmt::format("#{}=IFCTRIMMEDCURVE(#{},(IFCPARAMETERVALUE({:.7f})),(IFCPARAMETERVALUE({:.7f})),.T.,.PARAMETER.);\n", id, id + 1,
                          from_rad, from_rad + kHalf_rad);
    curves += fmt::format("#{}=IFCCIRCLE(#{},{:.4f});\n#{}=IFCAXIS2PLACEMENT2D(#{},$);\n#{}=IFCCARTESIANPOINT(({:.4f},{:.4f}));\n", id + 1,
                          id + 2, radius_m, id + 2, id + 3, id + 3, hinge.x(), hinge.y());
    symbol += fmt::format("{}#{}", symbol.empty() ? "" : ",", id);
    return *this;
  }
};

std::string TypeOf(const std::string& operation, const std::string& words = "$") {
  return "IFCDOORTYPE('type000000000000000001',$,'T',$,$,(#80,#81),(#34),$,$,.DOOR.," + operation + ",$," + words + ")";
}

std::string StyleOf(const std::string& operation) {
  return "IFCDOORSTYLE('type000000000000000001',$,'T',$,$,$,(#34),$," + operation + ",.NOTDEFINED.,.F.,.F.)";
}

std::vector<PlanLeaf> LeavesOf(const Scene& scene) {
  const std::string text = scene.Text();
  DiagnosticSink sink;
  const std::optional<PlanIr> plan = ReadIfc(Source{.path = "d.ifc", .bytes = text, .sha256 = "", .format = DetectFormat(text)}, sink);
  if (!plan || plan->elements.size() != 1) {
    ADD_FAILURE() << DiagnosticsToText(sink.all(), "d.ifc");
    return {};
  }
  return plan->elements[0].leaves;
}

void ExpectLeaf(const PlanLeaf& leaf, LeafOperation operation, const Vector2d& to_jamb, const Vector2d& opens_to) {
  EXPECT_EQ(leaf.operation, operation);
  EXPECT_TRUE(leaf.to_jamb.isApprox(to_jamb, 1e-6) || (leaf.to_jamb - to_jamb).norm() < 1e-6) << leaf.to_jamb.transpose();
  EXPECT_TRUE((leaf.opens_to - opens_to).norm() < 1e-6) << leaf.opens_to.transpose();
}

TEST(IfcDoors, LeftIsLowXAndTheLeafOpensAlongY) {
  for (const bool stated_by_type : {false, true}) {
    Scene scene;
    (stated_by_type ? scene.type : scene.operation) = stated_by_type ? TypeOf(".SINGLE_SWING_LEFT.") : ".SINGLE_SWING_LEFT.";
    const auto leaves = LeavesOf(scene);
    ASSERT_EQ(leaves.size(), 1u);
    ExpectLeaf(leaves[0], LeafOperation::kSwing, {-1, 0}, {0, 1});
  }
}

TEST(IfcDoors, FollowThePlacementOfTheDoor) {
  Scene scene;
  scene.operation = ".SINGLE_SWING_RIGHT.";
  scene.x = "(0.,-1.,0.)";
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {0, -1}, {1, 0});
  // Upside down: what was to the left of y is so still, seen from below.
  scene.axis = "(0.,0.,-1.)";
  scene.x = "(1.,0.,0.)";
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {1, 0}, {0, -1});
}

TEST(IfcDoors, StylesOfOlderReleases) {
  Scene scene;
  scene.schema = "IFC2X3";
  scene.type = StyleOf(".DOUBLE_DOOR_SINGLE_SWING_OPPOSITE_LEFT.");
  const auto leaves = LeavesOf(scene);
  ASSERT_EQ(leaves.size(), 2u);
  ExpectLeaf(leaves[0], LeafOperation::kSwing, {-1, 0}, {0, 1});
  ExpectLeaf(leaves[1], LeafOperation::kSwing, {1, 0}, {0, -1});
}

// The type is drawn and stated as left; laid mirrored, it hangs right.
TEST(IfcDoors, AMirroredShapeMirrorsWhatItsTypeStates) {
  Scene scene;
  scene.type = TypeOf(".SINGLE_SWING_LEFT.");
  scene.target = "IFCCARTESIANTRANSFORMATIONOPERATOR3D(#90,#91,#21,1.,#92)";
  scene.curves = "#90=IFCDIRECTION((-1.,0.,0.));\n#91=IFCDIRECTION((0.,1.,0.));\n#92=IFCDIRECTION((0.,0.,1.));\n";
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {1, 0}, {0, 1});
  // What the door itself states is in its own frame.
  scene.operation = ".SINGLE_SWING_LEFT.";
  scene.type = TypeOf(".NOTDEFINED.");
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {-1, 0}, {0, 1});
}

TEST(IfcDoors, PanelsStateTheirShares) {
  Scene scene;
  scene.type = TypeOf(".DOUBLE_DOOR_SINGLE_SWING.");
  scene.curves =
      "#80=IFCDOORPANELPROPERTIES('panel00000000000000001',$,$,$,0.04,.SWINGING.,0.66,.RIGHT.,$);\n"
      "#81=IFCDOORPANELPROPERTIES('panel00000000000000002',$,$,$,0.04,.SWINGING.,0.36,.LEFT.,$);\n";
  const auto leaves = LeavesOf(scene);
  ASSERT_EQ(leaves.size(), 2u);
  EXPECT_NEAR(leaves[0].width_m, 0.36 / 1.02 * 1.2, 1e-9);
  EXPECT_NEAR(leaves[1].width_m, 0.66 / 1.02 * 1.2, 1e-9);
}

// The panels are the type's, left and right as it is drawn; what the door itself states is in its own frame.
TEST(IfcDoors, PanelsOfAMirroredTypeAreMirrored) {
  Scene scene;
  scene.operation = ".DOUBLE_DOOR_SINGLE_SWING.";
  scene.type = TypeOf(".NOTDEFINED.");
  scene.target = "IFCCARTESIANTRANSFORMATIONOPERATOR3D(#90,#91,#21,1.,#92)";
  scene.curves =
      "#80=IFCDOORPANELPROPERTIES('panel00000000000000001',$,$,$,0.04,.SWINGING.,0.7,.RIGHT.,$);\n"
      "#81=IFCDOORPANELPROPERTIES('panel00000000000000002',$,$,$,0.04,.SWINGING.,0.3,.LEFT.,$);\n"
      "#90=IFCDIRECTION((-1.,0.,0.));\n#91=IFCDIRECTION((0.,1.,0.));\n#92=IFCDIRECTION((0.,0.,1.));\n";
  const auto leaves = LeavesOf(scene);
  ASSERT_EQ(leaves.size(), 2u);
  for (const PlanLeaf& leaf : leaves) EXPECT_NEAR(leaf.width_m, leaf.to_jamb.x() > 0 ? 0.36 : 0.84, 1e-9);
}

TEST(IfcDoors, DrawnSwingsTellWhatIsNotStated) {
  Scene scene;
  scene.operation = ".NOTDEFINED.";
  // Hinge at high x; from there the open end lies against y.
  scene.AddSwing(70, {1.2, 0.05}, 1.19, 2 * kHalf_rad);
  auto leaves = LeavesOf(scene);
  ASSERT_EQ(leaves.size(), 1u);
  ExpectLeaf(leaves[0], LeafOperation::kSwing, {1, 0}, {0, -1});
  EXPECT_NEAR(leaves[0].width_m, 1.19, 1e-6);
  // Laid mirrored about the door's length.
  scene.target = "IFCCARTESIANTRANSFORMATIONOPERATOR3D(#90,#91,#21,1.,#92)";
  scene.curves += "#90=IFCDIRECTION((1.,0.,0.));\n#91=IFCDIRECTION((0.,-1.,0.));\n#92=IFCDIRECTION((0.,0.,1.));\n";
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {1, 0}, {0, 1});
}

TEST(IfcDoors, WhatIsStatedGoesBeforeWhatIsDrawn) {
  Scene scene;
  scene.operation = ".SLIDING_TO_LEFT.";
  scene.AddSwing(70, {0, 0}, 1.2, 0);
  const auto leaves = LeavesOf(scene);
  ASSERT_EQ(leaves.size(), 1u);
  ExpectLeaf(leaves[0], LeafOperation::kSliding, {-1, 0}, {0, 0});
}

TEST(IfcDoors, NothingStatedOrDrawnIsUnknown) {
  Scene scene;
  EXPECT_TRUE(LeavesOf(scene).empty());
  scene.type = TypeOf(".NOTDEFINED.");
  scene.AddSwing(70, {0, 0}, 0.1, 0);
  EXPECT_TRUE(LeavesOf(scene).empty());
}

TEST(IfcDoors, ASymbolWithinItselfEnds) {
  Scene scene;
  scene.AddSwing(70, {0, 0}, 1.2, 0);
  scene.symbol += ",#33";
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSwing, {-1, 0}, {0, 1});
}

// Each of eight maps holds the next a hundred times.
TEST(IfcDoors, SymbolsThatMultiplyEndSoon) {
  Scene scene;
  scene.AddSwing(70, {0, 0}, 1.2, 0);
  for (int level = 0; level < 8; ++level) {
    const int id = 100 + 10 * level;
    scene.curves += fmt::format("#{}=IFCMAPPEDITEM(#{},#36);\n#{}=IFCREPRESENTATIONMAP(#35,#{});\n", id, id + 1, id + 1, id + 2);
    std::string items = level == 7 ? "#70" : fmt::format("#{}", id + 10);
    const std::string one = items;
    for (int i = 1; i < 100; ++i) items += "," + one;
    scene.curves += fmt::format("#{}=IFCSHAPEREPRESENTATION($,'FootPrint','Curve2D',({}));\n", id + 2, items);
  }
  scene.symbol += ",#100";
  EXPECT_EQ(LeavesOf(scene).size(), 1u);
}

// One shape and one type with many references, shared by many doors: each reference of each door is work.
TEST(IfcDoors, ReferencesThatManyDoorsShareAreCounted) {
  constexpr int kReferences = 30000, kDoors = 2000;
  std::string items = "#33", maps = "#39", doors, ids;
  for (int i = 1; i < kReferences; ++i) {
    items += ",#33";
    maps += ",#39";
  }
  for (int i = 0; i < kDoors; ++i) {
    doors += fmt::format("#{}=IFCDOOR('door{:018}',$,'D',$,$,#25,#31,$,2.,1.2,.DOOR.,$,$);\n", 1000 + i, i);
    ids += fmt::format("{}#{}", i == 0 ? "" : ",", 1000 + i);
  }
  const std::string text = test::IfcText(
      "#21=IFCCARTESIANPOINT((0.,0.,0.));\n#24=IFCAXIS2PLACEMENT3D(#21,$,$);\n#25=IFCLOCALPLACEMENT($,#24);\n"
      "#31=IFCPRODUCTDEFINITIONSHAPE($,$,(#32));\n#32=IFCSHAPEREPRESENTATION($,'FootPrint','MappedRepresentation',(" +
          items +
          "));\n#33=IFCMAPPEDITEM(#34,#36);\n#34=IFCREPRESENTATIONMAP(#24,#37);\n#39=IFCREPRESENTATIONMAP(#24,#37);\n"
          "#36=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#21,1.,$);\n#37=IFCSHAPEREPRESENTATION($,'FootPrint','Curve2D',());\n"
          "#60=IFCDOORTYPE('type000000000000000001',$,'T',$,$,$,(" +
          maps + "),$,$,.DOOR.,.SINGLE_SWING_LEFT.,$,$);\n" + doors + "#61=IFCRELDEFINESBYTYPE('rel0000000000000000001',$,$,$,(" + ids +
          "),#60);\n",
      "IFC4");
  DiagnosticSink sink;
  (void)ReadIfc(Source{.path = "d.ifc", .bytes = text, .sha256 = "", .format = DetectFormat(text)}, sink);
  EXPECT_TRUE(
      std::any_of(sink.all().begin(), sink.all().end(), [](const Diagnostic& d) { return d.kind == DiagnosticKind::kPlanTooComplex; }));
}

TEST(IfcDoors, PeoplesOwnWords) {
  Scene scene;
  scene.type = TypeOf(".USERDEFINED.", "'Double panel sliding'");
  EXPECT_EQ(LeavesOf(scene).size(), 2u);
  scene.type = TypeOf(".USERDEFINED.", "'pocket door, oak'");
  ExpectLeaf(LeavesOf(scene).at(0), LeafOperation::kSliding, {0, 0}, {0, 0});
  scene.type = TypeOf(".USERDEFINED.", "'as agreed'");
  EXPECT_TRUE(LeavesOf(scene).empty());
}

TEST(LeavesByOperation, KnowsTheEnumeratorsOfAllReleases) {
  for (const char* one : {"SINGLE_SWING_LEFT", "DOUBLE_SWING_RIGHT", "SLIDING_TO_LEFT", "FOLDING_TO_RIGHT", "REVOLVING",
                          "REVOLVING_VERTICAL", "ROLLINGUP", "LIFTING_HORIZONTAL", "LIFTING_VERTICAL_LEFT"})
    EXPECT_EQ(LeavesByOperation(one).size(), 1u) << one;
  for (const char* two :
       {"DOUBLE_DOOR_SINGLE_SWING", "DOUBLE_PANEL_SINGLE_SWING_OPPOSITE_RIGHT", "DOUBLE_DOOR_DOUBLE_SWING", "DOUBLE_PANEL_SLIDING",
        "DOUBLE_PANEL_FOLDING", "SWING_FIXED_LEFT", "SWING_FIXED_RIGHT", "DOUBLE_PANEL_LIFTING_VERTICAL"}) {
    const auto leaves = LeavesByOperation(two);
    ASSERT_EQ(leaves.size(), 2u) << two;
    EXPECT_EQ(leaves[0].at_x, -1) << two;
    EXPECT_EQ(leaves[1].at_x, 1) << two;
  }
  for (const char* none : {"NOTDEFINED", "USERDEFINED", "", "DOUBLE_"}) EXPECT_TRUE(LeavesByOperation(none).empty()) << none;
  EXPECT_EQ(LeavesByOperation("SWING_FIXED_RIGHT")[0].operation, LeafOperation::kFixed);
  EXPECT_EQ(LeavesByOperation("DOUBLE_DOOR_SINGLE_SWING_OPPOSITE_RIGHT")[0].opens_to_y, -1);
}

}  // namespace
}  // namespace plumb::compiler
