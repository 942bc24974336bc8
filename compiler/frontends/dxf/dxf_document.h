// A DXF file as entities and blocks, in the drawing's own unit. What dxflib reads, with handle, layer and line of each.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// A line or curve, flattened; arcs are kept beside it.
struct DxfPath {
  std::vector<Eigen::Vector2d> points;
  bool closed = false, filled = false, curved = false;
  std::vector<Arc> arcs;  // in the drawing's unit
};

struct DxfText {
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double height = 0;
  bool underlined = false;
};

struct DxfInsert {
  std::string block;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), scale = Eigen::Vector2d::Ones(), spacing = Eigen::Vector2d::Zero();
  double angle_rad = 0;
  int columns = 1, rows = 1;
};

struct DxfEntity {
  uint32_t layer = 0;  // in DxfDocument::layers
  uint32_t handle = 0xffffffffu;
  uint32_t line = 0;
  std::string_view type;  // one of those that are read
  bool mirrored = false;  // drawn on the back of the plane (extrusion 0 0 -1): x is -x
  std::vector<DxfPath> paths;
  std::vector<DxfText> texts;
  std::optional<DxfInsert> insert;
};

struct DxfBlock {
  Eigen::Vector2d base = Eigen::Vector2d::Zero();
  std::vector<DxfEntity> entities;
};

struct DxfLayer {
  std::string name;
  bool hidden = false;  // off or frozen
};

struct DxfDocument {
  std::vector<DxfLayer> layers;
  std::map<std::string, DxfBlock> blocks;
  std::vector<DxfEntity> entities;   // of the model space
  std::map<std::string, size_t> not_read;  // types of entities and how many
  std::optional<int> insunits, measurement;
  std::string version;
};

struct DxfReadOptions {
  double chord_share = 0.0006;  // of a curve's radius, between it and its steps
  size_t max_points = 20'000'000;
};

// None: no DXF syntax, cut off, or too large, and an error says so.
[[nodiscard]] std::optional<DxfDocument> ReadDxfDocument(const std::string& bytes, const DxfReadOptions& options, DiagnosticSink& sink);

}  // namespace plumb::compiler
