#include "runtime/localizer/replay.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "runtime/localizer/bounded_queue.h"
#include "runtime/localizer/first_exception.h"

namespace plumb::runtime {
namespace {

constexpr size_t kScansAhead = 4;  // between two steps: a scan of 300,000 points takes some 10 MB
constexpr double kLongestWait_s = 5;  // for the next scan: recordings may have been paused for hours

struct ReadScan {
  size_t index = 0;
  Expected<Scan> scan;
};

struct OdometryScan {
  ReplayedScan replayed;
  RegisteredScan registered;  // unless unreadable
};

// Closes a queue at the end of its scope, whichever way that is left: no thread then waits on it any more.
template <class T>
class Closer {
 public:
  explicit Closer(BoundedQueue<T>& queue) : queue_(queue) {}
  ~Closer() { queue_.Close(); }
  Closer(const Closer&) = delete;
  Closer& operator=(const Closer&) = delete;

 private:
  BoundedQueue<T>& queue_;
};

// The scans to replay: [first, last).
struct ScanRange {
  size_t first = 0, last = 0;
};

ScanRange ScansOf(const Recording& recording, const ReplayOptions& options) {
  const auto since_start_s = [&](size_t i) { return recording.stamp_s(i) - recording.stamp_s(0); };
  ScanRange out;
  while (out.first < recording.size() && since_start_s(out.first) < options.start_s) ++out.first;
  out.last = out.first;
  const double end_s = options.max_duration_s > 0 ? options.start_s + options.max_duration_s : std::numeric_limits<double>::infinity();
  while (out.last < recording.size() && since_start_s(out.last) <= end_s) ++out.last;
  return out;
}

ReplayedScan Describe(const ReadScan& read) {
  ReplayedScan out;
  out.index = read.index;
  if (!read.scan) {
    out.unreadable = read.scan.error();
    return out;
  }
  out.has_points = !read.scan->points.empty();
  out.has_times = !read.scan->time_s.empty();
  return out;
}

std::optional<Odometry::GivenMotion> Given(const Recording& recording, const ReplayOptions& options, const Scan& scan) {
  if (!options.given_odometry) return std::nullopt;
  return GivenMotionDuring(scan, recording.odometry());
}

OdometryScan Register(const Recording& recording, const ReplayOptions& options, const ReadScan& read, Localizer& localizer) {
  OdometryScan out{Describe(read), {}};
  if (read.scan) out.registered = localizer.Register(*read.scan, Given(recording, options, *read.scan));
  return out;
}

// False if the sink has had enough.
bool Conclude(OdometryScan& scan, Localizer& localizer, const ReplaySink& sink) {
  if (!scan.replayed.unreadable) scan.replayed.verdict = localizer.Track(scan.registered, localizer.UpdateGraph(scan.registered));
  return sink(scan.replayed);
}

int NumThreads(int asked) { return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

// Reads the scans into `queue` until it is closed.
std::jthread StartReading(const Recording& recording, ScanRange scans, BoundedQueue<ReadScan>& queue, FirstException& failure) {
  return std::jthread([&recording, scans, &queue, &failure] {
    const Closer closer(queue);
    failure.Guard([&] {
      for (size_t i = scans.first; i < scans.last; ++i) {
        if (!queue.Push({i, recording.Read(i)})) return;
      }
    });
  });
}

// Odometry on a thread of its own, reading on another where there is a third; ends when all threads have.
void RunPipeline(const Recording& recording, const ReplayOptions& options, int num_threads, Localizer& localizer, const ReplaySink& sink,
                 FirstException& failure) {
  const ScanRange scans = ScansOf(recording, options);
  BoundedQueue<ReadScan> read(kScansAhead);
  BoundedQueue<OdometryScan> registered(kScansAhead);
  std::jthread reading;
  if (num_threads > 2) reading = StartReading(recording, scans, read, failure);
  const std::jthread odometry([&] {
    const Closer closer(registered);
    failure.Guard([&] {
      for (size_t i = scans.first; i < scans.last; ++i) {
        const std::optional<ReadScan> next = num_threads > 2 ? read.Pop() : ReadScan{i, recording.Read(i)};
        if (!next || !registered.Push(Register(recording, options, *next, localizer))) return;
      }
    });
  });
  const Closer close_read(read);
  const Closer close_registered(registered);
  while (std::optional<OdometryScan> scan = registered.Pop()) {
    if (!Conclude(*scan, localizer, sink)) return;
  }
}

}  // namespace

std::string ReplayOptions::Check() const {
  if (threads < 0) return "ReplayOptions.threads = " + std::to_string(threads) + "; must be >= 0";
  if (!(rate >= 0 && rate <= 1000)) return fmt::format("ReplayOptions.rate = {}; must be in [0, 1000]", rate);
  if (!(start_s >= 0)) return fmt::format("ReplayOptions.start_s = {}; must be >= 0", start_s);
  if (!(max_duration_s >= 0)) return fmt::format("ReplayOptions.max_duration_s = {}; must be >= 0", max_duration_s);
  return online.Check();
}

void ReplayOffline(const Recording& recording, const ReplayOptions& options, Localizer& localizer, const ReplaySink& sink) {
  const int num_threads = NumThreads(options.threads);
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, static_cast<size_t>(num_threads));
  if (num_threads == 1) {
    const ScanRange scans = ScansOf(recording, options);
    for (size_t i = scans.first; i < scans.last; ++i) {
      OdometryScan scan = Register(recording, options, {i, recording.Read(i)}, localizer);
      if (!Conclude(scan, localizer, sink)) return;
    }
    return;
  }
  FirstException failure;
  RunPipeline(recording, options, num_threads, localizer, sink, failure);
  failure.Rethrow();
}

namespace {

void GiveAtPace(const Recording& recording, const ReplayOptions& options, OnlineLocalizer& localizer, const ReplaySink& sink,
                FirstException& failure) {
  using Clock = std::chrono::steady_clock;
  BoundedQueue<ReadScan> read(kScansAhead);
  const std::jthread reading = StartReading(recording, ScansOf(recording, options), read, failure);
  const Closer closer(read);
  Clock::time_point due = Clock::now();
  std::optional<double> last_s;
  while (const std::optional<ReadScan> next = read.Pop()) {
    ReplayedScan replayed = Describe(*next);
    if (!replayed.unreadable) {
      const std::vector<float>& times_s = next->scan->time_s;
      const double ended_s = next->scan->stamp_s + (times_s.empty() ? 0.0 : *std::max_element(times_s.begin(), times_s.end()));
      const double step_s = std::clamp(ended_s - last_s.value_or(ended_s), 0.0, kLongestWait_s);
      last_s = ended_s;
      due += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step_s / options.rate));
      std::this_thread::sleep_until(due);
      replayed.verdict = localizer.AddScan(*next->scan, Given(recording, options, *next->scan));
      replayed.latency_ms = std::chrono::duration<double, std::milli>(Clock::now() - due).count();
    }
    if (!sink(replayed)) return;
  }
}

}  // namespace

void ReplayPaced(const Recording& recording, const ReplayOptions& options, OnlineLocalizer& localizer, const ReplaySink& sink) {
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<size_t>(NumThreads(options.threads)));
  FirstException failure;
  GiveAtPace(recording, options, localizer, sink, failure);
  failure.Rethrow();
}

}  // namespace plumb::runtime
