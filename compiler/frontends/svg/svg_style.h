// How SVG elements are painted, as far as it tells lines from fills: presentation attributes, `style`, and style sheets by element, class
// and id.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::compiler {

struct SvgPaint {
  bool drawn = true;
  uint32_t rgb = 0;
  [[nodiscard]] double luminance() const;  // 0 black, 1 white
};

// Inherited by what an element contains.
struct SvgStyle {
  SvgPaint fill, stroke{false, 0};
  bool fill_clear = false, stroke_clear = false;  // by their opacity
  double stroke_width = 1;  // user units
  double font_size = 16;    // user units
  double text_anchor = 0;   // share of a text's width left of its point
  bool visible = true;
  [[nodiscard]] bool fills() const { return visible && fill.drawn && !fill_clear; }
  [[nodiscard]] bool strokes() const { return visible && stroke.drawn && !stroke_clear && stroke_width > 0; }
};

struct SvgDeclaration {
  std::string property, value;
};

// "fill:none; stroke:#000" of a `style` attribute or a rule.
[[nodiscard]] std::vector<SvgDeclaration> ParseSvgDeclarations(std::string_view text);

// The rules of all <style> elements. Selectors of several steps, of attributes and of states are left out.
class SvgStyleSheet {
 public:
  void Add(std::string_view css);
  // Declarations that hold for an element, the strongest last.
  [[nodiscard]] std::vector<const SvgDeclaration*> For(std::string_view element, const std::vector<std::string>& classes,
                                                       std::string_view id) const;

 private:
  struct Rule {
    std::string element, class_name, id;  // empty: any
    int strength = 0;
    std::vector<SvgDeclaration> declarations;
  };
  void AddRule(std::string_view selector, const std::vector<SvgDeclaration>& declarations);
  std::vector<Rule> rules_;
};

// Sets what `declaration` says. False: `display: none`, which nothing within can undo.
bool ApplySvgDeclaration(std::string_view property, std::string_view value, SvgStyle& style);

}  // namespace plumb::compiler
