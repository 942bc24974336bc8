// Where on a storey a robot can stand: an occupancy grid of the house as built, at the heights of the robot's body.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "schema/agraph.h"
#include "tools/simulate/rectangle.h"

namespace plumb::tools {

struct Cell {
  int x = 0, y = 0;
  friend bool operator==(Cell, Cell) = default;
};

inline constexpr double kCell_m = 0.05;
inline constexpr double kBodyBottom_m = 0.1, kBodyTop_m = 1.2;  // above the floor; lower things are thresholds

class FreeSpace {
 public:
  static constexpr int16_t kNoRoom = -1, kPassage = -2;

  // `house` as built, inner doors open; rooms and doorways as planned. `passages`: the floor of the doorways between rooms, where built.
  // Empty (size() == 0) if the storey has no rooms or is larger than 400 m x 400 m. O(area + triangles).
  FreeSpace(const AGraph& house, StoreyId storey, const std::vector<Rectangle>& passages);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] double floor_z_m() const { return floor_z_m_; }
  [[nodiscard]] size_t Index(Cell c) const { return static_cast<size_t>(c.y) * static_cast<size_t>(width_) + static_cast<size_t>(c.x); }
  [[nodiscard]] Cell At(size_t index) const {
    return {static_cast<int>(index % static_cast<size_t>(width_)), static_cast<int>(index / static_cast<size_t>(width_))};
  }
  [[nodiscard]] Eigen::Vector2d Center(Cell c) const { return origin_ + kCell_m * Eigen::Vector2d(c.x + 0.5, c.y + 0.5); }
  // The cell that holds p, clamped to the grid.
  [[nodiscard]] Cell CellAt(const Eigen::Vector2d& p) const;
  // Distance to the nearest obstacle or place where the robot must not be; 0 there.
  [[nodiscard]] double clearance_m(size_t index) const { return static_cast<double>(clearance_m_[index]); }
  [[nodiscard]] double ClearanceAt(const Eigen::Vector2d& p) const { return clearance_m(Index(CellAt(p))); }
  // Something stands on the floor there. O(area nearer to it than to any other obstacle).
  void Block(const Rectangle& footprint);
  // The room whose planned polygon holds the cell, kPassage in doorways, else kNoRoom.
  [[nodiscard]] int16_t room(size_t index) const { return room_[index]; }
  [[nodiscard]] size_t size() const { return room_.size(); }

 private:
  void LabelRooms(const AGraph& house, StoreyId storey, const std::vector<Rectangle>& passages);
  void BlockTriangles(const AGraph& house, std::vector<uint8_t>& blocked) const;
  void BlockMissingFloor(const AGraph& house, std::vector<uint8_t>& blocked) const;
  void MeasureClearance(const std::vector<uint8_t>& blocked);
  // All cells that the convex polygon touches, edges included.
  template <class Visit>
  void VisitCells(const std::vector<Eigen::Vector2d>& polygon, const Visit& visit) const;

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  int width_ = 0, height_ = 0;
  double floor_z_m_ = 0;
  std::vector<int16_t> room_;
  std::vector<float> clearance_m_;
};

}  // namespace plumb::tools
