#include "compiler/frontends/ifc/step_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <numeric>

namespace plumb::compiler {
namespace {

constexpr size_t kLineBlockBytes = size_t{1} << 11;
constexpr size_t kMaxSyntaxDiagnostics = 50;
constexpr size_t kMaxTypes = 0xfffe;
constexpr uint32_t kIdsInBucket = 2;  // on average at least

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsNameChar(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || IsDigit(c) || c == '_'; }
char Upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

const char* Find(const char* p, const char* end, char c) {
  return p < end ? static_cast<const char*>(std::memchr(p, c, static_cast<size_t>(end - p))) : nullptr;
}

// Type names to numbers: open addressing over a hash of both ends of the name.
class TypeTable {
 public:
  // kMaxTypes if the table is full.
  size_t Intern(std::string_view name, std::vector<std::string>& names) {
    for (size_t slot = Hash(name) & (kSlots - 1);; slot = (slot + 1) & (kSlots - 1)) {
      if (slots_[slot] == 0) {
        if (names.size() >= kSlots / 2) return kMaxTypes;
        names.emplace_back(name);
        slots_[slot] = static_cast<uint16_t>(names.size());
        return names.size() - 1;
      }
      if (names[slots_[slot] - 1u] == name) return slots_[slot] - 1u;
    }
  }

 private:
  static uint64_t Hash(std::string_view name) {
    uint64_t head = 0, tail = 0;
    const size_t n = std::min(name.size(), sizeof head);
    std::memcpy(&head, name.data(), n);
    std::memcpy(&tail, name.data() + name.size() - n, n);
    const uint64_t hash = (head * 0x9e3779b97f4a7c15u) ^ (tail * 0xc2b2ae3d27d4eb4fu) ^ name.size();
    return hash ^ hash >> 32;
  }

  static constexpr size_t kSlots = size_t{1} << 14;  // IFC4X3 has about 1,000 types; the bound keeps hostile files cheap
  std::vector<uint16_t> slots_ = std::vector<uint16_t>(kSlots, 0);
};

}  // namespace

class StepIndexer {
 public:
  StepIndexer(std::string_view text, DiagnosticSink& diagnostics)
      : begin_(text.data()), end_(begin_ + text.size()), diagnostics_(diagnostics) {
    file_.text_ = text;
    const size_t expected = text.size() / 48;
    file_.ids_.reserve(expected);
    file_.offsets_.reserve(expected);
    file_.types_.reserve(expected);
    CountLines();
  }

  std::optional<StepFile> Run() {
    const char* p = begin_;
    if (file_.text_.starts_with("\xef\xbb\xbf")) p += 3;
    p = SkipStepSpace(p, end_);
    if (!std::string_view(p, static_cast<size_t>(end_ - p)).starts_with("ISO-10303-21")) {
      diagnostics_.Emit(DiagnosticKind::kStepSyntax, {}, "the file does not begin with `ISO-10303-21;`");
      return std::nullopt;
    }
    while (!closed_) {
      p = SkipStepSpace(p, end_);
      if (p == end_) break;
      p = *p == '#' ? Instance(p) : Keyword(p);
    }
    if (!closed_ && !truncated_) {
      truncated_ = !data_ended_;
      const DiagnosticKind kind = truncated_ ? DiagnosticKind::kFileCutOff : DiagnosticKind::kStepSyntax;
      Complain(end_, "the file ends before `END-ISO-10303-21;`", kind);
    }
    file_.is_whole_ = !truncated_;
    file_.BuildLookup();
    file_.ReportDuplicates(diagnostics_);
    file_.BuildTypeLists();
    return std::move(file_);
  }

 private:
  void CountLines() {
    const bool has_lf = Find(begin_, end_, '\n') != nullptr;
    file_.newline_ = has_lf ? '\n' : '\r';
    uint32_t count = 0;
    for (const char* p = begin_; p < end_;) {
      const char* stop = static_cast<size_t>(end_ - p) > kLineBlockBytes ? p + kLineBlockBytes : end_;
      file_.line_blocks_.push_back(count);
      count += static_cast<uint32_t>(std::count(p, stop, file_.newline_));
      p = stop;
    }
  }

  void Complain(const char* at, std::string message, DiagnosticKind kind = DiagnosticKind::kStepSyntax) {
    const bool is_listed = kind == DiagnosticKind::kFileCutOff || ++complaints_ <= kMaxSyntaxDiagnostics;
    if (!is_listed) return;
    if (complaints_ == kMaxSyntaxDiagnostics) message += "; further syntax errors are not listed";
    SourceLocation location;
    location.line = file_.LineAt(static_cast<size_t>(at - begin_));
    location.column = file_.ColumnAt(static_cast<size_t>(at - begin_));
    diagnostics_.Emit(kind, location, std::move(message));
  }

