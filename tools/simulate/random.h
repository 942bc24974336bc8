// Random numbers that are the same with every compiler and library (std distributions are not). SplitMix64.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace plumb::tools {

class Random {
 public:
  // Streams of one seed are independent of each other.
  explicit Random(uint64_t seed, uint64_t stream = 0) : state_(seed * 0x9e3779b97f4a7c15u + stream * 0xd1b54a32d192ed03u) {
    state_ = Next() ^ (Next() << 1);
  }

  [[nodiscard]] uint64_t Next() {
    state_ += 0x9e3779b97f4a7c15u;
    uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // In [0, 1).
  [[nodiscard]] double Uniform() { return static_cast<double>(Next() >> 11) * 0x1p-53; }
  [[nodiscard]] double Uniform(double min, double max) { return min + (max - min) * Uniform(); }
  // In [0, size); size > 0.
  [[nodiscard]] size_t Index(size_t size) { return static_cast<size_t>(Next() % size); }
  [[nodiscard]] double Sign() { return (Next() >> 63) != 0 ? 1.0 : -1.0; }

  // Zero mean, unit variance (Box and Muller, both values used).
  [[nodiscard]] double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(1 - Uniform())), angle = 2 * std::numbers::pi * Uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

  template <class T>
  void Shuffle(std::vector<T>& items) {
    for (size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[Index(i)]);
  }

 private:
  uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

// One stream for each purpose: another option for one stage must not change what the others draw.
enum class RandomStream : uint64_t { kDeviations = 1, kClutter, kTour, kWobble, kOdometry, kMissing, kUnplanned, kDoorways, kSweeps = 1000 };

}  // namespace plumb::tools
