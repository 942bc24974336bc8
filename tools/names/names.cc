#include "tools/names/names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace plumb::tools {
namespace {

constexpr char32_t kFirstLetter = 0xC0, kDiaeresis = 0x308;

// Of the letters from U+00C0 on, without accents.
constexpr auto kPlain = std::to_array<std::string_view>({
    "a", "a", "a",  "a",  "a", "a", "ae", "c", "e", "e", "e", "e", "i", "i", "i",  "i",   // U+00C0
    "d", "n", "o",  "o",  "o", "o", "o",  " ", "o", "u", "u", "u", "u", "y", "th", "ss",  // U+00D0
    "a", "a", "a",  "a",  "a", "a", "ae", "c", "e", "e", "e", "e", "i", "i", "i",  "i",   // U+00E0
    "d", "n", "o",  "o",  "o", "o", "o",  " ", "o", "u", "u", "u", "u", "y", "th", "y",   // U+00F0
    "a", "a", "a",  "a",  "a", "a", "c",  "c", "c", "c", "c", "c", "c", "c", "d",  "d",   // U+0100
    "d", "d", "e",  "e",  "e", "e", "e",  "e", "e", "e", "e", "e", "g", "g", "g",  "g",   // U+0110
    "g", "g", "g",  "g",  "h", "h", "h",  "h", "i", "i", "i", "i", "i", "i", "i",  "i",   // U+0120
    "i", "i", "ij", "ij", "j", "j", "k",  "k", "k", "l", "l", "l", "l", "l", "l",  "l",   // U+0130
    "l", "l", "l",  "n",  "n", "n", "n",  "n", "n", "n", "n", "n", "o", "o", "o",  "o",   // U+0140
    "o", "o", "oe", "oe", "r", "r", "r",  "r", "r", "r", "s", "s", "s", "s", "s",  "s",   // U+0150
    "s", "s", "t",  "t",  "t", "t", "t",  "t", "u", "u", "u", "u", "u", "u", "u",  "u",   // U+0160
    "u", "u", "u",  "u",  "w", "w", "y",  "y", "y", "z", "z", "z", "z", "z", "z",  "s",   // U+0170
});

// Takes a character off the front; bytes that are no UTF-8 stand for themselves.
std::string_view TakeCharacter(std::string_view& text, char32_t& code) {
  const auto byte = [&text](size_t i) { return static_cast<unsigned char>(text[i]); };
  const size_t length = byte(0) < 0xC0 ? 1 : byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  const std::string_view out = text.substr(0, std::min(length, text.size()));
  code = out.size() == 2 && (byte(1) & 0xC0) == 0x80 ? ((byte(0) & 0x1Fu) << 6 | (byte(1) & 0x3Fu)) : out.size() == 1 ? byte(0) : 0;
  text.remove_prefix(out.size());
  return out;
}

bool IsUmlaut(char32_t code) { return code == 0xC4 || code == 0xD6 || code == 0xDC || code == 0xE4 || code == 0xF6 || code == 0xFC; }

std::string Fold(std::string_view text, bool german) {
  std::string out;
  const auto add_space = [&out] {
    if (!out.empty() && out.back() != ' ') out += ' ';
  };
  while (!text.empty()) {
    char32_t code = 0;
    const std::string_view character = TakeCharacter(text, code);
    if (code >= kFirstLetter && code < kFirstLetter + kPlain.size()) {
      out += kPlain[code - kFirstLetter];
      if (german && IsUmlaut(code)) out += 'e';
    } else if (code >= 0x300 && code < 0x370) {  // accents by themselves, as some systems write them
      if (german && code == kDiaeresis) out += 'e';
    } else if (code == 0 || code >= 0x80) {
      out += character;
    } else if (std::isalnum(static_cast<unsigned char>(character[0])) != 0) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(character[0])));
    } else {
      add_space();
    }
  }
  if (out.ends_with(' ')) out.pop_back();
  return out;
}

// "|6|kuche|", so that words are found as wholes.
std::string Fenced(std::string folded) {
  std::replace(folded.begin(), folded.end(), ' ', '|');
  return "|" + folded + "|";
}

}  // namespace

std::string Folded(std::string_view utf8) { return Fold(utf8, false); }

std::string FoldedGerman(std::string_view utf8) { return Fold(utf8, true); }

bool IsSameName(std::string_view a, std::string_view b) {
  if (Folded(a).empty()) return a == b;  // "-" is not " "
  return Folded(a) == Folded(b) || Folded(a) == FoldedGerman(b) || FoldedGerman(a) == Folded(b);
}

bool IsPartOfName(std::string_view part, std::string_view name) {
  const auto holds = [](const std::string& whole, const std::string& words) {
    return Fenced(whole).find(Fenced(words)) != std::string::npos;
  };
  if (Folded(part).empty()) return false;
  return holds(Folded(name), Folded(part)) || holds(FoldedGerman(name), Folded(part)) || holds(Folded(name), FoldedGerman(part));
}

std::string NearestName(const std::string& name, const std::vector<std::string>& names) {
  std::string best;
  size_t best_edits = std::min(name.size() / 3 + 2, name.size());
  for (const std::string& candidate : names) {
    std::vector<size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 0; i < name.size(); ++i) {
      size_t diagonal = row[0]++;
      for (size_t j = 0; j < candidate.size(); ++j) {
        const size_t replaced = diagonal + (name[i] == candidate[j] ? 0 : 1);
        diagonal = row[j + 1];
        row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
      }
    }
    if (row.back() < best_edits) {
      best_edits = row.back();
      best = candidate;
    }
  }
  return best;
}

}  // namespace plumb::tools