  // p at `#`. Returns where to go on.
  const char* Instance(const char* p) {
    const char* start = p;
    uint64_t id = 0;
    const auto digits = std::from_chars(p + 1, end_, id);
    if (digits.ec != std::errc()) return Broken(start, "`#` stands without an id");
    p = SkipStepSpace(digits.ptr, end_);
    if (p == end_ || *p != '=') return Broken(start, fmt::format("`#{}` stands without `=`", id));
    p = SkipStepSpace(p + 1, end_);
    const char* name = p;
    while (p != end_ && IsNameChar(*p)) ++p;
    const std::string_view type(name, static_cast<size_t>(p - name));
    p = SkipStepSpace(p, end_);
    if (p == end_ || *p != '(') return Broken(start, fmt::format("`#{}` has no argument list", id));
    const size_t type_number = types_.Intern(type, file_.type_names_);
    if (type_number == kMaxTypes) return Broken(start, fmt::format("`#{}` is of one type too many; at most 8192 are read", id));
    const char* next = Terminator(start, p);
    if (truncated_) return end_;  // cut off inside its arguments: not kept
    file_.ids_.push_back(id);
    file_.offsets_.push_back(static_cast<uint32_t>(p - begin_));
    file_.types_.push_back(static_cast<uint16_t>(type_number));
    return next;
  }

  // Sections, header entities and garbage.
  const char* Keyword(const char* p) {
    const char* name = p;
    while (p != end_ && (IsNameChar(*p) || *p == '-')) ++p;
    const std::string_view word(name, static_cast<size_t>(p - name));
    if (word.empty()) return Broken(name, fmt::format("`{}` begins no statement", Printable(*name)));
    if (word == "END-ISO-10303-21") {
      closed_ = true;
      return end_;
    }
    if (word == "DATA") data_ended_ = false, in_data_ = true;
    if (word == "ENDSEC") data_ended_ = in_data_;
    p = SkipStepSpace(p, end_);
    if (word == "FILE_SCHEMA" && p != end_ && *p == '(') ReadSchema(p);
    return Terminator(name, p);
  }

  void ReadSchema(const char* open) {
    const StepArguments args(open, end_);
    const StepItems names = args[0].Items();
    if (names.empty()) return;
    file_.schema_name_ = (*names.begin()).Text();
    std::transform(file_.schema_name_.begin(), file_.schema_name_.end(), file_.schema_name_.begin(), Upper);
  }

  // Behind the `;` that ends the statement from `start`, looked for from `p` on and past strings and comments. Stops early, with a
  // complaint, where the next instance begins without a `;` before it.
  const char* Terminator(const char* start, const char* p) {
    while (true) {
      const char* stop = Next(p, ';', semicolon_);
      const char* limit = std::min(Next(p, '\'', quote_), stop);
      if (const char* comment = NextComment(p); comment < limit) {
        p = SkipStepSpace(comment, end_);
        continue;
      }
      if (const char* next = NextInstance(p, limit)) {
        Complain(start, "a statement does not end with `;` before the next instance");
        return next;
      }
      if (limit == stop) {
        if (stop != end_) return stop + 1;
        truncated_ = true;
        Complain(start, "the file ends inside this statement", DiagnosticKind::kFileCutOff);
        return end_;
      }
      const char* close = Next(limit + 1, '\'', quote_);
      const char* inside = InstanceInString(limit + 1, close);
      if (inside != nullptr || close == end_) {
        truncated_ = inside == nullptr;
        Complain(limit, "a string has no closing quote", truncated_ ? DiagnosticKind::kFileCutOff : DiagnosticKind::kStepSyntax);
        return truncated_ ? end_ : inside;
      }
      p = close + 1;
    }
  }

  // The next `c` at or behind p, or the end. `found` keeps it: p only moves on, so no byte is searched twice.
  const char* Next(const char* p, char c, const char*& found) const {
    if (found == nullptr || found < p) {
      found = Find(p, end_, c);
      if (found == nullptr) found = end_;
    }
    return found;
  }

  // The same for the opening of a comment.
  const char* NextComment(const char* p) {
    if (comment_ != nullptr && comment_ >= p) return comment_;
    for (comment_ = Find(p, end_, '/'); comment_ != nullptr; comment_ = Find(comment_ + 1, end_, '/')) {
      if (end_ - comment_ >= 2 && comment_[1] == '*') return comment_;
    }
    return comment_ = end_;
  }

  // `#12=` in [p, limit): the `=` shows that an instance begins there.
  const char* NextInstance(const char* p, const char* limit) const {
    const char* equals = Find(p, limit, '=');
    if (equals == nullptr) return nullptr;
    const char* q = equals;
    while (q != p && (q[-1] == ' ' || q[-1] == '\t')) --q;
    const char* digits_end = q;
    while (q != p && IsDigit(q[-1])) --q;
    return q != digits_end && q != p && q[-1] == '#' ? q - 1 : nullptr;
  }

  // A line of its own that reads `#12=` in what should be a string.
  static const char* InstanceInString(const char* p, const char* limit) {
    while ((p = Find(p, limit, '\n')) != nullptr) {
      ++p;
      const char* q = p;
      if (q == limit || *q != '#') continue;
      ++q;
      while (q != limit && IsDigit(*q)) ++q;
      while (q != limit && *q == ' ') ++q;
      if (q != limit && *q == '=') return p;
    }
    return nullptr;
  }

