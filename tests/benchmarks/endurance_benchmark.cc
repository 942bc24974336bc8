// Hours of driving without hours of waiting: memory, and whether the graph keeps up, every five simulated minutes.
//   endurance_benchmark PLAN.agraph [MINUTES [SCANS_PER_S]]    60 and 10 by default; keyframes, and so the map, grow the same with 5 scans
//   a second
//
// A second process simulates the scans (VLP-16, no deviations) and hands them on through a pipe, so that the memory shown is the
// localizer's. Scans are fed as fast as it goes, odometry and graph in turn; `behind` is how far the graph would lag at that rate on a core
// of its own.
#include <fmt/core.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "runtime/localizer/localizer.h"
#include "runtime/localizer/stopwatch.h"
#include "schema/agraph_reader.h"
#include "tools/plumb/memory.h"
#include "tools/simulate/as_built.h"
#include "tools/simulate/reach.h"
#include "tools/simulate/sweep.h"
#include "tools/simulate/tour.h"

namespace {

using namespace plumb;

constexpr double kReportEvery_s = 300;

bool WriteAll(int file, const void* data, size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::write(file, at, size);
    if (done <= 0) return false;
    at += done;
    size -= static_cast<size_t>(done);
  }
  return true;
}

bool ReadAll(int file, void* data, size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t done = ::read(file, at, size);
    if (done <= 0) return false;
    at += done;
    size -= static_cast<size_t>(done);
  }
  return true;
}

struct Header {
  double stamp_s = 0;
  std::array<double, 16> T_plan_lidar{};  // as it is
  uint64_t points = 0;
};

// The simulating process. False if nothing can be driven through.
bool Simulate(const AGraph& plan, double duration_s, double period_s, int out) {
  std::vector<size_t> rooms(plan.storeys.size(), 0);
  for (const Room& room : plan.rooms) {
    if (room.storey.valid()) ++rooms[room.storey.index()];
  }
  const StoreyId storey(static_cast<size_t>(std::max_element(rooms.begin(), rooms.end()) - rooms.begin()));
  tools::SimulateOptions options;
  options.deviate = 0;
  const auto built = tools::BuildWithDeviations(plan, storey, options);
  if (!built) return false;
  const tools::FreeSpace space(built->house, storey, built->passages);
  tools::TourOptions tour_options;
  tour_options.min_duration_s = tour_options.max_duration_s = duration_s;
  tools::Random random(options.seed);
  const auto tour = tools::PlanTour(built->house, space, tools::FindReach(built->house, storey, space), tour_options, random);
  if (!tour) return false;
  const tools::Lidar lidar(built->house, *tools::FindSensor("vlp16"), options.glass_transmission);
  for (size_t i = 0; static_cast<double>(i + 1) * period_s < tour->drive.duration_s(); ++i) {
    const double at_s = static_cast<double>(i) * period_s;
    const auto sweep = lidar.Take(at_s, at_s, [&](double t_s) { return tour->drive.PoseAt(t_s); }, random);
    Header header{at_s, {}, sweep.scan.points.size()};
    Eigen::Map<Eigen::Matrix4d>(header.T_plan_lidar.data()) = tour->drive.PoseAt(at_s).matrix();
    if (!WriteAll(out, &header, sizeof header) || !WriteAll(out, sweep.scan.points.data(), header.points * sizeof(Eigen::Vector3f)) ||
        !WriteAll(out, sweep.scan.time_s.data(), header.points * sizeof(float))) {
      return true;
    }
  }
  return true;
}

