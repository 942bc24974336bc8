// Drawings built path by path, for tests.
#pragma once

#include <string>
#include <utility>

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler::test {

// A closed outline; its location's id is its number in the drawing.
inline void AddBox(double x0, double y0, double x1, double y1, Drawing& drawing) {
  DrawnPath path;
  path.points = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  path.closed = true;
  path.location.guid = std::to_string(drawing.paths.size());
  drawing.paths.push_back(std::move(path));
}

}  // namespace plumb::compiler::test
