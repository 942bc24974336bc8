#include "compiler/frontends/mesh/mesh_parts.h"

#include <algorithm>
#include <unordered_map>

#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLevel = 0.9;    // of a normal: the face is a floor, a ceiling or a cap
constexpr double kSkin_m = 0.02;  // triangles this close to a wall's box are its faces
constexpr double kFoot_m = 0.3;   // ... and down to here, where it stands on a slab
constexpr double kWeld_m = 1e-4;

const Vector3d& Corner(const Solid& solid, const Eigen::Vector3i& t, int k) { return solid.vertices[static_cast<size_t>(t[k])]; }

BoxTree<2> TreeOf(const std::vector<WallPiece>& pieces, const std::vector<FaceDirection>& directions) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const WallPiece& p : pieces) {
    const FaceDirection& d = directions[p.direction];
    Eigen::AlignedBox2d box;
    for (const double s : {p.span.s0_m - kSkin_m, p.span.s1_m + kSkin_m}) {
      for (const double c : {p.c0_m - kSkin_m, p.c1_m + kSkin_m}) box.extend(d.At(s, c));
    }
    boxes.push_back(box);
  }
  return BoxTree<2>(std::move(boxes));
}

double AreaOf(const Solid& solid, const std::vector<uint32_t>& triangles) {
  double out = 0;
  for (const uint32_t i : triangles) {
    const Eigen::Vector3i& t = solid.triangles[i];
    const Vector3d& a = Corner(solid, t, 0);
    out += 0.5 * (Corner(solid, t, 1) - a).cross(Corner(solid, t, 2) - a).norm();
  }
  return out;
}

}  // namespace

std::vector<std::vector<bool>> AssignTriangles(const std::vector<MeshObject>& objects, const std::vector<FaceDirection>& directions,
                                               std::vector<StoreyWalls>& storeys) {
  std::vector<std::vector<bool>> taken;
  for (const MeshObject& o : objects) taken.emplace_back(o.solid.triangles.size(), false);
  for (StoreyWalls& storey : storeys) {
    storey.triangles.assign(storey.pieces.size(), {});
    const BoxTree<2> tree = TreeOf(storey.pieces, directions);
    for (uint32_t o = 0; o < objects.size(); ++o) {
      const Solid& solid = objects[o].solid;
      for (uint32_t t = 0; t < solid.triangles.size(); ++t) {
        if (taken[o][t]) continue;
        const Eigen::Vector3i& corners = solid.triangles[t];
        const Vector3d middle = (Corner(solid, corners, 0) + Corner(solid, corners, 1) + Corner(solid, corners, 2)) / 3;
        const Vector3d normal =
            (Corner(solid, corners, 1) - Corner(solid, corners, 0)).cross(Corner(solid, corners, 2) - Corner(solid, corners, 0));
        const bool is_level = std::abs(normal.z()) > kLevel * normal.norm();
        const size_t none = storey.pieces.size();
        size_t own = none, any = none;
        tree.ForEachIn(Eigen::AlignedBox2d(Vector2d(middle.head<2>())), [&](uint32_t p) {
          const WallPiece& piece = storey.pieces[p];
          if (middle.z() < piece.z0_m - kFoot_m || middle.z() > piece.z1_m + kSkin_m) return;
          const FaceDirection& d = directions[piece.direction];
          if (!piece.Contains(d, middle.head<2>(), kSkin_m)) return;
          // Floors and ceilings lie over walls with their middles only.
          for (int k = 0; is_level && k < 3; ++k) {
            if (!piece.Contains(d, Corner(solid, corners, k).head<2>(), kSkin_m)) return;
          }
          size_t& best = piece.group == o + 1 ? own : any;
          best = std::min(best, size_t{p});
        });
        if (own == none && any == none) continue;
        storey.triangles[own != none ? own : any][o].push_back(t);
        taken[o][t] = true;
      }
    }
  }
  return taken;
}

uint32_t OwnerOf(const std::vector<MeshObject>& objects, const StoreyWalls& storey, size_t piece) {
  const uint32_t group = storey.pieces[piece].group;
  if (group != kPool) return group - 1;
  uint32_t best = 0;
  double most_m2 = 0;
  for (const auto& [object, triangles] : storey.triangles[piece]) {
    const double area_m2 = AreaOf(objects[object].solid, triangles);
    if (area_m2 <= most_m2) continue;
    most_m2 = area_m2;
    best = object;
  }
  return best;
}

void AppendPart(const Solid& from, const std::vector<uint32_t>& triangles, Solid& into) {
  Solid part;
  std::unordered_map<int, int> moved;  // corners that the part has
  for (const uint32_t i : triangles) {
    Eigen::Vector3i t = from.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const auto [place, fresh] = moved.try_emplace(t[k], static_cast<int>(part.vertices.size()));
      if (fresh) part.vertices.push_back(from.vertices[static_cast<size_t>(t[k])]);
      t[k] = place->second;
    }
    part.triangles.push_back(t);
  }
  WeldSolid(kWeld_m, part);
  AppendSolid(std::move(part), into);
}

}  // namespace plumb::compiler
