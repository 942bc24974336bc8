// Sections of a mesh as lines: upright faces grouped to vertical planes by direction and offset, with the stretches that each covers at
// each height, and the pairs of faces that are the two sides of a wall.
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

// The directions of upright faces, those with the most area first; faces within half a degree of one belong to it.
[[nodiscard]] std::vector<FaceDirection> FindDirections(const std::vector<MeshObject>& objects);

struct Span {
  double s0_m = 0, s1_m = 0;
};

// Two faces with solid between them, or one with nothing behind it, at the heights of the section.
struct Band {
  size_t direction = 0;
  double c0_m = 0, c1_m = 0;             // offsets of its faces across; c0 < c1
  uint32_t group = 0;                    // of objects that make walls together
  bool sheet = false;                    // has one face only; the other one is made up
  std::vector<std::vector<Span>> spans;  // by height: where it is solid, sorted
};

// How the triangles' orientation is to be read.
enum class Facing : uint8_t { kOutward, kInward, kUnknown };

struct SectionStack {
  std::vector<double> heights_m;                   // of the cuts
  std::vector<std::vector<FaceSegment>> segments;  // by height
};

[[nodiscard]] Facing FindFacing(const std::vector<FaceDirection>& directions, const SectionStack& stack, const MeshOptions& options);

// `group_of`: by object. In the order of directions, groups and offsets.
[[nodiscard]] std::vector<Band> FindBands(const std::vector<FaceDirection>& directions, const SectionStack& stack,
                                          const std::vector<uint32_t>& group_of, Facing facing, const MeshOptions& options);

}  // namespace plumb::compiler
