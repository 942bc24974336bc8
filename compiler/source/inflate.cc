#include "compiler/source/inflate.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace plumb::compiler {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS, kRawDeflate = -MAX_WBITS;

Error Damaged(size_t unpacked) {
  return {ErrorCode::kFileUnreadable, fmt::format("the compressed data are damaged after {} unpacked bytes", unpacked)};
}

Error TooLarge(size_t max_bytes) { return {ErrorCode::kFileTooLarge, fmt::format("unpacks to more than {} bytes, the limit", max_bytes)}; }

// One deflate stream, or all members of a gzip file.
Expected<std::string> Inflate(std::string_view packed, int window_bits, size_t max_bytes) {
  std::string out;
  z_stream stream{};
  if (inflateInit2(&stream, window_bits) != Z_OK) return tl::unexpected(Damaged(0));
  size_t fed = 0;
  std::string chunk(size_t{1} << 18, '\0');
  std::optional<Error> problem;
  while (true) {
    if (stream.avail_in == 0 && fed < packed.size()) {
      const size_t n = std::min<size_t>(packed.size() - fed, std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + fed));  // zlib's interface lacks the const
      stream.avail_in = static_cast<uInt>(n);
      fed += n;
    }
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    const int result = inflate(&stream, Z_NO_FLUSH);
    const size_t produced = chunk.size() - stream.avail_out;
    if (produced > max_bytes - out.size()) {
      problem = TooLarge(max_bytes);
      break;
    }
    out.append(chunk, 0, produced);
    if (result == Z_STREAM_END) {
      const bool more = window_bits == kGzipOnly && (stream.avail_in > 0 || fed < packed.size());
      if (!more) break;
      if (stream.avail_in > 0 && *stream.next_in != 0x1f) break;  // padding after the last member
      if (inflateReset(&stream) != Z_OK) problem = Damaged(out.size());
    } else if (result != Z_OK) {
      problem = Damaged(out.size());  // Z_BUF_ERROR too: the input ended inside a member
    }
    if (problem) break;
  }
  inflateEnd(&stream);
  if (problem) return tl::unexpected(std::move(*problem));
  return out;
}

// Little-endian numbers of an archive; zero beyond its end.
class ArchiveBytes {
 public:
  explicit ArchiveBytes(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] size_t size() const { return bytes_.size(); }
  [[nodiscard]] uint32_t U16(size_t at) const { return Byte(at) | Byte(at + 1) << 8; }
  [[nodiscard]] uint32_t U32(size_t at) const { return U16(at) | U16(at + 2) << 16; }
  [[nodiscard]] std::string_view Part(size_t at, size_t size) const {
    return at <= bytes_.size() && size <= bytes_.size() - at ? bytes_.substr(at, size) : std::string_view();
  }

 private:
  [[nodiscard]] uint32_t Byte(size_t at) const { return at < bytes_.size() ? static_cast<unsigned char>(bytes_[at]) : 0u; }
  std::string_view bytes_;
};

struct Entry {
  std::string_view name;
  uint32_t method = 0, crc = 0;
  size_t packed_size = 0, local_header = 0;
  bool is_encrypted = false;
};

constexpr uint32_t kEndOfDirectory = 0x06054b50, kDirectoryEntry = 0x02014b50, kLocalHeader = 0x04034b50;

// The central directory, found from the archive's end: only it knows the sizes of entries that were written in one go.
std::vector<Entry> ReadDirectory(const ArchiveBytes& zip) {
  constexpr size_t kEndSize = 22, kMaxComment = 65535, kHeaderSize = 46;
  std::vector<Entry> entries;
  if (zip.size() < kEndSize) return entries;
  size_t end = zip.size() - kEndSize;
  const size_t last = end > kMaxComment ? end - kMaxComment : 0;
  while (zip.U32(end) != kEndOfDirectory) {
    if (end == last) return entries;
    --end;
  }
  size_t at = zip.U32(end + 16);
  for (uint32_t i = 0; i < zip.U16(end + 10) && zip.U32(at) == kDirectoryEntry; ++i) {
    Entry entry;
    entry.is_encrypted = (zip.U16(at + 8) & 1u) != 0;
    entry.method = zip.U16(at + 10);
    entry.crc = zip.U32(at + 16);
    entry.packed_size = zip.U32(at + 20);
    entry.local_header = zip.U32(at + 42);
    const size_t name_size = zip.U16(at + 28);
    entry.name = zip.Part(at + kHeaderSize, name_size);
    if (!entry.name.empty() && entry.name.back() != '/') entries.push_back(entry);
    at += kHeaderSize + name_size + zip.U16(at + 30) + zip.U16(at + 32);
  }
  return entries;
}

