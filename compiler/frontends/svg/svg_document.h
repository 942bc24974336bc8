// An SVG file as shapes and texts with all transforms applied and all <use> elements unfolded; y up, in the user units of the root's
// viewBox.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/svg/svg_path.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

inline constexpr uint32_t kNoSvgNode = 0xffffffffu;

// An element that has a name: the layers and classes that tell what is drawn.
struct SvgNode {
  uint32_t parent = kNoSvgNode;
  std::vector<std::string> names;  // its layer's label, its classes, its id; ids that programs number are none
};

struct SvgShape {
  uint32_t node = kNoSvgNode;  // innermost
  std::vector<SvgOutline> outlines;
  bool strokes = false, fills = false;
  double fill_luminance = 1;  // 0 black, 1 white
  double stroke_width = 0;    // user units
  uint32_t stroke_rgb = 0;
  SourceLocation location;
};

struct SvgText {
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // its middle
  double height = 0;
  uint32_t node = kNoSvgNode;
  SourceLocation location;
};

struct SvgDocument {
  std::vector<SvgNode> nodes;  // parents first
  std::vector<SvgShape> shapes;
  std::vector<SvgText> texts;
  std::optional<double> unit_on_paper_m;  // metres of a user unit as the root's size and viewBox state them
  std::map<std::string, size_t> not_read;  // elements that are drawn, but not read, and how many
  std::set<std::string> hidden_layers;
};

struct SvgReadOptions {
  int max_depth = 16;               // of <use> within each other
  size_t max_points = 3'000'000;
  size_t max_elements = 2'000'000;  // with those that <use> repeats
};

// None: no SVG, nested too deep, or too large, and an error says so.
[[nodiscard]] std::optional<SvgDocument> ReadSvgDocument(const Source& source, const SvgReadOptions& options, DiagnosticSink& sink);

}  // namespace plumb::compiler
