// LZF decompression (the codec of binary_compressed PCD files), safe on hostile input.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumb::runtime {

// The decompressed bytes, exactly `size` of them; none if the stream is damaged or of another length. O(size).
// Allocates only if `size` is reachable: three bytes of LZF expand to at most 264.
[[nodiscard]] std::optional<std::vector<uint8_t>> DecompressLzf(std::span<const uint8_t> in, size_t size);

}  // namespace plumb::runtime
