#include "runtime/sources/pcd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

namespace plumb::runtime {
namespace {

constexpr size_t kMaxHeaderLine = 4096;        // longer lines are no header
constexpr size_t kMaxPointSize = 65536;        // bytes
constexpr size_t kMaxPoints = size_t{1} << 31;

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r";
  size_t at = line.find_first_not_of(kBlank);
  while (at != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

std::optional<size_t> ToSize(std::string_view word) {
  size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool EqualIgnoringCase(std::string_view a, std::string_view b) {
  const auto equal = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

class HeaderParser {
 public:
  HeaderParser(std::span<const uint8_t> bytes, const std::string& path)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), path_(path) {}

  Expected<PcdHeader> Run() {
    bool have_data = false;
    while (!have_data && header_.data_at < text_.size()) {
      const std::string_view rest = text_.substr(header_.data_at);
      const size_t length = rest.substr(0, kMaxHeaderLine).find('\n');
      if (length == std::string_view::npos) return Bad("the header has a line without an end; it must close with `DATA ...`");
      header_.data_at += length + 1;
      const std::vector<std::string_view> words = Words(rest.substr(0, length));
      if (words.empty() || words[0][0] == '#') continue;
      if (std::string fault = TakeLine(words); !fault.empty()) return Bad(fault);
      have_data = words[0] == "DATA";
    }
    if (text_.empty()) return Bad("is empty");
    if (!have_data) return Bad("the header has no `DATA` line");
    if (std::string fault = Finish(); !fault.empty()) return Bad(fault);
    return std::move(header_);
  }

 private:
  tl::unexpected<Error> Bad(const std::string& why) const { return Fail(ErrorCode::kBadScan, fmt::format("`{}`: {}", path_, why)); }

  // Returns what is wrong with the line; empty if nothing.
  std::string TakeLine(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const size_t values = words.size() - 1;
    if (key == "FIELDS" || key == "COLUMNS") {
      header_.fields.resize(values);
      for (size_t i = 0; i < values; ++i) header_.fields[i].name = words[i + 1];
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      if (values != header_.fields.size()) return fmt::format("{} has {} entries for {} fields", key, values, header_.fields.size());
      for (size_t i = 0; i < values; ++i) {
        if (!TakeFieldValue(key, words[i + 1], header_.fields[i])) return fmt::format("{} has `{}`", key, words[i + 1]);
      }
      have_size_ |= key == "SIZE";
      have_type_ |= key == "TYPE";
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      const std::optional<size_t> value = values == 1 ? ToSize(words[1]) : std::nullopt;
      if (!value || *value > kMaxPoints) return fmt::format("{} must be one number up to {}", key, kMaxPoints);
      (key == "WIDTH" ? width_ : key == "HEIGHT" ? height_ : points_) = value;
    } else if (key == "DATA") {
      if (values != 1) return "DATA must be ascii, binary or binary_compressed";
      if (words[1] == "ascii") header_.storage = PcdStorage::kAscii;
      else if (words[1] == "binary") header_.storage = PcdStorage::kBinary;
      else if (words[1] == "binary_compressed") header_.storage = PcdStorage::kBinaryCompressed;
      else return fmt::format("DATA is `{}`; must be ascii, binary or binary_compressed", words[1]);
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      return "it does not begin with a PCD header";
    }
    return {};
  }

  static bool TakeFieldValue(std::string_view key, std::string_view word, PcdField& field) {
    if (key == "TYPE") {
      field.type = word[0];
      return word == "F" || word == "I" || word == "U";
    }
    const std::optional<size_t> value = ToSize(word);
    if (!value || *value > kMaxPointSize) return false;
    (key == "SIZE" ? field.size : field.count) = *value;
    return key == "COUNT" || *value == 1 || *value == 2 || *value == 4 || *value == 8;
  }

  std::string Finish() {
    if (header_.fields.empty() || !have_size_ || !have_type_) return "the header lacks FIELDS, SIZE or TYPE";
    for (PcdField& field : header_.fields) {
      if (field.type == 'F' && field.size < 4) return fmt::format("field {} has type F and {} bytes", field.name, field.size);
      field.offset = header_.point_size;
      field.column = header_.columns;
      header_.point_size += field.size * field.count;
      header_.columns += field.count;
      if (header_.point_size > kMaxPointSize) return fmt::format("a point has more than {} bytes", kMaxPointSize);
    }
    if (header_.point_size == 0) return "a point has no values";
    if (!points_ && !width_) return "the header lacks POINTS or WIDTH";
    const size_t area = width_.value_or(0) * height_.value_or(1);
    header_.points = points_.value_or(area);
    if (header_.points > kMaxPoints) return fmt::format("more than {} points", kMaxPoints);
    if (width_ && area != header_.points) return fmt::format("POINTS is {} but WIDTH x HEIGHT is {}", header_.points, area);
    return {};
  }

  std::string_view text_;
  const std::string& path_;
  PcdHeader header_;
  bool have_size_ = false, have_type_ = false;
  std::optional<size_t> width_, height_, points_;
};

}  // namespace

const PcdField* PcdHeader::Find(std::span<const std::string_view> names) const {
  for (const std::string_view name : names) {
    for (const PcdField& field : fields) {
      if (EqualIgnoringCase(field.name, name) && field.count == 1) return &field;
    }
  }
  return nullptr;
}

Expected<PcdHeader> ParsePcdHeader(std::span<const uint8_t> bytes, const std::string& path) { return HeaderParser(bytes, path).Run(); }

}  // namespace plumb::runtime
