// Triangle solids in double precision and what the frontends and passes ask of them. Metres. All functions are deterministic.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumb::compiler {

// A polygon soup in double precision; triangles index vertices, counter-clockwise seen from outside.
struct Solid {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

// Signed volume by the divergence theorem: positive for a closed solid with its normals outward.
[[nodiscard]] double Volume(const Solid& solid);
[[nodiscard]] double SurfaceArea(const Solid& solid);
[[nodiscard]] Eigen::AlignedBox3d Bounds(const Solid& solid);  // of the vertices that triangles use

// Every edge is run through as often in one direction as in the other: the surface has no boundary and one orientation.
// Vertices must be welded. O(n): edges are summed up by hash, and a surface with a boundary passes by a chance of 2^-64.
[[nodiscard]] bool IsClosed(const Solid& solid);

// Mirroring maps keep the normals outward: the triangles are turned.
void TransformSolid(const Eigen::Affine3d& T_out_in, Solid& solid);
void AppendSolid(const Solid& from, Solid& into);
void AppendSolid(Solid&& from, Solid& into);  // without a copy where `into` is empty
void FlipSolid(Solid& solid);
void ShrinkSolid(Solid& solid);  // gives back the memory that it does not use, if that is much

// Finds an earlier point within a tolerance by hashing points to cells much larger than it; only points near a cell's border are looked up
// in more than one cell. O(1) a point.
class VertexWelder {
 public:
  explicit VertexWelder(double tolerance_m);
  [[nodiscard]] int FindOrAdd(const Eigen::Vector3d& p);                            // its number
  [[nodiscard]] std::vector<Eigen::Vector3d> Take() { return std::move(points_); }  // by number

 private:
  struct HashCell {
    uint64_t key = 0;
    int head = -1;  // its last point; none: the slot is empty
  };
  [[nodiscard]] int FindInCell(uint64_t key, const Eigen::Vector3d& p) const;
  [[nodiscard]] size_t SlotOf(uint64_t key) const;
  void Grow();

  double tolerance_m_, cell_m_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<int> next_;  // in the same cell
  std::vector<HashCell> cells_;  // a hash table with open addresses; their number is a power of two
  size_t used_cells_ = 0;
};

// Makes vertices closer than `tolerance_m` one, drops triangles that lose a corner by it and vertices that no triangle uses.
void WeldSolid(double tolerance_m, Solid& solid);

// Turns the triangles of each connected, closed, consistently orientable piece to one orientation; and the whole so that its volume is
// positive. Pieces inside another one (cavities) keep their given orientation if the surface was closed already. Expects welded vertices.
void OrientOutward(Solid& solid);

// The pieces that share no vertex, in the order of their first triangles. Expects welded vertices.
[[nodiscard]] std::vector<Solid> ConnectedPieces(const Solid& solid);

// The box [low, high] under `T_out_box`; 12 triangles.
[[nodiscard]] Solid MakeBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                            const Eigen::Affine3d& T_out_box = Eigen::Affine3d::Identity());

}  // namespace plumb::compiler
