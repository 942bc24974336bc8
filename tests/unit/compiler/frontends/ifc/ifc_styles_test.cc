#include "compiler/frontends/ifc/ifc_styles.h"

#include "tests/unit/compiler/frontends/ifc/ifc_reader_fixture.h"

namespace plumb::compiler {
namespace {

using StyleReaderTest = IfcReaderTest;

TEST(IsGlassName, KnowsGlassFromWhatOnlySoundsLikeIt) {
  for (const char* name : {"Glass", "Glas - klar", "Doppelverglasung", "VERRE", "Vitrage", "Glazing 6mm", "vidrio"})
    EXPECT_TRUE(IsGlassName(name)) << name;
  for (const char* name : {"", "Concrete", "Glaswolle", "Glass wool 40", "Fiberglass insulation", "Glasbausteine"})
    EXPECT_FALSE(IsGlassName(name)) << name;
}

TEST_F(StyleReaderTest, TransparencyOfAnItemInBothReleases) {
  const std::string styles =
      "#20=IFCSURFACESTYLE('pane',.BOTH.,(#21));\n#21=IFCSURFACESTYLERENDERING(#22,0.6,$,$,$,$,$,$,.NOTDEFINED.);\n#22=IFCCOLOURRGB($,1.,1."
      ",1.);\n"
      "#30=IFCSURFACESTYLE('wood',.BOTH.,(#31));\n#31=IFCSURFACESTYLERENDERING(#22,0.,$,$,$,$,$,$,.NOTDEFINED.);\n#40="
      "IFCPRESENTATIONSTYLEASSIGNMENT((#20));\n";
  Open(styles +
       "#50=IFCX();\n#51=IFCX();\n#52=IFCX();\n#60=IFCSTYLEDITEM(#50,(#40),$);\n#61=IFCSTYLEDITEM(#51,(#20),$);\n#62=IFCSTYLEDITEM(#52,(#"
       "30),$);");
  EXPECT_EQ(styles_->OfItem(Get(50).index), Look::kGlass);
  EXPECT_EQ(styles_->OfItem(Get(51).index), Look::kGlass);
  EXPECT_EQ(styles_->OfItem(Get(52).index), Look::kOpaque);
  EXPECT_EQ(styles_->OfItem(Get(20).index), Look::kUnstated);
}

TEST_F(StyleReaderTest, MaterialsAreGlassOnlyIfAllOfThemAre) {
  Open(
      "#10=IFCMATERIAL('Glass');\n#11=IFCMATERIAL('Aluminium');\n#12=IFCMATERIALLIST((#10,#11));\n#13=IFCMATERIALLAYERSETUSAGE(#14,.AXIS2.,"
      ".POSITIVE.,0.);\n"
      "#14=IFCMATERIALLAYERSET((#15),$);\n#15=IFCMATERIALLAYER(#10,0.02,$);\n#16=IFCMATERIALLIST((#16));");
  EXPECT_EQ(styles_->OfMaterial(Get(10)), Look::kGlass);
  EXPECT_EQ(styles_->OfMaterial(Get(11)), Look::kUnstated);
  EXPECT_EQ(styles_->OfMaterial(Get(12)), Look::kUnstated);
  EXPECT_EQ(styles_->OfMaterial(Get(13)), Look::kGlass);
  EXPECT_EQ(styles_->OfMaterial(Get(16)), Look::kUnstated);
}

}  // namespace
}  // namespace plumb::compiler
