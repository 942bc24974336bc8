#include "tools/plumb/replayer.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "tools/plumb/match_rows.h"

namespace plumb::tools {
namespace {

// Takes in what a replay gives, scan by scan.
class Collector {
 public:
  // `request_update`: called where the user asks what is known.
  Collector(const AGraph& plan, size_t num_scans, bool paced, Console& console, InterruptGuard& interrupt,
            std::function<void()> request_update)
      : plan_(plan), num_scans_(num_scans), paced_(paced), console_(console), interrupt_(interrupt), request_update_(std::move(request_update)) {}

  // False once the user has had enough.
  bool Add(const runtime::ReplayedScan& scan) {
    if (interrupt_.requested()) {
      results_.interrupted = true;
      return false;
    }
    if (interrupt_.TakeReportRequest()) request_update_();
    if (scan.unreadable) {  // one bad file is no reason to lose hours of good ones
      console_.Error(scan.unreadable->message + "; skipped");
      last_error_ = *scan.unreadable;
      ++results_.unreadable_scans;
      return true;
    }
    const runtime::ScanVerdict& verdict = scan.verdict;
    if (!verdict.in_order) {
      if (results_.unordered_scans++ == 0) {
        console_.Info(fmt::format("the scan at {:.9f} s does not come after the one before it: left out, as all others of that kind",
                                  verdict.stamp_s));
      }
      return true;
    }
    if (!verdict.timed && scan.has_points && results_.untimed_scans++ == 0) {
      console_.Info(fmt::format("scans without {}per-point time: deskew off", scan.has_times ? "usable " : ""));
    }
    if (verdict.last_try && (results_.tries.empty() || verdict.last_try->stamp_s > results_.tries.back().stamp_s)) {
      results_.tries.push_back(ToRow(plan_, *verdict.last_try));
    }
    results_.verdicts.push_back({verdict.stamp_s, runtime::VerdictName(verdict.verdict), verdict.hypotheses});
    if (verdict.T_plan_lidar) results_.online.push_back({verdict.stamp_s, *verdict.T_plan_lidar});
    for (const runtime::StageTime& stage : verdict.timing) results_.timing.push_back({verdict.stamp_s, stage.stage, stage.ms});
    if (paced_) results_.timing.push_back({verdict.stamp_s, "latency", scan.latency_ms});
    if (paced_) latencies_ms_.push_back(scan.latency_ms);
    console_.Progress("localizing", scan.index + 1, num_scans_);
    return true;
  }

  Expected<ReplayResults> Take() {
    if (results_.verdicts.empty()) return tl::unexpected(last_error_);
    if (paced_) results_.pace = PaceOf(latencies_ms_);
    return std::move(results_);
  }

 private:
  const AGraph& plan_;
  size_t num_scans_;
  bool paced_;
  Console& console_;
  InterruptGuard& interrupt_;
  std::function<void()> request_update_;
  Error last_error_{ErrorCode::kBadScan, "no scan lies between --start and the end of the recording"};
  std::vector<double> latencies_ms_;
  ReplayResults results_;
};

}  // namespace

Replayer::Replayer(const AGraph& plan, const runtime::LocalizerOptions& localizer, const runtime::ReplayOptions& replay)
    : plan_(plan), replay_(replay) {
  if (replay.rate > 0) {
    online_.emplace(plan, localizer, replay.online);
  } else {
    offline_.emplace(plan, localizer);
  }
}

Expected<ReplayResults> Replayer::Run(const runtime::Recording& recording, Console& console, InterruptGuard& interrupt) {
  Collector collector(plan_, recording.size(), online_.has_value(), console, interrupt, [this] { RequestUpdate(); });
  const auto sink = [&](const runtime::ReplayedScan& scan) { return collector.Add(scan); };
  if (offline_) {
    runtime::ReplayOffline(recording, replay_, *offline_, sink);
  } else {
    runtime::ReplayPaced(recording, replay_, *online_, sink);
    drained_ = &online_->Drain();
  }
  Expected<ReplayResults> results = collector.Take();
  if (results && online_) AddGraphSide(*results);
  return results;
}

void Replayer::RequestUpdate() { offline_ ? offline_->RequestUpdate() : online_->RequestUpdate(); }

void Replayer::AddGraphSide(ReplayResults& results) {
  for (runtime::OnlineLocalizer::StampedTime& t : online_->TakeGraphTimes()) {
    results.timing.push_back({t.stamp_s, std::move(t.time.stage), t.time.ms});
  }
  std::stable_sort(results.timing.begin(), results.timing.end(),
                   [](const TimingRow& a, const TimingRow& b) { return a.stamp_s < b.stamp_s; });
  const runtime::OnlineCounts counts = online_->counts();
  results.pace->rate = replay_.rate;
  results.pace->held_solves = counts.held_solves;
  results.pace->unmapped_scans = counts.unmapped_scans;
}

}  // namespace plumb::tools
