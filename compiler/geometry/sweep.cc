#include "compiler/geometry/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kWeldTolerance_m = 1e-7;
constexpr double kFullTurnTolerance_rad = 1e-6;

// Outward side walls ask for the rings' sense: is the area to the left of a ring as it runs? Counted by how many other rings hold it.
bool AreaIsLeft(const Area& profile, size_t ring) {
  const Vector2d p = profile[ring][0];
  size_t containing = 0;
  for (size_t r = 0; r < profile.size(); ++r) {
    if (r != ring && Contains(profile[r], p)) ++containing;
  }
  const bool counter_clockwise = SignedArea(profile[ring]) > 0;
  return counter_clockwise == (containing % 2 == 0);
}

void AddQuad(int a, int b, int c, int d, Solid& solid) {
  solid.triangles.emplace_back(a, b, c);
  solid.triangles.emplace_back(a, c, d);
}

Area Clean(const Area& profile) {
  Area out;
  for (Ring2 ring : profile) {
    DropRepeatedPoints(kWeldTolerance_m, ring);
    if (ring.size() >= 3) out.push_back(std::move(ring));
  }
  return out;
}

Solid Prism(const Area& start, const Area& end, const Vector3d& offset) {
  Solid solid;
  const Triangulation2 cap = TriangulatePolygon(start);
  if (cap.triangles.empty()) return solid;
  for (const Vector2d& p : cap.points) solid.vertices.emplace_back(p.x(), p.y(), 0);
  const int top = static_cast<int>(cap.points.size());
  size_t given = 0;
  for (const Ring2& ring : end) {
    for (const Vector2d& p : ring) solid.vertices.push_back(Vector3d(p.x(), p.y(), 0) + offset);
    given += ring.size();
  }
  // Points where the profile crosses itself keep their place in the profile.
  for (size_t i = given; i < cap.points.size(); ++i) solid.vertices.push_back(Vector3d(cap.points[i].x(), cap.points[i].y(), 0) + offset);
  for (const Vector3i& t : cap.triangles) {
    solid.triangles.emplace_back(t[0], t[2], t[1]);
    solid.triangles.emplace_back(top + t[0], top + t[1], top + t[2]);
  }
  int base = 0;
  for (size_t r = 0; r < start.size(); ++r) {
    const int n = static_cast<int>(start[r].size());
    const bool left = AreaIsLeft(start, r);
    for (int i = 0; i < n; ++i) {
      int a = base + i, b = base + (i + 1) % n;
      if (!left) std::swap(a, b);
      AddQuad(a, b, top + b, top + a, solid);
    }
    base += n;
  }
  if (offset.z() < 0) FlipSolid(solid);
  WeldSolid(kWeldTolerance_m, solid);
  return solid;
}

}  // namespace

Solid Extrude(const Area& profile, const Vector3d& offset) {
  const Area clean = Clean(profile);
  if (clean.empty() || !(std::abs(offset.z()) > kWeldTolerance_m)) return {};
  return Prism(clean, clean, offset);
}

Solid Loft(const Area& start, const Area& end, const Vector3d& offset) {
  if (start.empty() || start.size() != end.size() || !(std::abs(offset.z()) > kWeldTolerance_m)) return {};
  for (size_t r = 0; r < start.size(); ++r) {
    if (start[r].size() < 3 || start[r].size() != end[r].size()) return {};
  }
  return Prism(start, end, offset);
}

