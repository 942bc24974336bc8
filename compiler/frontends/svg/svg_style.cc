#include "compiler/frontends/svg/svg_style.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "compiler/frontends/svg/svg_values.h"

namespace plumb::compiler {
namespace {

constexpr size_t kMaxRules = 500;  // each is tried on each element

struct NamedColor {
  std::string_view name;
  uint32_t rgb;
};
constexpr std::array<NamedColor, 12> kColors = {{{"black", 0}, {"white", 0xffffff}, {"red", 0xff0000}, {"green", 0x8000}, {"blue", 0xff},
                                                 {"gray", 0x808080}, {"grey", 0x808080}, {"silver", 0xc0c0c0}, {"lightgray", 0xd3d3d3},
                                                 {"lightgrey", 0xd3d3d3}, {"darkgray", 0xa9a9a9}, {"yellow", 0xffff00}}};
constexpr uint32_t kOtherColor = 0x909090;  // of names that are not in the table

std::string_view Trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

uint32_t HexColor(std::string_view digits) {
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return kOtherColor;
  if (digits.size() == 8) return value >> 8;
  if (digits.size() != 3) return value;
  const uint32_t r = value >> 8 & 15, g = value >> 4 & 15, b = value & 15;
  return r * 0x110000 + g * 0x1100 + b * 0x11;
}

uint32_t RgbColor(std::string_view text) {
  uint32_t out = 0;
  SvgScanner scanner(text.substr(text.find('(') + 1));
  for (int i = 0; i < 3; ++i) {
    const double v = scanner.Number().value_or(0);
    const bool percent = !scanner.at_end() && scanner.front() == '%';
    if (percent) scanner.Skip(1);
    out = out << 8 | static_cast<uint32_t>(std::clamp(percent ? 2.55 * v : v, 0.0, 255.0));
  }
  return out;
}

SvgPaint PaintOf(std::string_view value) {
  if (value == "none" || value == "transparent") return {false, 0};
  if (value.starts_with('#')) return {true, HexColor(value.substr(1))};
  if (value.starts_with("rgb")) return {true, RgbColor(value)};
  if (value.starts_with("url(")) return {true, 0xffffff};  // a pattern or gradient is no poché
  if (value == "currentColor") return {true, 0};
  const auto known = std::find_if(kColors.begin(), kColors.end(), [&](const NamedColor& c) { return c.name == value; });
  return {true, known == kColors.end() ? kOtherColor : known->rgb};
}

std::string WithoutComments(std::string_view css) {
  std::string out;
  for (size_t at = 0; at < css.size();) {
    const size_t open = css.find("/*", at);
    out += css.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const size_t close = css.find("*/", open + 2);
    if (close == std::string_view::npos) break;
    at = close + 2;
  }
  return out;
}

}  // namespace

double SvgPaint::luminance() const {
  const double r = rgb >> 16 & 255, g = rgb >> 8 & 255, b = rgb & 255;
  return (0.299 * r + 0.587 * g + 0.114 * b) / 255;
}

std::vector<SvgDeclaration> ParseSvgDeclarations(std::string_view text) {
  std::vector<SvgDeclaration> out;
  while (!text.empty()) {
    const size_t end = std::min(text.find(';'), text.size());
    const std::string_view one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const size_t colon = one.find(':');
    if (colon == std::string_view::npos) continue;
    std::string_view value = Trim(one.substr(colon + 1));
    if (const size_t important = value.find('!'); important != std::string_view::npos) value = Trim(value.substr(0, important));
    out.push_back({std::string(Trim(one.substr(0, colon))), std::string(value)});
  }
  return out;
}

void SvgStyleSheet::Add(std::string_view css) {
  const std::string text = WithoutComments(css);
  std::string_view rest = text;
  while (true) {
    const size_t open = rest.find('{');
    const size_t close = open == std::string_view::npos ? open : rest.find('}', open);
    if (close == std::string_view::npos) break;
    std::string_view selectors = rest.substr(0, open);
    const auto declarations = ParseSvgDeclarations(rest.substr(open + 1, close - open - 1));
    rest.remove_prefix(close + 1);
    while (!selectors.empty()) {
      const size_t comma = std::min(selectors.find(','), selectors.size());
      AddRule(Trim(selectors.substr(0, comma)), declarations);
      selectors.remove_prefix(std::min(comma + 1, selectors.size()));
    }
  }
  std::stable_sort(rules_.begin(), rules_.end(), [](const Rule& a, const Rule& b) { return a.strength < b.strength; });
}

void SvgStyleSheet::AddRule(std::string_view selector, const std::vector<SvgDeclaration>& declarations) {
  if (selector.empty() || selector.find_first_of(" >+~[:@\t\n") != std::string_view::npos || rules_.size() >= kMaxRules) return;
  Rule rule;
  const size_t mark = std::min(selector.find_first_of(".#"), selector.size());
  rule.element = selector.substr(0, mark) == "*" ? std::string() : std::string(selector.substr(0, mark));
  if (mark < selector.size()) {
    const std::string_view name = selector.substr(mark + 1);
    if (name.find_first_of(".#") != std::string_view::npos) return;
    (selector[mark] == '#' ? rule.id : rule.class_name) = std::string(name);
  }
  rule.strength = (rule.id.empty() ? 0 : 100) + (rule.class_name.empty() ? 0 : 10) + (rule.element.empty() ? 0 : 1);
  rule.declarations = declarations;
  rules_.push_back(std::move(rule));
}

std::vector<const SvgDeclaration*> SvgStyleSheet::For(std::string_view element, const std::vector<std::string>& classes, std::string_view id) const {
  std::vector<const SvgDeclaration*> out;
  for (const Rule& rule : rules_) {
    if (!rule.element.empty() && rule.element != element) continue;
    if (!rule.id.empty() && rule.id != id) continue;
    if (!rule.class_name.empty() && std::find(classes.begin(), classes.end(), rule.class_name) == classes.end()) continue;
    for (const SvgDeclaration& d : rule.declarations) out.push_back(&d);
  }
  return out;
}

bool ApplySvgDeclaration(std::string_view property, std::string_view value, SvgStyle& style) {
  value = Trim(value);
  if (value == "inherit") return true;
  const auto is_zero = [&] { return SvgLength(value, 1).value_or(1) <= 0; };
  if (property == "display") return value != "none";
  if (property == "opacity") return !is_zero();
  if (property == "visibility") style.visible = value == "visible";
  if (property == "fill") style.fill = PaintOf(value);
  if (property == "stroke") style.stroke = PaintOf(value);
  if (property == "fill-opacity") style.fill_clear = is_zero();
  if (property == "stroke-opacity") style.stroke_clear = is_zero();
  if (property == "stroke-width") style.stroke_width = std::max(0.0, SvgLength(value, 0).value_or(style.stroke_width));
  if (property == "font-size") style.font_size = std::max(0.0, SvgLength(value, style.font_size).value_or(style.font_size));
  if (property == "text-anchor") style.text_anchor = value == "middle" ? 0.5 : value == "end" ? 1 : 0;
  return true;
}

}  // namespace plumb::compiler
