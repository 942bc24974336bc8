#include "compiler/geometry/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <new>
#include <vector>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
struct PointNumber {
  int value = -1;  // a vertex that the triangulation makes itself has none
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<PointNumber, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                                       CGAL::Exact_predicates_tag>;

constexpr int kNoLevel = -1;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
double Cross(const Vector2d& a, const Vector2d& b, const Vector2d& c) { return Cross(b - a, c - a); }

// Turned one way at each corner, and all of it to the same side of each line from the first corner to another: strictly convex.
bool IsConvex(std::span<const Vector2d> ring, double side) {
  const size_t n = ring.size();
  for (size_t i = 0; i < n; ++i) {
    if (!(side * Cross(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) > 0)) return false;
    if (i > 0 && i + 1 < n && !(side * Cross(ring[0], ring[i], ring[i + 1]) > 0)) return false;
  }
  return true;
}

// Triangles and strictly convex polygons need no triangulator. False: it is neither.
bool TriangulateConvex(std::span<const Vector2d> ring, std::vector<Vector3i>& triangles) {
  if (ring.size() == 3) {
    const double area = Cross(ring[0], ring[1], ring[2]);
    if (area > 0) triangles.emplace_back(0, 1, 2);
    if (area < 0) triangles.emplace_back(0, 2, 1);
    return true;
  }
  if (ring.size() < 3) return false;
  const double side = Cross(ring[0], ring[1], ring[2]) > 0 ? 1 : -1;
  if (!IsConvex(ring, side)) return false;
  for (int i = 1; i + 1 < static_cast<int>(ring.size()); ++i) triangles.emplace_back(0, side > 0 ? i : i + 1, side > 0 ? i + 1 : i);
  return true;
}

// Numbers each face by how many rings' sides lie between it and the outside.
void MarkLevels(Cdt& cdt) {
  for (auto face : cdt.all_face_handles()) face->info() = kNoLevel;
  std::vector<Cdt::Face_handle> level = {cdt.infinite_face()}, next_level;
  for (int depth = 0; !level.empty(); ++depth) {
    while (!level.empty()) {
      const Cdt::Face_handle face = level.back();
      level.pop_back();
      if (face->info() != kNoLevel) continue;
      face->info() = depth;
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle neighbor = face->neighbor(i);
        if (neighbor->info() == kNoLevel) (face->is_constrained(i) ? next_level : level).push_back(neighbor);
      }
    }
    level.swap(next_level);
    next_level.clear();
  }
}

// False: its sides cross so often that there is no polygon to speak of.
bool TriangulateWithCgal(std::span<const Ring2> rings, Triangulation2& out) {
  const size_t max_vertices = 2 * out.points.size() + 1000;
  Cdt cdt;
  int base = 0;
  for (const Ring2& ring : rings) {
    std::vector<Cdt::Vertex_handle> handles;
    for (size_t i = 0; i < ring.size(); ++i) {
      const size_t before = cdt.number_of_vertices();
      const auto hint = handles.empty() ? Cdt::Face_handle() : handles.back()->face();
      const Cdt::Vertex_handle v = cdt.insert(Kernel::Point_2(ring[i].x(), ring[i].y()), hint);
      if (cdt.number_of_vertices() != before) v->info().value = base + static_cast<int>(i);
      handles.push_back(v);
    }
    for (size_t i = 0; i < handles.size(); ++i) {
      const Cdt::Vertex_handle a = handles[i], b = handles[(i + 1) % handles.size()];
      if (a != b) cdt.insert_constraint(a, b);
      if (cdt.number_of_vertices() > max_vertices) return false;
    }
    base += static_cast<int>(ring.size());
  }
  for (auto v : cdt.finite_vertex_handles()) {
    if (v->info().value >= 0) continue;  // the others are where sides cross
    v->info().value = static_cast<int>(out.points.size());
    out.points.emplace_back(v->point().x(), v->point().y());
  }
  MarkLevels(cdt);
  for (auto face : cdt.finite_face_handles()) {
    if (face->info() % 2 == 0) continue;
    out.triangles.emplace_back(face->vertex(0)->info().value, face->vertex(1)->info().value, face->vertex(2)->info().value);
  }
  return true;
}

