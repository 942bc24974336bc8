// Bounds of time and memory while a plan is compiled: plans come from anywhere, and some make any compiler work for hours.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace plumb::tools {

// In force from construction to destruction. For a plan of under 50 MB: 55 s, after which an error goes to standard error and the process
// ends with the exit status of bad input, and 2 GB of data, beyond which allocations fail (std::bad_alloc; not in builds with sanitizers).
// In proportion for larger ones. Nothing may be half written meanwhile.
class CompileLimits {
 public:
  explicit CompileLimits(const std::string& plan_path);
  ~CompileLimits();
  CompileLimits(const CompileLimits&) = delete;
  CompileLimits& operator=(const CompileLimits&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable done_changed_;
  bool done_ = false;
  unsigned long previous_data_limit_ = 0;
  std::thread watch_;
};

}  // namespace plumb::tools
