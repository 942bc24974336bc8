#include "compiler/frontends/ifc/ifc_units.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/ifc_text.h"

namespace plumb::compiler {
namespace {

struct Units {
  double length, angle;
  std::vector<Diagnostic> diagnostics;
};

Units Read(const std::string& text) {
  DiagnosticSink sink;
  std::optional<IfcModel> model = IfcModel::Open(text, sink);
  EXPECT_TRUE(model);
  ReadUnits(*model);
  return {model->length_scale(), model->angle_scale(), sink.all()};
}

std::string WithUnits(const std::string& list, const std::string& data) {
  std::string text = test::IfcText(data);
  text.replace(text.find("((#3,#4))"), 9, "(" + list + ")");
  return text;
}

TEST(ReadUnits, SiUnitsAndPrefixes) {
  EXPECT_EQ(Read(test::IfcText("")).length, 1);
  EXPECT_EQ(Read(WithUnits("(#10)", "#10=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);")).length, 1e-3);
  EXPECT_EQ(Read(WithUnits("(#10)", "#10=IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.);")).length, 1e-2);
}

TEST(ReadUnits, FeetInchesAndDegrees) {
  const Units units =
      Read(WithUnits("(#10,#13)",
                     "#10=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'FOOT',#11);\n#11=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#12);\n"
                     "#12=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#13=IFCCONVERSIONBASEDUNIT($,.PLANEANGLEUNIT.,'DEGREE',#14);\n"
                     "#14=IFCMEASUREWITHUNIT(IFCPLANEANGLEMEASURE(0.0174532925199433),#4);"));
  EXPECT_DOUBLE_EQ(units.length, 0.3048);
  EXPECT_NEAR(units.angle, std::numbers::pi / 180, 1e-12);
  // Inches converted to feet converted to millimetres.
  EXPECT_NEAR(
      Read(WithUnits(
               "(#10)",
               "#10=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'INCH',#11);\n#11=IFCMEASUREWITHUNIT(IFCRATIOMEASURE(0.0833333333333333),#12);\n"
               "#12=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'FOOT',#13);\n#13=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(304.8),#14);\n"
               "#14=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);"))
          .length,
      0.0254, 1e-12);
}

TEST(ReadUnits, MissingOrCyclicUnitsFallBackToMetres) {
  const Units missing = Read(WithUnits("(#4)", ""));
  EXPECT_EQ(missing.length, 1);
  ASSERT_EQ(missing.diagnostics.size(), 1u);
  EXPECT_EQ(missing.diagnostics[0].kind, DiagnosticKind::kNoLengthUnit);
  const Units cycle =
      Read(WithUnits("(#10)", "#10=IFCCONVERSIONBASEDUNIT($,.LENGTHUNIT.,'X',#11);\n#11=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(2.),#10);"));
  EXPECT_EQ(cycle.length, 1);
  EXPECT_EQ(cycle.diagnostics[0].kind, DiagnosticKind::kUnitNotRead);
}

TEST(IfcModel, RefusesOtherSchemas) {
  DiagnosticSink sink;
  EXPECT_FALSE(IfcModel::Open(test::IfcText("", "AUTOMOTIVE_DESIGN"), sink));
  ASSERT_EQ(sink.all().size(), 1u);
  EXPECT_EQ(sink.all()[0].kind, DiagnosticKind::kUnknownSchema);
  for (const char* schema : {"IFC2X_FINAL", "IFC2X3", "IFC4", "IFC4X3_ADD2"})
    EXPECT_TRUE(IfcModel::Open(test::IfcText("", schema), sink)) << schema;
}

TEST(IfcModel, MissingReferencesAreReportedOnce) {
  DiagnosticSink sink;
  const std::string text = test::IfcText("#10=IFCWALL('a',#77,#77);");
  const auto model = IfcModel::Open(text, sink);
  const IfcInstance wall = model->Get(model->InstancesOf(IfcType::kIfcWall)[0]);
  EXPECT_FALSE(model->Follow(wall[1]));
  EXPECT_FALSE(model->Follow(wall[2]));
  ASSERT_EQ(sink.all().size(), 1u);
  EXPECT_EQ(sink.all()[0].kind, DiagnosticKind::kMissingReference);
  EXPECT_EQ(sink.all()[0].location.step_id, 77u);
}

}  // namespace
}  // namespace plumb::compiler
