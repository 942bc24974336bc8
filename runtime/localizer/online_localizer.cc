#include "runtime/localizer/online_localizer.h"

#include <utility>

namespace plumb::runtime {

std::string OnlineOptions::Check() const {
  if (hold_solves_behind < 1) return "OnlineOptions.hold_solves_behind = " + std::to_string(hold_solves_behind) + "; must be >= 1";
  if (max_scans_behind < hold_solves_behind) {
    return "OnlineOptions.max_scans_behind = " + std::to_string(max_scans_behind) + "; must be >= hold_solves_behind";
  }
  return {};
}

OnlineLocalizer::OnlineLocalizer(const AGraph& plan, const LocalizerOptions& options, const OnlineOptions& online)
    : options_(online),
      localizer_(plan, options),
      queue_(static_cast<size_t>(online.max_scans_behind)),
      graph_thread_([this] { RunGraph(); }) {}

OnlineLocalizer::~OnlineLocalizer() {
  {
    const std::lock_guard lock(mutex_);
    dropping_ = true;
  }
  queue_.Close();
  if (graph_thread_.joinable()) graph_thread_.join();
}

ScanVerdict OnlineLocalizer::AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given) {
  RegisteredScan registered = localizer_.Register(scan, given);
  GraphState state;
  {
    const std::lock_guard lock(mutex_);
    state = state_;
  }
  ScanVerdict verdict = localizer_.Track(registered, state);
  waiting_.push_back(std::move(registered));
  if (queue_.TryPush(waiting_)) {
    waiting_.clear();
    return verdict;
  }
  if (waiting_.back().has_points) {
    const std::lock_guard lock(mutex_);
    ++counts_.unmapped_scans;
  }
  waiting_.back().Strip();
  return verdict;
}

Localizer& OnlineLocalizer::Drain() {
  if (!waiting_.empty()) queue_.Push(std::exchange(waiting_, {}));
  queue_.Close();
  if (graph_thread_.joinable()) graph_thread_.join();
  failure_.Rethrow();
  return localizer_;
}

OnlineCounts OnlineLocalizer::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::vector<OnlineLocalizer::StampedTime> OnlineLocalizer::TakeGraphTimes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(graph_times_, {});
}

void OnlineLocalizer::RunGraph() {
  if (!failure_.Guard([this] { TakeInScans(); })) queue_.Close();
}

void OnlineLocalizer::TakeInScans() {
  while (const auto scans = queue_.Pop()) {
    for (const RegisteredScan& scan : *scans) {
      const bool behind = queue_.size() >= static_cast<size_t>(options_.hold_solves_behind);
      GraphState state = localizer_.UpdateGraph(scan, behind);
      const std::lock_guard lock(mutex_);
      if (dropping_) return;
      counts_.held_solves += state.solve_held;
      for (StageTime& time : state.timing) graph_times_.push_back({scan.stamp_s, std::move(time)});
      state.timing.clear();
      state_ = std::move(state);
    }
  }
}

}  // namespace plumb::runtime
