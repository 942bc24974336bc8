// A plan as lines and texts on a sheet, whatever file they come from: what the formats that draw (rather than model) walls have in common.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// What the source says that a line stands for. `kAny`: it says nothing, so that its shape must tell.
enum class LineRole : uint8_t {
  kAny,
  kWall,
  kColumn,
  kDoor,
  kWindow,
  kOpening,  // a door or a window
  kPassage   // an opening that nothing fills
};

struct DrawnPath {
  LineRole role = LineRole::kAny;
  std::vector<Eigen::Vector2d> points;
  bool closed = false;            // the last point leads back to the first, which is not repeated
  bool filled = false;            // a hatch or a solid fill: its inside is material
  bool outlines_room = false;     // the side of a room as well as of the walls around it, also across doorways
  bool curved = false;            // the points are steps along a curve, not corners
  std::vector<Arc> arcs;          // the exact arcs among its sides
  double stroke_m = 0;            // how thick the line is drawn; 0: no more than it must be to be seen
  uint32_t layer = 0;             // the source's, by number: what is drawn alike
  uint32_t symbol = 0xffffffffu;  // paths of one symbol (a block, a group) have the same number
  SourceLocation location;
};

struct DrawnText {
  std::string text;                              // one line
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // its middle, as far as the source tells
  double height_m = 0;
  bool underlined = false;
  bool names_room = false;  // stated by the source (a layer for names of rooms)
  SourceLocation location;
};

// A room that the source draws as such, whatever its walls.
struct DrawnSpace {
  std::string name;  // if no text in it names it
  std::vector<Eigen::Vector2d> outline;
  SourceLocation location;
};

struct Drawing {
  std::vector<DrawnPath> paths;
  std::vector<DrawnText> texts;
  std::vector<DrawnSpace> spaces;
};

}  // namespace plumb::compiler
