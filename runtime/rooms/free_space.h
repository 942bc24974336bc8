// What the robot saw of one floor, from above: free space, walls, and other things that rays ended at.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/rooms/floor_grid.h"
#include "runtime/rooms/room_options.h"
#include "runtime/rooms/rooms.h"

namespace plumb::runtime {

// A stretch of a wall surface that was seen within the floor's height band, without openings; free space to the left of the way from start
// to end. Unlike MapSurface's, its ends are those of the wall beside a doorway, not of the lintel above.
struct WallPiece {
  uint32_t surface = 0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();

  [[nodiscard]] double length_m() const { return (end - start).norm(); }
  [[nodiscard]] Eigen::Vector2d along() const { return (end - start).normalized(); }
  [[nodiscard]] Eigen::Vector2d normal() const {
    const Eigen::Vector2d a = along();
    return {-a.y(), a.x()};
  }
};

enum class CellState : uint8_t { kUnknown, kFree, kHit, kWall };

struct FreeSpace {
  FloorGrid grid;
  std::vector<CellState> cells;
  std::vector<WallPiece> walls;  // by surface
};

// From the points of the floor's keyframes, as seen from the keyframes' poses: of every half degree the farthest that a ray got within the
// height band, so that one sees over tables and under lamps. Nothing passes a wall: window panes have their parapets below. A surface that
// ends below 1.5 m and is mostly seen over is furniture, not a wall. Where the floor was not seen, the band is that of a sensor 0.5 m above
// it. A floor without points has a grid without cells.
[[nodiscard]] FreeSpace FindFreeSpace(const SGraph& graph, const MapFloor& floor, const RoomOptions& options);

}  // namespace plumb::runtime
