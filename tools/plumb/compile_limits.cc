#include "tools/plumb/compile_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "tools/plumb/command.h"

namespace plumb::tools {
namespace {

constexpr double kSeconds = 55, kBytes = 2e9, kPlanBytes = 50e6;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;  // their shadow memory counts as data
#else
constexpr bool kLimitMemory = true;
#endif

// How much larger than a plan of kPlanBytes.
double Factor(const std::string& plan_path) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(plan_path, error);
  return error ? 1.0 : std::max(1.0, static_cast<double>(bytes) / kPlanBytes);
}

// The soft limit; returns the one before.
rlim_t SetDataLimit(rlim_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  const rlim_t previous = limit.rlim_cur;
  limit.rlim_cur = std::min(bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
  return previous;
}

}  // namespace

CompileLimits::CompileLimits(const std::string& plan_path) {
  const double factor = Factor(plan_path);
  const std::chrono::duration<double> time(kSeconds * factor);
  watch_ = std::thread([this, time, plan_path] {
    std::unique_lock lock(mutex_);
    if (done_changed_.wait_for(lock, time, [this] { return done_; })) return;
    fmt::print(stderr, "error: `{}` takes more than {:.0f} s to compile; at most that is given to a plan of its size\n", plan_path,
               time.count());
    std::_Exit(static_cast<int>(Status::kBadInput));
  });
  if (kLimitMemory) previous_data_limit_ = SetDataLimit(static_cast<rlim_t>(kBytes * factor));
}

CompileLimits::~CompileLimits() {
  if (kLimitMemory) SetDataLimit(previous_data_limit_);
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  done_changed_.notify_all();
  watch_.join();
}

}  // namespace plumb::tools
