// Faces of a planar map as rings, and which of them holds a point.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "compiler/geometry/box_tree.h"
#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

// Boundaries of a face as rings: the outer one first, then its holes.
[[nodiscard]] std::vector<Ring> FaceRings(const Floor& floor, const FloorFace& face);

// Which face holds a point. Keeps its own copy of the rings.
class FaceLocator {
 public:
  explicit FaceLocator(const Floor& floor);
  // On an edge: either side. 0 is the unbounded face. O(log faces + edges of those whose box holds `p`).
  [[nodiscard]] uint32_t FaceAt(const Eigen::Vector2d& p) const;

 private:
  std::vector<std::vector<Ring>> rings_;  // of faces 1, 2, ...
  BoxTree<2> boxes_;
};

}  // namespace plumb::compiler
