// Small scenes of boxes with known walls.
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/frontends/mesh/mesh_scene.h"

namespace plumb::compiler::test {

inline void AddBox(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high, MeshScene& scene) {
  MeshObject o;
  o.name = name;
  o.solid = MakeBox(low, high);
  scene.objects.push_back(std::move(o));
}

// Walls 0.2 m thick around 6 m by 4 m; a door 0.9 m wide and 2.1 m high in the south wall, from x = 2 on.
inline void AddHut(double floor_m, double height_m, MeshScene& scene, const std::string& suffix = "") {
  const double top = floor_m + height_m;
  AddBox("south_a" + suffix, {0, 0, floor_m}, {2, 0.2, top}, scene);
  AddBox("south_b" + suffix, {2.9, 0, floor_m}, {6, 0.2, top}, scene);
  AddBox("south_lintel" + suffix, {2, 0, floor_m + 2.1}, {2.9, 0.2, top}, scene);
  AddBox("north" + suffix, {0, 3.8, floor_m}, {6, 4, top}, scene);
  AddBox("west" + suffix, {0, 0.2, floor_m}, {0.2, 3.8, top}, scene);
  AddBox("east" + suffix, {5.8, 0.2, floor_m}, {6, 3.8, top}, scene);
}

// A ring wall around (0, 0) in `sides` straight steps, one object; its inner faces at inner_m.
inline void AddRing(double inner_m, double thickness_m, double height_m, int sides, MeshScene& scene) {
  MeshObject o;
  o.name = "ring";
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    for (const double r : {inner_m, inner_m + thickness_m}) {
      for (const double z : {0.0, height_m}) o.solid.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  }
  for (int i = 0; i < sides; ++i) {
    const int p = 4 * i, q = 4 * ((i + 1) % sides);
    const auto quad = [&](int a, int b, int c, int d) {
      o.solid.triangles.emplace_back(a, b, c);
      o.solid.triangles.emplace_back(a, c, d);
    };
    quad(p + 2, q + 2, q + 3, p + 3);  // outer
    quad(q, p, p + 1, q + 1);          // inner
    quad(p + 1, p + 3, q + 3, q + 1);  // top
    quad(p, q, q + 2, p + 2);          // bottom
  }
  scene.objects.push_back(std::move(o));
}

inline void Turn(const Eigen::Affine3d& T, MeshScene& scene) {
  for (MeshObject& o : scene.objects) TransformSolid(T, o.solid);
}

}  // namespace plumb::compiler::test
