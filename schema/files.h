// Whole-file reading and writing shared by all libraries.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schema/error.h"

namespace plumb {

// Errors: kFileNotFound, kFileUnreadable, kFileTooLarge (above max_bytes).
[[nodiscard]] Expected<std::vector<uint8_t>> ReadFileBytes(const std::string& path, size_t max_bytes = size_t{4} << 30);
[[nodiscard]] Expected<std::string> ReadFileText(const std::string& path, size_t max_bytes = size_t{4} << 30);

// Writes to a temporary file in the same folder, then renames it over `path` (over what it leads to, if it is a link); devices, pipes and open files
// (/dev/stdout) are written to as they are.
// Errors: kFileUnwritable.
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes);
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::string_view text);

}  // namespace plumb
