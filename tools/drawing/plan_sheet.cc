#include "tools/drawing/plan_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "schema/source_paths.h"
#include "tools/drawing/dimensions.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/room_labels.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

// Units of the sheet: 0.1 mm.
constexpr double kMargin = 30, kFooter = 210, kLongSide = 4000, kShortSide = 2770, kLeastWidth = 1500;
constexpr double kScales[] = {50, 100, 200, 500, 1000, 2000, 5000, 10000, 100000};

// Everything of the storey with the dimension lines around it.
Eigen::AlignedBox2d Extent(const AGraph& graph, StoreyId storey, double denominator) {
  Eigen::AlignedBox2d box = BoundsOf(graph, storey);
  const double depth_m = kDimensionDepth * denominator / 1e4;
  for (const DimensionChain& chain : DimensionsOf(graph, storey)) {
    for (const double stop_m : {chain.stops_m.front(), chain.stops_m.back()}) {
      box.extend(Vector2d(stop_m * chain.along + (chain.outward_m + depth_m) * chain.outward));
    }
  }
  return box;
}

Sheet SheetAt(const AGraph& graph, StoreyId storey, double denominator) {
  Eigen::AlignedBox2d box = Extent(graph, storey, denominator);
  if (box.isEmpty()) box.extend(Vector2d::Zero().eval());
  return {box.min(), box.max(), kMargin * denominator / 1e4, denominator};
}

double CommonScale(const AGraph& graph, const std::vector<StoreyId>& storeys) {
  const auto fits = [&](double denominator) {
    return std::all_of(storeys.begin(), storeys.end(), [&](StoreyId storey) {
      const Sheet sheet = SheetAt(graph, storey, denominator);
      const double w = sheet.width(), h = sheet.height() + kFooter;
      return std::max(w, h) <= kLongSide && std::min(w, h) <= kShortSide;
    });
  };
  const auto* it = std::find_if(std::begin(kScales), std::end(kScales), fits);
  return it == std::end(kScales) ? *std::rbegin(kScales) : *it;
}

// `var(--ink)` becomes the value that the style sheet itself declares.
std::string WithoutVariables(const std::string& style) {
  std::map<std::string, std::string> values;
  for (size_t at = style.find("--"); at != std::string::npos; at = style.find("--", at + 2)) {
    const size_t colon = style.find_first_of(":)", at), end = style.find_first_of(";}", at);
    if (colon < end && style[colon] == ':') values.emplace(style.substr(at, colon - at), style.substr(colon + 1, end - colon - 1));
  }
  std::string out;
  for (size_t at = 0; at < style.size();) {
    const size_t use = std::min(style.find("var(", at), style.size());
    out += style.substr(at, use - at);
    if (use == style.size()) break;
    const size_t close = style.find(')', use);
    out += values[style.substr(use + 4, close - use - 4)];
    at = close + 1;
  }
  return out;
}

std::string DrawNorth(double true_north_rad, double x, double y) {
  constexpr double kRadius = 55;
  const double turn_deg = 90 - true_north_rad * 180 / std::numbers::pi;  // clockwise from up
  const double rad = (90 - turn_deg) * std::numbers::pi / 180;
  const Vector2d letter(x + (kRadius + 20) * std::cos(rad), y - (kRadius + 20) * std::sin(rad));
  return fmt::format(
      "<g class=\"north\"><circle class=\"dim\" cx=\"{0}\" cy=\"{1}\" r=\"{2:g}\"/><path class=\"scale\" transform=\"translate({0} {1}) "
      "rotate({3:.2f})\" "
      "d=\"M0 -{2:g}L20 40L0 24Z\"/><path class=\"scale odd\" transform=\"translate({0} {1}) rotate({3:.2f})\" d=\"M0 -{2:g}L-20 40L0 "
      "24Z\"/>"
      "<text x=\"{4}\" y=\"{5}\" font-size=\"26\" font-weight=\"700\">N</text></g>\n",
      Decimal(x), Decimal(y), kRadius, turn_deg, Decimal(letter.x()), Decimal(letter.y() + 9));
}

