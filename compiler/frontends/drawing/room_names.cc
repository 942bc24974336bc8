#include "compiler/frontends/drawing/room_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "compiler/frontends/drawing/drawing_notes.h"

namespace plumb::compiler {
namespace {

constexpr size_t kMaxName = 60;  // bytes; longer texts are notes
constexpr size_t kMaxLines = 3;
constexpr int kMaxWords = 3;          // texts with more are notes, where there are others
constexpr double kSameHeight = 0.75;  // texts this much lower than the tallest are remarks to it

bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80; }

// Units, and what stands before figures of heights, sizes and areas on plans in English, German, French, Italian and Spanish.
constexpr auto kMeasureWords = std::to_array<std::string_view>(
    {"m",  "mm", "cm", "qm",   "sqm",  "mq",   "sq",  "sf",  "sqft", "ft",  "in", "x",   "ch",  "clg", "lh",  "rh", "bh", "brh", "ok",
     "uk", "ff", "rd", "okff", "okrd", "ukrd", "ukd", "ffb", "ffl",  "ngf", "nf", "nrf", "hsp", "hp",  "htl", "dn", "up", "el",  "lvl"});

// "3.25 x 4.10", "12'-6\"", "14.3 m2", "+0.00", "BRH 0.90": figures with nothing but units and such words between them. A number alone,
// or one with a letter, names a room.
bool IsMeasure(std::string_view text) {
  size_t digits = 0, marks = 0, dashes = 0;
  std::string word;
  bool only_units = true, letters = false;  // a letter alone: "H 2.50", but not "B 12" or "B-12"
  for (const char c : std::string(text) + ' ') {
    digits += std::isdigit(static_cast<unsigned char>(c)) != 0;
    marks += std::string_view("'\".,+-=/:*").find(c) != std::string_view::npos;
    dashes += c == '-';
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (static_cast<unsigned char>(c) < 0x80 && !word.empty()) {  // beyond ASCII: the square of m, diameters
      const bool unit = std::find(kMeasureWords.begin(), kMeasureWords.end(), word) != kMeasureWords.end();
      letters = letters || (!unit && word.size() == 1);
      only_units = only_units && (unit || word.size() == 1);
      word.clear();
    }
  }
  return digits > 0 && only_units && (marks > (letters ? dashes : 0) || (!letters && text.find(' ') != std::string_view::npos));
}

template <class Good>
void KeepIfAny(std::vector<const DrawnText*>& texts, const Good& good) {
  if (std::any_of(texts.begin(), texts.end(), good)) std::erase_if(texts, [&](const DrawnText* t) { return !good(t); });
}

}  // namespace

std::string RoomName(std::vector<const DrawnText*> texts) {
  std::erase_if(texts, [](const DrawnText* t) { return t->text.empty() || t->text.size() > kMaxName || IsMeasure(t->text) || IsNote(t->text); });
  if (std::none_of(texts.begin(), texts.end(), [](const DrawnText* t) { return t->names_room; }))
    std::erase_if(texts, [](const DrawnText* t) { return t->text == "N"; });  // the north arrow's
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
