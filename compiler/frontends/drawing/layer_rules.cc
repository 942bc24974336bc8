#include "compiler/frontends/drawing/layer_rules.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "compiler/frontends/drawing/layer_rule_sets.h"
#include "schema/files.h"

namespace plumb::compiler {
namespace {

constexpr std::array<std::pair<std::string_view, LayerUse>, 8> kUses = {{{"wall", LayerUse::kWall},
                                                                         {"column", LayerUse::kColumn},
                                                                         {"door", LayerUse::kDoor},
                                                                         {"window", LayerUse::kWindow},
                                                                         {"opening", LayerUse::kOpening},
                                                                         {"passage", LayerUse::kPassage},
                                                                         {"room-name", LayerUse::kRoomName},
                                                                         {"ignore", LayerUse::kIgnore}}};
constexpr size_t kMaxRuleBytes = 1 << 20;
constexpr double kKnownEnough = 0.02;  // share of what is drawn that walls must have for a set to be chosen

// Upper-case ASCII and the letters of Latin-1 in UTF-8 in lower case.
std::string Lower(std::string_view text) {
  std::string out(text);
  for (size_t i = 0; i < out.size(); ++i) {
    const auto c = static_cast<unsigned char>(out[i]);
    if (c < 0x80) out[i] = static_cast<char>(std::tolower(c));
    if (i > 0 && static_cast<unsigned char>(out[i - 1]) == 0xc3 && c >= 0x80 && c <= 0x9e && c != 0x97)
      out[i] = static_cast<char>(c + 0x20);
  }
  return out;
}

// `*` stands for anything, `?` for one byte. Greedy with one step back: linear in practice, and bounded by the product of the lengths.
bool Fits(std::string_view pattern, std::string_view text) {
  size_t p = 0, t = 0, star = std::string_view::npos, mark = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::string_view LastPart(std::string_view layer) {
  if (const size_t bar = layer.rfind('|'); bar != std::string_view::npos) layer.remove_prefix(bar + 1);
  // A bound reference: name$0$layer.
  for (size_t at = layer.rfind('$'); at != std::string_view::npos && at > 0; at = layer.rfind('$', at - 1)) {
    const size_t before = layer.rfind('$', at - 1);
    if (before == std::string_view::npos) break;
    const std::string_view number = layer.substr(before + 1, at - before - 1);
    if (!number.empty() && std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }))
      return layer.substr(at + 1);
  }
  return layer;
}

std::vector<std::string_view> Words(std::string_view name) {
  std::vector<std::string_view> out;
  size_t start = 0;
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80; };
  for (size_t i = 0; i <= name.size(); ++i) {
    if (i < name.size() && is_letter(name[i])) continue;
    if (i > start) out.push_back(name.substr(start, i - start));
    start = i + 1;
  }
  return out;
}

Expected<std::vector<std::string>> Patterns(const toml::table& rule, std::string_view key, const std::string& source) {
  std::vector<std::string> out;
  const toml::node* node = rule.get(key);
  if (node == nullptr) return out;
  if (!node->is_array()) return Fail(ErrorCode::kBadOption, fmt::format("{}: `{}` must be an array of strings", source, key));
  for (const toml::node& entry : *node->as_array()) {
    const auto text = entry.value<std::string>();
    if (!text) return Fail(ErrorCode::kBadOption, fmt::format("{}: `{}` must be an array of strings", source, key));
    out.push_back(Lower(*text));
  }
  return out;
}

}  // namespace

LineRole RoleOf(LayerUse use) {
  switch (use) {
    case LayerUse::kWall: return LineRole::kWall;
    case LayerUse::kColumn: return LineRole::kColumn;
    case LayerUse::kDoor: return LineRole::kDoor;
    case LayerUse::kWindow: return LineRole::kWindow;
    case LayerUse::kOpening: return LineRole::kOpening;
    case LayerUse::kPassage: return LineRole::kPassage;
    default: return LineRole::kAny;
  }
}

bool IsSymbolUse(LayerUse use) {
  return use == LayerUse::kDoor || use == LayerUse::kWindow || use == LayerUse::kOpening || use == LayerUse::kPassage;
}

