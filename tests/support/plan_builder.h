// Makes PlanIr by hand: walls as prisms, openings, spaces, slabs. For tests of passes that need no frontend.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/ir/plan_ir.h"

namespace plumb::test {

// A closed prism over a simple ring (any shape, counter-clockwise).
[[nodiscard]] compiler::Solid Prism(const Ring& ring, double z_min_m, double z_max_m);
[[nodiscard]] Ring Rectangle(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi);

class PlanBuilder {
 public:
  uint32_t Storey(const std::string& name, double elevation_m);
  // What follows belongs to `storey` (none: kNoIndex).
  PlanBuilder& On(uint32_t storey);

  // Along the centre line, square ends.
  uint32_t Wall(const std::string& guid, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness_m, double z_min_m = 0,
                double z_max_m = 2.5);
  uint32_t Prismatic(ElementKind kind, const std::string& guid, const Ring& ring, double z_min_m, double z_max_m);

  // A void of the wall's full thickness, `along_m` from the start of the centre line to its middle; bodies of walls stay uncut.
  uint32_t Opening(const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m, double z_max_m);
  uint32_t Door(const std::string& guid, uint32_t wall, double along_m, double width_m = 0.9, double z_min_m = 0, double z_max_m = 2.1);
  uint32_t Window(const std::string& guid, uint32_t wall, double along_m, double width_m = 1.2, double z_min_m = 0.9, double z_max_m = 2.1);

  uint32_t Space(const std::string& name, const Ring& ring, double z_min_m = 0, double z_max_m = 2.5);

  compiler::PlanIr plan;

 private:
  struct CentreLine {
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
    double thickness_m = 0;
  };
  compiler::Solid Void(const CentreLine& line, double along_m, double width_m, double depth_m, double z_min_m, double z_max_m) const;
  uint32_t Fill(ElementKind kind, const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m, double z_max_m);

  uint32_t storey_ = compiler::kNoIndex;
  std::map<uint32_t, CentreLine> lines_;  // of walls, by element
};

// The outer walls 0.3 m thick around [0,8] x [0,4] inside, an inner wall 0.2 m thick at x = 5 with door "D" (0.9 m wide, middle at y
// = 1.5), outer door "E" in the south wall at x = 2, window "W" in the east wall at y = 2, slabs at 0 and 2.5 m, spaces "West" and "East".
[[nodiscard]] compiler::PlanIr TwoRooms();

// The same plan after x -> Rz(yaw) x + translation.
[[nodiscard]] compiler::PlanIr Moved(const compiler::PlanIr& plan, double yaw_rad, const Eigen::Vector3d& translation);

// The same plan with elements, openings and spaces in another order.
[[nodiscard]] compiler::PlanIr Shuffled(const compiler::PlanIr& plan, uint64_t seed);

}  // namespace plumb::test
