// Gaps of full height in curved walls: doorways without a lintel.
#pragma once

#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

// Between two free ends of facet chains that stand on one circle within 2 cm, with nothing between them and no more than `max_free_gap_m`
// of it. Facets with nothing in them close the gap along the circle; their directions are appended to `directions`. O(n^2).
void CloseGapsInCurves(const MeshOptions& options, std::vector<FaceDirection>& directions, std::vector<WallPiece>& pieces);

}  // namespace plumb::compiler
