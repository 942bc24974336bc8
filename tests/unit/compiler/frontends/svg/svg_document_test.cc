#include "compiler/frontends/svg/svg_document.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

struct Reading {
  std::optional<SvgDocument> document;
  DiagnosticSink sink;
  [[nodiscard]] bool Says(DiagnosticKind kind) const {
    return std::any_of(sink.all().begin(), sink.all().end(), [&](const Diagnostic& d) { return d.kind == kind; });
  }
};

Reading ReadText(std::string text, const SvgReadOptions& options = {}) {
  Reading out;
  Source source{.path = "plan.svg", .bytes = std::move(text), .sha256 = {}, .format = SourceFormat::kSvg};
  out.document = ReadSvgDocument(source, options, out.sink);
  return out;
}

SvgDocument DocumentOf(const std::string& body, const std::string& attributes = "viewBox='0 0 100 100'") {
  const Reading reading = ReadText("<svg xmlns='http://www.w3.org/2000/svg' " + attributes + ">" + body + "</svg>");
  EXPECT_TRUE(reading.document);
  return reading.document.value_or(SvgDocument());
}

std::vector<Vector2d> OnlyPoints(const SvgDocument& document) {
  EXPECT_EQ(document.shapes.size(), 1u);
  if (document.shapes.size() != 1 || document.shapes[0].outlines.size() != 1) return {};
  return document.shapes[0].outlines[0].points;
}

void ExpectPoints(const SvgDocument& document, const std::vector<Vector2d>& expected) {
  const std::vector<Vector2d> points = OnlyPoints(document);
  ASSERT_EQ(points.size(), expected.size());
  for (size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - expected[i]).norm(), 1e-9) << points[i].transpose();
}

TEST(ReadSvgDocument, TurnsYUp) {
  ExpectPoints(DocumentOf("<line x1='1' y1='2' x2='3' y2='4' stroke='black'/>"), {{1, -2}, {3, -4}});
}

TEST(ReadSvgDocument, NestsTransforms) {
  ExpectPoints(DocumentOf("<g transform='translate(10,0)'><g transform='rotate(90)'><path d='M1 0h1' stroke='red'/></g></g>"),
               {{10, -1}, {10, -2}});
}

TEST(ReadSvgDocument, PlacesSymbolsByTheirViewBox) {
  const SvgDocument document = DocumentOf(
      "<defs><symbol id='s' viewBox='0 0 10 10'><line id='l' x1='0' y1='0' x2='10' y2='10' stroke='red'/></symbol></defs>"
      "<use href='#s' x='5' y='5' width='20' height='20'/>");
  ExpectPoints(document, {{5, -5}, {25, -25}});
}

TEST(ReadSvgDocument, NestedViewportsHaveTheirOwnUnits) {
  ExpectPoints(DocumentOf("<svg x='10' y='20' width='50' height='50' viewBox='0 0 100 100'><path d='M0 0H100' stroke='red'/></svg>"),
               {{10, -20}, {60, -20}});
}

TEST(ReadSvgDocument, UsesElementsOfTheFileOnly) {
  const Reading reading =
      ReadText("<svg><use href='#none'/><use href='other.svg#a'/><g id='a'><use href='#a'/><path d='M0 0H1' stroke='red'/></g></svg>");
  ASSERT_TRUE(reading.document);
  EXPECT_EQ(std::count_if(reading.sink.all().begin(), reading.sink.all().end(),
                          [](const Diagnostic& d) { return d.kind == DiagnosticKind::kUseUnresolved; }),
            3);
}

TEST(ReadSvgDocument, EndsWhereUsesMultiply) {
  std::string body;
  for (int i = 0; i < 15; ++i) {
    body += "<g id='g" + std::to_string(i) + "'>";
    for (int k = 0; k < 10; ++k) body += "<use href='#g" + std::to_string(i + 1) + "'/>";
    body += "</g>";
  }
  SvgReadOptions options;
  options.max_elements = 100'000;
  const Reading reading = ReadText("<svg>" + body + "<g id='g15'/></svg>", options);
  EXPECT_FALSE(reading.document);
  EXPECT_TRUE(reading.Says(DiagnosticKind::kPlanTooComplex));
}

TEST(ReadSvgDocument, EndsWhereAPathHasTooManyPoints) {
  std::string data = "M0 0";
  for (int i = 0; i < 2000; ++i) data += "l1 1";
  SvgReadOptions options;
  options.max_points = 1000;
  EXPECT_TRUE(ReadText("<svg><path stroke='red' d='" + data + "'/></svg>", options).Says(DiagnosticKind::kPlanTooComplex));
}

TEST(ReadSvgDocument, RefusesWhatIsNoSvg) {
  EXPECT_TRUE(ReadText("<svg><g>").Says(DiagnosticKind::kXmlSyntax));
  EXPECT_TRUE(ReadText("<html/>").Says(DiagnosticKind::kXmlSyntax));
  EXPECT_TRUE(ReadText("\xff\xd8\xff\xe0 a photograph").Says(DiagnosticKind::kXmlSyntax));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<g>";
  EXPECT_TRUE(ReadText("<svg>" + deep).Says(DiagnosticKind::kXmlTooDeep));
}

