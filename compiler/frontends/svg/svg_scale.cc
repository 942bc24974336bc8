#include "compiler/frontends/svg/svg_scale.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace plumb::compiler {
namespace {

constexpr double kPixel_m = 0.0254 / 96;      // where no other length of a unit on paper is stated
constexpr double kMinRatio = 10, kMaxRatio = 5000;
constexpr double kCloseUnit = 0.12, kCloseRatio = 0.2;  // of the usual size, for a unit or ratio to be what was meant
constexpr double kLargestPaper_m = 4;
constexpr double kUsualPlan_m = 30;           // if there is nothing else to go by
constexpr std::array kUsualRatios = {20.0, 25.0, 50.0, 100.0, 200.0, 250.0, 500.0, 1000.0};
constexpr std::array kUsualUnits = {"mm", "cm", "m", "in", "ft"};

double ScaleBySizes(const DrawnSizes& sizes, const UnitOptions& options) {
  if (sizes.door > 0) return options.usual_door_m / sizes.door;
  if (sizes.wall > 0 && options.usual_wall_m / sizes.wall * sizes.extent < 20 * kUsualPlan_m) return options.usual_wall_m / sizes.wall;
  return sizes.extent > 0 ? kUsualPlan_m / sizes.extent : 1;
}

double Misfit(double a, double b) { return std::abs(std::log(a / b)); }

ScaleChoice Choice(double metres, ScaleChoice::Origin origin, const std::string& why, const DrawnSizes& sizes) {
  return {metres, origin, fmt::format("{}; {}", why, DescribeSizes(sizes, {fmt::format("units of {:.4g} m", metres), metres}))};
}

}  // namespace

std::vector<double> RatiosIn(const Drawing& drawing) {
  std::vector<double> out;
  for (const DrawnText& text : drawing.texts) {
    std::string_view rest = text.text;
    const size_t one = rest.find("1:") != std::string_view::npos ? rest.find("1:") : rest.find("1 :");
    if (one == std::string_view::npos || (one > 0 && std::isdigit(static_cast<unsigned char>(rest[one - 1])) != 0)) continue;
    rest.remove_prefix(rest.find(':', one) + 1);
    while (rest.starts_with(' ')) rest.remove_prefix(1);
    double ratio = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), ratio);
    if (error == std::errc() && ratio >= kMinRatio && ratio <= kMaxRatio) out.push_back(ratio);
  }
  return out;
}

ScaleChoice ChooseScale(const DrawnSizes& sizes, const std::optional<double>& unit_on_paper_m, const std::vector<double>& ratios, const UnitOptions& options) {
  using Origin = ScaleChoice::Origin;
  // Walls that are drawn as single lines lie as far apart as rooms are wide: they count only where there is nothing better.
  DrawnSizes firm = sizes;
  if (sizes.door > 0 || sizes.extent * unit_on_paper_m.value_or(0) > kLargestPaper_m) firm.wall = 0;
  const bool no_evidence = sizes.extent == 0 || (sizes.wall == 0 && sizes.door == 0 && sizes.extent * unit_on_paper_m.value_or(0) > kLargestPaper_m);
  if (unit_on_paper_m && (no_evidence || SizesHold(firm, *unit_on_paper_m, options))) return {*unit_on_paper_m, Origin::kStated, {}};
  const double on_paper_m = unit_on_paper_m.value_or(kPixel_m);
  for (const double ratio : ratios) {
    if (SizesHold(firm, ratio * on_paper_m, options)) return Choice(ratio * on_paper_m, Origin::kRatio, fmt::format("a text states 1:{:g}", ratio), sizes);
  }
  const double seen = ScaleBySizes(sizes, options);
  const std::string page = unit_on_paper_m ? fmt::format("the page has user units of {:.4g} m, in which nothing has the size of a building", on_paper_m)
                                           : "the file does not state how long its user unit is";
  double best = kCloseUnit, metres = seen;
  for (const char* name : kUsualUnits) {
    const double unit = FindUnit(name)->metres;
    if (SizesHold(sizes, unit, options) && Misfit(unit, seen) < best) best = Misfit(unit, seen), metres = unit;
  }
  if (metres != seen || !unit_on_paper_m) return Choice(metres, Origin::kSizes, page, sizes);
  best = kCloseRatio;
  for (const double ratio : kUsualRatios) {
    if (Misfit(ratio * on_paper_m, seen) < best) best = Misfit(ratio * on_paper_m, seen), metres = ratio * on_paper_m;
  }
  return Choice(metres, Origin::kSizes, page, sizes);
}

}  // namespace plumb::compiler
