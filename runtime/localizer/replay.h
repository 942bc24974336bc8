// A recording through the localizer: offline on several threads, or at its own pace as on a robot.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runtime/localizer/localizer.h"
#include "runtime/localizer/online_localizer.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

struct ReplayOptions {
  int threads =
      0;  // offline: 1 does one thing after another, 2 runs the graph beside the rest, more read ahead as well; 0: all the machine has
  double rate = 0;  // 0: offline, as fast as it goes. Else times real time: a scan is given when its sweep has ended, and the graph gets
                    // what time there is
  double start_s = 0;          // leaves out this much of the recording at its beginning
  double max_duration_s = 0;   // stops after this much of the rest; 0: all of it
  bool given_odometry = true;  // use the recording's
  OnlineOptions online;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// One scan of the recording, in its order.
struct ReplayedScan {
  size_t index = 0;
  std::optional<Error> unreadable;  // then there is no verdict
  bool has_points = false, has_times = false;
  ScanVerdict verdict;
  double latency_ms = 0;            // with a rate: from when the scan was due until its verdict was there
};

// False ends the replay.
using ReplaySink = std::function<bool(const ReplayedScan&)>;

// Offline the results are the same to the last bit for any number of threads: odometry needs nothing of the graph, so each step works on
// the scans in their order and only the steps overlap; the verdict on a scan waits for the graph to have taken in this very scan. At most a
// few scans are between two steps. `sink` is called on the calling thread. The caller calls Finish().
void ReplayOffline(const Recording& recording, const ReplayOptions& options, Localizer& localizer, const ReplaySink& sink);

// At `options.rate`; decoding ahead. A scan that is late because odometry was busy is still given, later.
void ReplayPaced(const Recording& recording, const ReplayOptions& options, OnlineLocalizer& localizer, const ReplaySink& sink);

}  // namespace plumb::runtime
