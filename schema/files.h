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

// A file's bytes in memory, of which only those asked for have been read; the others are zero and take no memory. What is done to the file
// meanwhile can change what is still to be read, nothing else.
class SparseFile {
 public:
  // Errors as ReadFileBytes, but kFileTooLarge.
  [[nodiscard]] static Expected<SparseFile> Open(const std::string& path);

  SparseFile() = default;
  SparseFile(SparseFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)), bytes_(std::exchange(other.bytes_, {})) {}
  SparseFile& operator=(SparseFile&& other) noexcept {
    std::swap(fd_, other.fd_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~SparseFile();

  // As long as the file was when it was opened.
  [[nodiscard]] std::span<const uint8_t> bytes() const { return bytes_; }

  // Reads what lies `from` that place on into bytes(). False: it cannot be read, or the file has become shorter.
  [[nodiscard]] bool Read(size_t from, size_t size);
  // The same to somewhere else.
  [[nodiscard]] bool ReadTo(std::span<uint8_t> out, size_t from) const;

 private:
  int fd_ = -1;
  std::span<uint8_t> bytes_;
};

// Writes to a temporary file in the same folder, then renames it over `path` (over what it leads to, if it is a link); devices, pipes and
// open files
// (/dev/stdout) are written to as they are.
// Errors: kFileUnwritable.
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes);
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::string_view text);
// The same of what stands in pieces, one after the other.
[[nodiscard]] Expected<void> WriteFileAtomically(const std::string& path, std::span<const std::span<const uint8_t>> pieces);

}  // namespace plumb
