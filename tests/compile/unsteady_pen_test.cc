// Two rooms drawn with an unsteady pen: jambs beside their walls, and all ends of all lines off.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

constexpr double kDoor_m = 0.9;
constexpr uint32_t kMostWrong = 2;  // of 20

struct PenLine {
  Eigen::Vector2d a, b;
  bool is_jamb = false;
};

// 8 m by 5 m with a wall between two rooms, a doorway in it and one to the outside; each side of the walls is a line of its own.
std::vector<PenLine> TwoRooms(double thickness_m) {
  const double t = thickness_m, w = 8, h = 5, x = 4, out = 1, in = 2;
  const std::vector<Eigen::Vector2d> corners = {{0, 0},
                                                {out, 0},
                                                {out, t},
                                                {t, t},
                                                {t, h - t},
                                                {x, h - t},
                                                {x, in + kDoor_m},
                                                {x + t, in + kDoor_m},
                                                {x + t, h - t},
                                                {w - t, h - t},
                                                {w - t, t},
                                                {x + t, t},
                                                {x + t, in},
                                                {x, in},
                                                {x, t},
                                                {out + kDoor_m, t},
                                                {out + kDoor_m, 0},
                                                {w, 0},
                                                {w, h},
                                                {0, h}};
  std::vector<PenLine> lines;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    lines.push_back({a, b, (b - a).norm() < 1.5 * t});
  }
  return lines;
}

class UnsteadyPen : public testing::TestWithParam<double> {
 protected:
  bool AreTwoRooms(const std::vector<PenLine>& lines) {
    std::ostringstream out;
    out.precision(10);
    out << "  0\nSECTION\n  2\nHEADER\n  9\n$INSUNITS\n 70\n6\n  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n";
    for (const PenLine& l : lines)
      out << "  0\nLINE\n  8\nWALL\n 10\n" << l.a.x() << "\n 20\n" << l.a.y() << "\n 11\n" << l.b.x() << "\n 21\n" << l.b.y() << "\n";
    out << "  0\nENDSEC\n  0\nEOF\n";
    const std::string path = folder_ / "rooms.dxf";
    EXPECT_TRUE(WriteFileAtomically(path, std::string_view(out.str())));
    const CompileResult result = Compile(path);
    return result.graph && result.graph->rooms.size() == 2 && result.graph->doorways.size() == 2;
  }

  test::TemporaryFolder folder_;
};

TEST_P(UnsteadyPen, JambsBesideTheirWallsStayJambs) {
  const std::vector<PenLine> drawn = TwoRooms(GetParam());
  for (const double aside_m : {-0.005, -0.002, 0.0, 0.0005, 0.002, 0.005}) {
    for (const double short_m : {-0.0035, 0.0, 0.0035, 0.005}) {
      for (const bool both_ends : {false, true}) {
        std::vector<PenLine> lines = drawn;
        for (PenLine& l : lines) {
          if (!l.is_jamb) continue;
          const Eigen::Vector2d u = (l.b - l.a).normalized(), aside = aside_m * Eigen::Vector2d(-u.y(), u.x());
          l.a += aside + short_m * u;
          l.b += aside - (both_ends ? short_m : 0) * u;
        }
        EXPECT_TRUE(AreTwoRooms(lines)) << 1000 * aside_m << " mm aside, " << 1000 * short_m << " mm short";
      }
    }
  }
}

TEST_P(UnsteadyPen, AllEndsMayBeOffByMillimetres) {
  for (const double off_m : {0.002, 0.005}) {
    uint32_t wrong = 0;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
      std::mt19937 random(seed);
      const auto shift_m = [&] { return off_m * (2.0 * random() / std::mt19937::max() - 1); };
      std::vector<PenLine> lines = TwoRooms(GetParam());
      for (PenLine& l : lines) {
        for (double* v : {&l.a.x(), &l.a.y(), &l.b.x(), &l.b.y()}) *v += shift_m();
      }
      wrong += AreTwoRooms(lines) ? 0 : 1;
    }
    EXPECT_LE(wrong, kMostWrong) << 1000 * off_m << " mm";
  }
}

INSTANTIATE_TEST_SUITE_P(WallsOf, UnsteadyPen, testing::Values(0.1, 0.24, 0.6),
                         [](const auto& wall) { return std::to_string(static_cast<int>(100 * wall.param)) + "cm"; });

}  // namespace
}  // namespace plumb::compiler
