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

// The characters 0xA0 to 0xFE of ISO 8859-1 to -9, by Python's codecs; U+FFFD where a part has none.
constexpr const char8_t* kPages[] = {
    u8"\u00a0¡¢£¤¥¦§¨©ª«¬\u00ad®¯°±²³´µ¶·¸¹º»¼½¾¿ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÐÑÒÓÔÕÖ×ØÙÚÛÜÝÞßàáâãäåæçèéêëìíîïðñòóôõö÷øùúûüýþ",
    u8"\u00a0Ą˘Ł¤ĽŚ§¨ŠŞŤŹ\u00adŽŻ°ą˛ł´ľśˇ¸šşťź˝žżŔÁÂĂÄĹĆÇČÉĘËĚÍÎĎĐŃŇÓÔŐÖ×ŘŮÚŰÜÝŢßŕáâăäĺćçčéęëěíîďđńňóôőö÷řůúűüýţ",
    u8"\u00a0Ħ˘£¤�Ĥ§¨İŞĞĴ\u00ad�Ż°ħ²³´µĥ·¸ışğĵ½�żÀÁÂ�ÄĊĈÇÈÉÊËÌÍÎÏ�ÑÒÓÔĠÖ×ĜÙÚÛÜŬŜßàáâ�äċĉçèéêëìíîï�ñòóôġö÷ĝùúûüŭŝ",
    u8"\u00a0ĄĸŖ¤ĨĻ§¨ŠĒĢŦ\u00adŽ¯°ą˛ŗ´ĩļˇ¸šēģŧŊžŋĀÁÂÃÄÅÆĮČÉĘËĖÍÎĪĐŅŌĶÔÕÖ×ØŲÚÛÜŨŪßāáâãäåæįčéęëėíîīđņōķôõö÷øųúûüũū",
    u8"\u00a0ЁЂЃЄЅІЇЈЉЊЋЌ\u00adЎЏАБВГДЕЖЗИЙКЛМНОПРСТУФХЦЧШЩЪЫЬЭЮЯабвгдежзийклмнопрстуфхцчшщъыьэюя№ёђѓєѕіїјљњћќ§ў",
    u8"\u00a0���¤�������،\u00ad�������������؛���؟�ءآأؤإئابةتثجحخدذرزسشصضطظعغ�����ـفقكلمنهوىيًٌٍَُِّْ������������",
    u8"\u00a0‘’£€₯¦§¨©ͺ«¬\u00ad�―°±²³΄΅Ά·ΈΉΊ»Ό½ΎΏΐΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡ�ΣΤΥΦΧΨΩΪΫάέήίΰαβγδεζηθικλμνξοπρςστυφχψωϊϋόύώ",
    u8"\u00a0�¢£¤¥¦§¨©×«¬\u00ad®¯°±²³´µ¶·¸¹÷»¼½¾��������������������������������‗אבגדהוזחטיךכלםמןנסעףפץצקרשת��\u200e\u200f",
    u8"\u00a0¡¢£¤¥¦§¨©ª«¬\u00ad®¯°±²³´µ¶·¸¹º»¼½¾¿ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏĞÑÒÓÔÕÖ×ØÙÚÛÜİŞßàáâãäåæçèéêëìíîïğñòóôõö÷øùúûüış",
};

TEST(DecodeStepString, EveryCharacterOfEveryPage) {
  for (char page = 'A'; page <= 'I'; ++page) {
    std::string raw = std::string("\\P") + page + "\\";
    for (char c = ' '; c < 0x7f; ++c) raw += std::string("\\S\\") + (c == '\'' ? "''" : std::string(1, c));
    EXPECT_EQ(DecodeStepString(raw), reinterpret_cast<const char*>(kPages[page - 'A'])) << "page " << page;
  }
}

TEST(DecodeStepString, APageHoldsToTheNextOneAndOnlyForShiftedCharacters) {
  EXPECT_EQ(DecodeStepString("\\PG\\a\\S\\a\\X\\E1\\PA\\\\S\\a"), "aαáá");  // \X\ is ISO 8859-1 on every page
  EXPECT_EQ(DecodeStepString("\\S\\a"), "á");                              // none named: ISO 8859-1
  EXPECT_EQ(DecodeStepString("\\PJ\\x"), "\\PJ\\x");                       // there is no part J
}

TEST(DecodeStepString, WideCharactersInOneRunAndAtItsEnds) {
  EXPECT_EQ(DecodeStepString("a\\X2\\00E400F600FC\\X0\\b\\X2\\20AC\\X0\\"), "aäöüb€");
  EXPECT_EQ(DecodeStepString("\\X2\\0041D83DDE000042\\X0\\"), "A😀B");
  EXPECT_EQ(DecodeStepString("\\X4\\000000410001F6000010FFFF\\X0\\"), "A😀\xf4\x8f\xbf\xbf");
  EXPECT_EQ(DecodeStepString("\\X2\\\\X0\\"), "");
  EXPECT_EQ(DecodeStepString("\\X2\\00fc\\X0\\"), "ü");                               // lower case, as some programs write it
  EXPECT_EQ(DecodeStepString("\\X4\\00110000\\X0\\"), "\xef\xbf\xbd");                // beyond Unicode
  EXPECT_EQ(DecodeStepString("\\X2\\DE00D83D\\X0\\"), "\xef\xbf\xbd\xef\xbf\xbd");    // surrogates the wrong way round
  EXPECT_EQ(DecodeStepString("\\X2\\D83D0041\\X0\\"), "\xef\xbf\xbd" "A");
}

TEST(DecodeStepString, QuotesAndBackslashesNextToDirectives) {
  EXPECT_EQ(DecodeStepString("''\\X\\E9''"), "'é'");
  EXPECT_EQ(DecodeStepString("\\\\X\\\\E9"), "\\X\\E9");  // two escaped backslashes, no directive
  EXPECT_EQ(DecodeStepString("\\S\\\\"), "Ü");            // a backslash with the high bit
}

TEST(DecodeStepString, BrokenDirectivesStayAsTheyAre) {
  EXPECT_EQ(DecodeStepString("\\X2\\00F\\X0\\"), "\\X2\\00F\\X0\\");
  EXPECT_EQ(DecodeStepString("\\X4\\0001F60\\X0\\"), "\\X4\\0001F60\\X0\\");
  EXPECT_EQ(DecodeStepString("\\X\\F"), "\\X\\F");
  EXPECT_EQ(DecodeStepString("\\P"), "\\P");
  EXPECT_EQ(DecodeStepString("\\Q\\"), "\\Q\\");
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
  EXPECT_EQ(DecodeStepString("\xf0\x9f\x98\x80 \\X\\FC"), "😀 ü");                // UTF-8 and directives in one string
  EXPECT_EQ(DecodeStepString("\xc3\xbc \xfc"), "Ã¼ ü");                           // one bad byte: all of it is ISO 8859-1
  EXPECT_EQ(DecodeStepString("\xed\xa0\x80"), "\xc3\xad\xc2\xa0\xc2\x80");        // a surrogate in UTF-8 is none
}

}  // namespace
}  // namespace plumb::compiler
