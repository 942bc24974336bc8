#include "compiler/passes/face_locator.h"

#include <utility>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {

std::vector<Ring> FaceRings(const Floor& floor, const FloorFace& face) {
  std::vector<Ring> out;
  const auto append = [&](const std::vector<BoundaryEdge>& edges) {
    Ring ring;
    for (const BoundaryEdge& e : edges) ring.push_back(floor.vertices[e.from]);
    out.push_back(std::move(ring));
  };
  if (face.bounded()) append(face.outer);
  for (const auto& hole : face.holes) append(hole);
  return out;
}

FaceLocator::FaceLocator(const Floor& floor) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (size_t i = 1; i < floor.faces.size(); ++i) {
    rings_.push_back(FaceRings(floor, floor.faces[i]));
    boxes.push_back(BoundingBox(rings_.back()));
  }
  boxes_ = BoxTree<2>(std::move(boxes));
}

uint32_t FaceLocator::FaceAt(const Eigen::Vector2d& p) const {
  uint32_t first = kNoIndex;
  boxes_.ForEachIn(Eigen::AlignedBox2d(p), [&](uint32_t i) {
    if (i < first && WindingNumber(rings_[i], p) != 0) first = i;
  });
  return first == kNoIndex ? 0 : first + 1;
}

}  // namespace plumb::compiler
