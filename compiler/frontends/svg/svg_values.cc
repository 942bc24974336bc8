#include "compiler/frontends/svg/svg_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kInch_m = 0.0254, kPixelsPerInch = 96;

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

struct PhysicalUnit {
  std::string_view name;
  double metres;
};
constexpr std::array<PhysicalUnit, 6> kPhysicalUnits = {
    {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", kInch_m}, {"pt", kInch_m / 72}, {"pc", kInch_m / 6}}};

// The value and what stands behind it.
std::optional<std::pair<double, std::string_view>> ValueAndUnit(std::string_view text) {
  SvgScanner scanner(text);
  const std::optional<double> value = scanner.Number();
  if (!value) return std::nullopt;
  std::string_view unit = scanner.rest();
  while (!unit.empty() && IsSpace(unit.back())) unit.remove_suffix(1);
  while (!unit.empty() && IsSpace(unit.front())) unit.remove_prefix(1);
  return std::pair(*value, unit);
}

std::optional<Eigen::Affine2d> OneTransform(std::string_view name, const std::vector<double>& v) {
  Eigen::Affine2d out = Eigen::Affine2d::Identity();
  const auto at = [&](size_t i, double otherwise) { return i < v.size() ? v[i] : otherwise; };
  if (v.empty()) return std::nullopt;
  if (name == "matrix" && v.size() == 6) {
    out.linear() << v[0], v[2], v[1], v[3];
    out.translation() << v[4], v[5];
  } else if (name == "translate" && v.size() <= 2) {
    out.translation() << v[0], at(1, 0);
  } else if (name == "scale" && v.size() <= 2) {
    out.linear() << v[0], 0, 0, at(1, v[0]);
  } else if (name == "rotate" && (v.size() == 1 || v.size() == 3)) {
    const Eigen::Vector2d center(at(1, 0), at(2, 0));
    out = Eigen::Translation2d(center) * Eigen::Rotation2Dd(v[0] * kDegree) * Eigen::Translation2d(-center);
  } else if (name == "skewX" && v.size() == 1) {
    out.linear()(0, 1) = std::tan(v[0] * kDegree);
  } else if (name == "skewY" && v.size() == 1) {
    out.linear()(1, 0) = std::tan(v[0] * kDegree);
  } else {
    return std::nullopt;
  }
  return out;
}

}  // namespace

void SvgScanner::SkipSpace() {
  while (!rest_.empty() && (IsSpace(rest_.front()) || rest_.front() == ',')) rest_.remove_prefix(1);
}

std::optional<double> SvgScanner::Number() {
  SkipSpace();
  std::string_view text = rest_;
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
  // Never "inf" or "nan".
  if (digits.empty() || !(digits[0] == '.' || (digits[0] >= '0' && digits[0] <= '9'))) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  rest_ = text.substr(static_cast<size_t>(end - text.data()));
  return value;
}

std::optional<bool> SvgScanner::Flag() {
  SkipSpace();
  if (rest_.empty() || (rest_[0] != '0' && rest_[0] != '1')) return std::nullopt;
  const bool out = rest_[0] == '1';
  rest_.remove_prefix(1);
  return out;
}

std::optional<double> SvgLength(std::string_view text, double whole) {
  const auto parts = ValueAndUnit(text);
  if (!parts) return std::nullopt;
  const auto& [value, unit] = *parts;
  if (unit.empty() || unit == "px") return value;
  if (unit == "%") return value / 100 * whole;
  if (unit == "em") return 16 * value;
  const auto known = std::find_if(kPhysicalUnits.begin(), kPhysicalUnits.end(), [&, name = unit](const PhysicalUnit& u) { return u.name == name; });
  if (known == kPhysicalUnits.end()) return std::nullopt;
  return value * known->metres / kInch_m * kPixelsPerInch;
}

std::optional<double> SvgPhysicalLength_m(std::string_view text) {
  const auto parts = ValueAndUnit(text);
  if (!parts) return std::nullopt;
  for (const PhysicalUnit& unit : kPhysicalUnits) {
    if (unit.name == parts->second) return parts->first * unit.metres;
  }
  return std::nullopt;
}

std::vector<double> SvgNumbers(std::string_view text) {
  std::vector<double> out;
  SvgScanner scanner(text);
  while (const auto value = scanner.Number()) out.push_back(*value);
  return out;
}

std::optional<Eigen::Affine2d> SvgTransform(std::string_view text) {
  Eigen::Affine2d out = Eigen::Affine2d::Identity();
  SvgScanner scanner(text);
  for (scanner.SkipSpace(); !scanner.at_end(); scanner.SkipSpace()) {
    const std::string_view rest = scanner.rest();
    const size_t open = rest.find('('), close = rest.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
    std::string_view name = rest.substr(0, open);
    while (!name.empty() && IsSpace(name.back())) name.remove_suffix(1);
    const auto one = OneTransform(name, SvgNumbers(rest.substr(open + 1, close - open - 1)));
    if (!one) return std::nullopt;
    out = out * *one;
    scanner.Skip(close + 1);
  }
  return out;
}

std::optional<SvgViewBox> ParseSvgViewBox(std::string_view text) {
  const std::vector<double> v = SvgNumbers(text);
  if (v.size() != 4 || !(v[2] > 0) || !(v[3] > 0)) return std::nullopt;
  return SvgViewBox{v[0], v[1], v[2], v[3]};
}

Eigen::Affine2d SvgViewport(const SvgViewBox& box, double width, double height, std::string_view aspect) {
  double sx = width / box.width, sy = height / box.height;
  Eigen::Vector2d at(0, 0);
  if (aspect.find("none") == std::string_view::npos) {
    sx = sy = aspect.find("slice") != std::string_view::npos ? std::max(sx, sy) : std::min(sx, sy);
    const auto share = [&](const char* low, const char* high) {
      return aspect.find(low) != std::string_view::npos ? 0.0 : aspect.find(high) != std::string_view::npos ? 1.0 : 0.5;
    };
    at << share("xMin", "xMax") * (width - sx * box.width), share("YMin", "YMax") * (height - sy * box.height);
  }
  return Eigen::Translation2d(at) * Eigen::Scaling(sx, sy) * Eigen::Translation2d(-box.x, -box.y);
}

}  // namespace plumb::compiler
