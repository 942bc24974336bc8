// Decoding of strings in STEP physical files (ISO 10303-21, 6.4.3) to UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace plumb::compiler {

// `raw` is what stands between the outer quotes. Handles '' and \\, \S\, \P?\, \X\, \X2\ and \X4\. Bytes above 127, which the standard
// forbids and programs write all the same, are kept if the string is valid UTF-8 and read as ISO 8859-1 otherwise.
// A directive that is cut off or malformed is kept as it stands. The result is always valid UTF-8.
[[nodiscard]] std::string DecodeStepString(std::string_view raw);

}  // namespace plumb::compiler
