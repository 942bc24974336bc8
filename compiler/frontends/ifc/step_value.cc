#include "compiler/frontends/ifc/step_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "compiler/frontends/ifc/step_text.h"

namespace plumb::compiler {
namespace {

bool IsSpace(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\f' || c == '\v'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }
bool IsNumberPart(char c) { return IsDigit(c) || c == '.' || c == 'E' || c == 'e' || c == '-' || c == '+'; }

const char* Find(const char* p, const char* end, char c) {
  return p < end ? static_cast<const char*>(std::memchr(p, c, static_cast<size_t>(end - p))) : nullptr;
}

// p at the opening quote; returns behind the closing one.
const char* SkipString(const char* p, const char* end) {
  ++p;
  while (true) {
    p = Find(p, end, '\'');
    if (p == nullptr) return end;
    ++p;
    if (p == end || *p != '\'') return p;
    ++p;
  }
}

std::string_view NumberText(const char* p, const char* end) {
  if (p != end && *p == '+') ++p;  // from_chars takes no plus
  const char* last = p;
  while (last != end && IsNumberPart(*last)) ++last;
  return {p, static_cast<size_t>(last - p)};
}

// The whole of `number`; infinite beyond the range of double. None: it is no number, or goes on behind as 1.#IND does.
std::optional<double> ParseReal(std::string_view number, const char* end) {
  const char* last = number.data() + number.size();
  if (last != end && *last == '#') return std::nullopt;
  double value = 0;
  const auto result = std::from_chars(number.data(), last, value);
  if (result.ptr != last || result.ec == std::errc::invalid_argument) return std::nullopt;
  // Out of range: too small is zero, too large is infinite; from_chars does not tell which.
  if (result.ec == std::errc::result_out_of_range) return std::strtod(std::string(number).c_str(), nullptr);
  return value;
}

// A number as nearly all are written, in one pass. None: look closer.
std::optional<double> PlainReal(const char* p, const char* end) {
  if (p == nullptr || p == end || !(IsDigit(*p) || *p == '-')) return std::nullopt;
  double value = 0;
  const auto result = std::from_chars(p, end, value);
  const bool ends = result.ptr != end && (*result.ptr == ',' || *result.ptr == ')');
  return result.ec == std::errc() && ends && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// NAN, -INF, 1.#IND as programs write them.
bool NamesNoNumber(const char* p, const char* end) {
  if (p == nullptr) return false;
  if (p != end && (*p == '-' || *p == '+')) ++p;
  const auto starts_with = [&](std::string_view lower) {
    return static_cast<size_t>(end - p) >= lower.size() &&
           std::equal(lower.begin(), lower.end(), p, [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
  };
  return starts_with("nan") || starts_with("inf") || starts_with("1.#");
}

}  // namespace

const char* SkipStepSpace(const char* p, const char* end) {
  while (p != end) {
    if (IsSpace(*p)) {
      ++p;
    } else if (*p == '/' && end - p >= 2 && p[1] == '*') {
      p += 2;
      while (true) {
        p = Find(p, end, '*');
        if (p == nullptr) return end;
        ++p;
        if (p != end && *p == '/') break;
      }
      ++p;
    } else {
      return p;
    }
  }
  return p;
}

const char* SkipStepValue(const char* p, const char* end) {
  size_t depth = 0;
  while (p != end) {
    switch (*p) {
      case '\'': p = SkipString(p, end); continue;
      case '/': {
        const char* next = SkipStepSpace(p, end);
        p = next == p ? p + 1 : next;
        continue;
      }
      case '(': ++depth; break;
      case ')':
        if (depth == 0) return p;
        --depth;
        break;
      case ',':
        if (depth == 0) return p;
        break;
      case ';': return p;
      default: break;
    }
    ++p;
  }
  return p;
}

StepValue::Kind StepValue::kind() const {
  if (begin_ == nullptr || begin_ == end_) return Kind::kNone;
  const char c = *begin_;
  switch (c) {
    case '$': return Kind::kNull;
    case '*': return Kind::kDerived;
    case '#': return Kind::kReference;
    case '\'': return Kind::kString;
    case '(': return Kind::kList;
    case '"': return Kind::kBinary;
    default: break;
  }
  if (c == '.') return begin_ + 1 != end_ && IsDigit(begin_[1]) ? Kind::kReal : Kind::kEnumeration;
  if (IsLetter(c)) return Kind::kTyped;
  if (IsDigit(c) || c == '-' || c == '+') {
    const std::string_view number = NumberText(begin_, end_);
    return number.find_first_of(".Ee") == std::string_view::npos ? Kind::kInteger : Kind::kReal;
  }
  return Kind::kBad;
}

std::optional<double> StepValue::Real() const {
  if (const std::optional<double> number = PlainReal(begin_, end_)) return number;
  const Kind k = kind();
  if (k == Kind::kTyped) {
    const StepValue inner = Inner();
    return inner.kind() == Kind::kTyped ? std::nullopt : inner.Real();
  }
  if (k != Kind::kReal && k != Kind::kInteger) return std::nullopt;
  const std::optional<double> value = ParseReal(NumberText(begin_, end_), end_);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

bool StepValue::IsNotFinite() const {
  const StepValue value = NamesNoNumber(begin_, end_) ? *this : Inner();
  if (NamesNoNumber(value.begin_, value.end_)) return true;
  const Kind k = value.kind();
  if (k != Kind::kReal && k != Kind::kInteger) return false;
  const std::optional<double> number = ParseReal(NumberText(value.begin_, end_), end_);
  return number && !std::isfinite(*number);
}

std::optional<int64_t> StepValue::Integer() const {
  const Kind k = kind();
  if (k == Kind::kTyped) {
    const StepValue inner = Inner();
    return inner.kind() == Kind::kTyped ? std::nullopt : inner.Integer();
  }
  if (k != Kind::kInteger) return std::nullopt;
  const std::string_view number = NumberText(begin_, end_);
  int64_t value = 0;
  const auto result = std::from_chars(number.data(), number.data() + number.size(), value);
  if (result.ec != std::errc() || result.ptr != number.data() + number.size()) return std::nullopt;
  return value;
}

std::optional<uint64_t> StepValue::Reference() const {
  if (kind() != Kind::kReference) return std::nullopt;
  uint64_t value = 0;
  const auto result = std::from_chars(begin_ + 1, end_, value);
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

std::string_view StepValue::Enumeration() const {
  if (kind() != Kind::kEnumeration) return {};
  const char* p = begin_ + 1;
  while (p != end_ && (IsLetter(*p) || IsDigit(*p))) ++p;
  if (p == end_ || *p != '.') return {};
  return {begin_ + 1, static_cast<size_t>(p - begin_ - 1)};
}

std::optional<bool> StepValue::Boolean() const {
  const StepValue value = Inner();
  const std::string_view name = value.Enumeration();
  if (name == "T" || name == "TRUE") return true;
  if (name == "F" || name == "FALSE") return false;
  return std::nullopt;
}

std::string StepValue::Text() const {
  const StepValue value = Inner();
  if (value.kind() != Kind::kString) return {};
  const char* close = SkipString(value.begin_, value.end_);
  const char* first = value.begin_ + 1;
  if (close - first < 1 || close[-1] != '\'') return {};  // the text ends inside the string
  return DecodeStepString({first, static_cast<size_t>(close - first - 1)});
}

std::string_view StepValue::TypeName() const {
  if (kind() != Kind::kTyped) return {};
  const char* p = begin_;
  while (p != end_ && (IsLetter(*p) || IsDigit(*p))) ++p;
  return {begin_, static_cast<size_t>(p - begin_)};
}

StepValue StepValue::Inner() const {
  if (kind() != Kind::kTyped) return *this;
  const char* open = SkipStepSpace(begin_ + TypeName().size(), end_);
  if (open == end_ || *open != '(') return {};
  const StepItems items(open, end_);
  return items.empty() ? StepValue() : *items.begin();
}

StepItems StepValue::Items() const { return kind() == Kind::kList ? StepItems(begin_, end_) : StepItems(); }

StepItems::StepItems(const char* open, const char* end) : end_(end) {
  const char* p = SkipStepSpace(open + 1, end);
  first_ = p == end || *p == ')' || *p == ';' ? nullptr : p;
}

StepItems::Iterator& StepItems::Iterator::operator++() {
  p_ = SkipStepValue(p_, end_);
  if (p_ != end_ && *p_ == ',') {
    p_ = SkipStepSpace(p_ + 1, end_);
    if (p_ == end_) p_ = nullptr;
  } else {
    p_ = nullptr;
  }
  return *this;
}

StepArguments::StepArguments(const char* open, const char* end) : open_(open), end_(end) {
  if (StepItems(open, end).empty()) return;
  offsets_[known_++] = static_cast<uint32_t>(SkipStepSpace(open + 1, end) - open);
  is_complete_ = false;
}

bool StepArguments::Reach(size_t i) const {
  while (i >= known_ && !is_complete_) {
    const char* p = SkipStepValue(open_ + offsets_[known_ - 1], end_);
    p = p != end_ && *p == ',' ? SkipStepSpace(p + 1, end_) : end_;
    is_complete_ = p == end_ || known_ == kMax;
    if (!is_complete_) offsets_[known_++] = static_cast<uint32_t>(p - open_);
  }
  return i < known_;
}

size_t StepArguments::size() const {
  (void)Reach(kMax);
  return known_;
}

}  // namespace plumb::compiler