// Resident, in MB.
double Memory_MB() {
  std::ifstream file("/proc/self/statm");
  size_t total = 0, resident = 0;
  file >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

// Of the resident memory, what is in use: the rest is what freed blocks left between them.
double InUse_MB() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

int Localize(const AGraph& plan, double period_s, int in) {
  runtime::Localizer localizer(plan);
  fmt::print("{:>7} {:>9} {:>10} {:>10} {:>10} {:>13} {:>10} {:>9} {:>9} {:>10}\n", "minute", "RSS MB", "in use MB", "keyframes",
             "surfaces", "odometry ms", "graph ms", "behind s", "found %", "worst m");
  fmt::print("{:>7} {:>9.0f} {:>10.0f}\n", 0, Memory_MB(), InUse_MB());
  double odometry_ms = 0, graph_ms = 0, behind_ms = 0, worst_behind_ms = 0, worst_m = 0, next_s = kReportEvery_s;
  size_t scans = 0, localized = 0;
  Header header;
  runtime::Scan scan;
  for (;;) {
    const bool more = ReadAll(in, &header, sizeof header);
    if (!more || header.stamp_s >= next_s) {
      size_t keyframes = 0, surfaces = 0;
      for (const runtime::Keyframe& k : localizer.map().keyframes) keyframes += !k.merged;
      for (const runtime::MapSurface& s : localizer.map().surfaces) surfaces += !s.observations.empty();
      const double n = static_cast<double>(std::max<size_t>(scans, 1));
      fmt::print("{:>7.0f} {:>9.0f} {:>10.0f} {:>5}/{:<5} {:>4}/{:<5} {:>12.1f} {:>10.1f} {:>9.1f} {:>9.1f} {:>10.3f}\n", scan.stamp_s / 60,
                 Memory_MB(), InUse_MB(), keyframes, localizer.map().keyframes.size(), surfaces, localizer.map().surfaces.size(),
                 odometry_ms / n, graph_ms / n, worst_behind_ms / 1e3, 100.0 * static_cast<double>(localized) / n, worst_m);
      std::fflush(stdout);
      odometry_ms = graph_ms = worst_behind_ms = worst_m = 0;
      scans = localized = 0;
      next_s += kReportEvery_s;
    }
    if (!more) break;
    scan.stamp_s = header.stamp_s;
    scan.points.resize(header.points);
    scan.time_s.resize(header.points);
    if (!ReadAll(in, scan.points.data(), header.points * sizeof(Eigen::Vector3f)) ||
        !ReadAll(in, scan.time_s.data(), header.points * sizeof(float)))
      break;
    runtime::Stopwatch watch;
    const runtime::RegisteredScan registered = localizer.Register(scan, std::nullopt);
    odometry_ms += watch.Lap();
    const runtime::ScanVerdict verdict = localizer.Track(registered, localizer.UpdateGraph(registered));
    const double spent_ms = watch.Lap();
    graph_ms += spent_ms;
    behind_ms = std::max(0.0, behind_ms + spent_ms - 1e3 * period_s);
    worst_behind_ms = std::max(worst_behind_ms, behind_ms);
    ++scans;
    if (verdict.verdict != runtime::Verdict::kLocalized) continue;
    ++localized;
    const Eigen::Map<const Eigen::Matrix4d> truth(header.T_plan_lidar.data());
    worst_m = std::max(worst_m, (verdict.T_plan_lidar->translation() - truth.block<3, 1>(0, 3)).norm());
  }
  runtime::Stopwatch watch;
  localizer.Finish();
  fmt::print("final solve {:.1f} s, then {:.0f} MB\n", watch.Lap() / 1e3, Memory_MB());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  tools::ReturnLargeBlocks();  // as the program does
  const double minutes = argc > 2 ? std::atof(argv[2]) : 60;
  const double period_s = 1 / (argc > 3 ? std::atof(argv[3]) : 10);
  if (argc < 2 || !(minutes > 0) || !(period_s >= 0.1 && period_s <= 1)) {
    fmt::print(stderr, "usage: endurance_benchmark PLAN.agraph [MINUTES [SCANS_PER_S]], 1 to 10 scans a second\n");
    return 2;
  }
  int ends[2];
  if (::pipe(ends) != 0) return 3;
  const pid_t child = ::fork();
  if (child < 0) return 3;
  const auto plan = ReadAGraphFile(argv[1]);
  if (!plan) {
    fmt::print(stderr, "{}\n", plan.error().message);
    return 2;
  }
  if (child == 0) {
    ::close(ends[0]);
    return Simulate(*plan, minutes * 60, period_s, ends[1]) ? 0 : 2;
  }
  ::close(ends[1]);
  const int status = Localize(*plan, period_s, ends[0]);
  ::close(ends[0]);
  int child_status = 0;
  ::waitpid(child, &child_status, 0);
  return child_status != 0 ? 2 : status;
}
