// The shapes of an SVG file as lines with the meaning of their groups.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/layer_rules.h"
#include "compiler/frontends/svg/svg_document.h"

namespace plumb::compiler {

// How much is drawn under each name, for the choice of rules.
[[nodiscard]] std::vector<LayerWeight> WeighNames(const SvgDocument& document);

// In user units. What a group stands for holds for all that it contains, unless a group within says something else; rooms that are drawn
// as such become spaces, and lines as well where nothing is drawn as a wall.
[[nodiscard]] Drawing DrawingFromSvg(const SvgDocument& document, const LayerRules& rules);

}  // namespace plumb::compiler
