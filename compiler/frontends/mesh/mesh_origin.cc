#include "compiler/frontends/mesh/mesh_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

constexpr double kFarObj = 4096;  // single precision tells 0.0005 apart there
constexpr double kFar = 10;       // sizes of the building from zero

// The three numbers of a line `v x y z`; what follows them in `rest`.
std::optional<Vector3d> CornerOf(std::string_view line, std::string_view& rest) {
  if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) return std::nullopt;
  Vector3d out;
  rest = line.substr(2);
  for (int k = 0; k < 3; ++k) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (rest.starts_with('+')) rest.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), out[k]);
    if (error != std::errc() || !std::isfinite(out[k])) return std::nullopt;
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
  }
  return out;
}

}  // namespace

std::optional<std::string> ObjNearZero(std::string_view text, Vector3d& origin) {
  std::string out;
  bool any = false;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    std::string_view rest;
    if (const std::optional<Vector3d> corner = CornerOf(line, rest)) {
      if (!any) {
        if (corner->cwiseAbs().maxCoeff() < kFarObj) return std::nullopt;
        origin = corner->array().round();
        any = true;
        out.reserve(text.size());
      }
      const Vector3d moved = *corner - origin;
      out += fmt::format("v {} {} {}{}", moved.x(), moved.y(), moved.z(), rest);
    } else {
      out += line;
    }
    out += '\n';
    at = end + 1;
  }
  return any ? std::optional(std::move(out)) : std::nullopt;
}

void MoveSceneNearZero(MeshScene& scene) {
  Eigen::AlignedBox3d box;
  for (const MeshObject& o : scene.objects) box.extend(Bounds(o.solid));
  if (box.isEmpty() || box.center().norm() <= kFar * box.sizes().norm()) return;
  const Vector3d middle = box.center().array().round();
  for (MeshObject& o : scene.objects) {
    for (Vector3d& v : o.solid.vertices) v -= middle;
  }
  scene.origin += middle;
}

double BlurOf(const MeshScene& scene) {
  double farthest = 0;
  for (const MeshObject& o : scene.objects) {
    for (const Vector3d& v : o.solid.vertices) farthest = std::max(farthest, v.cwiseAbs().maxCoeff());
  }
  const auto single = static_cast<float>(farthest);
  return std::nextafter(single, HUGE_VALF) - single;
}

}  // namespace plumb::compiler
