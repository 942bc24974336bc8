// `plumb localize`'s way through a recording: scan by scan, until its end or Ctrl-C, with what the user is told on the way.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runtime/localizer/replay.h"
#include "tools/plumb/console.h"
#include "tools/plumb/interrupt.h"
#include "tools/run/run_folder.h"
#include "tools/run/run_info.h"
#include "tools/run/tries_json.h"

namespace plumb::tools {

// What the scans gave, in the order of the scans.
struct ReplayResults {
  runtime::Trajectory online;
  std::vector<VerdictRow> verdicts;
  std::vector<TryRow> tries;
  std::vector<TimingRow> timing;
  size_t unreadable_scans = 0, untimed_scans = 0, unordered_scans = 0;
  bool interrupted = false;
  std::optional<Pace> pace;  // with --rate
};

// The localizer with what a recording taught it. One of the two runs; `localizer()` has the estimate.
class Replayer {
 public:
  // The pace decides: `replay.rate` 0 goes scan by scan, else as on a robot. `plan` must outlive it.
  Replayer(const AGraph& plan, const runtime::LocalizerOptions& localizer, const runtime::ReplayOptions& replay);

  // Errors: kBadScan (no scan could be read, or none lies in the time asked for).
  [[nodiscard]] Expected<ReplayResults> Run(const runtime::Recording& recording, Console& console, InterruptGuard& interrupt);

  // After Run.
  [[nodiscard]] runtime::Localizer& localizer() { return offline_ ? *offline_ : *drained_; }

 private:
  void RequestUpdate();
  void AddGraphSide(ReplayResults& results);

  const AGraph& plan_;
  runtime::ReplayOptions replay_;
  std::optional<runtime::Localizer> offline_;
  std::optional<runtime::OnlineLocalizer> online_;
  runtime::Localizer* drained_ = nullptr;
};

}  // namespace plumb::tools
