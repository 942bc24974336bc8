#include "compiler/frontends/sdf/sdf_shapes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

constexpr int kSides = 24;

Ring2 Circle(double radius_m) {
  Ring2 out;
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * std::numbers::pi * i / kSides;
    out.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a));
  }
  return out;
}

}  // namespace

Solid MakeCylinder(double radius_m, double length_m) {
  Solid out = Extrude({Circle(radius_m)}, {0, 0, length_m});
  TransformSolid(Eigen::Affine3d(Eigen::Translation3d(0, 0, -0.5 * length_m)), out);
  return out;
}

Solid MakeSphere(double radius_m) {
  Ring2 half;
  for (int i = 0; i <= kSides / 2; ++i) {
    const double a = std::numbers::pi * (2.0 * i / kSides - 0.5);
    half.emplace_back(std::max(0.0, radius_m * std::cos(a)), radius_m * std::sin(a));
  }
  return Revolve({half}, {0, 0}, {0, 1}, 2 * std::numbers::pi, kSides);
}

Solid MakePlane(const Eigen::Vector3d& normal, const Eigen::Vector2d& size_m) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y();
  Solid out;
  out.vertices = {turn * Eigen::Vector3d(-x, -y, 0), turn * Eigen::Vector3d(x, -y, 0), turn * Eigen::Vector3d(x, y, 0),
                  turn * Eigen::Vector3d(-x, y, 0)};
  out.triangles = {{0, 1, 2}, {0, 2, 3}};
  return out;
}

}  // namespace plumb::compiler
