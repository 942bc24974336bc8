// The ground floor of our house with what goes wrong when people draw: it keeps its rooms, doorways and windows.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

constexpr double kUnitsPerMm = 0.1;  // the drawing is in centimetres

// A LINE of the drawing: from (x0, y0) to (x1, y1), in its units.
struct DrawnLine {
  std::string layer;
  std::array<double, 4> at{};
};

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

class DraftingErrors : public testing::Test {
 protected:
  void SetUp() override {
    const auto text = ReadFileText((std::filesystem::path(PLUMB_SOURCE_DIR) / "plans/house/ground.dxf").string());
    ASSERT_TRUE(text);
    const std::vector<std::string> raw = LinesOf(*text);
    std::string* target = &before_;
    for (size_t i = 0; i + 1 < raw.size();) {
      if (std::stoi(raw[i]) == 0 && raw[i + 1] == "LINE") {
        i = ReadLine(raw, i + 2);
        target = &after_;
        continue;
      }
      *target += raw[i] + "\n" + raw[i + 1] + "\n";
      i += 2;
    }
    ASSERT_GT(lines_.size(), 100u);
  }

  size_t ReadLine(const std::vector<std::string>& raw, size_t i) {
    DrawnLine line;
    for (; std::stoi(raw[i]) != 0; i += 2) {
      const int code = std::stoi(raw[i]);
      if (code == 8) line.layer = raw[i + 1];
      for (const auto& [where, k] : {std::pair(10, 0u), {20, 1u}, {11, 2u}, {21, 3u}}) {
        if (code == where) line.at[k] = std::stod(raw[i + 1]);
      }
    }
    lines_.push_back(line);
    return i;
  }

  CompileResult CompileLines(const std::vector<DrawnLine>& lines) {
    std::string text = before_;
    for (const DrawnLine& line : lines) {
      std::ostringstream out;
      out.precision(10);
      out << "  0\nLINE\n  8\n" << line.layer << "\n 10\n" << line.at[0] << "\n 20\n" << line.at[1];
      out << "\n 11\n" << line.at[2] << "\n 21\n" << line.at[3] << "\n";
      text += out.str();
    }
    const std::string path = folder_ / "house.dxf";
    EXPECT_TRUE(WriteFileAtomically(path, std::string_view(text + after_)));
    return Compile(path);
  }

  void ExpectTheHouse(const std::vector<DrawnLine>& lines, const std::string& what) {
    const CompileResult result = CompileLines(lines);
    ASSERT_TRUE(result.graph) << what;
    EXPECT_EQ(result.graph->rooms.size(), 5u) << what;
    EXPECT_EQ(result.graph->doorways.size(), 7u) << what;
    EXPECT_EQ(result.graph->windows.size(), 6u) << what;
  }

  // By number: the closed outline that each line of a wall belongs to.
  std::vector<std::vector<size_t>> Outlines() const {
    std::vector<std::vector<size_t>> out;
    for (size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].layer != "WAND") continue;
      const bool goes_on =
          !out.empty() && lines_[out.back().back()].at[2] == lines_[i].at[0] && lines_[out.back().back()].at[3] == lines_[i].at[1];
      if (!goes_on) out.emplace_back();
      out.back().push_back(i);
    }
    return out;
  }

  // In three pieces, each longer by `overlap_mm` than a third at its inner ends.
  static std::vector<DrawnLine> InThree(const DrawnLine& line, double overlap_mm) {
    const double dx = line.at[2] - line.at[0], dy = line.at[3] - line.at[1], more = overlap_mm * kUnitsPerMm / 2 / std::hypot(dx, dy);
    std::vector<DrawnLine> out;
    for (const auto& [from, to] : {std::pair(0.0, 1 / 3.0 + more), {1 / 3.0 - more, 2 / 3.0 + more}, {2 / 3.0 - more, 1.0}})
      out.push_back({line.layer, {line.at[0] + from * dx, line.at[1] + from * dy, line.at[0] + to * dx, line.at[1] + to * dy}});
    return out;
  }

  test::TemporaryFolder folder_;
  std::string before_, after_;  // what is drawn before the lines, and the rest
  std::vector<DrawnLine> lines_;
};

TEST_F(DraftingErrors, NoneIsTheHouse) { ExpectTheHouse(lines_, "as drawn"); }

TEST_F(DraftingErrors, EndsThatMissByMillimetresMeet) {
  constexpr std::array<double, 11> kShifts_mm = {4.5, -2, 5.5, -4.5, 8, -7, 3.5, -12, 20, 2, -20};
  size_t turn = 0;
  for (size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].layer != "WAND") continue;
    for (size_t k = 0; k < 4; ++k) {
      std::vector<DrawnLine> lines = lines_;
      const double shift_mm = kShifts_mm[turn++ % kShifts_mm.size()];
      lines[i].at[k] += shift_mm * kUnitsPerMm;
      ExpectTheHouse(lines, "line " + std::to_string(i) + ", number " + std::to_string(k) + " by " + std::to_string(shift_mm) + " mm");
    }
  }
  EXPECT_GT(turn, 300u);
}

