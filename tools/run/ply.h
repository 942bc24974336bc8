// Point clouds as PLY, the form that CloudCompare, MeshLab and Open3D open.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace plumb::tools {

// Binary little-endian PLY with x, y, z in metres; double, because plans may lie hundreds of kilometres from their zero.
[[nodiscard]] std::string PointsToPly(const std::vector<Eigen::Vector3d>& points, const std::string& comment);

}  // namespace plumb::tools
