// What the shape of a product is made of.
#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "compiler/frontends/ifc/ifc_styles.h"
#include "compiler/geometry/solid.h"
#include "schema/agraph.h"

namespace plumb::compiler {

struct ShapePart {
  Solid solid;
  Look look = Look::kUnstated;
  std::vector<Arc> arcs;                                         // exact arcs of an extruded profile ...
  Eigen::Affine3d T_part_profile = Eigen::Affine3d::Identity();  // ... and where its plane lies

  ShapePart() = default;
  ShapePart(Solid its_solid, Look its_look) : solid(std::move(its_solid)), look(its_look) {}
  ShapePart(const ShapePart&) = default;
  ShapePart& operator=(const ShapePart&) = default;
  // Eigen's transforms do not state that they never throw: vectors that grow would copy the solids.
  ShapePart(ShapePart&&) noexcept = default;
  ShapePart& operator=(ShapePart&&) noexcept = default;
  ~ShapePart() = default;
};
using ShapeParts = std::vector<ShapePart>;

}  // namespace plumb::compiler
