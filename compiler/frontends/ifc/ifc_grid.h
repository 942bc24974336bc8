// Placements on a building grid (IfcGridPlacement): where two grid axes meet. Metres.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <unordered_map>

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

class PlacementReader;

class GridReader {
 public:
  explicit GridReader(const IfcModel& model);

  // The IfcObjectPlacement that an IfcGridPlacement is relative to: the one it states (IFC4X3), else that of its grid.
  [[nodiscard]] IfcInstance ParentOf(const IfcInstance& grid_placement) const;
  // An IfcGridPlacement in that frame: the origin where its axes meet, each moved aside by its offset, x along the first axis or in the
  // placement's reference direction. None if the axes do not meet. O(points of the one axis times points of the other).
  [[nodiscard]] std::optional<Eigen::Isometry3d> Read(const IfcInstance& grid_placement, const PlacementReader& placements) const;

 private:
  const IfcModel& model_;
  std::unordered_map<uint32_t, uint32_t> grid_of_axis_;
};

}  // namespace plumb::compiler
