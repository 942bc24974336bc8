#include "compiler/frontends/ifc/ifc_wall_proxies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool IsLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; }

// The horizontal direction in which most of the upright surface faces; zero without any.
Vector2d MainNormal(const ShapeParts& parts) {
  // Opposite faces add up: by doubled angles.
  Vector2d sum = Vector2d::Zero();
  for (const ShapePart& part : parts) {
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      const auto corner = [&](int k) -> const Vector3d& { return part.solid.vertices[static_cast<size_t>(t[k])]; };
      const Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      const double horizontal = n.head<2>().norm();
      if (!(horizontal > 0.99 * n.norm())) continue;
      const double angle = std::atan2(n.y(), n.x());
      sum += horizontal * Vector2d(std::cos(2 * angle), std::sin(2 * angle));
    }
  }
  if (!(sum.norm() > 0)) return Vector2d::Zero();
  const double angle = std::atan2(sum.y(), sum.x()) / 2;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

bool IsWallName(std::string_view name) {
  constexpr std::array<std::string_view, 22> kWords = {
      "wall",   "walls",  "wand",   "mauer", "mur", "murs",        "muro",         "muros",         "muri",             "pared", "paredes",
      "parete", "pareti", "parede", "vegg", "fal", "v\xc3\xa6g", "v\xc3\xa4gg", "sein\xc3\xa4", "\xc5\x9b" "ciana", "zid",   "stena"};
  std::string word;
  const auto is_wall = [&] { return std::find(kWords.begin(), kWords.end(), word) != kWords.end(); };
  for (const char c : name) {
    if (IsLetter(c)) {
      word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      continue;
    }
    if (is_wall()) return true;
    word.clear();
  }
  return is_wall();
}

bool IsWallShaped(const ShapeParts& parts) {
  constexpr double kMinHeight_m = 1.5, kMaxThickness_m = 1, kMinLengthRatio = 2;
  const Vector2d across = MainNormal(parts);
  if (across.isZero()) return false;
  Eigen::AlignedBox3d box;
  for (const ShapePart& part : parts) {
    for (const Vector3d& v : part.solid.vertices)
      box.extend(Vector3d(across.dot(v.head<2>()), across.x() * v.y() - across.y() * v.x(), v.z()));
  }
  const Vector3d size = box.sizes();
  return size.z() >= kMinHeight_m && size.x() <= kMaxThickness_m && size.y() >= kMinLengthRatio * size.x();
}

}  // namespace plumb::compiler
