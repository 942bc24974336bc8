// Counts in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plumb {

// "1 storey", "2 storeys", "0 storeys": for nouns whose plural is made with an s.
[[nodiscard]] inline std::string Counted(size_t n, std::string_view noun) {
  return std::to_string(n).append(" ").append(noun).append(n == 1 ? "" : "s");
}

}  // namespace plumb
