// Signals while a long job runs. Ctrl-C: it ends early and writes what it has; a second one ends the program at once. SIGUSR1: it writes
// what it has and goes on.
#pragma once

namespace plumb::tools {

// While one lives, SIGINT, SIGTERM and SIGUSR1 only set a flag; before and after (main.cc) SIGUSR1 does nothing. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] bool requested() const;
  // SIGUSR1 since the last call.
  [[nodiscard]] bool TakeReportRequest();
};

}  // namespace plumb::tools