// By its extension; what archivers leave beside a file (`__MACOSX/._plan.dxf`) is none.
bool IsPlanName(std::string_view name) {
  constexpr std::array<std::string_view, 12> kExtensions = {".ifc", ".dxf", ".svg",  ".obj", ".ply", ".stl",
                                                            ".gltf", ".glb", ".dae", ".sdf", ".world", ".dwg"};
  std::string lower(name.substr(name.find_last_of('/') + 1));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return !lower.starts_with('.') && std::any_of(kExtensions.begin(), kExtensions.end(), [&](auto end) { return lower.ends_with(end); });
}

// Names in an archive are of any bytes.
std::string Printable(std::string_view name) {
  std::string out(name.substr(0, 200));
  std::replace_if(out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

Expected<std::string> Extract(const ArchiveBytes& zip, const Entry& entry, size_t max_bytes) {
  constexpr uint32_t kStored = 0, kDeflated = 8;
  constexpr size_t kLocalSize = 30;
  if (entry.is_encrypted || (entry.method != kStored && entry.method != kDeflated)) {
    return Fail(ErrorCode::kFileUnreadable,
                fmt::format("its entry `{}` is encrypted or packed by method {}; stored and deflated ones are read", Printable(entry.name),
                            entry.method));
  }
  const size_t data = entry.local_header + kLocalSize + zip.U16(entry.local_header + 26) + zip.U16(entry.local_header + 28);
  const std::string_view packed = zip.Part(data, entry.packed_size);
  if (zip.U32(entry.local_header) != kLocalHeader || packed.empty()) {
    return Fail(ErrorCode::kFileUnreadable,
                fmt::format("its directory leads to no data for `{}`: it is cut off or damaged", Printable(entry.name)));
  }
  if (entry.method == kStored && packed.size() > max_bytes) return tl::unexpected(TooLarge(max_bytes));
  Expected<std::string> out = entry.method == kStored ? Expected<std::string>(packed) : Inflate(packed, kRawDeflate, max_bytes);
  if (out && crc32_z(0, reinterpret_cast<const Bytef*>(out->data()), out->size()) != entry.crc) return tl::unexpected(Damaged(out->size()));
  return out;
}

}  // namespace

bool IsGzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

bool IsZip(std::string_view bytes) { return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06"); }

Expected<std::string> InflateGzip(std::string_view packed, size_t max_bytes) { return Inflate(packed, kGzipOnly, max_bytes); }

Expected<std::string> UnpackPlan(std::string_view archive, size_t max_bytes) {
  const ArchiveBytes zip(archive);
  const std::vector<Entry> entries = ReadDirectory(zip);
  if (entries.empty())
    return Fail(ErrorCode::kFileUnreadable, "the archive has no directory or nothing in it: it is cut off, damaged or empty");
  if (entries.size() == 1) return Extract(zip, entries[0], max_bytes);
  const auto is_plan = [](const Entry& entry) { return IsPlanName(entry.name); };
  const auto plans = std::count_if(entries.begin(), entries.end(), is_plan);
  if (plans != 1)
    return Fail(ErrorCode::kFileUnreadable,
                fmt::format("the archive has {} files, {} of them plans; it must have one plan: take it out and give that", entries.size(),
                            plans == 0 ? "none" : fmt::to_string(plans)));
  return Extract(zip, *std::find_if(entries.begin(), entries.end(), is_plan), max_bytes);
}

}  // namespace plumb::compiler
