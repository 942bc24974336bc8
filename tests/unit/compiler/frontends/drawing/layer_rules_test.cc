#include "compiler/frontends/drawing/layer_rules.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

LayerUse Use(const std::string& set, const std::string& layer) { return LoadLayerRules(set)->UseOf(layer); }

TEST(LayerRules, BuiltInSetsKnowTheirWallsAndDoors) {
  EXPECT_EQ(Use("aia", "A-WALL-FULL"), LayerUse::kWall);
  EXPECT_EQ(Use("aia", "A-WALL-PATT"), LayerUse::kIgnore);
  EXPECT_EQ(Use("aia", "A-DOOR"), LayerUse::kDoor);
  EXPECT_EQ(Use("german", "AR_Außenwand_24"), LayerUse::kWall);
  EXPECT_EQ(Use("german", "01 TÜREN"), LayerUse::kDoor);
  EXPECT_EQ(Use("german", "Wand-Schraffur"), LayerUse::kIgnore);
  EXPECT_EQ(Use("french", "0_CLOISONS"), LayerUse::kWall);
  EXPECT_EQ(Use("french", "FENÊTRES"), LayerUse::kWindow);
  EXPECT_EQ(Use("italian", "MURATURE"), LayerUse::kWall);
  EXPECT_EQ(Use("spanish", "Tabiques"), LayerUse::kWall);
  EXPECT_EQ(Use("english", "Walls"), LayerUse::kWall);
  EXPECT_EQ(Use("english", "Wallpaper note"), LayerUse::kIgnore);
}

TEST(LayerRules, LastPartOfReferencesCounts) {
  EXPECT_EQ(Use("aia", "house|A-WALL"), LayerUse::kWall);
  EXPECT_EQ(Use("aia", "xref-house-08$0$A-WALL"), LayerUse::kWall);
  EXPECT_EQ(Use("english", "walls|furniture"), LayerUse::kIgnore);
}

TEST(LayerRules, SetThatKnowsMostIsChosenWithItsShare) {
  const LayerChoice german = ChooseLayerRules({{"Wand", 60}, {"Fenster", 20}, {"XYZ", 20}});
  EXPECT_EQ(german.rules->name(), "german");
  EXPECT_NEAR(german.confidence, 0.8, 1e-9);
  const LayerChoice none = ChooseLayerRules({{"0", 100}, {"Layer1", 40}});
  EXPECT_EQ(none.rules->name(), "none");
  EXPECT_EQ(none.confidence, 0);
}

TEST(LayerRules, OwnRulesAreReadAndWrongOnesNamed) {
  const auto own = LayerRules::Parse("name = \"ours\"\n[[rule]]\nuse = \"wall\"\nnames = [\"k1*\"]\n", "ours.toml");
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(own->UseOf("K1-17"), LayerUse::kWall);
  EXPECT_EQ(own->UseOf("K2"), LayerUse::kUnknown);
  const auto unknown = LayerRules::Parse("[[rule]]\nuse = \"wal\"\n", "ours.toml");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("use = \"wal\""), std::string::npos);
  EXPECT_FALSE(LayerRules::Parse("[[rule", "ours.toml"));
  EXPECT_FALSE(LoadLayerRules("germna"));
}

}  // namespace
}  // namespace plumb::compiler