Solid Revolve(const Area& profile, const Vector2d& axis_point, const Vector2d& axis_direction, double angle_rad, int segments) {
  const Area clean = Clean(profile);
  Solid solid;
  const Triangulation2 cap = TriangulatePolygon(clean);
  if (cap.triangles.empty() || segments < 1 || !(std::abs(angle_rad) > kFullTurnTolerance_rad)) return solid;
  const bool full = std::abs(angle_rad) >= 2 * std::numbers::pi - kFullTurnTolerance_rad;
  if (full) angle_rad = std::copysign(2 * std::numbers::pi, angle_rad);
  const Vector3d point(axis_point.x(), axis_point.y(), 0), axis = Vector3d(axis_direction.x(), axis_direction.y(), 0).normalized();
  const int n = static_cast<int>(cap.points.size());
  for (int s = 0; s <= segments; ++s) {
    const Eigen::AngleAxisd turn(full && s == segments ? 0 : angle_rad * s / segments, axis);
    for (const Vector2d& p : cap.points) solid.vertices.push_back(point + turn * (Vector3d(p.x(), p.y(), 0) - point));
  }
  if (!full) {
    const int last = segments * n;
    for (const Vector3i& t : cap.triangles) {
      solid.triangles.emplace_back(t[0], t[2], t[1]);
      solid.triangles.emplace_back(last + t[0], last + t[1], last + t[2]);
    }
  }
  for (int s = 0; s < segments; ++s) {
    int base = s * n;
    for (size_t r = 0; r < clean.size(); ++r) {
      const int size = static_cast<int>(clean[r].size());
      const bool left = AreaIsLeft(clean, r);
      for (int i = 0; i < size; ++i) {
        int a = base + i, b = base + (i + 1) % size;
        if (!left) std::swap(a, b);
        AddQuad(a, b, b + n, a + n, solid);
      }
      base += size;
    }
  }
  WeldSolid(kWeldTolerance_m, solid);
  if (Volume(solid) < 0) FlipSolid(solid);
  return solid;
}

Solid SweepDisk(const std::vector<Vector3d>& path, double radius_m, int sides) {
  std::vector<Vector3d> points = path;
  const bool closed = points.size() > 3 && (points.front() - points.back()).norm() < kWeldTolerance_m;
  DropRepeatedPoints(kWeldTolerance_m, points);
  if (!closed && path.size() > 1 && points.size() == 1) return {};
  const int n = static_cast<int>(points.size());
  if (n < 2 || sides < 3 || !(radius_m > 0)) return {};
  const auto direction = [&](int i) { return (points[static_cast<size_t>((i + 1) % n)] - points[static_cast<size_t>(i)]).normalized(); };
  Solid solid;
  Vector3d u = direction(closed ? n - 1 : 0).unitOrthogonal();
  for (int i = 0; i < n; ++i) {
    const Vector3d in = i > 0 || closed ? direction((i + n - 1) % n) : direction(0);
    const Vector3d out = i + 1 < n || closed ? direction(i) : in;
    // The ring is carried along `in` onto the plane that halves the bend.
    Vector3d normal = in + out;
    normal = normal.norm() > 1e-3 ? normal.normalized().eval() : in;
    u = (u - u.dot(in) * in).normalized();
    const Vector3d v = in.cross(u);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Vector3d spoke = radius_m * (std::cos(angle) * u + std::sin(angle) * v);
      const double slope = std::max(0.2, in.dot(normal));  // sharp bends are cut short
      solid.vertices.push_back(points[static_cast<size_t>(i)] + spoke - in * (spoke.dot(normal) / slope));
    }
    const Vector3d axis = in.cross(out);
    if (const double sine = axis.norm(); sine > 1e-12) u = Eigen::AngleAxisd(std::atan2(sine, in.dot(out)), axis / sine) * u;
  }
  const int rings = closed ? n : n - 1;
  for (int i = 0; i < rings; ++i) {
    const int a = i * sides, b = (i + 1) % n * sides;
    for (int k = 0; k < sides; ++k) AddQuad(a + k, a + (k + 1) % sides, b + (k + 1) % sides, b + k, solid);
  }
  if (!closed) {
    const int last = (n - 1) * sides;
    for (int k = 1; k + 1 < sides; ++k) {
      solid.triangles.emplace_back(0, k + 1, k);
      solid.triangles.emplace_back(last, last + k, last + k + 1);
    }
  }
  return solid;
}

int ArcSegments(double radius_m, double sweep_rad, double chord_tolerance_m, int min_per_turn) {
  constexpr int kMaxPerTurn = 256;
  if (!std::isfinite(radius_m) || !std::isfinite(sweep_rad)) return 1;
  const double turns = std::min(std::abs(sweep_rad) / (2 * std::numbers::pi), 1.0);
  const double ratio = std::clamp(1 - chord_tolerance_m / std::max(radius_m, 1e-9), -1.0, 1.0);
  const double step_rad = 2 * std::acos(ratio);
  const double per_turn = std::clamp(2 * std::numbers::pi / std::max(step_rad, 1e-6), double(min_per_turn), double(kMaxPerTurn));
  return std::max(1, static_cast<int>(std::ceil(turns * per_turn - 1e-9)));
}

}  // namespace plumb::compiler
