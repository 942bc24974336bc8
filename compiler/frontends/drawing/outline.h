// The straight sides of the walls' material, with the wall on their left.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

struct Side {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();
  uint32_t source = 0;        // path of its first edge
  uint32_t prev = 0, next = 0;  // sides around the same piece of material
  bool curved = false;        // a step along a curve
  uint32_t circle = 0xffffffffu;  // ... along an arc: in the mass's circles
  [[nodiscard]] double length_m() const { return (b - a).norm(); }
  [[nodiscard]] Eigen::Vector2d along() const { return (b - a).normalized(); }
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (a + b); }
};

struct SideHit {
  double t_m = 0;
  uint32_t side = 0;
};

class Outline {
 public:
  explicit Outline(const WallMass& mass);
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  [[nodiscard]] const WallMass& mass() const { return mass_; }
  [[nodiscard]] bool InWall(const Eigen::Vector2d& p) const { return mass_.is_wall[mass_.map.FaceAt(p)]; }
  // The first side on the way, seen from within the walls or from the free space.
  [[nodiscard]] std::optional<SideHit> Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double max_m) const;
  [[nodiscard]] std::vector<uint32_t> SidesIn(const Eigen::AlignedBox2d& box) const;  // sorted
  [[nodiscard]] double DistanceTo(const Eigen::Vector2d& p, double max_m) const;     // to the nearest side; max_m if none is nearer
  // Both neighbours turn away by about a right angle: the end of a wall.
  [[nodiscard]] bool IsEnd(uint32_t side) const;

 private:
  [[nodiscard]] uint32_t NextBoundary(uint32_t half_edge) const;
  void AddLoop(const std::vector<uint32_t>& loop);

  const WallMass& mass_;
  std::vector<Side> sides_;
  std::vector<uint32_t> side_of_edge_;
};

}  // namespace plumb::compiler
