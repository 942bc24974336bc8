#include "runtime/sources/lzf.h"

namespace plumb::runtime {

std::optional<std::vector<uint8_t>> DecompressLzf(std::span<const uint8_t> in, size_t size) {
  constexpr size_t kMaxExpansion = 264 / 3;
  if (size > in.size() * kMaxExpansion) return std::nullopt;
  std::vector<uint8_t> out;
  out.reserve(size);
  size_t at = 0;
  while (at < in.size()) {
    const uint8_t control = in[at++];
    if (control < 32) {  // control + 1 literal bytes
      const size_t count = control + size_t{1};
      if (count > in.size() - at || count > size - out.size()) return std::nullopt;
      out.insert(out.end(), in.begin() + static_cast<ptrdiff_t>(at), in.begin() + static_cast<ptrdiff_t>(at + count));
      at += count;
      continue;
    }
    // LLLddddd [llllllll] dddddddd: copy L (+ l if L is 7) + 2 bytes from d + 1 bytes back; the ranges may overlap.
    size_t count = control >> 5;
    if (count == 7) {
      if (at >= in.size()) return std::nullopt;
      count += in[at++];
    }
    count += 2;
    if (at >= in.size()) return std::nullopt;
    const size_t back = (static_cast<size_t>(control & 31) << 8) + in[at++] + 1;
    if (back > out.size() || count > size - out.size()) return std::nullopt;
    for (size_t i = 0; i < count; ++i) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace plumb::runtime
