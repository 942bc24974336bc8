// The readers of the frontend over a small file, for their tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "compiler/frontends/ifc/ifc_shape.h"
#include "compiler/frontends/ifc/ifc_units.h"
#include "tests/support/ifc_text.h"

namespace plumb::compiler {

class IfcReaderTest : public ::testing::Test {
 protected:
  void Open(const std::string& data) {
    text_ = test::IfcText(data);
    model_ = IfcModel::Open(text_, diagnostics_);
    ASSERT_TRUE(model_);
    ReadUnits(*model_);
    placements_ = std::make_unique<PlacementReader>(*model_);
    curves_ = std::make_unique<CurveReader>(*model_, *placements_, options_.chord_tolerance_m);
    profiles_ = std::make_unique<ProfileReader>(*model_, *placements_, *curves_, options_.chord_tolerance_m);
    styles_ = std::make_unique<StyleReader>(*model_, options_.glass_transparency);
    shapes_ = std::make_unique<ShapeReader>(*model_, *placements_, *styles_, options_);
  }
  IfcInstance Get(uint64_t id) const { return model_->Get(model_->file().Find(id)); }

  // The body of a product whose representation holds the item #`id` of `data`; ids from 9000 on are taken.
  ShapeParts ReadItem(const std::string& data, const std::string& item, const std::string& type = "SweptSolid") {
    Open(data + "\n#9000=IFCPRODUCTDEFINITIONSHAPE($,$,(#9001));\n#9001=IFCSHAPEREPRESENTATION($,'Body','" + type + "',(" + item + "));");
    return shapes_->Body(Get(9000));
  }

  std::string text_;
  DiagnosticSink diagnostics_;
  IfcOptions options_;
  std::optional<IfcModel> model_;
  std::unique_ptr<PlacementReader> placements_;
  std::unique_ptr<CurveReader> curves_;
  std::unique_ptr<ProfileReader> profiles_;
  std::unique_ptr<StyleReader> styles_;
  std::unique_ptr<ShapeReader> shapes_;
};

}  // namespace plumb::compiler
