#include "compiler/frontends/drawing/drawing_notes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace plumb::compiler {
namespace {

// What stands in title blocks before a colon.
constexpr auto kLabels = std::to_array<std::string_view>(
    {"approved",  "architect", "architecte", "architekt", "arquitecto", "auftraggeber", "bauherr",  "blatt",      "checked",  "client",
     "cliente",   "data",      "date",       "datum",     "dessin",     "disegno",      "drawing",  "drawn",      "echelle",  "escala",
     "fecha",     "gepr",      "gezeichnet", "index",     "job",        "massstab",     "owner",    "plan",       "planinhalt", "plannummer",
     "progetto",  "project",   "projekt",    "projet",    "proyecto",   "rev",          "revision", "scala",      "scale",    "sheet",
     "stand",     "title",     "titel",      "titolo",    "titre",      "titulo"});
// What numbers or letters alone after them make notes of.
constexpr auto kMarks = std::to_array<std::string_view>({"blatt", "coupe", "detail", "plan", "rev", "revision", "schnitt", "section", "sezione", "sheet"});
constexpr auto kTitles = std::to_array<std::string_view>({"floor plan", "floorplan", "grundriss", "grundri\xc3\x9f", "plan du ", "plan de ", "pianta piano"});
constexpr int kMinScale = 5;  // 1:5; doors may be marked 1/2

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80; }

std::string Lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::vector<std::string> WordsOf(std::string_view text) {
  std::vector<std::string> out;
  bool within = false;
  for (const char c : text) {
    if (IsLetter(c) && !within) out.emplace_back();
    if (IsLetter(c)) out.back() += c;
    within = IsLetter(c);
  }
  return out;
}

// Figures with the character before each of them.
struct Figure {
  long value = 0;
  size_t digits = 0;
  char before = ' ';
};

std::vector<Figure> FiguresOf(std::string_view text) {
  std::vector<Figure> out;
  char before = ' ';
  bool within = false;
  for (const char c : text) {
    if (IsDigit(c)) {
      if (!within) out.push_back({0, 0, before});
      if (++out.back().digits <= 6) out.back().value = 10 * out.back().value + (c - '0');
    } else if (c != ' ' || within) {
      before = c;
    }
    within = IsDigit(c);
  }
  return out;
}

bool HasScale(const std::vector<Figure>& figures) {
  for (size_t i = 0; i + 1 < figures.size(); ++i) {
    const bool ratio = figures[i + 1].before == ':' || figures[i + 1].before == '/';
    if (figures[i].value == 1 && figures[i].digits == 1 && ratio && figures[i + 1].value >= kMinScale) return true;
  }
  return false;
}

bool HasDate(const std::vector<Figure>& figures) {
  for (size_t i = 0; i + 2 < figures.size(); ++i) {
    const Figure &a = figures[i], &b = figures[i + 1], &c = figures[i + 2];
    if (b.before != c.before || std::string_view("./-").find(b.before) == std::string_view::npos) continue;
    const bool day_first = a.digits <= 2 && b.digits <= 2 && a.value >= 1 && a.value <= 31 && b.value >= 1 && b.value <= 31 && c.digits == 4;
    const bool year_first = a.digits == 4 && b.digits <= 2 && c.digits <= 2 && b.value >= 1 && b.value <= 12 && c.value >= 1 && c.value <= 31;
    if (day_first || year_first) return true;
  }
  return false;
}

template <class Words>
bool Contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

bool IsNote(std::string_view text) {
  const std::string lower = Lower(text);
  const std::vector<Figure> figures = FiguresOf(lower);
  if (HasScale(figures) || HasDate(figures) || lower == "nts" || lower == "n.t.s.") return true;
  if (std::any_of(kTitles.begin(), kTitles.end(), [&](std::string_view title) { return lower.find(title) != std::string::npos; })) return true;
  const std::vector<std::string> words = WordsOf(lower);
  if (words.empty()) return false;
  if (lower.find(':') != std::string::npos && Contains(kLabels, words[0])) return true;
  const bool bare = std::all_of(words.begin() + 1, words.end(), [](const std::string& w) { return w.size() == 1 || w == "nr" || w == "no"; });
  return bare && Contains(kMarks, words[0]) && (words.size() > 1 || !figures.empty());
}

}  // namespace plumb::compiler