Expected<LayerRules> LayerRules::Parse(std::string_view text, const std::string& source) {
  const auto bad = [&](const std::string& what) { return Fail(ErrorCode::kBadOption, fmt::format("{}: {}", source, what)); };
  toml::table table;
  try {
    table = toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    return bad(fmt::format("line {}: {}", e.source().begin.line, e.description()));
  }
  for (const auto& [key, value] : table) {
    if (key.str() != "name" && key.str() != "rule") return bad(fmt::format("unknown key `{}`; there are `name` and `[[rule]]`", key.str()));
  }
  LayerRules out;
  out.name_ = table["name"].value_or(source);
  const toml::array* rules = table["rule"].as_array();
  if (rules == nullptr) return bad("there is no `[[rule]]`");
  for (const toml::node& node : *rules) {
    const toml::table* rule = node.as_table();
    if (rule == nullptr) return bad("a rule is a table");
    for (const auto& [key, value] : *rule) {
      if (key.str() != "use" && key.str() != "layers" && key.str() != "names")
        return bad(fmt::format("unknown key `{}` of a rule; there are `use`, `layers` and `names`", key.str()));
    }
    Rule entry;
    const std::string use = (*rule)["use"].value_or(std::string());
    const auto known = std::find_if(kUses.begin(), kUses.end(), [&](const auto& u) { return u.first == use; });
    if (known == kUses.end())
      return bad(fmt::format("`use = \"{}\"`; must be wall, column, door, window, opening, passage, room-name or ignore", use));
    entry.use = known->second;
    auto words = Patterns(*rule, "layers", source), names = Patterns(*rule, "names", source);
    if (!words) return tl::unexpected(words.error());
    if (!names) return tl::unexpected(names.error());
    entry.words = std::move(*words);
    entry.names = std::move(*names);
    out.rules_.push_back(std::move(entry));
  }
  return out;
}

LayerUse LayerRules::UseOf(std::string_view layer) const {
  const std::string name = Lower(LastPart(layer));
  const std::vector<std::string_view> words = Words(name);
  for (const Rule& rule : rules_) {
    for (const std::string& pattern : rule.names) {
      if (Fits(pattern, name)) return rule.use;
    }
    for (const std::string& pattern : rule.words) {
      if (std::any_of(words.begin(), words.end(), [&](std::string_view w) { return Fits(pattern, w); })) return rule.use;
    }
  }
  return LayerUse::kUnknown;
}

const std::vector<LayerRules>& BuiltInLayerRules() {
  static const std::vector<LayerRules> sets = [] {
    std::vector<LayerRules> out;
    for (const char* text : kLayerRuleSets) out.push_back(*LayerRules::Parse(text, "built in"));
    return out;
  }();
  return sets;
}

Expected<LayerRules> LoadLayerRules(const std::string& name_or_path) {
  std::string known;
  for (const LayerRules& set : BuiltInLayerRules()) {
    if (set.name() == name_or_path) return set;
    known += (known.empty() ? "" : ", ") + set.name();
  }
  Expected<std::string> text = ReadFileText(name_or_path, kMaxRuleBytes);
  if (!text)
    return Fail(ErrorCode::kBadOption, fmt::format("`{}` is neither a built-in set of layer rules ({}) nor a file: {}", name_or_path, known,
                                                   text.error().message));
  return LayerRules::Parse(*text, name_or_path);
}

LayerChoice ChooseLayerRules(const std::vector<LayerWeight>& layers) {
  double total = 0;
  for (const LayerWeight& layer : layers) total += layer.weight;
  LayerChoice best;
  for (const LayerRules& set : BuiltInLayerRules()) {
    double known = 0, walls = 0;
    for (const LayerWeight& layer : layers) {
      const LayerUse use = set.UseOf(layer.name);
      if (use != LayerUse::kUnknown) known += layer.weight;
      if (use == LayerUse::kWall) walls += layer.weight;
    }
    const double share = total > 0 ? known / total : 0;
    if (walls >= kKnownEnough * total && walls > 0 && share > best.confidence) best = {&set, share};
  }
  if (best.rules == nullptr) best = {&BuiltInLayerRules().back(), 0};
  return best;
}

}  // namespace plumb::compiler
