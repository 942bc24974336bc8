// One storey as the occupancy grid that nav2's map_server reads: map.yaml and map.pgm.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

struct OccupancyOptions {
  double height_m = 0.3;         // of the sensor above the floor: what is cut there is occupied
  double resolution_m = 0.05;    // edge of a cell
  double margin_m = 0.5;         // unknown border around the storey
  size_t max_cells = 100000000;  // more is an error, not a file that no robot can load
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

// Grey values as map_saver writes them and, with the thresholds of MapYaml, as map_server reads them.
enum class Occupancy : uint8_t { kOccupied = 0, kUnknown = 205, kFree = 254 };

struct OccupancyMap {
  Eigen::Vector2d origin =
      Eigen::Vector2d::Zero();  // lower left corner of the lower left cell, plan frame, metres; a multiple of the resolution
  double resolution_m = 0;
  size_t columns = 0, rows = 0;
  std::vector<Occupancy> cells;  // by row from the lowest y, as x and y grow

  [[nodiscard]] Occupancy& at(size_t column, size_t row) { return cells[row * columns + column]; }
  [[nodiscard]] Occupancy at(size_t column, size_t row) const { return cells[row * columns + column]; }
};

// Free: rooms and doorways, all doors standing open. Occupied: every cell that an element meets at that height over the storey's floor (the
// one with the most area), also panes, which a robot cannot pass. Unknown: the rest. Linear in triangles and cells. Errors: kBadOption
// (options, too many cells), kPlanUnsuitable (a storey without rooms and walls).
[[nodiscard]] Expected<OccupancyMap> MakeOccupancyMap(const AGraph& graph, StoreyId storey, const OccupancyOptions& options = {});

// Binary PGM (P5), the highest y first.
[[nodiscard]] std::string MapPgm(const OccupancyMap& map);
// Mode trinary, origin [x, y, 0]; `image` is the name of the PGM beside it.
[[nodiscard]] std::string MapYaml(const OccupancyMap& map, const std::string& image);

}  // namespace plumb::tools
