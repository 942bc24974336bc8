// Large drawings: DXF files that are nothing but walls are drawn and compiled, each in a process of its own; whole compile (open to written
// .agraph) by the wall clock and by all threads' processor time, and peak memory.
//   drawing_benchmark [SIZE_MB...]     sizes of the drawings (5 50); with -k FOLDER they and their A-Graphs are kept there
// Two kinds of drawing: `doors` is one building of rooms that lead to each other, every wall drawn by the lines of its two sides; `boxes`
// (of 10 MB at most) is closed outlines of single rooms, which share nothing. Goals: 50 MB in 10 s and 2 GB, and as much by megabyte; what
// misses one is marked with `!`.
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"
#include "tests/benchmarks/child.h"

namespace {

using namespace plumb;
using bench::kMegabyte;
namespace fs = std::filesystem;

constexpr double kMax_s_mb = 10.0 / 50, kMaxPeakRatio = 2000.0 / 50;  // by megabyte of drawing
constexpr double kMaxBoxes_mb = 10;                                   // they hold five times as many rooms
constexpr double kWall_m = 0.2, kDoor_m = 0.9, kToDoor_m = 1.0;

// As CAD programs write it, with handles and the classes of entities.
class DrawingText {
 public:
  DrawingText() {
    out_ = "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\nAC1024\n  9\n$INSUNITS\n 70\n     6\n  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n";
  }

  void Line(double x0, double y0, double x1, double y1) {
    Entity("LINE", "A-WALL", "AcDbLine");
    Append(" 10\n{:.8f}\n 20\n{:.8f}\n 30\n0.0\n 11\n{:.8f}\n 21\n{:.8f}\n 31\n0.0\n", x0, y0, x1, y1);
  }
  void Box(double x0, double y0, double x1, double y1) {
    Entity("LWPOLYLINE", "A-WALL", "AcDbPolyline");
    Append(" 90\n4\n 70\n1\n 43\n0.0\n");
    for (const auto& [x, y] : {std::pair(x0, y0), {x1, y0}, {x1, y1}, {x0, y1}}) Append(" 10\n{:.8f}\n 20\n{:.8f}\n", x, y);
  }
  void Text(double x, double y, const std::string& text) {
    Entity("TEXT", "A-AREA-IDEN", "AcDbText");
    Append(" 10\n{:.3f}\n 20\n{:.3f}\n 30\n0.0\n 40\n0.2\n  1\n{}\n", x, y, text);
  }
  [[nodiscard]] std::string Take() { return std::move(out_ += "  0\nENDSEC\n  0\nEOF\n"); }

 private:
  void Entity(const char* type, const char* layer, const char* of_class) {
    Append("  0\n{}\n  5\n{:X}\n330\n1F\n100\nAcDbEntity\n  8\n{}\n100\n{}\n", type, ++handle_, layer, of_class);
  }
  template <class... Values>
  void Append(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }

