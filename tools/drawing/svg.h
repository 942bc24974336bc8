// Small helpers for writing SVG: escaping, numbers, the sheet's coordinates, colours.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "schema/agraph.h"

namespace plumb::tools {

// Text that comes from files, safe between tags and in attributes.
[[nodiscard]] std::string EscapeXml(std::string_view text);

// A drawing sheet at a scale of 1 to `denominator`: y down, 1 unit = 0.1 mm of paper. At 1:100 a unit is 1 cm of the building.
class Sheet {
 public:
  // What the drawing must hold, plan frame, metres; a margin is added.
  Sheet(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi, double margin_m, double denominator = 100);

  [[nodiscard]] double denominator() const { return 1e4 / units_per_m_; }
  [[nodiscard]] double Length(double length_m) const { return units_per_m_ * length_m; }

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] double x(double plan_x_m) const { return Length(plan_x_m - lo_.x()); }
  [[nodiscard]] double y(double plan_y_m) const { return Length(hi_.y() - plan_y_m); }
  // "x y" on the sheet of a point of the plan.
  [[nodiscard]] std::string At(const Eigen::Vector2d& plan_m) const;
  // Path data of an open line or of a closed ring.
  [[nodiscard]] std::string Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  [[nodiscard]] std::string Closed(const Ring& ring) const;

 private:
  Eigen::Vector2d lo_, hi_;
  double units_per_m_ = 100, width_ = 0, height_ = 0;
};

// About how wide text is set in the widest of the common sans-serif faces, in multiples of the font's size.
[[nodiscard]] double TextWidth(std::string_view text, bool bold);

// A number with one decimal, never "-0.0".
[[nodiscard]] std::string Decimal(double value);

// With its sign, a true minus, and `digits` decimals; no sign where it rounds to zero.
[[nodiscard]] std::string Signed(double value, int digits);

// "#rrggbb" of a deviation on a scale from -limit to +limit: purple, grey, orange (told apart by all common kinds of colour blindness).
[[nodiscard]] std::string DeviationColor(double translation_m, double limit_m);

// "#rrggbb" along a run, ratio from 0 to 1: dark blue to yellow, ever lighter.
[[nodiscard]] std::string TimeColor(double ratio);

}  // namespace plumb::tools
