#include "compiler/frontends/drawing/room_names.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace plumb::compiler {
namespace {

constexpr size_t kMaxName = 60;       // bytes; longer texts are notes
constexpr size_t kMaxLines = 3;
constexpr int kMaxWords = 3;          // texts with more are notes, where there are others
constexpr double kSameHeight = 0.75;  // texts this much lower than the tallest are remarks to it

bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80; }

// "3.25 x 4.10", "12'-6\"", "14.3 m2", "+0.00": figures with nothing but units between them. A number alone, or one with a letter, names a room.
bool IsMeasure(std::string_view text) {
  size_t digits = 0, marks = 0, longest_word = 0, word = 0;
  for (const char c : text) {
    digits += std::isdigit(static_cast<unsigned char>(c)) != 0;
    marks += std::string_view("'\".,+-=/:*").find(c) != std::string_view::npos;
    word = IsLetter(c) ? word + 1 : 0;
    longest_word = std::max(longest_word, word);
  }
  return digits > 0 && longest_word <= 3 && (marks > 0 || text.find(' ') != std::string_view::npos);
}

template <class Good>
void KeepIfAny(std::vector<const DrawnText*>& texts, const Good& good) {
  if (std::any_of(texts.begin(), texts.end(), good)) std::erase_if(texts, [&](const DrawnText* t) { return !good(t); });
}

}  // namespace

std::string RoomName(std::vector<const DrawnText*> texts) {
  std::erase_if(texts, [](const DrawnText* t) { return t->text.empty() || t->text.size() > kMaxName || IsMeasure(t->text); });
  // Several numbers are sizes of doors and windows; one is the room's.
  const auto is_number = [](const DrawnText* t) { return std::none_of(t->text.begin(), t->text.end(), IsLetter); };
  if (std::count_if(texts.begin(), texts.end(), is_number) > 1) std::erase_if(texts, is_number);
  KeepIfAny(texts, [](const DrawnText* t) { return t->names_room; });
  KeepIfAny(texts, [](const DrawnText* t) { return t->underlined; });
  KeepIfAny(texts, [](const DrawnText* t) { return std::count(t->text.begin(), t->text.end(), ' ') < kMaxWords; });
  double tallest = 0;
  for (const DrawnText* t : texts) tallest = std::max(tallest, t->height_m);
  std::erase_if(texts, [&](const DrawnText* t) { return t->height_m < kSameHeight * tallest; });
  std::stable_sort(texts.begin(), texts.end(), [](const DrawnText* a, const DrawnText* b) { return a->at.y() > b->at.y(); });
  if (texts.size() > kMaxLines) texts.resize(kMaxLines);
  std::string out;
  for (const DrawnText* t : texts) out += (out.empty() ? "" : " ") + t->text;
  return out;
}

}  // namespace plumb::compiler
