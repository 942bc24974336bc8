// A checksum against damage, not against forgery.
#pragma once

#include <cstdint>
#include <span>

namespace plumb {

// 64 bits over `bytes`, of which the 8 from `hole` on count as zero: there the checksum itself stands. `hole` is a multiple of 8 and lies
// within. Any change that stays within one aligned word of 8 bytes is found for certain, others but for a chance of 2^-64. Memory speed.
[[nodiscard]] uint64_t ChecksumAround(std::span<const uint8_t> bytes, size_t hole);

}  // namespace plumb
