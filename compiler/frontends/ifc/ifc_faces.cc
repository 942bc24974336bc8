#include "compiler/frontends/ifc/ifc_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool IsOuter(const IfcInstance& bound) { return bound.type == IfcType::kIfcFaceOuterBound; }

// 1-based indices of a list into 0-based ones; empty if one is out of range.
std::vector<int> Indices(StepValue list, size_t count) {
  std::vector<int> out;
  for (const StepValue item : list.Items()) {
    const auto number = item.Integer();
    if (!number || *number < 1 || static_cast<uint64_t>(*number) > count) return {};
    out.push_back(static_cast<int>(*number - 1));
  }
  return out;
}

}  // namespace

Ring3 FaceReader::Loop(const IfcInstance& loop) const {
  Ring3 ring;
  if (!loop) return ring;
  if (loop.type == IfcType::kIfcPolyLoop) {
    ring = curves_.Points(loop[attribute::kLoopPoints], loop.index);
  } else if (loop.type == IfcType::kIfcEdgeLoop) {
    ring = EdgeLoop(loop);
  }
  DropRepeatedPoints(options_.weld_tolerance_m, ring);
  return ring;
}

Ring3 FaceReader::EdgeLoop(const IfcInstance& loop) const {
  Ring3 ring;
  const auto vertex = [&](StepValue reference) {
    const IfcInstance v = model_.Follow(reference);
    return v && v.type == IfcType::kIfcVertexPoint ? placements_.Point(v[attribute::kVertexGeometry]) : Vector3d(Vector3d::Zero());
  };
  for (const StepValue item : loop[attribute::kLoopEdges].Items()) {
    const IfcInstance oriented = model_.Follow(item);
    if (!oriented || !model_.Spend(1, loop.index)) continue;
    const IfcInstance edge = model_.Follow(oriented[attribute::kOrientedEdgeElement]);
    if (!edge) continue;
    const Vector3d start = vertex(edge[attribute::kEdgeStart]), end = vertex(edge[attribute::kEdgeEnd]);
    Ring3 points = {start, end};
    if (edge.type == IfcType::kIfcEdgeCurve) {
      points = curves_.ReadBetween(model_.Follow(edge[attribute::kEdgeGeometry]), start, end,
                                   edge[attribute::kEdgeSameSense].Boolean().value_or(true));
    }
    if (!oriented[attribute::kOrientedEdgeOrientation].Boolean().value_or(true)) std::reverse(points.begin(), points.end());
    ring.insert(ring.end(), points.begin(), points.end());
  }
  return ring;
}

// Triangles of the unrolled face connect points across the surface, not through it.
bool FaceReader::AppendCurvedFace(const IfcInstance& surface, const std::vector<Ring3>& rings, Solid& solid) const {
  const UnrolledFace flat = surfaces_.Unroll(surface, rings);
  const Triangulation2 result = TriangulatePolygon(flat.rings);
  const bool is_triangulated = !result.triangles.empty() && result.points.size() == flat.points.size();
  if (!is_triangulated || !flat.is_ruled) {
    model_.Emit(DiagnosticKind::kSimplifiedGeometry, surface.index,
                fmt::format("the curved surface {} is replaced by flat triangles between its edges", model_.Label(surface.index)));
  }
  if (!is_triangulated) return false;
  const int base = static_cast<int>(solid.vertices.size());
  solid.vertices.insert(solid.vertices.end(), flat.points.begin(), flat.points.end());
  const bool turned = SignedArea(flat.rings[0]) < 0;
  for (const Eigen::Vector3i& t : result.triangles) {
    solid.triangles.emplace_back(base + t[0], base + t[turned ? 2 : 1], base + t[turned ? 1 : 2]);
  }
  return true;
}

void FaceReader::AppendIfcFace(const IfcInstance& face, Solid& solid) const {
  std::vector<Ring3> rings;
  bool has_outer = false;
  for (const StepValue item : face[attribute::kFaceBounds].Items()) {
    const IfcInstance bound = model_.Follow(item);
    if (!bound) continue;
    Ring3 ring = Loop(model_.Follow(bound[attribute::kBoundLoop]));
    if (ring.size() < 3) continue;
    if (!bound[attribute::kBoundOrientation].Boolean().value_or(true)) std::reverse(ring.begin(), ring.end());
    rings.push_back(std::move(ring));
    if (IsOuter(bound) && !has_outer) {
      has_outer = true;
      std::swap(rings.front(), rings.back());
    }
  }
  if (rings.empty()) return;
  if (face.type == IfcType::kIfcAdvancedFace || face.type == IfcType::kIfcFaceSurface) {
    const IfcInstance surface = model_.Follow(face[attribute::kFaceSurface]);
    if (surface && surface.type != IfcType::kIfcPlane && AppendCurvedFace(surface, rings, solid)) return;
  }
  AppendFace(rings, solid);
}

