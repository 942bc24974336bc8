// SVG outlines as points: path data and the basic shapes, curves as steps along them.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace plumb::compiler {

struct SvgOutline {
  std::vector<Eigen::Vector2d> points;
  bool closed = false;  // the last point leads back to the first, which is not repeated
};

struct SvgPathData {
  std::vector<SvgOutline> outlines;
  bool faulty = false;  // it was read up to its first fault, as SVG asks for
};

// All commands of path data, M to Z and m to z, in user units. Curves have steps of at most 3.75 degrees. Stops, faulty, at `max_points`.
[[nodiscard]] SvgPathData ParseSvgPath(std::string_view data, size_t max_points);

[[nodiscard]] SvgOutline SvgRect(double x, double y, double width, double height, double rx, double ry);
[[nodiscard]] SvgOutline SvgEllipse(double cx, double cy, double rx, double ry);

}  // namespace plumb::compiler
