#include "tools/drawing/section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace plumb::tools {
namespace {

using Point = std::pair<double, double>;  // ordered, so that rings are found without tolerance

Point PointOf(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

Eigen::Vector3d Corner(const AGraph& g, uint32_t vertex) { return g.mesh.vertices[vertex].cast<double>() + g.origin; }

bool LessXyz(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Where edge a-b, one end of which is above, passes z. Always from the lesser end, so that both triangles at the edge get the same bits.
Eigen::Vector2d Crossing(Eigen::Vector3d a, Eigen::Vector3d b, double z_m) {
  if (LessXyz(b, a)) std::swap(a, b);
  const double t = (z_m - a.z()) / (b.z() - a.z());
  return {a.x() + t * (b.x() - a.x()), a.y() + t * (b.y() - a.y())};
}

// The solid lies to the left of the segment. A corner at exactly z counts as above.
std::optional<SectionSegment> CutTriangle(const std::array<Eigen::Vector3d, 3>& corners, uint32_t element, double z_m) {
  std::optional<Eigen::Vector2d> rising, falling;  // along the triangle's own, counter-clockwise edges
  for (size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.z() < z_m && b.z() >= z_m) rising = Crossing(a, b, z_m);
    if (a.z() >= z_m && b.z() < z_m) falling = Crossing(a, b, z_m);
  }
  if (!rising || !falling || *rising == *falling) return std::nullopt;
  return SectionSegment{element, *falling, *rising};
}

std::vector<Ring> Chain(const std::vector<SectionSegment>& segments) {
  std::multimap<Point, size_t> leaving;
  for (size_t i = 0; i < segments.size(); ++i) leaving.emplace(PointOf(segments[i].from), i);
  std::vector<Ring> rings;
  while (!leaving.empty()) {
    const Point start = leaving.begin()->first;
    Ring ring;
    Point at = start;
    for (auto next = leaving.begin(); next != leaving.end(); next = leaving.find(at)) {
      ring.emplace_back(at.first, at.second);
      at = PointOf(segments[next->second].to);
      leaving.erase(next);
      if (at == start) break;
    }
    if (at == start && ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

bool IsFurnishing(ElementKind kind) {
  return kind == ElementKind::kStair || kind == ElementKind::kRailing || kind == ElementKind::kFurniture;
}

// The faces at one edge of an element.
struct Faces {
  Eigen::Vector3d a, b;
  std::vector<Eigen::Vector3d> normals;
};

constexpr double kUpwards = 0.3;   // of a normal's z: the face looks up
constexpr double kSmooth = 0.9;    // of the cosine between two normals: no crease
constexpr double kShort_m = 0.02;  // seen from above; upright edges are points

bool IsSeen(const Faces& faces) {
  if ((faces.a - faces.b).head<2>().norm() < kShort_m) return false;
  const bool up = std::any_of(faces.normals.begin(), faces.normals.end(), [](const auto& n) { return n.z() > kUpwards; });
  const bool flat = faces.normals.size() == 2 && faces.normals[0].dot(faces.normals[1]) > kSmooth;
  return up && !flat;
}

}  // namespace

Ring RectangleAlong(const Eigen::Vector2d& middle, const Eigen::Vector2d& along, double length_m, double width_m) {
  const Eigen::Vector2d a = 0.5 * length_m * along, b = 0.5 * width_m * Eigen::Vector2d(-along.y(), along.x());
  return {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
}

std::vector<SectionSegment> SegmentsAt(const AGraph& graph, double z_m) {
  std::vector<SectionSegment> out;
  for (const Triangle& t : graph.mesh.triangles) {
    const auto segment = CutTriangle({Corner(graph, t.a), Corner(graph, t.b), Corner(graph, t.c)}, t.element, z_m);
    if (segment) out.push_back(*segment);
  }
  return out;
}

std::vector<ElementSection> ClosedSections(const std::vector<SectionSegment>& segments) {
  std::map<uint32_t, std::vector<SectionSegment>> by_element;
  for (const SectionSegment& segment : segments) by_element[segment.element].push_back(segment);
  std::vector<ElementSection> sections;
  for (const auto& [element, cut] : by_element) {
    ElementSection section{element, Chain(cut)};
    if (!section.rings.empty()) sections.push_back(std::move(section));
  }
  return sections;
}

std::vector<ElementSection> CutAt(const AGraph& graph, double z_m) { return ClosedSections(SegmentsAt(graph, z_m)); }

std::vector<Edge> EdgesSeenFromAbove(const AGraph& graph, double z_min_m, double z_max_m) {
  using Key = std::array<double, 6>;
  std::map<uint32_t, std::map<Key, Faces>> by_element;
  for (const Triangle& t : graph.mesh.triangles) {
    if (!IsFurnishing(graph.elements[t.element].kind)) continue;
    const std::array<Eigen::Vector3d, 3> p = {Corner(graph, t.a), Corner(graph, t.b), Corner(graph, t.c)};
    const Eigen::Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (size_t i = 0; i < 3; ++i) {
      Eigen::Vector3d a = p[i], b = p[(i + 1) % 3];
      if (std::min(a.z(), b.z()) < z_min_m || std::max(a.z(), b.z()) > z_max_m) continue;
      if (LessXyz(b, a)) std::swap(a, b);
      Faces& faces = by_element[t.element][{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
      faces.a = a;
      faces.b = b;
      faces.normals.push_back(normal);
    }
  }
  std::vector<Edge> edges;
  for (const auto& [element, all] : by_element) {
    for (const auto& [key, faces] : all) {
      if (IsSeen(faces)) edges.emplace_back(faces.a.head<2>(), faces.b.head<2>());
    }
  }
  return edges;
}

}  // namespace plumb::tools
