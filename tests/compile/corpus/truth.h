// What a plan says about its rooms and doors, by rules that share nothing with the compiler's passes but the section of one solid.
// Frame: as PlanIr.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/ir/plan_ir.h"
#include "tests/compile/corpus/raster.h"

namespace plumb::corpus {

struct TrueSpace {
  std::string name, guid, storey;
  Rings outline;
  double z_m = 0;         // where it is cut
  bool enclosed = false;  // walls, columns, doors or windows run along at least 95 % of its outline
};

// One side of a door: a point in the first space or free cell that a walk away from the wall meets.
struct DoorSide {
  enum class Kind { kSpace, kCell, kOutside, kBlocked } kind = Kind::kBlocked;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  int32_t id = -1;  // of the space or the cell
  bool open_air = false;  // a space that walls do not enclose, as a terrace: a room or the outside
};

struct TrueDoor {
  std::string name, guid, storey;
  double z_m = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  DoorSide sides[2];
};

class Truth {
 public:
  explicit Truth(const compiler::PlanIr& plan);

  [[nodiscard]] const std::vector<TrueSpace>& spaces() const { return spaces_; }
  [[nodiscard]] const std::vector<TrueDoor>& doors() const { return doors_; }

 private:
  void ReadSpaces();
  void ReadDoors();
  void AddDoor(uint32_t element, const compiler::PlanOpening* opening);
  [[nodiscard]] Eigen::Vector2d Along(uint32_t element, const compiler::PlanOpening* opening) const;
  [[nodiscard]] DoorSide SideOf(const TrueDoor& door, const Eigen::Vector2d& along, const Eigen::Vector2d& away, double width_m);
  const Raster& RasterAt(double z_m);

  const compiler::PlanIr& plan_;
  std::vector<TrueSpace> spaces_;
  std::vector<TrueDoor> doors_;
  std::map<int, Raster> rasters_;  // by height in units of 0.1 m
};

}  // namespace plumb::corpus
