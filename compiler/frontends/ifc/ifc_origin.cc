#include "compiler/frontends/ifc/ifc_origin.h"

#include <cmath>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

Eigen::AlignedBox3d BoundsOfBuilding(const PlanIr& plan) {
  Eigen::AlignedBox3d walls, all;
  for (const PlanElement& element : plan.elements) {
    if (element.kind == ElementKind::kGround) continue;
    const Eigen::AlignedBox3d box = Bounds(element.body);
    all.extend(box);
    if (element.kind == ElementKind::kWall || element.kind == ElementKind::kCurtainWall) walls.extend(box);
  }
  return walls.isEmpty() ? all : walls;
}

}  // namespace

bool MoveNearZero(double far_origin_m, PlanIr& plan) {
  const Eigen::AlignedBox3d box = BoundsOfBuilding(plan);
  if (box.isEmpty() || box.center().cwiseAbs().maxCoeff() <= far_origin_m) return false;
  Vector3d origin = box.center().array().round();  // whole metres: numbers in the file and here differ by a plain amount
  if (std::abs(origin.z()) <= far_origin_m) origin.z() = 0;
  plan.origin = origin;
  const auto move = [&origin](Solid& solid) {
    for (Vector3d& v : solid.vertices) v -= origin;
  };
  for (PlanElement& element : plan.elements) {
    move(element.body);
    move(element.uncut);
    for (Arc& arc : element.arcs) arc.center -= origin.head<2>();
    if (!element.axis) continue;
    element.axis->first -= origin.head<2>();
    element.axis->second -= origin.head<2>();
  }
  for (PlanOpening& opening : plan.openings) move(opening.body);
  for (PlanSpace& space : plan.spaces) move(space.body);
  for (PlanStorey& storey : plan.storeys) storey.elevation_m -= origin.z();
  return true;
}

}  // namespace plumb::compiler
