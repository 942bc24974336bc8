#include "compiler/frontends/ifc/ifc_primitives.h"

#include <cmath>
#include <numbers>

#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// A profile of radius over height, from the foot up, turned about the z axis.
Solid Turned(const Ring2& profile, int segments) {
  Solid solid = Revolve({profile}, Vector2d::Zero(), Vector2d::UnitY(), 2 * kPi, segments);
  TransformSolid(Eigen::Affine3d(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX())), solid);
  return solid;
}

Solid Pyramid(double x_m, double y_m, double height_m) {
  Solid solid;
  solid.vertices = {{0, 0, 0}, {x_m, 0, 0}, {x_m, y_m, 0}, {0, y_m, 0}, {x_m / 2, y_m / 2, height_m}};
  solid.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return solid;
}

Solid Sphere(double radius_m, double chord_tolerance_m) {
  const int rows = ArcSegments(radius_m, kPi, chord_tolerance_m);
  Ring2 profile = {{0, -radius_m}};
  for (int i = 1; i < rows; ++i) {
    const double latitude = kPi * i / rows - kPi / 2;
    profile.emplace_back(radius_m * std::cos(latitude), radius_m * std::sin(latitude));
  }
  profile.emplace_back(0, radius_m);
  return Turned(profile, ArcSegments(radius_m, 2 * kPi, chord_tolerance_m));
}

}  // namespace

Solid ReadPrimitive(const IfcModel& model, const IfcInstance& item, double chord_tolerance_m) {
  if (item.type == IfcType::kIfcBlock || item.type == IfcType::kIfcRectangularPyramid) {
    const Vector3d size(model.Length(item, attribute::kBlockX), model.Length(item, attribute::kBlockY),
                        model.Length(item, attribute::kBlockZ));
    if (!(size.minCoeff() > 0)) return {};
    return item.type == IfcType::kIfcBlock ? MakeBox(Vector3d::Zero(), size) : Pyramid(size.x(), size.y(), size.z());
  }
  if (item.type == IfcType::kIfcSphere) {
    const double radius_m = model.Length(item, attribute::kSphereRadius);
    return radius_m > 0 ? Sphere(radius_m, chord_tolerance_m) : Solid();
  }
  const double radius_m = model.Length(item, attribute::kCylinderRadius), height_m = model.Length(item, attribute::kCylinderHeight);
  if (!(radius_m > 0 && height_m > 0)) return {};
  Ring2 profile = {{0, 0}, {radius_m, 0}};
  if (item.type == IfcType::kIfcRightCircularCylinder) profile.emplace_back(radius_m, height_m);
  profile.emplace_back(0, height_m);
  return Turned(profile, ArcSegments(radius_m, 2 * kPi, chord_tolerance_m));
}

}  // namespace plumb::compiler
