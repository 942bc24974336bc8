#include "tools/report/place_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "tools/report/trajectory_overlay.h"

namespace plumb::tools {
namespace {

constexpr size_t kMost = 20;                             // more are no help
constexpr double kRadius = 13, kArrow = 34, kFont = 17;  // units of a sheet as wide as the page
constexpr double kPage = 1300;
constexpr double kHalfWidth = 0.4;  // of an arrow's head, rad

size_t NumPlaces(const TryRow& attempt) { return std::min(attempt.hypotheses.size(), kMost); }

std::string Arrow(const HypothesisRow& place, size_t number, const Sheet& sheet) {
  const double unit = std::max(1.0, sheet.width() / kPage);
  // Places beyond the sheet are drawn at its edge.
  const double x = std::clamp(sheet.x(place.position_m.x()), unit * kArrow, std::max(unit * kArrow, sheet.width() - unit * kArrow));
  const double y = std::clamp(sheet.y(place.position_m.y()), unit * kArrow, std::max(unit * kArrow, sheet.height() - unit * kArrow));
  const auto corner = [&](double angle_rad, double radius) {  // the sheet's y points down
    return fmt::format("{} {}", Decimal(x + radius * std::cos(angle_rad)), Decimal(y - radius * std::sin(angle_rad)));
  };
  return fmt::format(
      "<g class=\"mark place\" opacity=\"{}\"><path d=\"M{}L{}L{}Z\"/><circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>"
      "<text x=\"{}\" y=\"{}\" font-size=\"{}\">{}</text></g>\n",
      Decimal(std::max(0.35, std::min(1.0, 0.3 + place.probability))), corner(place.yaw_rad, unit * kArrow),
      corner(place.yaw_rad + kHalfWidth, unit * kArrow / 2), corner(place.yaw_rad - kHalfWidth, unit * kArrow / 2), Decimal(x), Decimal(y),
      Decimal(unit * kRadius), Decimal(x), Decimal(y + unit * kFont / 3), Decimal(unit * kFont), number);
}

std::string Percent(double probability) {
  if (probability < 0.001) return "&lt; 0.1";
  return probability > 0.999 ? "&gt; 99.9" : fmt::format("{:.1f}", 100 * probability);
}

}  // namespace

std::string PlaceStyle() {
  return R"(.plan .place circle,.plan .place path{fill:#3b1c8c;stroke:var(--paper);stroke-width:2}
.plan .place text{fill:#fff;stroke:none;text-anchor:middle}
)";
}

std::string DrawPlaces(const AGraph& plan, StoreyId storey, const TryRow& attempt, const Sheet& sheet) {
  std::string out;
  for (size_t i = NumPlaces(attempt); i-- > 0;) {  // the best on top
    const HypothesisRow& place = attempt.hypotheses[i];
    if (StoreyAt(plan, place.position_m.z()) == storey) out += Arrow(place, i + 1, sheet);
  }
  return out;
}

std::string PlacesHtml(const TryRow& attempt) {
  std::string body;
  for (size_t i = 0; i < NumPlaces(attempt); ++i) {
    const HypothesisRow& h = attempt.hypotheses[i];
    fmt::format_to(
        std::back_inserter(body),
        "<tr><td>{}</td><td class=\"t\">{}</td><td class=\"t\">{}</td><td>{:.2f}, {:.2f}</td><td>{:.0f}</td><td>{}</td><td>{}</td>"
        "<td>{:.0f}</td></tr>\n",
        i + 1, EscapeXml(h.storey), EscapeXml(h.room_name), h.position_m.x(), h.position_m.y(), h.yaw_rad * 180 / std::numbers::pi,
        Percent(h.probability), h.consistent_planes, 100 * h.explained_ratio);
  }
  if (body.empty()) return {};
  const std::string advice = attempt.guidance ? fmt::format("<p class=\"note\">{}.</p>\n", EscapeXml(Advice(*attempt.guidance))) : "";
  return fmt::format(
      "<h2>Where it could be</h2>\n<p class=\"note\">What the last try to find the robot left open, the most probable first; a place outside "
      "of all that is planned has {} %.</p>\n{}"
      "<p class=\"note\">If none can be right: another plan or storey? <code>plumb validate</code> looks at the plan, <code>plumb doctor</code> "
      "at the recording.</p>\n"
      "<div class=\"scroll\"><table><thead><tr><th></th><th class=\"t\">storey</th><th class=\"t\">room</th><th>x, y, m</th>"
      "<th>heading, &deg;</th><th>probability, %</th><th>walls that agree</th><th>area explained, %</th></tr></thead><tbody>\n{}</tbody>"
      "</table></div>\n",
      Percent(attempt.probability_outside), advice, body);
}

}  // namespace plumb::tools
