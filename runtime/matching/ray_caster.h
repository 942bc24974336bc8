// Casts rays into an A-Graph's triangles (Embree). Thread-safe after construction.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "schema/agraph.h"

namespace plumb::runtime {

struct Ray {
  Eigen::Vector3f origin, direction;  // mesh frame (plan minus AGraph::origin); direction of unit length
  float max_range_m = 120.0f;
};

struct RayHit {
  float range_m = -1;                 // negative: nothing hit within max_range_m
  uint32_t triangle = 0xffffffffu;    // index into Mesh::triangles
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // unit, towards the ray's origin
  [[nodiscard]] bool hit() const { return range_m >= 0; }
};

class RayCaster {
 public:
  // Keeps only triangles for which keep[i] is true (empty: all). O(n log n).
  explicit RayCaster(const Mesh& mesh, const std::vector<bool>& keep = {});
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  // The same triangles mirrored in x, at no cost: they are kept once, and rays are turned round instead.
  [[nodiscard]] RayCaster Mirrored() const;

  // First hit of each ray; hits.size() == rays.size().
  void Cast(std::span<const Ray> rays, std::span<RayHit> hits) const;
  [[nodiscard]] RayHit Cast(const Ray& ray) const;

 private:
  struct Impl;
  explicit RayCaster(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
  bool mirrored_ = false;
};

}  // namespace plumb::runtime
