// Which triangles of a mesh are the faces of which wall.
#pragma once

#include <map>
#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

inline constexpr uint32_t kPool = 0;  // group of the objects that make walls only together; else 1 + the object's index

struct StoreyWalls {
  StoreyRange range;
  std::vector<WallPiece> pieces;
  std::vector<std::map<uint32_t, std::vector<uint32_t>>> triangles;  // by piece: of which objects, ascending
};

// Each triangle goes to the wall whose box holds its middle: one of its own object's walls first, on the lowest storey. Fills
// `triangles` of the storeys. Returns by object and triangle whether a wall took it. n triangles, w walls: O(n log w).
[[nodiscard]] std::vector<std::vector<bool>> AssignTriangles(const std::vector<MeshObject>& objects,
                                                             const std::vector<FaceDirection>& directions,
                                                             std::vector<StoreyWalls>& storeys);

// The object that most of a wall's faces come from.
[[nodiscard]] uint32_t OwnerOf(const std::vector<MeshObject>& objects, const StoreyWalls& storey, size_t piece);

// Those triangles of `from`, welded.
void AppendPart(const Solid& from, const std::vector<uint32_t>& triangles, Solid& into);

}  // namespace plumb::compiler
