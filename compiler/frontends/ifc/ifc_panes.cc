#include "compiler/frontends/ifc/ifc_panes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The horizontal direction across the piece: the normal of its largest upright face; zero if none of its faces is upright.
Vector2d Across(const Solid& piece) {
  double best = 0;
  Vector2d across = Vector2d::Zero();
  for (const Eigen::Vector3i& t : piece.triangles) {
    const Vector3d& a = piece.vertices[static_cast<size_t>(t[0])];
    const Vector3d n = (piece.vertices[static_cast<size_t>(t[1])] - a).cross(piece.vertices[static_cast<size_t>(t[2])] - a);
    const double area = n.norm();
    if (area > best && n.head<2>().norm() > 0.99 * area) {
      best = area;
      across = n.head<2>().normalized();
    }
  }
  return across;
}

bool IsPane(const Solid& piece, const IfcOptions& options) {
  constexpr double kMinFill = 0.9;  // of the box around it: a frame fills much less
  const Vector2d across = Across(piece);
  if (across.isZero()) return false;
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : piece.vertices) box.extend(Vector3d(across.dot(v.head<2>()), across.x() * v.y() - across.y() * v.x(), v.z()));
  const Vector3d size = box.sizes();
  const double face_m2 = size.y() * size.z();
  if (!(size.x() < options.pane_max_thickness_m) || !(face_m2 > options.pane_min_area_m2)) return false;
  if (size.x() < 1e-4) return true;  // a single sheet
  return std::min(size.y(), size.z()) > 2 * size.x() && std::abs(Volume(piece)) > kMinFill * face_m2 * size.x();
}

}  // namespace

void MarkPanes(const IfcOptions& options, ShapeParts& parts) {
  if (std::any_of(parts.begin(), parts.end(), [](const ShapePart& part) { return part.look == Look::kGlass; })) return;
  ShapeParts out;
  for (ShapePart& part : parts) {
    Solid panes, rest;
    WeldSolid(options.weld_tolerance_m, part.solid);
    for (Solid& piece : ConnectedPieces(part.solid)) AppendSolid(std::move(piece), IsPane(piece, options) ? panes : rest);
    if (!panes.empty()) out.emplace_back(std::move(panes), Look::kGlass);
    if (!rest.empty()) out.emplace_back(std::move(rest), part.look);
  }
  parts = std::move(out);
}

}  // namespace plumb::compiler
