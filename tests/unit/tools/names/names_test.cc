#include "tools/names/names.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

TEST(Folded, LeavesCaseAccentsAndPunctuationOut) {
  EXPECT_EQ(Folded("6  K\u00fcche/Bad."), "6 kuche bad");
  EXPECT_EQ(FoldedGerman("K\u00dcCHE"), "kueche");
  EXPECT_EQ(Folded("Ca\u0300fe\u0301"), "cafe") << "accents by themselves";
  EXPECT_EQ(FoldedGerman("Ku\u0308che"), "kueche");
  EXPECT_EQ(Folded("Stra\u00dfe \u0141\u00f3d\u017a \u0152uvre \u00deing"), "strasse lodz oeuvre thing");
  EXPECT_EQ(Folded("\u041a\u0443\u0445\u043d\u044f 2"), "\u041a\u0443\u0445\u043d\u044f 2") << "another script";
  EXPECT_EQ(Folded("\xff\xc3"), "\xff\xc3") << "no UTF-8";
  EXPECT_EQ(Folded(" -- "), "");
}

TEST(IsSameName, TakesUmlautsEitherWay) {
  for (const char* typed : {"K\u00fcche", "kueche", "KUCHE", "ku\u0308che"}) EXPECT_TRUE(IsSameName(typed, "K\u00fcche")) << typed;
  EXPECT_TRUE(IsSameName("Blaue", "blaue")) << "no umlaut at all";
  EXPECT_FALSE(IsSameName("Koche", "K\u00fcche"));
  EXPECT_FALSE(IsSameName("-", " "));
  EXPECT_TRUE(IsSameName("-", "-"));
}

TEST(IsPartOfName, IsOfWholeWords) {
  EXPECT_TRUE(IsPartOfName("kueche", "6 K\u00fcche"));
  EXPECT_TRUE(IsPartOfName("conference rm", "150 CONFERENCE RM"));
  EXPECT_FALSE(IsPartOfName("rm conference", "150 CONFERENCE RM"));
  EXPECT_FALSE(IsPartOfName("15", "150 CONFERENCE RM"));
  EXPECT_FALSE(IsPartOfName("", "150 CONFERENCE RM"));
}

TEST(NearestName, IsEmptyWhereNothingIsNear) {
  const std::vector<std::string> names = {"seed", "sensor", "sensor-height"};
  EXPECT_EQ(NearestName("sensr", names), "sensor");
  EXPECT_EQ(NearestName("sensor-hieght", names), "sensor-height");
  EXPECT_EQ(NearestName("frobnicate", names), "");
  EXPECT_EQ(NearestName("Z", {"A"}), "");
}

}  // namespace
}  // namespace plumb::tools
