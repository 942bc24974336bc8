// Shape elements of an SVG as outlines, in the user units of the place where they stand.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string_view>
#include <vector>

#include "compiler/frontends/svg/svg_path.h"

namespace tinyxml2 {
class XMLElement;
}  // namespace tinyxml2

namespace plumb::compiler {

// Empty where the attribute is not stated.
[[nodiscard]] std::string_view SvgAttribute(const tinyxml2::XMLElement& element, const char* name);
// A length in user units, % of `whole`; `otherwise` where none is stated.
[[nodiscard]] double SvgLengthOf(const tinyxml2::XMLElement& element, const char* name, double whole, double otherwise = 0);

// `kind`: line, circle, ellipse, rect, path, polyline or polygon. Empty where a measure is not positive. Sets `faulty` where path data is
// read up to a fault, the `max_points`-th point being one.
[[nodiscard]] std::vector<SvgOutline> SvgOutlinesOf(const tinyxml2::XMLElement& element, std::string_view kind,
                                                    const Eigen::Vector2d& viewport, size_t max_points, bool& faulty);

// The part of a straight line within `box`; what is not straight stays whole as long as some of it may be within. False: nothing is.
[[nodiscard]] bool ClipSvgOutline(const Eigen::AlignedBox2d& box, SvgOutline& outline);

}  // namespace plumb::compiler
