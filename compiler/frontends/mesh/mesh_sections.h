// Sections of a mesh as lines, the directions of its upright faces, and which way these face.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/frontends/mesh/mesh_scene.h"

namespace plumb::compiler {

struct FaceSegment {
  Eigen::Vector2d a, b;  // the solid is on the left of the way from a to b, where the mesh is oriented
  uint32_t object = 0;
};

// Where the triangles of the objects meet the plane at z_m.
[[nodiscard]] std::vector<FaceSegment> CutScene(const std::vector<MeshObject>& objects, double z_m);

struct FaceDirection {
  Eigen::Vector2d along = Eigen::Vector2d::UnitX(), across = Eigen::Vector2d::UnitY();  // across = along turned by +90 degrees
  [[nodiscard]] double S(const Eigen::Vector2d& p) const { return along.dot(p); }
  [[nodiscard]] double C(const Eigen::Vector2d& p) const { return across.dot(p); }
  [[nodiscard]] Eigen::Vector2d At(double s_m, double c_m) const { return s_m * along + c_m * across; }
};

inline constexpr double kSameDirection_rad = 0.005;  // faces within it are parallel

// The directions of upright faces, those with the most area first; faces within half a degree of one belong to it.
[[nodiscard]] std::vector<FaceDirection> FindDirections(const std::vector<MeshObject>& objects);

// How the triangles' orientation is to be read.
enum class Facing : uint8_t { kOutward, kInward, kUnknown };

struct SectionStack {
  std::vector<double> heights_m;                   // of the cuts
  std::vector<std::vector<FaceSegment>> segments;  // by height
};

[[nodiscard]] Facing FindFacing(const std::vector<FaceDirection>& directions, const SectionStack& stack, const MeshOptions& options);

}  // namespace plumb::compiler
