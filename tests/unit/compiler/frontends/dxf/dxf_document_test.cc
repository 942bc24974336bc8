#include "compiler/frontends/dxf/dxf_document.h"

#include <gtest/gtest.h>

#include <cstring>

#include "compiler/frontends/dxf/dxf_text.h"
#include "tests/support/dxf_text.h"

namespace plumb::compiler {
namespace {

using test::DxfText;

std::optional<DxfDocument> Read(const std::string& bytes, DiagnosticSink& sink) { return ReadDxfDocument(bytes, {}, sink); }

DxfDocument Read(const std::string& bytes) {
  DiagnosticSink sink;
  auto out = Read(bytes, sink);
  EXPECT_TRUE(out);
  EXPECT_FALSE(sink.has_errors());
  return out.value_or(DxfDocument());
}

TEST(DxfDocument, EntitiesHaveHandleLayerAndLine) {
  const DxfDocument d = Read(DxfText().Line("A-WALL", 1, 2, 3, 4).Box("B", 0, 0, 1, 1).Str());
  ASSERT_EQ(d.entities.size(), 2u);
  EXPECT_EQ(d.entities[0].handle, 0x21u);
  EXPECT_EQ(d.layers[d.entities[0].layer].name, "A-WALL");
  EXPECT_EQ(d.entities[0].line, 17u);
  EXPECT_EQ(d.entities[1].type, "LWPOLYLINE");
  ASSERT_EQ(d.entities[1].paths.size(), 1u);
  EXPECT_TRUE(d.entities[1].paths[0].closed);
  EXPECT_EQ(d.entities[1].paths[0].points.size(), 4u);
}

TEST(DxfDocument, LinesStandBetweenOtherEntitiesAsInTheFile) {
  const DxfDocument d =
      Read(DxfText().Box("A", 0, 0, 1, 1).Line("B", 1, 2, 3, 4).Line("C", 5, 6, 7, 8).Box("D", 0, 0, 1, 1).Line("E", 9, 9, 8, 8).Str());
  std::string layers;
  for (const DxfEntity& e : d.entities) layers += d.layers[e.layer].name;
  EXPECT_EQ(layers, "ABCDE");
  ASSERT_EQ(d.entities[1].paths.size(), 1u);
  EXPECT_EQ(d.entities[1].paths[0].points, (std::vector<Eigen::Vector2d>{{1, 2}, {3, 4}}));
  EXPECT_EQ(d.entities[4].paths[0].points, (std::vector<Eigen::Vector2d>{{9, 9}, {8, 8}}));
}

TEST(DxfDocument, NumbersOfLinesMayBeWrittenInAnyWay) {
  const auto line = [](const std::string& x0) {
    return "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nW\n10\n" + x0 +
           "\n20\n2\n11\n3\n21\n4\n0\nLINE\n8\nW\n10\n5\n20\n6\n11\n7\n21\n8\n0\nENDSEC\n0\nEOF\n";
  };
  for (const char* x0 : {"1.5", " 1.50000 ", "15e-1", "+1.5", "1,5"}) {
    const DxfDocument d = Read(line(x0));
    ASSERT_EQ(d.entities.size(), 2u) << x0;
    EXPECT_EQ(d.entities[0].paths[0].points[0], Eigen::Vector2d(1.5, 2)) << x0;
    EXPECT_EQ(d.entities[1].paths[0].points[1], Eigen::Vector2d(7, 8)) << x0;
  }
  for (const char* x0 : {"nan", "inf", "-inf", "abc", "", "1.5m"}) {
    DiagnosticSink sink;
    const auto d = Read(line(x0), sink);
    ASSERT_TRUE(d);
    ASSERT_EQ(d->entities.size(), 1u) << "a number that is none is no 0: " << x0;
    EXPECT_EQ(d->entities[0].paths[0].points[1], Eigen::Vector2d(7, 8)) << x0;
    EXPECT_EQ(sink.all().size(), 1u) << x0;
  }
  DiagnosticSink unended;
  const auto without_end = Read("0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nW\n10\n1\n20\n2\n0\nENDSEC\n0\nEOF\n", unended);
  ASSERT_TRUE(without_end);
  EXPECT_TRUE(without_end->entities.empty()) << "no line to the origin";
  DiagnosticSink sink;
  const auto too_large = Read(line("1e300"), sink);
  ASSERT_TRUE(too_large);
  EXPECT_EQ(too_large->entities.size(), 1u);
  EXPECT_EQ(sink.all().size(), 1u);
}

// The same groups with binary values.
std::string Binary(const std::string& text) {
  std::string out("AutoCAD Binary DXF\r\n\x1a\0", 22);
  size_t at = 0;
  const auto line = [&] {
    const size_t end = text.find('\n', at);
    const std::string value = text.substr(at, end - at);
    at = end + 1;
    return value;
  };
  while (at < text.size()) {
    const auto code = static_cast<int16_t>(std::stoi(line()));
    const std::string value = line();
    out.append(reinterpret_cast<const char*>(&code), 2);
    if (code >= 10 && code < 60) {
      const double number = std::stod(value);
      out.append(reinterpret_cast<const char*>(&number), 8);
    } else if (code >= 60 && code < 80) {
      const auto number = static_cast<int16_t>(std::stoi(value));
      out.append(reinterpret_cast<const char*>(&number), 2);
    } else if (code >= 90 && code < 100) {
      const int32_t number = std::stoi(value);
      out.append(reinterpret_cast<const char*>(&number), 4);
    } else {
      out.append(value.c_str(), value.size() + 1);
    }
  }
  return out;
}

TEST(DxfDocument, BinaryFilesReadAsTextOnes) {
  const std::string text =
      DxfText().Header("$INSUNITS", 70, "5").Line("W", 0.125, 2, 3, 4).Box("W", 0, 0, 7, 1).Text("T", "Bad", 1, 1).Str();
  const DxfDocument a = Read(text), b = Read(Binary(text));
  ASSERT_EQ(b.entities.size(), a.entities.size());
  EXPECT_EQ(b.insunits, 5);
  EXPECT_EQ(b.entities[0].paths[0].points, a.entities[0].paths[0].points);
  EXPECT_EQ(b.entities[1].paths[0].points, a.entities[1].paths[0].points);
  EXPECT_EQ(b.entities[2].texts[0].text, "Bad");
}

TEST(DxfDocument, OldPolylinesHaveTheirVertices) {
  DxfText dxf;
  dxf.Entity("POLYLINE", "W", {{66, "1"}, {70, "1"}});
  for (const char* x : {"0", "3", "5"}) dxf.Entity("VERTEX", "W", {{10, x}, {20, x[0] == '3' ? "4" : "0"}});
  dxf.Entity("SEQEND", "W", {});
  const DxfDocument d = Read(dxf.Str());
  ASSERT_EQ(d.entities.size(), 1u);
  EXPECT_EQ(d.entities[0].paths[0].points.size(), 3u);
  EXPECT_TRUE(d.entities[0].paths[0].closed);
}

TEST(DxfDocument, BulgesAreArcsAndTheRestStaysStraight) {
  const DxfDocument d = Read(
      DxfText().Entity("LWPOLYLINE", "W", {{90, "3"}, {10, "0"}, {20, "0"}, {10, "2"}, {20, "0"}, {42, "1"}, {10, "2"}, {20, "2"}}).Str());
  ASSERT_EQ(d.entities.size(), 2u);
  EXPECT_FALSE(d.entities[0].paths[0].curved);
  ASSERT_EQ(d.entities[1].paths[0].arcs.size(), 1u);
  EXPECT_NEAR(d.entities[1].paths[0].arcs[0].radius_m, 1.0, 1e-9);
}

TEST(DxfDocument, ExtrusionDownMirrorsArcs) {
  const DxfDocument d = Read(
      DxfText().Entity("ARC", "W", {{10, "3"}, {20, "1"}, {40, "1"}, {50, "0"}, {51, "90"}, {210, "0"}, {220, "0"}, {230, "-1"}}).Str());
  ASSERT_EQ(d.entities.size(), 1u);
  EXPECT_NEAR(d.entities[0].paths[0].arcs[0].center.x(), -3, 1e-9);
  EXPECT_NEAR(d.entities[0].paths[0].points.front().x(), -4, 1e-9);
}

TEST(DxfDocument, HatchesAreFilledOutlines) {
  const DxfDocument d = Read(DxfText()
                                 .Entity("HATCH", "W", {{2, "SOLID"}, {70, "1"}, {71, "0"}, {91, "1"}, {92, "3"}, {72, "0"}, {73, "1"},
                                                        {93, "4"},    {10, "0"}, {20, "0"}, {10, "5"}, {20, "0"}, {10, "5"}, {20, "1"},
                                                        {10, "0"},    {20, "1"}, {97, "0"}, {75, "0"}, {76, "1"}, {98, "0"}})
                                 .Str());
  ASSERT_EQ(d.entities.size(), 1u);
  EXPECT_TRUE(d.entities[0].paths[0].filled);
  EXPECT_EQ(d.entities[0].paths[0].points.size(), 4u);
}

TEST(DxfDocument, CountsThatLieReserveNoMemory) {
  const DxfDocument d = Read(DxfText().Entity("LWPOLYLINE", "W", {{90, "2000000000"}, {10, "0"}, {20, "0"}, {10, "1"}, {20, "0"}}).Str());
  EXPECT_EQ(d.entities.at(0).paths.at(0).points.size(), 2u);
}

TEST(DxfDocument, EveryPrefixIsRefusedOrReadWithoutACrash) {
  const std::string text = DxfText().DoorBlock("D").Box("W", 0, 0, 5, 4).Insert("W", "D", 1, 1).Text("T", "x", 1, 1).Str();
  for (size_t n = 0; n + 12 < text.size(); n += 3) {
    DiagnosticSink sink;
    const auto d = Read(text.substr(0, n), sink);
    EXPECT_TRUE(!d || n < 40 || text.substr(0, n).ends_with("ENDSEC\n") || text.substr(0, n).ends_with("ENDSEC")) << n;
  }
}

TEST(DxfText, CodesAndFormattingAreTakenOut) {
  EXPECT_EQ(PlainText("%%uB\\U+00FCro%%u"), "Büro");
  EXPECT_EQ(PlainText("B\xfcro"), "Büro");
  EXPECT_EQ(PlainLines("{\\fArial|b0;Living}\\Proom \\A1;2"), (std::vector<std::string>{"Living", "room 2"}));
}

}  // namespace
}  // namespace plumb::compiler