bool AllFinite(std::span<const Ring2> rings) {
  for (const Ring2& ring : rings) {
    for (const Vector2d& p : ring) {
      if (!p.allFinite()) return false;
    }
  }
  return true;
}

// A plane with axes of its own, for a face.
struct FacePlane {
  Vector3d origin, u, v;
  [[nodiscard]] Vector2d Flat(const Vector3d& p) const { return {u.dot(p - origin), v.dot(p - origin)}; }
};

// AppendFace of one short convex ring, as most faces are, without any memory of its own. False: it is no such ring.
bool AppendSmallFace(const Ring3& ring, const FacePlane& plane, Solid& solid) {
  std::array<Vector2d, 8> flat;
  if (ring.size() > flat.size()) return false;
  for (size_t i = 0; i < ring.size(); ++i) flat[i] = plane.Flat(ring[i]);
  const size_t first = solid.triangles.size();
  if (!TriangulateConvex(std::span<const Vector2d>(flat).first(ring.size()), solid.triangles) || solid.triangles.size() == first)
    return false;
  const int base = static_cast<int>(solid.vertices.size());
  for (size_t t = first; t < solid.triangles.size(); ++t) solid.triangles[t].array() += base;
  solid.vertices.insert(solid.vertices.end(), ring.begin(), ring.end());
  return true;
}

Vector3d NewellNormal(const Ring3& ring) {
  Vector3d n = Vector3d::Zero();
  for (size_t i = 0; i < ring.size(); ++i) n += (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]);
  return n;
}

}  // namespace

double SignedArea(std::span<const Vector2d> ring) {
  double sum = 0;
  for (size_t i = 1; i + 1 < ring.size(); ++i) sum += Cross(ring[0], ring[i], ring[i + 1]);
  return sum / 2;
}

Triangulation2 TriangulatePolygon(std::span<const Ring2> rings) {
  Triangulation2 out;
  for (const Ring2& ring : rings) out.points.insert(out.points.end(), ring.begin(), ring.end());
  if (rings.empty() || !AllFinite(rings)) return out;
  if (rings.size() == 1 && TriangulateConvex(rings[0], out.triangles)) return out;
  try {
    (void)TriangulateWithCgal(rings, out);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // CGAL's preconditions on degenerate input
    out.triangles.clear();
  }
  return out;
}

bool AppendFace(std::span<const Ring3> rings, Solid& solid) {
  if (rings.empty() || rings[0].size() < 3) return false;
  Vector3d normal = NewellNormal(rings[0]);
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length)) return false;
  normal /= length;
  const Vector3d u = normal.unitOrthogonal();
  const FacePlane plane{rings[0][0], u, normal.cross(u)};
  if (rings.size() == 1 && AppendSmallFace(rings[0], plane, solid)) return true;
  std::vector<Ring2> flat(rings.size());
  size_t given = 0;
  for (size_t r = 0; r < rings.size(); ++r) {
    for (const Vector3d& p : rings[r]) flat[r].push_back(plane.Flat(p));
    given += rings[r].size();
  }
  const Triangulation2 result = TriangulatePolygon(flat);
  if (result.triangles.empty()) return false;
  const int base = static_cast<int>(solid.vertices.size());
  for (const Ring3& ring : rings) solid.vertices.insert(solid.vertices.end(), ring.begin(), ring.end());
  for (size_t i = given; i < result.points.size(); ++i) {
    solid.vertices.push_back(plane.origin + plane.u * result.points[i].x() + plane.v * result.points[i].y());
  }
  for (const Vector3i& t : result.triangles) solid.triangles.emplace_back(t.array() + base);
  return true;
}

}  // namespace plumb::compiler