std::string DrawTitle(const AGraph& graph, StoreyId storey, const Sheet& sheet, double section_height_m, double x, double y) {
  const Storey& s = graph.storeys[storey.index()];
  const std::string file = SourceFileNames(graph.source_path);
  return fmt::format(
      "<text class=\"title\" x=\"{0}\" y=\"{1}\" font-size=\"42\" font-weight=\"600\">{2}</text>"
      "<text class=\"title\" x=\"{0}\" y=\"{3}\" font-size=\"24\">floor plan 1:{4:g}, storey at {5} m, cut {6:.2f} m above; measures in "
      "m</text>"
      "<text class=\"title\" x=\"{0}\" y=\"{7}\" font-size=\"24\">{8}</text>\n",
      Decimal(x), Decimal(y), EscapeXml(s.name), Decimal(y + 40), sheet.denominator(), Signed(s.elevation_m, 2), section_height_m,
      Decimal(y + 74), EscapeXml(file));
}

std::string DrawStorey(const AGraph& graph, StoreyId storey, const Sheet& sheet, const FloorPlanOptions& options, double width) {
  const double foot = sheet.height();
  // In a window of its own: the cut passes through walls of other storeys, too, which may reach far beyond this one's.
  std::string out =
      fmt::format("<svg width=\"{}\" height=\"{}\">\n{}{}{}</svg>\n", Decimal(sheet.width()), Decimal(foot),
                  DrawFloorPlan(graph, storey, sheet, options), DrawDimensions(graph, storey, sheet), DrawRoomLabels(graph, storey, sheet));
  out += DrawTitle(graph, storey, sheet, SectionHeight(graph, storey, options), kMargin + 20, foot + 30);
  out += DrawScaleBar(sheet, kMargin + 20, foot + 130);
  if (graph.true_north_rad) out += DrawNorth(*graph.true_north_rad, width - 140, foot + 90);
  return out;
}

}  // namespace

std::vector<StoreyId> DrawnStoreys(const AGraph& graph) {
  std::vector<StoreyId> out;
  for (size_t i = 0; i < graph.storeys.size(); ++i) {
    if (!BoundsOf(graph, StoreyId(i)).isEmpty()) out.emplace_back(i);
  }
  return out;
}

std::string DrawScaleBar(const Sheet& sheet, double x, double y) {
  double metres = 1;
  int steps = 5;  // each of 1, 2 or 5 of a power of ten
  for (const double m : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    if (sheet.Length(m) > 600) break;
    metres = m;
    steps = m == 2 || m == 20 || m == 200 ? 4 : 5;
  }
  const double step = sheet.Length(metres) / steps;
  std::string out;
  for (int i = 0; i < steps; ++i) {
    fmt::format_to(std::back_inserter(out), "<rect class=\"scale{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"8\"/>",
                   i % 2 == 0 ? "" : " odd", Decimal(x + i * step), Decimal(y), Decimal(step));
  }
  for (const int i : {0, 1, steps}) {
    fmt::format_to(std::back_inserter(out), "<text x=\"{}\" y=\"{}\" font-size=\"18\">{:g}{}</text>", Decimal(x + i * step),
                   Decimal(y + 28), metres * i / steps, i == steps ? " m" : "");
  }
  return out + "\n";
}

std::string FloorPlansToSvg(const AGraph& graph, const std::vector<StoreyId>& storeys, const FloorPlanOptions& options) {
  const double denominator = CommonScale(graph, storeys);
  double width = kLeastWidth, height = 0;
  for (const StoreyId storey : storeys) {
    const Sheet sheet = SheetAt(graph, storey, denominator);
    width = std::max(width, sheet.width());
    height += sheet.height() + kFooter;
  }
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plan\" viewBox=\"0 0 {0} {1}\" width=\"{2:.2f}mm\" "
      "height=\"{3:.2f}mm\">\n<style>\n{4}"
      ".plan .title{{text-anchor:start}}\n</style>\n<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>\n",
      Decimal(width), Decimal(height), width / 10, height / 10, WithoutVariables(FloorPlanStyle()));
  double y = 0;
  for (const StoreyId storey : storeys) {
    const Sheet sheet = SheetAt(graph, storey, denominator);
    fmt::format_to(std::back_inserter(out), "<g class=\"storey\" id=\"storey-{}\" transform=\"translate(0 {})\">\n{}</g>\n", storey.value,
                   Decimal(y), DrawStorey(graph, storey, sheet, options, width));
    y += sheet.height() + kFooter;
  }
  return out + "</svg>\n";
}

}  // namespace plumb::tools
