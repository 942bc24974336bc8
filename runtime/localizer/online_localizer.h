// The localizer on a robot: a pose on every scan after odometry's few milliseconds, while the graph works on a thread of its own.
#pragma once

#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/localizer/bounded_queue.h"
#include "runtime/localizer/first_exception.h"
#include "runtime/localizer/localizer.h"

namespace plumb::runtime {

struct OnlineOptions {
  int hold_solves_behind = 5;  // scans that wait for the graph: from so many on keyframes are mapped, but neither matched nor solved, ...
  int max_scans_behind = 30;   // ... and from so many on scans reach the graph without their points
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// How well the graph kept up.
struct OnlineCounts {
  size_t held_solves = 0;     // keyframes that were not solved when they were made; the next solve takes them in
  size_t unmapped_scans = 0;  // their points are in no keyframe; they got a verdict and a pose as all others
};

// AddScan() never waits for the graph. Its verdict and pose rest on the graph's last finished state; how old that is depends on the
// machine, so two runs are not equal to the last digit. Queue of registered scans: bounded, the drop rule is OnlineOptions.
class OnlineLocalizer {
 public:
  // `plan` must outlive it; both options must pass Check(). Starts the graph's thread.
  OnlineLocalizer(const AGraph& plan, const LocalizerOptions& options = {}, const OnlineOptions& online = {});
  ~OnlineLocalizer();  // what still waits for the graph is dropped

  // The next scan in time order. The timing is odometry's only.
  [[nodiscard]] ScanVerdict AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given);

  // After the last scan: waits until the graph has taken in all scans and ends its thread. The results are then the localizer's (with
  // Finish() for a final solve).
  [[nodiscard]] Localizer& Drain();

  // See GraphEstimator::RequestUpdate.
  void RequestUpdate() { localizer_.RequestUpdate(); }

  [[nodiscard]] OnlineCounts counts() const;
  // Times of the graph's stages since the last call, by the stamp of the scan that they were spent on.
  struct StampedTime {
    double stamp_s = 0;
    StageTime time;
  };
  [[nodiscard]] std::vector<StampedTime> TakeGraphTimes();

 private:
  void RunGraph();
  void TakeInScans();

  OnlineOptions options_;
  Localizer localizer_;
  std::vector<RegisteredScan> waiting_;  // the last scan and those before it that found the queue full, without points
  BoundedQueue<std::vector<RegisteredScan>> queue_;
  mutable std::mutex mutex_;  // of what follows
  GraphState state_;
  OnlineCounts counts_;
  std::vector<StampedTime> graph_times_;
  bool dropping_ = false;
  FirstException failure_;  // of the graph; Drain() throws it
  std::thread graph_thread_;  // last: it uses all of the above
};

}  // namespace plumb::runtime
