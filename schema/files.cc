#include "schema/files.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace plumb {
namespace {

struct Descriptor {
  int fd = -1;
  explicit Descriptor(int its_fd = -1) : fd(its_fd) {}
  Descriptor(Descriptor&& other) noexcept : fd(std::exchange(other.fd, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd, other.fd);
    return *this;
  }
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

std::string Reason() { return std::strerror(errno); }

struct OpenedFile {
  Descriptor file;
  size_t size = 0;
};

Expected<OpenedFile> OpenForReading(const std::string& path) {
  OpenedFile out;
  out.file.fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (out.file.fd < 0) {
    const ErrorCode code = errno == ENOENT ? ErrorCode::kFileNotFound : ErrorCode::kFileUnreadable;
    return Fail(code, "cannot open `" + path + "`: " + Reason());
  }
  struct stat info {};
  if (::fstat(out.file.fd, &info) != 0 || S_ISDIR(info.st_mode)) return Fail(ErrorCode::kFileUnreadable, "`" + path + "` is no file");
  out.size = static_cast<size_t>(info.st_size);
  return out;
}

// Container: std::string or std::vector<uint8_t>.
template <class Container>
Expected<Container> ReadWhole(const std::string& path, size_t max_bytes) {
  Expected<OpenedFile> opened = OpenForReading(path);
  if (!opened) return tl::unexpected<Error>(opened.error());
  if (opened->size > max_bytes) {
    return Fail(ErrorCode::kFileTooLarge,
                "`" + path + "` has " + std::to_string(opened->size) + " bytes; at most " + std::to_string(max_bytes) + " are read");
  }
  Container bytes;
  bytes.resize(opened->size);
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(opened->file.fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return Fail(ErrorCode::kFileUnreadable, "cannot read `" + path + "`: " + Reason());
    if (n == 0) break;  // shorter than stat said: it was cut meanwhile
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

// A device, a pipe or an open file, as /dev/stdout: it can only be written to, not replaced.
bool IsSpecial(const std::string& path) {
  if (path.starts_with("/dev/") || path.starts_with("/proc/")) return true;
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

// The file that a chain of links leads to, so that the links stay.
std::string Target(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target.string();
}

// False: errno says why.
bool WriteAll(int fd, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
  return true;
}

}  // namespace

Expected<void> WriteFileAtomically(const std::string& given_path, std::span<const std::span<const uint8_t>> pieces) {
  const bool in_place = IsSpecial(given_path);
  const std::string path = in_place ? given_path : Target(given_path);
  const std::string temporary = in_place ? path : path + ".tmp" + std::to_string(::getpid());
  const auto fail = [&](const std::string& what) {
    const std::string reason = Reason();
    if (!in_place) ::unlink(temporary.c_str());
    return Fail(ErrorCode::kFileUnwritable, what + " `" + path + "`: " + reason);
  };
  {
    Descriptor file{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (file.fd < 0) return fail("cannot create");
    for (const auto piece : pieces) {
      if (!WriteAll(file.fd, piece)) return fail("cannot write");
    }
  }
  if (!in_place && ::rename(temporary.c_str(), path.c_str()) != 0) return fail("cannot rename onto");
  return {};
}

Expected<std::vector<uint8_t>> ReadFileBytes(const std::string& path, size_t max_bytes) {
  return ReadWhole<std::vector<uint8_t>>(path, max_bytes);
}

Expected<std::string> ReadFileText(const std::string& path, size_t max_bytes) { return ReadWhole<std::string>(path, max_bytes); }

Expected<SparseFile> SparseFile::Open(const std::string& path) {
  Expected<OpenedFile> opened = OpenForReading(path);
  if (!opened) return tl::unexpected<Error>(opened.error());
  SparseFile out;
  if (opened->size > 0) {
    void* at = ::mmap(nullptr, opened->size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) return Fail(ErrorCode::kFileUnreadable, "cannot read `" + path + "`: " + Reason());
    out.bytes_ = {static_cast<uint8_t*>(at), opened->size};
  }
  out.fd_ = std::exchange(opened->file.fd, -1);
  return out;
}

SparseFile::~SparseFile() {
  if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
  if (fd_ >= 0) ::close(fd_);
}

bool SparseFile::Read(size_t from, size_t size) {
  return from <= bytes_.size() && size <= bytes_.size() - from && ReadTo(bytes_.subspan(from, size), from);
}

bool SparseFile::ReadTo(std::span<uint8_t> out, size_t from) const {
  while (!out.empty()) {
    const ssize_t n = ::pread(fd_, out.data(), out.size(), static_cast<off_t>(from));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    out = out.subspan(static_cast<size_t>(n));
    from += static_cast<size_t>(n);
  }
  return true;
}

Expected<void> WriteFileAtomically(const std::string& path, std::span<const uint8_t> bytes) {
  return WriteFileAtomically(path, std::span(&bytes, 1));
}

Expected<void> WriteFileAtomically(const std::string& path, std::string_view text) {
  return WriteFileAtomically(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

}  // namespace plumb
