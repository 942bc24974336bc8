// The whole compiler: a plan file in, an A-Graph and diagnostics out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/drawing_file.h"
#include "schema/agraph.h"

namespace plumb::compiler {

#ifdef NDEBUG
inline constexpr bool kVerifyByDefault = false;
#else
inline constexpr bool kVerifyByDefault = true;
#endif

// One storey of a plan that is drawn storey by storey.
struct StoreyDrawing {
  std::string name, path;
  double elevation_m = 0;
};

struct CompileOptions {
  double section_height_m = 1.1;          // walls are cut here above the storey's zero to get their footprints
  double snap_radius_m = 0.002;           // vertices of the planar map closer than this become one
  double min_room_area_m2 = 0.5;          // smaller faces between walls are shafts or gaps, no rooms, but for closets with a door
  double max_gap_m = 0.2;                 // walls closer than this are taken to meet where that keeps two rooms apart
  bool divide_open_plans = true;          // along the source's spaces where no walls do; false: one room
  std::string unit;                       // of drawings and meshes: m, cm, mm, in or ft; empty: as stated by the file or seen in its walls
  std::string up;                         // of meshes: x, y or z; empty: as stated by the file or seen in its walls
  std::vector<std::string> model_path;    // of Gazebo worlds: folders besides the world's own that hold included models
  bool verify_stages = kVerifyByDefault;  // check the invariants of every intermediate form; a fault is an InternalError
  DrawingFileOptions drawing;             // for drawings: DXF, SVG
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

struct CompileResult {
  std::optional<AGraph> graph;  // none: the plan was not usable, and an error among the diagnostics says why
  DiagnosticSink diagnostics;
  // True if the fault is the compiler's or its caller's, not the plan's.
  [[nodiscard]] bool has_internal_error() const;
};

// Reads and compiles the plan at `path`. Never throws; invalid options are an InternalError. Same file and options, same graph.
[[nodiscard]] CompileResult Compile(const std::string& path, const CompileOptions& options = {});
// Several drawings as the storeys of one plan; its source is the first one.
[[nodiscard]] CompileResult CompileStoreys(const std::vector<StoreyDrawing>& storeys, const CompileOptions& options = {});

}  // namespace plumb::compiler
