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
  for (size_t i = 1; i < floor.faces.size(); ++i) {
    std::vector<Ring> rings = FaceRings(floor, floor.faces[i]);
    const Eigen::AlignedBox2d box = BoundingBox(rings);
    entries_.push_back({std::move(rings), box});
  }
}

uint32_t FaceLocator::FaceAt(const Eigen::Vector2d& p) const {
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].box.contains(p) && WindingNumber(entries_[i].rings, p) != 0) return static_cast<uint32_t>(i + 1);
  }
  return 0;
}

}  // namespace plumb::compiler
