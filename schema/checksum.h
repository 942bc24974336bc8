// A checksum against damage, not against forgery.
#pragma once

#include <cstdint>
#include <span>

namespace plumb {

// 64 bits over the bytes of all `pieces`, one after the other, and their sizes; `seed` is a number that they belong to. A change that stays
// within 8 bytes counted from a piece's start is found for certain, others but for a chance of 2^-64. Memory speed.
[[nodiscard]] uint64_t Checksum(std::span<const std::span<const uint8_t>> pieces, uint64_t seed);

}  // namespace plumb
