#include "compiler/frontends/dxf/dxf_groups.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

namespace plumb::compiler {
namespace {

constexpr std::string_view kBinaryMark("AutoCAD Binary DXF\r\n\x1a\0", 22);

enum class ValueType { kText, kDouble, kInt16, kInt32, kInt64, kBool, kBytes };

// By the ranges that the format's reference lays down.
ValueType TypeOf(int code) {
  if (code < 10 || (code >= 100 && code < 110) || (code >= 300 && code < 310) || (code >= 320 && code < 370)) return ValueType::kText;
  if (code < 60 || (code >= 110 && code < 150) || (code >= 210 && code < 240) || (code >= 460 && code < 470)) return ValueType::kDouble;
  if (code < 80 || (code >= 170 && code < 180) || (code >= 270 && code < 290) || (code >= 370 && code < 390) || (code >= 400 && code < 410)) return ValueType::kInt16;
  if ((code >= 90 && code < 100) || (code >= 420 && code < 430) || (code >= 440 && code < 460)) return ValueType::kInt32;
  if (code >= 160 && code < 170) return ValueType::kInt64;
  if (code >= 290 && code < 300) return ValueType::kBool;
  if (code >= 310 && code < 320) return ValueType::kBytes;
  if (code == 1004) return ValueType::kBytes;
  if (code >= 1010 && code < 1060) return ValueType::kDouble;
  if (code >= 1060 && code < 1071) return ValueType::kInt16;
  if (code == 1071) return ValueType::kInt32;
  return ValueType::kText;
}

template <class T>
T Read(std::string_view bytes) {
  T out;
  std::memcpy(&out, bytes.data(), sizeof out);
  return out;
}

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

}  // namespace

DxfGroups::DxfGroups(std::string_view bytes) : rest_(bytes) {
  if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  binary_ = rest_.starts_with(kBinaryMark);
  if (!binary_) return;
  rest_.remove_prefix(kBinaryMark.size());
  // Up to R12 a code is one byte: the first group is then 0 and the text SECTION without a zero between them.
  wide_codes_ = rest_.size() < 2 || rest_[1] == '\0';
}

bool DxfGroups::Next(DxfGroup& group) { return fault_.empty() && (binary_ ? NextBinary(group) : NextText(group)); }

std::string_view DxfGroups::TakeLine() {
  const size_t end = rest_.find_first_of("\r\n");
  const std::string_view out = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
  } else {
    const bool pair = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
    rest_.remove_prefix(end + (pair ? 2 : 1));
  }
  ++line_;
  return out;
}

bool DxfGroups::NextText(DxfGroup& group) {
  std::string_view code;
  while (code.empty()) {
    if (rest_.empty()) return false;
    code = Trimmed(TakeLine());
  }
  group.line = line_;
  const auto [end, error] = std::from_chars(code.data(), code.data() + code.size(), group.code);
  if (error != std::errc() || end != code.data() + code.size()) {
    fault_ = fmt::format("line {} is `{}`, no group code", line_, code.substr(0, 20));
    return false;
  }
  if (rest_.empty()) return false;  // cut off between a code and its value
  group.value = std::string(Trimmed(TakeLine()));
  return true;
}

bool DxfGroups::Take(size_t count, std::string_view& out) {
  if (rest_.size() < count) {
    rest_ = {};
    return false;
  }
  out = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return true;
}

bool DxfGroups::NextBinary(DxfGroup& group) {
  std::string_view bytes;
  if (rest_.empty() || !Take(wide_codes_ ? 2 : 1, bytes)) return false;
  group.code = wide_codes_ ? Read<int16_t>(bytes) : static_cast<unsigned char>(bytes[0]);
  if (!wide_codes_ && group.code == 255) {
    if (!Take(2, bytes)) return false;
    group.code = Read<int16_t>(bytes);
  }
  group.line = ++line_;
  switch (TypeOf(group.code)) {
    case ValueType::kText: {
      const size_t end = rest_.find('\0');
      if (end == std::string_view::npos) {
        rest_ = {};
        return false;
      }
      group.value = std::string(rest_.substr(0, end));
      rest_.remove_prefix(end + 1);
      return true;
    }
    case ValueType::kDouble:
      if (!Take(8, bytes)) return false;
      group.value = fmt::format("{}", Read<double>(bytes));
      return true;
    case ValueType::kInt16:
      if (!Take(2, bytes)) return false;
      group.value = fmt::format("{}", Read<int16_t>(bytes));
      return true;
    case ValueType::kInt32:
      if (!Take(4, bytes)) return false;
      group.value = fmt::format("{}", Read<int32_t>(bytes));
      return true;
    case ValueType::kInt64:
      if (!Take(8, bytes)) return false;
      group.value = fmt::format("{}", Read<int64_t>(bytes));
      return true;
    case ValueType::kBool:
      if (!Take(1, bytes)) return false;
      group.value = bytes[0] != 0 ? "1" : "0";
      return true;
    case ValueType::kBytes:
      if (!Take(1, bytes)) return false;
      group.value.clear();
      return Take(static_cast<unsigned char>(bytes[0]), bytes);
  }
  return false;
}

}  // namespace plumb::compiler
