// Time between two moments, for reports only: nothing may depend on it.
#pragma once

#include <chrono>

namespace plumb::runtime {

// Milliseconds since construction or the last call of Lap.
class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace plumb::runtime
