#include "compiler/frontends/svg/svg_style.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

SvgStyle StyleOf(const SvgStyleSheet& sheet, std::string_view element, const std::vector<std::string>& classes, std::string_view id) {
  SvgStyle out;
  for (const SvgDeclaration* d : sheet.For(element, classes, id)) ApplySvgDeclaration(d->property, d->value, out);
  return out;
}

TEST(SvgStyleSheet, IdsAreStrongerThanClassesAndClassesThanElements) {
  SvgStyleSheet sheet;
  sheet.Add("#a{stroke-width:3} .st0,.st1{stroke-width:2px;fill:none!important} /* path{stroke-width:9} */ path{stroke-width:1;fill:red}");
  EXPECT_DOUBLE_EQ(StyleOf(sheet, "path", {}, "").stroke_width, 1);
  EXPECT_DOUBLE_EQ(StyleOf(sheet, "path", {"st1"}, "").stroke_width, 2);
  EXPECT_FALSE(StyleOf(sheet, "path", {"st1"}, "").fills());
  EXPECT_DOUBLE_EQ(StyleOf(sheet, "path", {"st0"}, "a").stroke_width, 3);
}

TEST(SvgStyleSheet, LeavesOutSelectorsOfSeveralSteps) {
  SvgStyleSheet sheet;
  sheet.Add("g > path{fill:none} .a .b{fill:none} a:hover{fill:none} unclosed{fill:none");
  EXPECT_TRUE(StyleOf(sheet, "path", {"b"}, "").fills());
}

TEST(ApplySvgDeclaration, OpacityOutlastsPaint) {
  SvgStyle style;
  ApplySvgDeclaration("fill-opacity", "0", style);
  ApplySvgDeclaration("fill", "#ff0000", style);
  EXPECT_FALSE(style.fills());
  ApplySvgDeclaration("fill-opacity", "0.5", style);
  EXPECT_TRUE(style.fills());
}

TEST(ApplySvgDeclaration, KnowsColors) {
  SvgStyle style;
  for (const char* black : {"#000", "#000000", "rgb(0,0,0)", "rgb(0%, 0%, 0%)", "black", "currentColor"}) {
    ApplySvgDeclaration("fill", black, style);
    EXPECT_DOUBLE_EQ(style.fill.luminance(), 0) << black;
  }
  for (const char* white : {"#fff", "#ffffff", "#ffffffff", "rgb(255 255 255)", "white", "url(#pattern)"}) {
    ApplySvgDeclaration("fill", white, style);
    EXPECT_NEAR(style.fill.luminance(), 1, 1e-9) << white;
  }
}

TEST(ApplySvgDeclaration, TellsWhatIsNotDisplayed) {
  SvgStyle style;
  EXPECT_FALSE(ApplySvgDeclaration("display", "none", style));
  EXPECT_TRUE(ApplySvgDeclaration("display", "inline", style));
  EXPECT_FALSE(ApplySvgDeclaration("opacity", "0", style));
  ApplySvgDeclaration("visibility", "hidden", style);
  EXPECT_FALSE(style.fills());
}

}  // namespace
}  // namespace plumb::compiler