TEST_F(DraftingErrors, EndsOfWallsMayBeAskew) {
  for (size_t i = 0; i < lines_.size(); ++i) {
    const auto& at = lines_[i].at;
    if (lines_[i].layer != "WAND" || std::hypot(at[2] - at[0], at[3] - at[1]) > 400 * kUnitsPerMm) continue;
    for (size_t k = 0; k < 4; ++k) {
      for (const double shift_mm : {-20.0, 20.0}) {
        std::vector<DrawnLine> lines = lines_;
        lines[i].at[k] += shift_mm * kUnitsPerMm;
        ExpectTheHouse(lines, "line " + std::to_string(i) + ", number " + std::to_string(k) + " by " + std::to_string(shift_mm) + " mm");
      }
    }
  }
}

// One side of a wall ends half a metre before its corner: the wall cannot be told, which is said with the place.
TEST_F(DraftingErrors, AnOutlineThatStaysOpenIsAWarningWithItsPlace) {
  std::vector<DrawnLine> lines = lines_;
  for (DrawnLine& line : lines) {
    if (line.layer == "WAND" && line.at == std::array<double, 4>{705.75, 300, 424, 300}) line.at[2] += 50;
  }
  const CompileResult result = CompileLines(lines);
  ASSERT_TRUE(result.graph);
  ASSERT_LT(result.graph->rooms.size(), 5u) << "else there is nothing to warn of";
  size_t warnings = 0;
  for (const Diagnostic& d : result.diagnostics.all()) {
    if (d.kind != DiagnosticKind::kOutlineOpen) continue;
    ++warnings;
    EXPECT_GT(d.location.line, 0u);
  }
  EXPECT_GE(warnings, 1u);
}

TEST_F(DraftingErrors, WallsThatAreTurnedALittleStayWalls) {
  for (const std::vector<size_t>& outline : Outlines()) {
    double x = 0, y = 0;
    for (const size_t i : outline) x += lines_[i].at[0] / double(outline.size()), y += lines_[i].at[1] / double(outline.size());
    for (const double angle_deg : {0.1, -0.2, 0.3}) {
      std::vector<DrawnLine> lines = lines_;
      const double c = std::cos(angle_deg * std::numbers::pi / 180), s = std::sin(angle_deg * std::numbers::pi / 180);
      for (const size_t i : outline) {
        for (const size_t k : {0u, 2u}) {
          const double dx = lines_[i].at[k] - x, dy = lines_[i].at[k + 1] - y;
          lines[i].at[k] = x + c * dx - s * dy;
          lines[i].at[k + 1] = y + s * dx + c * dy;
        }
      }
      ExpectTheHouse(lines, "outline from line " + std::to_string(outline[0]) + " by " + std::to_string(angle_deg) + " deg");
    }
  }
}

TEST_F(DraftingErrors, LayersThatLieBesideEachOtherStillFit) {
  const auto moved = [&](const std::function<bool(size_t)>& is_moved, double x_mm, double y_mm) {
    std::vector<DrawnLine> lines = lines_;
    for (size_t i = 0; i < lines.size(); ++i) {
      for (size_t k = 0; k < 4 && is_moved(i); ++k) lines[i].at[k] += (k % 2 == 0 ? x_mm : y_mm) * kUnitsPerMm;
    }
    return lines;
  };
  std::vector<bool> second(lines_.size(), false);
  const auto outlines = Outlines();
  for (size_t o = 0; o < outlines.size(); o += 2) {
    for (const size_t i : outlines[o]) second[i] = true;
  }
  for (const auto& [x_mm, y_mm] : {std::pair(5.0, 0.0), {0.0, -5.0}, {-3.5, 3.5}}) {
    ExpectTheHouse(moved([&](size_t i) { return lines_[i].layer != "WAND"; }, x_mm, y_mm), "doors and windows");
    ExpectTheHouse(moved([&](size_t i) { return second[i]; }, x_mm, y_mm), "every other wall");
  }
}

TEST_F(DraftingErrors, LinesDrawnTwiceAreOne) {
  for (const auto& [x_mm, y_mm] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, -1.0}, {0.7, 0.7}}) {
    std::vector<DrawnLine> all = lines_;
    for (size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].layer != "WAND") continue;
      DrawnLine copy = lines_[i];
      for (size_t k = 0; k < 4; ++k) copy.at[k] += (k % 2 == 0 ? x_mm : y_mm) * kUnitsPerMm;
      std::vector<DrawnLine> one = lines_;
      one.push_back(copy);
      all.push_back(copy);
      if (i % 5 == 0) ExpectTheHouse(one, "line " + std::to_string(i) + " twice");
    }
    ExpectTheHouse(all, "all lines twice");
  }
}

TEST_F(DraftingErrors, LinesInPiecesAreOne) {
  for (const double overlap_mm : {-5.0, -2.0, 2.0, 5.0}) {
    std::vector<DrawnLine> all;
    for (size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].layer != "WAND") {
        all.push_back(lines_[i]);
        continue;
      }
      const std::vector<DrawnLine> pieces = InThree(lines_[i], overlap_mm);
      all.insert(all.end(), pieces.begin(), pieces.end());
      std::vector<DrawnLine> one = lines_;
      one[i] = pieces[0];
      one.insert(one.end(), pieces.begin() + 1, pieces.end());
      if (i % 5 == 0) ExpectTheHouse(one, "line " + std::to_string(i) + " in pieces");
    }
    ExpectTheHouse(all, "all lines in pieces");
  }
}

}  // namespace
}  // namespace plumb::compiler
