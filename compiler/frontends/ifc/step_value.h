// Values in the argument list of a STEP instance, read where they stand in the text: views, no allocation, parsed on demand.
// Robust on any bytes: a malformed value is of kind kBad, lists end where the text does, nesting costs no stack.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace plumb::compiler {

// Past white space and comments. Never beyond `end`.
[[nodiscard]] const char* SkipStepSpace(const char* p, const char* end);
// Past the value at `p`: to the `,` or `)` behind it, or to a `;` or `end` in broken text.
[[nodiscard]] const char* SkipStepValue(const char* p, const char* end);

class StepItems;

class StepValue {
 public:
  enum class Kind { kNone, kNull, kDerived, kInteger, kReal, kString, kEnumeration, kReference, kList, kTyped, kBinary, kBad };

  StepValue() = default;
  StepValue(const char* begin, const char* end) : begin_(begin), end_(end) {}

  [[nodiscard]] Kind kind() const;  // kNone: the list has no such item; kNull: $; kDerived: *; kTyped: IFCLABEL('x')
  [[nodiscard]] bool is_null() const { return kind() == Kind::kNull || kind() == Kind::kNone; }
  // A number; a typed value gives what is in it.
  [[nodiscard]] std::optional<double> Real() const;
  // NAN, INF, 1.#IND and the like as programs write them, and numbers beyond the range of double. Real() gives none for them.
  [[nodiscard]] bool IsNotFinite() const;
  [[nodiscard]] std::optional<int64_t> Integer() const;
  [[nodiscard]] std::optional<uint64_t> Reference() const;  // 12 for #12
  [[nodiscard]] std::string_view Enumeration() const;       // "METRE" for .METRE.; empty if it is none
  [[nodiscard]] std::optional<bool> Boolean() const;        // .T. and .F.
  [[nodiscard]] std::string Text() const;                   // UTF-8; empty if it is no string
  [[nodiscard]] std::string_view TypeName() const;          // "IFCLABEL" of a typed value
  [[nodiscard]] StepValue Inner() const;                    // of a typed value, its argument; else itself
  [[nodiscard]] StepItems Items() const;                    // of a list; empty if it is none

 private:
  const char* begin_ = nullptr;  // at the value's first character, or null
  const char* end_ = nullptr;    // of the text
};

// The items of a list, for a range-based for. One pass; complexity linear in the list's text.
class StepItems {
 public:
  class Iterator {
   public:
    Iterator(const char* p, const char* end) : p_(p), end_(end) {}
    StepValue operator*() const { return {p_, end_}; }
    Iterator& operator++();
    bool operator!=(const Iterator& other) const { return p_ != other.p_; }

   private:
    const char* p_;  // null at the end
    const char* end_;
  };

  StepItems() = default;
  StepItems(const char* open, const char* end);  // `open`: at the list's parenthesis
  [[nodiscard]] Iterator begin() const { return {first_, end_}; }
  [[nodiscard]] Iterator end() const { return {nullptr, end_}; }
  [[nodiscard]] bool empty() const { return first_ == nullptr; }

 private:
  const char* first_ = nullptr;
  const char* end_ = nullptr;
};

// The arguments of an instance with random access. They are looked for as far as they are asked for: the long list at the end of most
// instances is then gone through once, by who reads it. Instances of IFC have fewer than kMax; further ones are not kept.
class StepArguments {
 public:
  static constexpr size_t kMax = 24;
  StepArguments() = default;
  StepArguments(const char* open, const char* end);
  [[nodiscard]] size_t size() const;
  [[nodiscard]] StepValue operator[](size_t i) const { return Reach(i) ? StepValue(open_ + offsets_[i], end_) : StepValue(); }

 private:
  [[nodiscard]] bool Reach(size_t i) const;  // whether there is an argument i

  const char* open_ = nullptr;
  const char* end_ = nullptr;
  mutable size_t known_ = 0;
  mutable bool is_complete_ = true;
  mutable std::array<uint32_t, kMax> offsets_;
};

}  // namespace plumb::compiler