  std::string out_;
  uint32_t handle_ = 0xff;
};

// Where the rooms of a row begin: of several widths in turn.
std::vector<double> Places(size_t rooms, std::vector<double> widths_m) {
  std::vector<double> out = {0};
  for (size_t i = 0; i < rooms; ++i) out.push_back(out.back() + widths_m[i % widths_m.size()]);
  return out;
}

// `rooms` by `rooms` of them, each with a door in its wall to the south; the first row's doors lead outside.
std::string Doors(size_t rooms) {
  const std::vector<double> xs = Places(rooms, {4, 3.4, 5.2}), ys = Places(rooms, {5, 4.2});
  const double half = kWall_m / 2;
  DrawingText out;
  for (size_t j = 0; j <= rooms; ++j) {
    for (size_t i = 0; i < rooms; ++i) {
      const double from = i == 0 ? -half : xs[i] + half, to = xs[i + 1] - half, door = xs[i] + half + kToDoor_m;
      const double end = i + 1 == rooms ? xs[i + 1] + half : to;
      const bool outer = j == 0 || j == rooms, open = j < rooms;
      for (const double side : {-half, half}) {
        const bool outside = outer && (side < 0) == (j == 0);
        const double a = outside ? (i == 0 ? from : xs[i] + half) : xs[i] + half,
                     b = outside ? (i + 1 == rooms ? end : xs[i + 1] + half) : to;
        const double y = ys[j] + side;
        if (!open) {
          out.Line(a, y, b, y);
          continue;
        }
        out.Line(a, y, door, y);
        out.Line(door + kDoor_m, y, b, y);
      }
      if (!open) continue;
      for (const double x : {door, door + kDoor_m}) out.Line(x, ys[j] - half, x, ys[j] + half);
      out.Line(xs[i] + half, ys[j] + half, xs[i] + half, ys[j + 1] - half);
      out.Line(to, ys[j] + half, to, ys[j + 1] - half);
      out.Text(xs[i] + 1.8, ys[j] + 2, fmt::format("R{}-{}", j, i));
    }
  }
  for (const double x : {-half, xs.back() + half}) out.Line(x, -half, x, ys.back() + half);
  return out.Take();
}

std::string Boxes(size_t rooms) {
  DrawingText out;
  for (size_t j = 0; j < rooms; ++j) {
    for (size_t i = 0; i < rooms; ++i) {
      const double x = 5.4 * static_cast<double>(i), y = 5.4 * static_cast<double>(j);
      out.Box(x, y, x + 5, y + 4);
    }
  }
  return out.Take();
}

// A drawing of about that size: rooms grow with the square of their number in a row.
template <class Draw>
std::string OfSize(double size_mb, const Draw& draw) {
  constexpr size_t kProbe = 20;
  const double probe_mb = static_cast<double>(draw(kProbe).size()) / kMegabyte;
  return draw(std::max<size_t>(1, static_cast<size_t>(std::lround(static_cast<double>(kProbe) * std::sqrt(size_mb / probe_mb)))));
}

double Compile_s(const std::string& plan, const std::string& agraph) {
  const auto start = std::chrono::steady_clock::now();
  const compiler::CompileResult result = compiler::Compile(plan);
  if (!result.graph || !WriteAGraphFile(*result.graph, agraph)) _exit(1);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Measure(const char* kind, const std::string& drawing, const fs::path& folder) {
  const double size_mb = static_cast<double>(drawing.size()) / kMegabyte;
  const std::string name = fmt::format("{}-{:.0f}", kind, size_mb);
  const std::string plan = (folder / (name + ".dxf")).string(), agraph = (folder / (name + ".agraph")).string();
  std::ofstream(plan, std::ios::binary) << drawing;
  const auto measured = bench::InChild([&] { return Compile_s(plan, agraph); });
  if (!measured) {
    fmt::print("{:<10} {:>7.2f} not compiled\n", kind, size_mb);
    return;
  }
  const auto graph = ReadAGraphFile(agraph);
  const auto marked = [](double value, bool missed) { return fmt::format("{:.2f}{}", value, missed ? "!" : " "); };
  fmt::print("{:<10} {:>7.2f} {:>8} {:>9} {:>8.2f} {:>10}\n", kind, size_mb, graph ? graph->rooms.size() : 0,
             marked(measured->value, measured->value > kMax_s_mb * size_mb), measured->cpu_s,
             marked(measured->peak_mb, measured->peak_mb > kMaxPeakRatio * size_mb));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> sizes_mb;
  fs::path kept;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-k" && i + 1 < argc)
      kept = argv[++i];
    else
      sizes_mb.push_back(std::atof(argv[i]));
  }
  if (std::any_of(sizes_mb.begin(), sizes_mb.end(), [](double size_mb) { return !(size_mb > 0 && size_mb <= 1000); })) {
    fmt::print(stderr, "usage: drawing_benchmark [-k FOLDER] [SIZE_MB...]\n");
    return 2;
  }
  if (sizes_mb.empty()) sizes_mb = {5, 50};
  std::string folder = kept.empty() ? (fs::temp_directory_path() / "plumb-benchmark-XXXXXX").string() : kept.string();
  if (kept.empty() && mkdtemp(folder.data()) == nullptr) return 2;
  fmt::print("{:<10} {:>7} {:>8} {:>9} {:>8} {:>10}\n", "drawing", "MB", "rooms", "seconds ", "cpu s", "peak MB ");
  for (const double size_mb : sizes_mb) {
    Measure("doors", OfSize(size_mb, Doors), folder);
    Measure("boxes", OfSize(std::min(size_mb, kMaxBoxes_mb), Boxes), folder);
  }
  if (kept.empty()) fs::remove_all(folder);
  return 0;
}
