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
    {"approved", "architect", "architecte", "architekt", "arquitecto", "auftraggeber", "bauherr",  "blatt", "checked",    "client",
     "cliente",  "data",      "date",       "datum",     "dessin",     "disegno",      "drawing",  "drawn", "echelle",    "escala",
     "fecha",    "gepr",      "gezeichnet", "index",     "job",        "massstab",     "owner",    "plan",  "planinhalt", "plannummer",
     "progetto", "project",   "projekt",    "projet",    "proyecto",   "rev",          "revision", "scala", "scale",      "sheet",
     "stand",    "title",     "titel",      "titolo",    "titre",      "titulo"});
// What numbers or letters alone after them make notes of.
constexpr auto kMarks =
    std::to_array<std::string_view>({"blatt", "coupe", "detail", "plan", "rev", "revision", "schnitt", "section", "sezione", "sheet"});
constexpr auto kScaleWords =
    std::to_array<std::string_view>({"\xc3\xa9\x63helle", "echelle", "escala", "ma\xc3\x9fstab", "massstab", "scala", "scale"});
constexpr auto kScales = std::to_array<long>({1, 2, 5, 10, 20, 25, 50, 75, 100, 125, 200, 250, 500, 1000, 2000, 2500, 5000});
// Titles by themselves, and with a storey.
constexpr auto kTitles = std::to_array<std::string_view>({"floorplan", "grundriss", "grundri\xc3\x9f"});
constexpr auto kTitlesOfStoreys = std::to_array<std::string_view>({"pianta", "plan"});
constexpr std::string_view kStoreyWords =
    " attic basement cellar existing fifth first floor fourth ground level loft lower main mezzanine nd of proposed rd roof second sixth st"
    " storey story th the third typical upper"
    " dachgeschoss dachgescho\xc3\x9f des dg ebene eg erdgeschoss erdgescho\xc3\x9f geschoss gescho\xc3\x9f keller kellergeschoss"
    " kellergescho\xc3\x9f kg obergeschoss obergescho\xc3\x9f og ug untergeschoss untergescho\xc3\x9f vom"
    " chaussee chauss\xc3\xa9\x65 combles de deuxi\xc3\xa8me du \xc3\xa8me er \xc3\xa9tage etage la le niveau premier rdc rez sol sous toiture"
    " ammezzato copertura interrato piano primo rialzato secondo seminterrato sottotetto terra terzo ";

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80; }

// ASCII, and the letters that UTF-8 writes as C3 80 to C3 9E (the times sign among them stays).
std::string Lower(std::string_view text) {
  std::string out(text);
  unsigned char before = 0;
  for (char& c : out) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 0x80) c = static_cast<char>(std::tolower(u));
    if (before == 0xc3 && u >= 0x80 && u <= 0x9e && u != 0x97) c = static_cast<char>(u + 0x20);
    before = u;
  }
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

template <class Words>
bool Holds(const Words& words, const auto& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// "1:100", and, since flats are numbered "1/12", anything else only beside a word for it: "Scale 1/8".
bool HasScale(const std::vector<Figure>& figures, const std::vector<std::string>& words) {
  const bool called = std::any_of(words.begin(), words.end(), [](const std::string& w) { return Holds(kScaleWords, w); });
  for (size_t i = 0; i + 1 < figures.size(); ++i) {
    if (figures[i].value != 1 || figures[i].digits != 1) continue;
    const Figure& to = figures[i + 1];
    if (called && (to.before == ':' || to.before == '/')) return true;
    if (to.before == ':' && Holds(kScales, to.value)) return true;
  }
  return false;
}

// "Ground floor plan", "Grundriss 1. OG": nothing else beside it. "Floor plan archive" is a room.
bool IsTitle(const std::vector<std::string>& words) {
  bool title = false, of_storeys = false, storey = false;
  for (const std::string& w : words) {
    if (Holds(kTitles, w)) {
      title = true;
    } else if (Holds(kTitlesOfStoreys, w)) {
      of_storeys = true;
    } else if (kStoreyWords.find(" " + w + " ") != std::string_view::npos) {
      storey = true;
    } else if (w.size() > 1) {
      return false;
    }
  }
  return title || (of_storeys && storey);
}

bool HasDate(const std::vector<Figure>& figures) {
  for (size_t i = 0; i + 2 < figures.size(); ++i) {
    const Figure &a = figures[i], &b = figures[i + 1], &c = figures[i + 2];
    if (b.before != c.before || std::string_view("./-").find(b.before) == std::string_view::npos) continue;
    const bool day_first =
        a.digits <= 2 && b.digits <= 2 && a.value >= 1 && a.value <= 31 && b.value >= 1 && b.value <= 31 && c.digits == 4;
    const bool year_first =
        a.digits == 4 && b.digits <= 2 && c.digits <= 2 && b.value >= 1 && b.value <= 12 && c.value >= 1 && c.value <= 31;
    if (day_first || year_first) return true;
  }
  return false;
}

}  // namespace

bool IsNote(std::string_view text) {
  const std::string lower = Lower(text);
  const std::vector<Figure> figures = FiguresOf(lower);
  const std::vector<std::string> words = WordsOf(lower);
  if (HasScale(figures, words) || HasDate(figures) || lower == "nts" || lower == "n.t.s." || IsTitle(words)) return true;
  if (words.empty()) return false;
  if (lower.find(':') != std::string::npos && Holds(kLabels, words[0])) return true;
  const bool bare =
      std::all_of(words.begin() + 1, words.end(), [](const std::string& w) { return w.size() == 1 || w == "nr" || w == "no"; });
  return bare && Holds(kMarks, words[0]) && (words.size() > 1 || !figures.empty());
}

}  // namespace plumb::compiler
