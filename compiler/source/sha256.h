// SHA-256 (FIPS 180-4) of a byte string: the A-Graph names by it the plan that it was made from.
#pragma once

#include <string>
#include <string_view>

namespace plumb::compiler {

// 64 lower-case hexadecimal digits.
[[nodiscard]] std::string Sha256Hex(std::string_view bytes);

}  // namespace plumb::compiler
