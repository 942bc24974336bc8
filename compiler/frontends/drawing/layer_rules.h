// What the layers of a drawing stand for, by their names: rules in TOML, built-in sets for usual standards and languages.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontends/drawing/drawing.h"
#include "schema/error.h"

namespace plumb::compiler {

enum class LayerUse : uint8_t { kUnknown, kWall, kColumn, kDoor, kWindow, kOpening, kPassage, kRoomName, kIgnore };

[[nodiscard]] LineRole RoleOf(LayerUse use);  // kAny for uses that no line has
// Of what stands in walls and is drawn as one symbol: doors, windows, openings.
[[nodiscard]] bool IsSymbolUse(LayerUse use);

// A set in TOML:
//   name = "german"
//   [[rule]]
//   use = "wall"                  # wall, column, door, window, opening, room-name, ignore
//   layers = ["*wand*", "mauer*"] # any word of the layer's name, case does not matter; * stands for anything
//   [[rule]]
//   use = "wall"
//   names = ["A-WALL-*"]          # the whole name
// The first rule that fits holds. Words are parted by whatever is no letter. Of the names of external references (`house|A-WALL`,
// `house$0$A-WALL`) the last part counts.
class LayerRules {
 public:
  [[nodiscard]] static Expected<LayerRules> Parse(std::string_view toml, const std::string& source);
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] LayerUse UseOf(std::string_view layer) const;

 private:
  struct Rule {
    LayerUse use = LayerUse::kUnknown;
    std::vector<std::string> words, names;
  };
  std::string name_;
  std::vector<Rule> rules_;
};

// "aia", "english", "german", "french", "italian", "spanish", "none" (everything on layer 0): in the order in which they are tried.
[[nodiscard]] const std::vector<LayerRules>& BuiltInLayerRules();

// A built-in set by its name, else the file at that path.
[[nodiscard]] Expected<LayerRules> LoadLayerRules(const std::string& name_or_path);

struct LayerWeight {
  std::string name;
  double weight = 0;  // how much is drawn on it
};

struct LayerChoice {
  const LayerRules* rules = nullptr;
  double confidence = 0;  // share of what is drawn that lies on layers which the set knows
};

// The built-in set that knows most of what is drawn, walls among it; "none" if no set knows a layer of walls.
[[nodiscard]] LayerChoice ChooseLayerRules(const std::vector<LayerWeight>& layers);

}  // namespace plumb::compiler
