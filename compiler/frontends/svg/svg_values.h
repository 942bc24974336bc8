// Numbers, lengths, transforms and view boxes as SVG 1.1 and 2 write them in attributes.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>
#include <vector>

namespace plumb::compiler {

// Reads through numbers that white space, commas or nothing at all part: "1.5.5-3e2" are three. Locale plays no part.
class SvgScanner {
 public:
  explicit SvgScanner(std::string_view text) : rest_(text) {}

  // The next number; none where something else stands, which stays. Numbers that are not finite are none.
  std::optional<double> Number();
  std::optional<bool> Flag();  // of an arc: one digit, which the next number may touch
  void SkipSpace();
  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] char front() const { return rest_.front(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  void Skip(size_t count) { rest_.remove_prefix(count); }

 private:
  std::string_view rest_;
};

// A length in user units: px is one, physical units have 96 px to the inch, % is of `whole`. None: no length.
[[nodiscard]] std::optional<double> SvgLength(std::string_view text, double whole);
// Metres on paper of a length with a physical unit (mm, cm, m, in, pt, pc); none: px, %, or no length.
[[nodiscard]] std::optional<double> SvgPhysicalLength_m(std::string_view text);
// All numbers of a list; what follows the first fault is left out.
[[nodiscard]] std::vector<double> SvgNumbers(std::string_view text);
// A `transform` attribute. None: no transform list.
[[nodiscard]] std::optional<Eigen::Affine2d> SvgTransform(std::string_view text);

struct SvgViewBox {
  double x = 0, y = 0, width = 0, height = 0;
};
// None: not four numbers, or no area.
[[nodiscard]] std::optional<SvgViewBox> ParseSvgViewBox(std::string_view text);
// From the coordinates of `box` to a viewport of that size, as `preserveAspectRatio` says (empty: xMidYMid meet).
[[nodiscard]] Eigen::Affine2d SvgViewport(const SvgViewBox& box, double width, double height, std::string_view aspect);

}  // namespace plumb::compiler