TEST(ReadSvgDocument, DoesNotExpandEntities) {
  const Reading reading =
      ReadText("<!DOCTYPE svg [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;'>]><svg xmlns='&b;'><text>&b;</text></svg>");
  ASSERT_TRUE(reading.document);
  ASSERT_EQ(reading.document->texts.size(), 1u);
  EXPECT_EQ(reading.document->texts[0].text, "&b;");
}

TEST(ReadSvgDocument, LeavesOutWhatIsNotDisplayed) {
  const SvgDocument document = DocumentOf(
      "<style>.off{display:none}</style><g class='off'><path d='M0 0H1' stroke='red'/></g>"
      "<path d='M0 0H1' stroke='red' visibility='hidden'/><path d='M0 0H1' fill='none'/>"
      "<g inkscape:groupmode='layer' inkscape:label='Old' style='display:none'><path d='M0 0H1' stroke='red'/></g>");
  EXPECT_TRUE(document.shapes.empty());
  EXPECT_TRUE(document.hidden_layers.contains("Old"));
}

TEST(ReadSvgDocument, ClipsStraightLines) {
  const std::string clip = "<clipPath id='c'><path d='m 10,10 20,0 0,20 -20,0 z'/></clipPath>";
  ExpectPoints(DocumentOf(clip + "<g clip-path='url(#c)'><path d='M0 20H100' stroke='red'/></g>"), {{10, -20}, {30, -20}});
  EXPECT_TRUE(DocumentOf(clip + "<g clip-path='url(#c)'><path d='M0 50H100' stroke='red'/></g>").shapes.empty());
  ExpectPoints(DocumentOf(clip + "<g transform='matrix(0,2,2,0,0,0)'><g clip-path='url(#c)'><path d='M0 20H100' stroke='red'/></g></g>"),
               {{40, -20}, {40, -60}});
}

TEST(ReadSvgDocument, StatesTheUnitOnPaper) {
  EXPECT_DOUBLE_EQ(*DocumentOf("", "width='200mm' viewBox='0 0 1000 500'").unit_on_paper_m, 0.0002);
  EXPECT_FALSE(DocumentOf("", "width='1000' viewBox='0 0 1000 500'").unit_on_paper_m);
}

TEST(ReadSvgDocument, NamesNodesByLabelClassAndId) {
  const SvgDocument document = DocumentOf(
      "<g inkscape:label='Walls' id='layer1'><g class='Door Swing' id='Exterior_x5F_door'><path id='path12' d='M0 0H1' "
      "stroke='red'/></g></g>");
  ASSERT_EQ(document.nodes.size(), 2u);
  EXPECT_EQ(document.nodes[0].names, std::vector<std::string>{"Walls"});
  EXPECT_EQ(document.nodes[1].names, (std::vector<std::string>{"Door", "Swing", "Exterior_door"}));
  EXPECT_EQ(document.shapes[0].location.guid, "path12");
}

TEST(ReadSvgDocument, LettersThatJumpAlongTheLineStartATextOfTheirOwn) {
  const SvgDocument document = DocumentOf(
      "<text font-size='10' x='100 106 112 160 166 40 46 52' y='20'>12A34567</text><text font-size='10' x='0 8 14 20 23'>A 1 B</text>");
  ASSERT_EQ(document.texts.size(), 4u);
  EXPECT_EQ(document.texts[0].text, "12A");
  EXPECT_NEAR(document.texts[0].at.x(), 109, 1e-9);
  EXPECT_EQ(document.texts[1].text, "34");
  EXPECT_NEAR(document.texts[1].at.x(), 166, 1e-9);
  EXPECT_EQ(document.texts[2].text, "567");
  EXPECT_NEAR(document.texts[2].at.x(), 49, 1e-9);
  EXPECT_EQ(document.texts[3].text, "A 1 B");
}

TEST(ReadSvgDocument, TextsWithPlacesOfTheirOwnStandAlone) {
  const SvgDocument document = DocumentOf(
      "<text font-size='10' text-anchor='middle'><tspan x='50' y='20'>Living</tspan><tspan x='50' dy='12'>\n room </tspan></text>");
  ASSERT_EQ(document.texts.size(), 2u);
  EXPECT_EQ(document.texts[0].text, "Living");
  EXPECT_EQ(document.texts[1].text, "room");
  EXPECT_NEAR(document.texts[0].at.x(), 50, 1e-9);
  EXPECT_LT(document.texts[1].at.y(), document.texts[0].at.y());
}

TEST(ReadSvgDocument, LeavesOutNumbersBeyondReason) {
  const Reading reading = ReadText(
      "<svg><path id='p' d='M0 0L1e300 0' stroke='red'/><path d='M0 0 nan 1' stroke='red'/><path transform='spin(2)' d='M0 0H1' "
      "stroke='red'/></svg>");
  ASSERT_TRUE(reading.document);
  EXPECT_TRUE(reading.document->shapes.empty());
  EXPECT_EQ(reading.sink.all().size(), 3u);
}

}  // namespace
}  // namespace plumb::compiler
