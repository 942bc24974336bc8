#include "runtime/matching/door_leaves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace plumb::runtime {
namespace {

// Connected pieces of the mesh of one doorway's elements: union-find over vertices at the same place.
class Pieces {
 public:
  Pieces(const Mesh& mesh, const std::vector<uint32_t>& triangles) : parent_(triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
    std::map<std::array<int64_t, 3>, size_t> first_at;  // 0.1 mm apart is the same place
    for (size_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[triangles[i]];
      for (const uint32_t v : {t.a, t.b, t.c}) {
        const Eigen::Vector3d p = mesh.vertices[v].cast<double>() * 1e4;
        const auto [it, added] = first_at.try_emplace({std::llround(p.x()), std::llround(p.y()), std::llround(p.z())}, i);
        if (!added) parent_[Root(i)] = Root(it->second);
      }
    }
  }
  size_t Root(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  std::vector<size_t> parent_;
};

// Does the triangle reach into the box [-half, half] about the origin? Separating axes (Akenine-Moeller 2001).
bool TriangleMeetsBox(const std::array<Eigen::Vector3d, 3>& p, const Eigen::Vector3d& half) {
  const auto separated = [&](const Eigen::Vector3d& axis) {
    const double a = axis.dot(p[0]), b = axis.dot(p[1]), c = axis.dot(p[2]), reach = axis.cwiseAbs().dot(half);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const std::array<Eigen::Vector3d, 3> edges = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  for (int k = 0; k < 3; ++k) {
    if (separated(Eigen::Vector3d::Unit(k))) return false;
    for (const Eigen::Vector3d& edge : edges) {
      if (separated(Eigen::Vector3d::Unit(k).cross(edge))) return false;
    }
  }
  return !separated(edges[0].cross(edges[1]));
}

// The space that people walk through: the opening less a frame on each side and above, and a threshold below. In the doorway's own frame, x
// along the passage.
struct Passage {
  Eigen::Vector3d center, half;
  Eigen::Matrix3d R;

  explicit Passage(const Doorway& d, double thickness_m) {
    constexpr double kFrameShare = 0.2;  // of width and height
    constexpr double kThreshold_m = 0.05;
    const double top_m = d.height_m * (1 - 0.5 * kFrameShare);
    half << 0.5 * thickness_m + 0.2, 0.5 * d.width_m * (1 - kFrameShare), 0.5 * (top_m - kThreshold_m);
    center = d.position + Eigen::Vector3d(0, 0, 0.5 * (top_m + kThreshold_m));
    R = Eigen::AngleAxisd(d.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
};

void MarkLeaf(const AGraph& plan, DoorwayId id, const std::vector<uint32_t>& triangles, std::vector<DoorwayId>& leaf_of) {
  const Doorway& doorway = plan.doorways[id.index()];
  const Passage passage(doorway, doorway.wall.valid() ? plan.walls[doorway.wall.index()].thickness_m : 0.3);
  Pieces pieces(plan.mesh, triangles);
  std::vector<bool> in_the_way(triangles.size(), false);
  for (size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = plan.mesh.triangles[triangles[i]];
    std::array<Eigen::Vector3d, 3> p;
    for (size_t k = 0; const uint32_t v : {t.a, t.b, t.c}) {
      p[k++] = passage.R.transpose() * (plan.mesh.vertices[v].cast<double>() + plan.origin - passage.center);
    }
    if (TriangleMeetsBox(p, passage.half)) in_the_way[pieces.Root(i)] = true;
  }
  for (size_t i = 0; i < triangles.size(); ++i) {
    if (in_the_way[pieces.Root(i)]) leaf_of[triangles[i]] = id;
  }
}

}  // namespace

std::vector<DoorwayId> LeafTriangles(const AGraph& plan) {
  std::vector<std::vector<uint32_t>> of_doorway(plan.doorways.size());
  for (uint32_t i = 0; i < plan.mesh.triangles.size(); ++i) {
    const Element& element = plan.elements[plan.mesh.triangles[i].element];
    if (element.kind == ElementKind::kDoor && element.doorway.valid()) of_doorway[element.doorway.index()].push_back(i);
  }
  std::vector<DoorwayId> leaf_of(plan.mesh.triangles.size());
  for (size_t d = 0; d < plan.doorways.size(); ++d) MarkLeaf(plan, DoorwayId(d), of_doorway[d], leaf_of);
  return leaf_of;
}

}  // namespace plumb::runtime
