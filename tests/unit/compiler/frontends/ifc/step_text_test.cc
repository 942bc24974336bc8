#include "compiler/frontends/ifc/step_text.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

TEST(DecodeStepString, PlainQuotesAndBackslashes) {
  EXPECT_EQ(DecodeStepString(""), "");
  EXPECT_EQ(DecodeStepString("Wand-1"), "Wand-1");
  EXPECT_EQ(DecodeStepString("it''s"), "it's");
  EXPECT_EQ(DecodeStepString("C:\\\\plans"), "C:\\plans");
}

TEST(DecodeStepString, DirectivesGiveUtf8) {
  EXPECT_EQ(DecodeStepString("K\\X\\FCche"), "Küche");
  EXPECT_EQ(DecodeStepString("K\\S\\|che"), "Küche");  // | with the high bit is ü in ISO 8859-1
  EXPECT_EQ(DecodeStepString("\\X2\\00FC\\X0\\ber"), "über");
  EXPECT_EQ(DecodeStepString("\\X2\\4E2D6587\\X0\\"), "中文");
  EXPECT_EQ(DecodeStepString("\\X4\\0001F3E0\\X0\\!"), "🏠!");
  EXPECT_EQ(DecodeStepString("\\X2\\D83CDFE0\\X0\\"), "🏠");  // surrogates
  EXPECT_EQ(DecodeStepString("\\PE\\\\S\\4"), "Д");          // ISO 8859-5
}

TEST(DecodeStepString, BrokenDirectivesStayAsTheyAre) {
  EXPECT_EQ(DecodeStepString("\\X2\\00FC"), "\\X2\\00FC");
  EXPECT_EQ(DecodeStepString("\\X\\G1"), "\\X\\G1");
  EXPECT_EQ(DecodeStepString("\\"), "\\");
  EXPECT_EQ(DecodeStepString("\\S\\"), "\\S\\");
  EXPECT_EQ(DecodeStepString("\\X2\\D83C\\X0\\"), "\xef\xbf\xbd");  // a lone surrogate is no character
}

TEST(DecodeStepString, RawBytesBecomeValidUtf8) {
  EXPECT_EQ(DecodeStepString("K\xc3\xbc"
                             "che"),
            "Küche");  // UTF-8 is kept
  EXPECT_EQ(DecodeStepString("K\xfc"
                             "che"),
            "Küche");  // ISO 8859-1 is converted
}

}  // namespace
}  // namespace plumb::compiler
