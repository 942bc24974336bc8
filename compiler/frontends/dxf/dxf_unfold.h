// The entities of a DXF file with all blocks unfolded, as lines with the meaning of their layers.
#pragma once

#include <functional>

#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/layer_rules.h"
#include "compiler/frontends/dxf/dxf_document.h"

namespace plumb::compiler {

struct UnfoldOptions {
  int max_depth = 16;
  size_t max_paths = 4'000'000;
  int max_copies = 100'000;  // of a block by one reference
};

// How much is drawn on each layer, for the choice of rules.
[[nodiscard]] std::vector<LayerWeight> WeighLayers(const DxfDocument& document);

// In the drawing's unit. None: too much comes of it, and an error says so.
[[nodiscard]] std::optional<Drawing> Unfold(const DxfDocument& document, const LayerRules& rules, const UnfoldOptions& options,
                                            DiagnosticSink& sink);

}  // namespace plumb::compiler
