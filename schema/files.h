// Whole-file reading and writing shared by all libraries.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "schema/error.h"

namespace plumb {

// Errors: kFileNotFound, kFileUnreadable, kFileTooLarge (above max_bytes).
[[nodiscard]] Expected<std::vector<uint8_t>> ReadFileBytes(const std::string& path, size_t max_bytes = size_t{4} << 30);
[[nodiscard]] Expected<std::string> ReadFileText(const std::string& path, size_t max_bytes = size_t{4} << 30);

// A whole file as read-only memory that is filled when it is touched. Bytes past an end that the file loses meanwhile end the process
// (SIGBUS), so it is for files that are replaced, not written to.
class MappedFile {
 public:
  // Errors as ReadFileBytes, but kFileTooLarge.
  [[nodiscard]] static Expected<MappedFile> Open(const std::string& path);

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedFile& operator=(MappedFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MappedFile();

  [[nodiscard]] std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  std::span<uint8_t> bytes_;
};

// Writes to a temporary file in the same folder, then renames it over `path` (over what it leads to, if it is a link); devices, pipes and open files
// (/dev/stdout) are written to as they are.
// Errors: kFileUnwritable.
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes);
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::string_view text);
// The same of what stands in pieces, one after the other.
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::span<const std::span<const uint8_t>> pieces);

}  // namespace plumb
