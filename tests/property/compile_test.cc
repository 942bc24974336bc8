// What holds for the whole compiler on a plan file: compiling twice gives the same bytes, and neither the order of the instances nor the
// unit of length changes what is found.
#include "compiler/compile.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "schema/agraph_writer.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

constexpr char kPlan[] = PLUMB_SOURCE_DIR "/plans/site_office/plan.ifc";

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> out(1);
  for (char c : text) {
    if (c == '\n')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

bool IsInstance(const std::string& line) { return line.starts_with("#"); }

// The instances of the file in another order; header and section marks stay.
std::string Shuffled(const std::string& text, uint64_t seed) {
  std::vector<std::string> lines = LinesOf(text);
  const auto first = std::find_if(lines.begin(), lines.end(), IsInstance);
  const auto last = std::find_if(lines.rbegin(), lines.rend(), IsInstance).base();
  std::mt19937_64 random(seed);
  for (auto n = last - first; n > 1; --n) std::swap(first[n - 1], first[static_cast<std::ptrdiff_t>(random() % static_cast<uint64_t>(n))]);
  return Joined(lines);
}

// Every real number of the line divided by `unit`; whole numbers, references, strings and enumerations stay.
std::string Divided(const std::string& line, double unit) {
  std::string out;
  bool in_string = false;
  for (size_t i = 0; i < line.size();) {
    if (line[i] == '\'') in_string = !in_string;
    const bool starts = !in_string && (std::isdigit(static_cast<unsigned char>(line[i])) != 0 || line[i] == '-') && i > 0 &&
                        (line[i - 1] == '(' || line[i - 1] == ',');
    char* end = nullptr;
    const double value = starts ? std::strtod(line.c_str() + i, &end) : 0;
    const std::string token = starts ? line.substr(i, static_cast<size_t>(end - line.c_str()) - i) : std::string();
    if (token.find('.') == std::string::npos) {
      out += line[i++];
      continue;
    }
    out += fmt::format("{:.12f}", value / unit);
    i += token.size();
  }
  return out;
}

// The same plan in feet. The file is in millimetres, its angles are directions.
std::string InFeet(const std::string& text) {
  constexpr std::array<const char*, 9> kWithLengths = {"=IFCCARTESIANPOINT(",
                                                       "=IFCRECTANGLEPROFILEDEF(",
                                                       "=IFCRECTANGLEHOLLOWPROFILEDEF(",
                                                       "=IFCEXTRUDEDAREASOLID(",
                                                       "=IFCMATERIALLAYER(",
                                                       "=IFCMATERIALLAYERSETUSAGE(",
                                                       "=IFCDOOR(",
                                                       "=IFCWINDOW(",
                                                       "=IFCBUILDINGSTOREY("};
  std::vector<std::string> lines = LinesOf(text);
  for (std::string& line : lines) {
    if (line.find(".LENGTHUNIT.,.MILLI.,.METRE.") != std::string::npos) {
      const std::string id = line.substr(0, line.find('='));
      line = id +
             "=IFCCONVERSIONBASEDUNIT(#9003,.LENGTHUNIT.,'FOOT',#9002);\n"
             "#9001=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
             "#9002=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#9001);\n"
             "#9003=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);";
    }
    if (std::any_of(kWithLengths.begin(), kWithLengths.end(), [&](const char* type) { return line.find(type) != std::string::npos; }))
      line = Divided(line, 304.8);
  }
  return Joined(lines);
}

// To 0.1 mm, sorted: what a plan says apart from ids and the order of things.
std::string Describe(const AGraph& g) {
  const auto room = [&](RoomId id) { return id.valid() ? g.rooms[id.index()].name : std::string("outside"); };
  const auto number = [](double v) { return fmt::format("{:.4f}", v + 0.0); };
  std::vector<std::string> lines;
  for (const Room& r : g.rooms) {
    lines.push_back(fmt::format("room {} {} area {} floor {} ceiling {} corners {} holes {} surfaces {}", r.name, r.guid, number(r.area_m2),
                                number(r.floor_z_m), number(r.ceiling_z_m), r.polygon.size(), r.holes.size(), r.surfaces.size()));
  }
  // By places, as the order of the rooms may differ.
  const auto leaves = [&](const Doorway& d) {
    std::vector<std::string> out;
    for (const DoorLeaf& l : d.leaves) {
      const double to_left = l.jamb == Jamb::kLeft ? 1 : l.jamb == Jamb::kRight ? -1 : 0;
      const bool known = l.opens_to != DoorwaySide::kUnknown;
      out.push_back(fmt::format(" leaf {} {} {} into {} width {}", static_cast<int>(l.operation), number(-std::sin(d.yaw_rad) * to_left),
                                number(std::cos(d.yaw_rad) * to_left),
                                known ? room(l.opens_to == DoorwaySide::kRoomA ? d.room_a : d.room_b) : "?", number(l.width_m)));
    }
    std::sort(out.begin(), out.end());
    return fmt::format("{}", fmt::join(out, ""));
  };
  for (const Doorway& d : g.doorways) {
    std::array<std::string, 2> sides = {room(d.room_a), room(d.room_b)};
    std::sort(sides.begin(), sides.end());
    lines.push_back(fmt::format("doorway {} {} / {} at {} {} width {}{}", d.guid, sides[0], sides[1], number(d.position.x()),
                                number(d.position.y()), number(d.width_m), leaves(d)));
  }
  for (const Wall& w : g.walls) lines.push_back(fmt::format("wall {} {} {}", w.guid, number(w.thickness_m), w.external));
  for (const Window& w : g.windows) lines.push_back(fmt::format("window {} {}", w.guid, number(w.width_m)));
  for (const Surface& s : g.surfaces)
    lines.push_back(fmt::format("surface {} {} {}", g.walls[s.wall.index()].guid, room(s.room), number(s.length_m())));
  std::sort(lines.begin(), lines.end());
  return Joined(lines);
}

class SiteOffice : public testing::Test {
 protected:
  AGraph CompileText(const std::string& text) {
    const std::string path = folder_ / "plan.ifc";
    EXPECT_TRUE(WriteFileAtomically(path, std::string_view(text)));
    CompileOptions options;
    options.verify_stages = true;
    CompileResult result = Compile(path, options);
    EXPECT_TRUE(result.graph.has_value()) << DiagnosticsToText(result.diagnostics.all(), path);
    return result.graph ? std::move(*result.graph) : AGraph{};
  }

  test::TemporaryFolder folder_;
  std::string text_ = ReadFileText(kPlan).value_or("");
};

TEST_F(SiteOffice, CompilingTwiceGivesTheSameBytes) { EXPECT_EQ(WriteAGraph(CompileText(text_)), WriteAGraph(CompileText(text_))); }

TEST_F(SiteOffice, TheOrderOfInstancesDoesNotMatter) {
  const std::string expected = Describe(CompileText(text_));
  ASSERT_NE(expected.find("room "), std::string::npos);
  ASSERT_NE(expected.find(" leaf 1 "), std::string::npos);
  for (uint64_t seed = 1; seed <= 3; ++seed) EXPECT_EQ(Describe(CompileText(Shuffled(text_, seed))), expected);
}

TEST_F(SiteOffice, TheUnitOfLengthDoesNotMatter) {
  const std::string feet = InFeet(text_);
  ASSERT_NE(feet, text_);
  EXPECT_EQ(Describe(CompileText(feet)), Describe(CompileText(text_)));
}

}  // namespace
}  // namespace plumb::compiler
