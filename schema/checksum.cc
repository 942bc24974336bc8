#include "schema/checksum.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace plumb {
namespace {

constexpr size_t kWord = 8, kLanes = 4;
constexpr uint64_t kOdd = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio

// One to one in `state` and in `word`, so that no single change is lost.
uint64_t Mix(uint64_t state, uint64_t word) { return std::rotl((state ^ word) * kOdd, 29); }

// Little-endian on every machine; `size` up to 8.
uint64_t WordAt(const uint8_t* at, size_t size) {
  uint64_t word = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&word, at, size);
  } else {
    for (size_t i = 0; i < size; ++i) word |= uint64_t{at[i]} << (8 * i);
  }
  return word;
}

// Goes on from `state`. Four lanes, since each step waits for the one before.
uint64_t Continue(uint64_t state, std::span<const uint8_t> bytes) {
  std::array<uint64_t, kLanes> lanes = {state, 1, 2, 3};
  size_t at = 0;
  for (; at + kWord * kLanes <= bytes.size(); at += kWord * kLanes) {
    for (size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = Mix(lanes[lane], WordAt(bytes.data() + at + kWord * lane, kWord));
  }
  uint64_t out = lanes[0];
  for (size_t lane = 1; lane < kLanes; ++lane) out = Mix(out, lanes[lane]);
  for (; at < bytes.size(); at += kWord) out = Mix(out, WordAt(bytes.data() + at, std::min(kWord, bytes.size() - at)));
  return Mix(out, bytes.size());
}

}  // namespace

uint64_t Checksum(std::span<const std::span<const uint8_t>> pieces, uint64_t seed) {
  uint64_t out = seed;
  for (const auto piece : pieces) out = Continue(out, piece);
  return out;
}

}  // namespace plumb
