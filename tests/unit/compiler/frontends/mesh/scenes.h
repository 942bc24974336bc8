// Small scenes of boxes with known walls.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/frontends/mesh/mesh_scene.h"
#include "compiler/geometry/sweep.h"

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

// A ring wall as AddRing makes it, open between two heights over `open` of its steps.
inline void AddRingWithOpening(double inner_m, double thickness_m, double height_m, int sides, int open, double sill_m, double head_m,
                               MeshScene& scene) {
  MeshObject o;
  o.name = "ring";
  const auto corner = [&](int i, double r_m, double z_m) {
    const double a = 2 * std::numbers::pi * i / sides;
    o.solid.vertices.emplace_back(r_m * std::cos(a), r_m * std::sin(a), z_m);
    return static_cast<int>(o.solid.vertices.size() - 1);
  };
  const double outer_m = inner_m + thickness_m;
  const auto quad = [&](int i, double r_m, double z_m, int j, double s_m, double y_m, int k, double t_m, double x_m, int l, double u_m,
                        double w_m) {
    const int a = corner(i, r_m, z_m), b = corner(j, s_m, y_m), c = corner(k, t_m, x_m), d = corner(l, u_m, w_m);
    o.solid.triangles.emplace_back(a, b, c);
    o.solid.triangles.emplace_back(a, c, d);
  };
  const auto add = [&](int i, double low_m, double high_m) {
    if (high_m <= low_m) return;
    quad(i, outer_m, low_m, i + 1, outer_m, low_m, i + 1, outer_m, high_m, i, outer_m, high_m);
    quad(i + 1, inner_m, low_m, i, inner_m, low_m, i, inner_m, high_m, i + 1, inner_m, high_m);
    quad(i, inner_m, high_m, i, outer_m, high_m, i + 1, outer_m, high_m, i + 1, inner_m, high_m);
    quad(i, outer_m, low_m, i, inner_m, low_m, i + 1, inner_m, low_m, i + 1, outer_m, low_m);
  };
  for (int i = 0; i < sides; ++i) {
    add(i, 0, i < open ? sill_m : height_m);
    if (i < open) add(i, head_m, height_m);
  }
  quad(0, inner_m, sill_m, 0, outer_m, sill_m, 0, outer_m, head_m, 0, inner_m, head_m);
  quad(open, outer_m, sill_m, open, inner_m, sill_m, open, inner_m, head_m, open, outer_m, head_m);
  scene.objects.push_back(std::move(o));
}

// What stands from angle to angle of a ring wall as AddRing makes it, cut square to the circle at both ends.
inline void AddRingPart(double inner_m, double thickness_m, double height_m, int sides, double from_rad, double to_rad, MeshScene& scene) {
  const double step_rad = 2 * std::numbers::pi / sides;
  std::vector<double> angles = {from_rad};
  for (double k = std::floor(from_rad / step_rad + 1e-6) + 1; k * step_rad < to_rad - 1e-6; ++k) angles.push_back(k * step_rad);
  angles.push_back(to_rad);
  Ring outline;
  const auto add = [&](double angle_rad, double corner_m) {
    const double off_rad = angle_rad - step_rad * std::floor(angle_rad / step_rad + 1e-6) - 0.5 * step_rad;  // from its facet's middle
    const double r_m = corner_m * std::cos(0.5 * step_rad) / std::cos(off_rad);
    outline.emplace_back(r_m * std::cos(angle_rad), r_m * std::sin(angle_rad));
  };
  for (const double a : angles) add(a, inner_m + thickness_m);
  for (auto a = angles.rbegin(); a != angles.rend(); ++a) add(*a, inner_m);
  MeshObject o;
  o.name = "ring";
  o.solid = Extrude({outline}, {0, 0, height_m});
  scene.objects.push_back(std::move(o));
}

inline void Turn(const Eigen::Affine3d& T, MeshScene& scene) {
  for (MeshObject& o : scene.objects) TransformSolid(T, o.solid);
}

}  // namespace plumb::compiler::test
