#include "tools/drawing/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace plumb::tools {
namespace {

using Color = std::array<double, 3>;

// Linear between evenly spaced stops.
std::string Blend(std::span<const Color> stops, double ratio) {
  const double at = std::clamp(ratio, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(i);
  Color c{};
  for (size_t k = 0; k < 3; ++k) c[k] = (1 - t) * stops[i][k] + t * stops[i + 1][k];
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(c[0]), std::lround(c[1]), std::lround(c[2]));
}

}  // namespace

std::string EscapeXml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default:
        // Control characters are not allowed in XML, not even escaped.
        if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
  }
  return out;
}

Sheet::Sheet(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi, double margin_m, double denominator)
    : lo_(lo.array() - margin_m),
      hi_(hi.array() + margin_m),
      units_per_m_(1e4 / denominator),
      width_(Length((hi_ - lo_).x())),
      height_(Length((hi_ - lo_).y())) {}

std::string Sheet::At(const Eigen::Vector2d& plan_m) const { return Decimal(x(plan_m.x())) + " " + Decimal(y(plan_m.y())); }

std::string Sheet::Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const { return "M" + At(a) + "L" + At(b); }

std::string Sheet::Closed(const Ring& ring) const {
  std::string out;
  for (const Eigen::Vector2d& p : ring) out += (out.empty() ? "M" : "L") + At(p);
  return out.empty() ? out : out + "Z";
}

double TextWidth(std::string_view text, bool bold) {
  double width = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // goes on with the letter before
    if (c == 'W' || c == 'M' || c == 'm' || c == 'w') {
      width += 0.95;
    } else if (c >= 'A' && c <= 'Z') {
      width += 0.70;
    } else if (std::string_view(" .,:;'|ijlftr()[]-/").find(c) != std::string_view::npos) {
      width += 0.42;
    } else {
      width += 0.62;
    }
  }
  return bold ? 1.1 * width : width;
}

std::string Decimal(double value) {
  const double rounded = std::round(value * 10) / 10;
  return fmt::format("{:.1f}", rounded == 0 ? 0.0 : rounded);
}

std::string Signed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", std::abs(value), digits);
  if (text.find_first_not_of("0.") == std::string::npos) return text;
  return (value < 0 ? "\u2212" : "+") + text;
}

std::string DeviationColor(double translation_m, double limit_m) {
  static constexpr Color kStops[] = {{84, 39, 136}, {128, 115, 172}, {170, 165, 180}, {224, 130, 20}, {179, 88, 6}};
  return Blend(kStops, 0.5 + 0.5 * translation_m / limit_m);
}

std::string TimeColor(double ratio) {
  static constexpr Color kStops[] = {{59, 28, 140}, {33, 113, 181}, {30, 155, 138}, {110, 195, 90}, {235, 200, 40}};
  return Blend(kStops, ratio);
}

}  // namespace plumb::tools