  const char* Broken(const char* at, std::string message) {
    Complain(at, std::move(message));
    const char* semicolon = Find(at, end_, ';');
    return semicolon != nullptr ? semicolon + 1 : end_;
  }

  static std::string Printable(char c) {
    return c >= ' ' && c <= '~' ? std::string(1, c) : fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c));
  }

  const char* begin_;
  const char* end_;
  const char* semicolon_ = nullptr;  // the next ones, as far as they were looked for
  const char* quote_ = nullptr;
  const char* comment_ = nullptr;
  DiagnosticSink& diagnostics_;
  StepFile file_;
  TypeTable types_;
  size_t complaints_ = 0;
  bool in_data_ = false, data_ended_ = false;  // the data section has begun, and it has ended
  bool closed_ = false, truncated_ = false;
};

std::optional<StepFile> StepFile::Index(std::string_view text, DiagnosticSink& diagnostics) { return StepIndexer(text, diagnostics).Run(); }

void StepFile::BuildLookup() {
  if (!std::is_sorted(ids_.begin(), ids_.end())) {
    by_id_.resize(size());
    std::iota(by_id_.begin(), by_id_.end(), 0u);
    std::stable_sort(by_id_.begin(), by_id_.end(), [this](uint32_t a, uint32_t b) { return ids_[a] < ids_[b]; });
  }
  const uint64_t max_id = ids_.empty() ? 0 : ids_[ById(size() - 1)];
  while (bucket_bits_ < 63 && max_id >> bucket_bits_ > size() / kIdsInBucket) ++bucket_bits_;
  bucket_starts_.reserve((max_id >> bucket_bits_) + 2);
  for (uint32_t rank = 0; rank < size(); ++rank) {
    while (bucket_starts_.size() <= ids_[ById(rank)] >> bucket_bits_) bucket_starts_.push_back(rank);
  }
  bucket_starts_.push_back(size());
}

void StepFile::ReportDuplicates(DiagnosticSink& diagnostics) const {
  std::vector<uint32_t> duplicates;
  for (size_t rank = 1; rank < size(); ++rank) {
    if (ids_[ById(rank - 1)] == ids_[ById(rank)]) duplicates.push_back(ById(rank));
  }
  std::sort(duplicates.begin(), duplicates.end());
  if (duplicates.size() > kMaxSyntaxDiagnostics) duplicates.resize(kMaxSyntaxDiagnostics);
  for (const uint32_t instance : duplicates) {
    const SourceLocation location{Line(instance), ids_[instance], {}, type_names_[types_[instance]], Column(instance)};
    diagnostics.Emit(DiagnosticKind::kDuplicateInstance, location, fmt::format("`#{}` is used again; the first one holds", ids_[instance]));
  }
}

void StepFile::BuildTypeLists() {
  type_starts_.assign(type_names_.size() + 1, 0);
  for (const uint16_t type : types_) ++type_starts_[type + 1u];
  std::partial_sum(type_starts_.begin(), type_starts_.end(), type_starts_.begin());
  by_type_.resize(size());
  std::vector<uint32_t> next(type_starts_.begin(), type_starts_.end() - 1);
  for (uint32_t i = 0; i < size(); ++i) by_type_[next[types_[i]]++] = i;
}

uint32_t StepFile::Find(uint64_t id) const {
  const uint64_t bucket = id >> bucket_bits_;
  if (bucket + 1 >= bucket_starts_.size()) return kNone;
  uint32_t rank = bucket_starts_[bucket], end = bucket_starts_[bucket + 1];
  while (end - rank > kIdsInBucket) {  // ids that crowd
    const uint32_t middle = rank + (end - rank) / 2;
    (ids_[ById(middle - 1)] < id ? rank : end) = middle;
  }
  while (rank < end && ids_[ById(rank)] < id) ++rank;
  return rank < end && ids_[ById(rank)] == id ? ById(rank) : kNone;
}

std::span<const uint32_t> StepFile::InstancesOf(uint16_t type) const {
  return std::span(by_type_).subspan(type_starts_[type], type_starts_[type + 1u] - type_starts_[type]);
}

size_t StepFile::StartOf(uint32_t instance) const {
  const size_t at = text_.rfind('#', offsets_[instance]);
  return at == std::string_view::npos ? offsets_[instance] : at;
}

uint32_t StepFile::ColumnAt(size_t offset) const {
  const size_t newline = offset == 0 ? std::string_view::npos : text_.rfind(newline_, offset - 1);
  return static_cast<uint32_t>(newline == std::string_view::npos ? offset + 1 : offset - newline);
}

uint32_t StepFile::LineAt(size_t offset) const {
  if (line_blocks_.empty()) return 1;
  const size_t block = std::min(offset / kLineBlockBytes, line_blocks_.size() - 1);
  const char* from = text_.data() + block * kLineBlockBytes;
  return 1 + line_blocks_[block] + static_cast<uint32_t>(std::count(from, text_.data() + offset, newline_));
}

}  // namespace plumb::compiler
