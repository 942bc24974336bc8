// Ctrl-C while a long job runs: it ends early and writes what it has. A second one ends the program at once.
#pragma once

namespace plumb::tools {

// While one lives, SIGINT and SIGTERM only set a flag. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] bool requested() const;
};

}  // namespace plumb::tools