Solid FaceReader::Shell(const IfcInstance& shell) const {
  Solid solid;
  if (!shell) return solid;
  for (const StepValue item : shell[attribute::kShellFaces].Items()) {
    if (!model_.Spend(1, shell.index)) break;
    if (const IfcInstance face = model_.Follow(item)) AppendIfcFace(face, solid);
    if (solid.triangles.size() > options_.max_triangles_per_element) break;
  }
  WeldSolid(options_.weld_tolerance_m, solid);
  OrientOutward(solid);
  return solid;
}

Solid FaceReader::Brep(const IfcInstance& brep) const {
  Solid solid = Shell(model_.Follow(brep[attribute::kBrepOuter]));
  for (const StepValue item : brep[attribute::kBrepVoids].Items()) {
    Solid cavity = Shell(model_.Follow(item));
    FlipSolid(cavity);
    AppendSolid(cavity, solid);
  }
  return solid;
}

void FaceReader::AppendTriangles(const IfcInstance& face_set, size_t point_count, Solid& solid) const {
  for (const StepValue item : face_set[attribute::kTriangleIndices].Items()) {
    const std::vector<int> corners = Indices(item, point_count);
    if (corners.size() == 3) {
      solid.triangles.emplace_back(corners[0], corners[1], corners[2]);
    } else {
      model_.Emit(DiagnosticKind::kBadAttribute, face_set.index,
                  fmt::format("a triangle of {} does not name three points in 1..{}", model_.Label(face_set.index), point_count));
      return;
    }
  }
}

void FaceReader::AppendPolygons(const IfcInstance& face_set, const std::vector<Vector3d>& points, Solid& solid) const {
  std::vector<int> renumbered;
  for (const StepValue item : face_set[attribute::kPolygonPointIndices].Items()) {
    renumbered.push_back(static_cast<int>(std::clamp<int64_t>(item.Integer().value_or(0), 0, static_cast<int64_t>(points.size())) - 1));
  }
  const size_t count = renumbered.empty() ? points.size() : renumbered.size();
  const auto ring_of = [&](StepValue list) {
    Ring3 ring;
    for (const int i : Indices(list, count)) {
      const int p = renumbered.empty() ? i : renumbered[static_cast<size_t>(i)];
      if (p >= 0) ring.push_back(points[static_cast<size_t>(p)]);
    }
    DropRepeatedPoints(options_.weld_tolerance_m, ring);
    return ring;
  };
  for (const StepValue item : face_set[attribute::kPolygonFaces].Items()) {
    const IfcInstance face = model_.Follow(item);
    if (!face) continue;
    std::vector<Ring3> rings = {ring_of(face[attribute::kPolygonIndices])};
    if (rings[0].size() < 3) continue;
    if (face.type == IfcType::kIfcIndexedPolygonalFaceWithVoids) {
      for (const StepValue inner : face[attribute::kPolygonInnerIndices].Items()) {
        Ring3 ring = ring_of(inner);
        if (ring.size() >= 3) rings.push_back(std::move(ring));
      }
    }
    AppendFace(rings, solid);
  }
}

Solid FaceReader::FaceSet(const IfcInstance& face_set) const {
  Solid solid;
  std::vector<Vector3d> points = curves_.PointList(model_.Follow(face_set[attribute::kFaceSetCoordinates]));
  if (face_set.type == IfcType::kIfcPolygonalFaceSet) {
    AppendPolygons(face_set, points, solid);
  } else {
    solid.vertices = std::move(points);
    AppendTriangles(face_set, solid.vertices.size(), solid);
  }
  if (!model_.Spend(solid.triangles.size(), face_set.index)) return {};
  WeldSolid(options_.weld_tolerance_m, solid);
  OrientOutward(solid);
  return solid;
}

}  // namespace plumb::compiler
