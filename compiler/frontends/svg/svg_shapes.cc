#include "compiler/frontends/svg/svg_shapes.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/frontends/svg/svg_values.h"

namespace plumb::compiler {

using Eigen::Vector2d;
using tinyxml2::XMLElement;

std::string_view SvgAttribute(const XMLElement& e, const char* name) {
  const char* value = e.Attribute(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

double SvgLengthOf(const XMLElement& e, const char* name, double whole, double otherwise) {
  return SvgLength(SvgAttribute(e, name), whole).value_or(otherwise);
}

std::vector<SvgOutline> SvgOutlinesOf(const XMLElement& e, std::string_view kind, const Vector2d& viewport, size_t max_points,
                                      bool& faulty) {
  const double w = viewport.x(), h = viewport.y(), diagonal = std::sqrt(0.5) * viewport.norm();
  if (kind == "line")
    return {{{{SvgLengthOf(e, "x1", w), SvgLengthOf(e, "y1", h)}, {SvgLengthOf(e, "x2", w), SvgLengthOf(e, "y2", h)}}, false}};
  if (kind == "circle") {
    const double r = SvgLengthOf(e, "r", diagonal);
    return r > 0 ? std::vector{SvgEllipse(SvgLengthOf(e, "cx", w), SvgLengthOf(e, "cy", h), r, r)} : std::vector<SvgOutline>();
  }
  if (kind == "ellipse") {
    const double rx = SvgLengthOf(e, "rx", w), ry = SvgLengthOf(e, "ry", h);
    return rx > 0 && ry > 0 ? std::vector{SvgEllipse(SvgLengthOf(e, "cx", w), SvgLengthOf(e, "cy", h), rx, ry)} : std::vector<SvgOutline>();
  }
  if (kind == "rect") {
    const double width = SvgLengthOf(e, "width", w), height = SvgLengthOf(e, "height", h),
                 rx = SvgLengthOf(e, "rx", w, SvgLengthOf(e, "ry", h));
    if (!(width > 0 && height > 0)) return {};
    return {SvgRect(SvgLengthOf(e, "x", w), SvgLengthOf(e, "y", h), width, height, rx, SvgLengthOf(e, "ry", h, rx))};
  }
  if (kind == "path") {
    SvgPathData path = ParseSvgPath(SvgAttribute(e, "d"), max_points);
    faulty = path.faulty;
    return std::move(path.outlines);
  }
  const std::vector<double> numbers = SvgNumbers(SvgAttribute(e, "points"));
  SvgOutline out;
  for (size_t i = 0; i + 1 < numbers.size(); i += 2) out.points.emplace_back(numbers[i], numbers[i + 1]);
  out.closed = kind == "polygon" && out.points.size() > 2;
  if (out.points.size() > 2 && out.points.front() == out.points.back()) out.points.pop_back(), out.closed = true;
  return out.points.size() > 1 ? std::vector{std::move(out)} : std::vector<SvgOutline>();
}

bool ClipSvgOutline(const Eigen::AlignedBox2d& box, SvgOutline& outline) {
  Eigen::AlignedBox2d own;
  for (const Vector2d& p : outline.points) own.extend(p);
  if (box.contains(own)) return true;
  if (!box.intersects(own)) return false;
  if (outline.points.size() != 2) return true;
  const Vector2d a = outline.points[0], d = outline.points[1] - a;
  double from = 0, to = 1;
  for (int k = 0; k < 2; ++k) {
    if (d[k] == 0) continue;
    const auto [lo, hi] = std::minmax({(box.min()[k] - a[k]) / d[k], (box.max()[k] - a[k]) / d[k]});
    from = std::max(from, lo);
    to = std::min(to, hi);
  }
  if (from >= to) return false;
  outline.points = {a + from * d, a + to * d};
  return true;
}

}  // namespace plumb::compiler
