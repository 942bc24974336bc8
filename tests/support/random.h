// Random numbers that are the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace plumb::test {

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double Uniform(double from, double to) { return from + (to - from) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53); }
  double Normal(double sigma) {
    const double u = 1 - Uniform(0, 1), v = Uniform(0, 1);
    return sigma * std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace plumb::test
