// The compiler beside other readers of IFC: whole compile (open to written .agraph) against npm's web-ifc (open and tessellate all) and
// assimp's import, each in a process of its own that takes its own time; the STEP scan alone; peak memory, of which the first line states
// what a process has that reads nothing; opening the compiled file, and loading its triangles as well; the aliasing forecast as a share of
// the compile.
//   compile_benchmark PLAN.ifc|FOLDER...     -n RUNS: the best of so many runs counts (3)
//                                            -c: processor time instead of the wall clock, for a busy machine; assimp is left out then
// A reader that is not installed, or fails on a plan, shows as `-`. Goals: web-ifc at least 3 times slower on files over 1 MB and on the
// sum, scan above 300 MB/s, memory under 6 times the file, opening under 2 ms, aliasing forecast under 10 % of the compile; what misses one
// is marked with `!`.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "compiler/frontends/ifc/step_file.h"
#include "compiler/passes/alias_forecast.h"
#include "compiler/source/source.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"
#include "tests/benchmarks/child.h"

namespace {

using namespace plumb;
using bench::InChild;
using bench::kMegabyte;
namespace fs = std::filesystem;

constexpr double kLarge_mb = 1, kMinRatio = 3, kMinScan_mb_s = 300, kMaxMemoryRatio = 6, kMaxOpen_ms = 2, kMaxForecast = 0.1;
constexpr int kChild_s = 300;  // for a reader to finish a plan

struct Row {
  std::string name;
  double size_mb = 0, compile_ms = 0, scan_mb_s = 0, peak_mb = 0, open_ms = 0, load_ms = 0, agraph_mb = 0, forecast_ms = 0;
  std::optional<double> web_ifc_ms, assimp_ms;
};

struct Options {
  int runs = 3;
  bool cpu = false;
};

// By the wall clock, or all threads' processor time.
template <class Function>
double Timed_ms(const Options& options, Function work) {
  const auto now_ms = [&] {
    timespec t{};
    clock_gettime(options.cpu ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  };
  const double start_ms = now_ms();
  work();
  return now_ms() - start_ms;
}

template <class Function>
double Best(int runs, Function once) {
  double best = once();
  for (int i = 1; i < runs; ++i) best = std::min(best, once());
  return best;
}

std::optional<std::string> OutputOf(const std::string& command) {
  FILE* pipe = popen(fmt::format("timeout {} {} 2> /dev/null", kChild_s, command).c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string out;
  char buffer[4096];
  for (size_t n = 0; (n = fread(buffer, 1, sizeof(buffer), pipe)) > 0;) out.append(buffer, n);
  return pclose(pipe) == 0 ? std::optional(out) : std::nullopt;
}

std::optional<double> WebIfc_ms(const fs::path& plan, const Options& options) {
  const auto out = OutputOf(fmt::format("node '{}/tests/support/web_ifc.mjs' time '{}'", PLUMB_SOURCE_DIR, plan.string()));
  if (!out) return std::nullopt;
  const auto json = nlohmann::json::parse(*out, nullptr, false);
  return json.is_object() ? std::optional(json.value(options.cpu ? "cpu_ms" : "all_ms", 0.0)) : std::nullopt;
}

// assimp prints how long the import took, in seconds.
std::optional<double> Assimp_ms(const fs::path& plan) {
  const auto out = OutputOf(fmt::format("assimp info '{}' -r", plan.string()));
  const size_t at = out ? out->find("import took approx. ") : std::string::npos;
  if (at == std::string::npos) return std::nullopt;
  return 1000 * std::strtod(out->c_str() + at + 20, nullptr);
}

void KeepLeast(std::optional<double>& best, const std::optional<double>& value) {
  if (value) best = std::min(best.value_or(*value), *value);
}

// The best of some runs, in a child. `setup` gives what `work` needs and is not timed.
template <class Setup, class Work>
double BestInChild_ms(const Options& options, Setup setup, Work work) {
  const auto measured = InChild([&] {
    auto input = setup();
    return Best(options.runs, [&] { return Timed_ms(options, [&] { work(input); }); });
  });
  return measured ? measured->value : 0;
}

double Scan_ms(const fs::path& plan, const Options& options) {
  const auto load = [&] {
    compiler::DiagnosticSink ignored;
    return compiler::LoadSource(plan.string(), ignored);
  };
  return BestInChild_ms(options, load, [](const std::optional<compiler::Source>& source) {
    compiler::DiagnosticSink ignored;
    if (source) (void)compiler::StepFile::Index(source->bytes, ignored);
  });
}

double Compile_ms(const fs::path& plan, const std::string& agraph, const Options& options) {
  return Timed_ms(options, [&] {
    const compiler::CompileResult result = compiler::Compile(plan.string());
    if (!result.graph || !WriteAGraphFile(*result.graph, agraph)) _exit(1);
  });
}

std::optional<Row> Measure(const fs::path& plan, const fs::path& folder, const Options& options) {
  Row row;
  row.name = plan.stem().string();
  row.size_mb = static_cast<double>(fs::file_size(plan)) / kMegabyte;
  const std::string agraph = (folder / "plan.agraph").string();
  row.compile_ms = row.peak_mb = 1e12;
  // In turns, so that a busy machine is busy for all.
  for (int i = 0; i < options.runs; ++i) {
    const auto measured = InChild([&] { return Compile_ms(plan, agraph, options); });
    if (!measured) return std::nullopt;
    row.compile_ms = std::min(row.compile_ms, measured->value);
    row.peak_mb = std::min(row.peak_mb, measured->peak_mb);
    KeepLeast(row.web_ifc_ms, WebIfc_ms(plan, options));
    if (!options.cpu) KeepLeast(row.assimp_ms, Assimp_ms(plan));
  }
  row.agraph_mb = static_cast<double>(fs::file_size(agraph)) / kMegabyte;
  row.forecast_ms = BestInChild_ms(
      options, [&] { return ReadAGraphFile(agraph); }, [](Expected<AGraph>& graph) { compiler::ForecastAliases({}, *graph); });
  row.open_ms = BestInChild_ms(options, [] { return 0; }, [&](int) { (void)AGraphFile::Open(agraph); });
  row.load_ms = BestInChild_ms(options, [] { return 0; }, [&](int) { (void)ReadAGraphFile(agraph); });
  row.scan_mb_s = 1000 * row.size_mb / std::max(1e-3, Scan_ms(plan, options));
  return row;
}

std::string Marked(const char* format, double value, bool missed) {
  return fmt::format(fmt::runtime(format), value) + (missed ? "!" : " ");
}

// How much slower the other is.
std::string Ratio(const std::optional<double>& other_ms, double own_ms, double at_least) {
  if (!other_ms) return "-";
  return Marked("{:.1f}", *other_ms / own_ms, *other_ms < at_least * own_ms);
}

std::string Time(const std::optional<double>& ms) { return ms ? fmt::format("{:.0f}", *ms) : "-"; }

void Print(const Row& r, bool sum = false) {
  const bool large = sum || r.size_mb > kLarge_mb;
  const auto column = [](const std::string& text) { fmt::print(" {:>9}", text); };
  fmt::print("{:<38} {:>6.2f}", r.name, r.size_mb);
  column(fmt::format("{:.0f}", r.compile_ms));
  column(Time(r.web_ifc_ms));
  column(Ratio(r.web_ifc_ms, r.compile_ms, large ? kMinRatio : 0));
  column(Time(r.assimp_ms));
  column(Ratio(r.assimp_ms, r.compile_ms, 0));
  if (!sum) {
    column(Marked("{:.0f}", r.scan_mb_s, large && r.scan_mb_s < kMinScan_mb_s));
    column(Marked("{:.0f}", r.peak_mb, false));
    column(Marked("{:.1f}", r.peak_mb / r.size_mb, large && r.peak_mb > kMaxMemoryRatio * r.size_mb));
    column(fmt::format("{:.2f}", r.agraph_mb));
    column(Marked("{:.2f}", r.open_ms, r.open_ms > kMaxOpen_ms));
    column(fmt::format("{:.2f}", r.load_ms));
    column(Marked("{:.1f}", 100 * r.forecast_ms / r.compile_ms, large && r.forecast_ms > kMaxForecast * r.compile_ms));
  }
  fmt::print("\n");
  std::fflush(stdout);
}

// Of those plans that the other reader could read as well.
Row Sum(const std::vector<Row>& rows, std::optional<double> Row::*other, const char* name) {
  Row sum;
  sum.name = name;
  sum.*other = 0;
  for (const Row& r : rows) {
    if (!(r.*other)) continue;
    sum.size_mb += r.size_mb;
    sum.compile_ms += r.compile_ms;
    sum.*other = *(sum.*other) + *(r.*other);
  }
  if (sum.compile_ms == 0) sum.*other = std::nullopt;
  return sum;
}

std::vector<fs::path> PlansIn(const std::vector<std::string>& arguments) {
  std::vector<fs::path> plans;
  for (const std::string& argument : arguments) {
    if (!fs::is_directory(argument)) {
      plans.emplace_back(argument);
      continue;
    }
    for (const auto& entry : fs::directory_iterator(argument)) {
      if (entry.path().extension() == ".ifc") plans.push_back(entry.path());
    }
  }
  std::sort(plans.begin(), plans.end());
  return plans;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments;
  Options options;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc)
      options.runs = std::max(1, std::atoi(argv[++i]));
    else if (std::string(argv[i]) == "-c")
      options.cpu = true;
    else
      arguments.emplace_back(argv[i]);
  }
  if (arguments.empty()) {
    fmt::print(stderr, "usage: compile_benchmark [-n RUNS] [-c] PLAN.ifc|FOLDER...\n");
    return 2;
  }
  std::string name = (fs::temp_directory_path() / "plumb-benchmark-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) return 2;
  if (const auto idle = InChild([] { return 0.0; }))
    fmt::print("{} time; a process that reads nothing has {:.1f} MB\n", options.cpu ? "processor" : "wall clock", idle->peak_mb);
  fmt::print("{:<38} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "plan", "MB", "plumb ms", "web-ifc",
             "ratio ", "assimp", "ratio ", "scan MB/s", "peak MB ", "peak/file", "agraph MB", "open ms ", "load ms", "alias % ");
  std::vector<Row> rows;
  for (const fs::path& plan : PlansIn(arguments)) {
    if (const auto row = Measure(plan, name, options)) {
      rows.push_back(*row);
      Print(*row);
    } else {
      fmt::print("{:<38} not compiled\n", plan.stem().string());
    }
  }
  Print(Sum(rows, &Row::web_ifc_ms, "sum, where web-ifc reads"), true);
  Print(Sum(rows, &Row::assimp_ms, "sum, where assimp reads"), true);
  fs::remove_all(name);
  return 0;
}
