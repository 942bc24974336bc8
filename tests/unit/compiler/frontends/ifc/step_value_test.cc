#include "compiler/frontends/ifc/step_value.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace plumb::compiler {
namespace {

using Kind = StepValue::Kind;

class Parsed {
 public:
  explicit Parsed(std::string text) : text_(std::move(text)), arguments_(text_.data(), text_.data() + text_.size()) {}
  StepValue operator[](size_t i) const { return arguments_[i]; }
  size_t size() const { return arguments_.size(); }

 private:
  std::string text_;
  StepArguments arguments_;
};

TEST(StepValue, TellsKindsApart) {
  const Parsed a("($,*,12,-1.5E3,'x',.T.,#42,(1,2),IFCLABEL('y'),\"0F\",!)");
  ASSERT_EQ(a.size(), 11u);
  const Kind expected[] = {Kind::kNull,      Kind::kDerived, Kind::kInteger, Kind::kReal,   Kind::kString, Kind::kEnumeration,
                           Kind::kReference, Kind::kList,    Kind::kTyped,   Kind::kBinary, Kind::kBad};
  for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].kind(), expected[i]) << i;
  EXPECT_EQ(a[11].kind(), Kind::kNone);
  EXPECT_TRUE(a[0].is_null());
  EXPECT_TRUE(a[11].is_null());
}

TEST(StepValue, NumbersInAllTheirForms) {
  const Parsed a("(1.,-2.5,+3.25,1.E-5,4,6.1230318E-17,1e300,.5)");
  const double expected[] = {1, -2.5, 3.25, 1e-5, 4, 6.1230318e-17, 1e300, 0.5};
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(a[i].Real()) << i;
    EXPECT_EQ(*a[i].Real(), expected[i]) << i;
  }
  EXPECT_EQ(a[4].Integer(), 4);
  EXPECT_FALSE(a[0].Integer());
}

TEST(StepValue, BadNumbersAreNone) {
  const Parsed a("(1.2.3,--4,1E,99999999999999999999,#,#x,1.E999)");
  EXPECT_FALSE(a[0].Real());
  EXPECT_FALSE(a[1].Real());
  EXPECT_FALSE(a[2].Real());
  EXPECT_FALSE(a[3].Integer());
  EXPECT_FALSE(a[4].Reference());
  EXPECT_FALSE(a[5].Reference());
  EXPECT_FALSE(a[6].Real());
}

TEST(StepValue, TypedValuesGiveWhatIsInThem) {
  const Parsed a("(IFCPOSITIVELENGTHMEASURE(2.5),IFCBOOLEAN(.F.),IFCLABEL ( 'a,(b' ),IFCLINEINDEX((1,2,3)),IFCLABEL)");
  EXPECT_EQ(a[0].TypeName(), "IFCPOSITIVELENGTHMEASURE");
  EXPECT_EQ(a[0].Real(), 2.5);
  EXPECT_EQ(a[1].Boolean(), false);
  EXPECT_EQ(a[2].Text(), "a,(b");
  std::vector<int64_t> items;
  for (const StepValue v : a[3].Inner().Items()) items.push_back(v.Integer().value_or(-1));
  EXPECT_EQ(items, (std::vector<int64_t>{1, 2, 3}));
  EXPECT_FALSE(a[4].Real());
  EXPECT_EQ(a[4].Inner().kind(), Kind::kNone);
}

TEST(StepValue, WhatIsNoFiniteNumberSaysSo) {
  const Parsed bad("(NAN,-INF,nan(ind),1.E999,-1.#IND,1.#QNAN,IFCLENGTHMEASURE(NAN),IFCREAL(-1.E400))");
  ASSERT_EQ(bad.size(), 8u);
  for (size_t i = 0; i < bad.size(); ++i) {
    EXPECT_FALSE(bad[i].Real()) << i;
    EXPECT_TRUE(bad[i].IsNotFinite()) << i;
  }
  const Parsed good("(1.,-2,1.E-999,IFCREAL(1.),$,*,'nan',#12,.INF.,(1.),IFCREAL(IFCREAL(NAN)))");
  for (size_t i = 0; i < good.size(); ++i) EXPECT_FALSE(good[i].IsNotFinite()) << i;
  EXPECT_EQ(good[2].Real(), 0.0);
}

TEST(StepValue, StringsAndCommentsHideSeparators) {
  const Parsed a("( 'a''),(;' , /* ,( ' */ #7 /* x */ , ('p','q)') )");
  ASSERT_EQ(a.size(), 3u);
  EXPECT_EQ(a[0].Text(), "a'),(;");
  EXPECT_EQ(a[1].Reference(), 7u);
  std::vector<std::string> texts;
  for (const StepValue v : a[2].Items()) texts.push_back(v.Text());
  EXPECT_EQ(texts, (std::vector<std::string>{"p", "q)"}));
}

TEST(StepValue, NestedListsAreWalkedInOnePass) {
  const Parsed a("(((0.,1.),(2.,3.),()),$)");
  std::vector<size_t> counts;
  for (const StepValue row : a[0].Items()) {
    size_t n = 0;
    for (const StepValue v : row.Items()) n += v.Real().has_value();
    counts.push_back(n);
  }
  EXPECT_EQ(counts, (std::vector<size_t>{2, 2, 0}));
}

TEST(StepValue, EnumerationsAndBooleans) {
  const Parsed a("(.METRE.,.U.,.BROKEN,.T.)");
  EXPECT_EQ(a[0].Enumeration(), "METRE");
  EXPECT_FALSE(a[1].Boolean());
  EXPECT_EQ(a[2].Enumeration(), "");
  EXPECT_EQ(a[3].Boolean(), true);
}

TEST(StepValue, TruncatedTextEndsLists) {
  for (const char* text : {"(", "(1,", "('abc", "((1,2", "(IFCX(", "(/*", "(1;2)", "(#", "(.", "(,,)"}) {
    const Parsed a(text);
    for (size_t i = 0; i < a.size() + 1; ++i) {
      for (const StepValue v : a[i].Items()) (void)v.Real();
      (void)a[i].Text();
      (void)a[i].Inner().Real();
      (void)a[i].Enumeration();
    }
    EXPECT_LE(a.size(), 3u) << text;
  }
}

TEST(StepValue, AbsurdNestingCostsNoStack) {
  const std::string open(2000000, '('), close(2000000, ')');
  const Parsed a(open + "1" + close + ",2)");
  ASSERT_GE(a.size(), 1u);
  StepValue v = a[0];
  for (int i = 0; i < 5; ++i) v = *v.Items().begin();
  EXPECT_EQ(v.kind(), Kind::kList);
}

TEST(StepArguments, KeepsTheFirstOnesOfTooMany) {
  std::string text = "(0";
  for (int i = 1; i < 100; ++i) text.append(",").append(std::to_string(i));
  const Parsed a(text + ")");
  EXPECT_EQ(a.size(), StepArguments::kMax);
  EXPECT_EQ(a[StepArguments::kMax - 1].Integer(), static_cast<int64_t>(StepArguments::kMax) - 1);
}

}  // namespace
}  // namespace plumb::compiler
