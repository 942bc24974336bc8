#include "compiler/frontends/mesh/mesh_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace plumb::compiler {
namespace {

constexpr std::array kFurnishing = {"frame", "rahmen", "handrail", "handle",  "rail",  "bumper",  "stair",  "treppe",  "escalier",
                                    "table", "tisch",  "chair",    "stuhl",   "sofa",  "bed_",    "desk",   "lamp",    "light",
                                    "sink",  "toilet", "plant",    "curtain", "floor", "boden",   "ground", "ceiling", "decke",
                                    "roof",  "dach",   "slab",     "cabinet", "shelf", "portrait"};
constexpr std::array kDoors = {"door", "tuer", "t\xc3\xbcr", "porte", "puerta", "porta_"};
constexpr std::array kWindows = {"window", "fenster", "fen\xc3\xaatre", "fenetre", "ventana", "finestra", "glass", "glazing"};
constexpr std::array kWalls = {"wall",  "wand", "w\xc3\xa4nde", "waende",    "mauer",  "mur_",  "murs",
                               "pared", "muro", "parete",       "partition", "column", "pillar"};

template <size_t N>
bool HasAny(const std::string& name, const std::array<const char*, N>& words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return name.find(word) != std::string::npos; });
}

}  // namespace

NameHint HintOfName(std::string_view name) {
  std::string lower;
  for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  lower += '_';
  if (HasAny(lower, kWalls)) return NameHint::kWall;
  if (HasAny(lower, kFurnishing)) return NameHint::kFurnishing;
  if (HasAny(lower, kDoors)) return NameHint::kDoor;
  if (HasAny(lower, kWindows)) return NameHint::kWindow;
  return NameHint::kNone;
}

}  // namespace plumb::compiler
