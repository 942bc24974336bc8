// Storeys of a mesh, told from its horizontal faces and from where its walls stand.
#pragma once

#include <vector>

#include "compiler/frontends/mesh/mesh_scene.h"
#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

// In metres, z up; from the lowest one upwards. `objects` are all there is, floors among them. Empty: none of the walls stands upright.
[[nodiscard]] std::vector<StoreyRange> FindStoreys(const std::vector<MeshObject>& walls, const std::vector<MeshObject>& objects);

// Heights between which the section of the walls does not change: of sills, lintels and tops; the first and last are those of `range`.
[[nodiscard]] std::vector<double> FindBreaks(const std::vector<MeshObject>& objects, const StoreyRange& range);

}  // namespace plumb::compiler
