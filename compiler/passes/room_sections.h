// What a LiDAR sees of a room at a few heights: horizontal sections of the fixed things around it, as points along them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/passes/planar_motion.h"
#include "schema/agraph.h"

namespace plumb::compiler {

struct SectionOptions {
  std::vector<double> heights_m = {0.5, 1.5};  // of the sections above a room's floor: below and above window sills
  double step_m = 0.1;                         // between the points along a section
  double tolerance_m = 0.06;                   // off a section that still coincides with it
  double max_turn_rad = 0.35;                  // between the normals of sections that coincide
  size_t max_compared = 1 << 17;               // points of all rooms; of more, each room has only some compared, but 16
  [[nodiscard]] std::string Check() const;
};

// Stands for `step_m` of section.
struct SectionPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();      // mesh frame: plan minus AGraph::origin
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // unit, into the room
  uint32_t element = 0;
  uint32_t height = 0;  // position in SectionOptions::heights_m
};

// Which of the points that were compared have no counterpart.
struct SectionComparison {
  size_t points = 0;
  std::vector<uint32_t> unmatched_elements;  // one entry for each point, both ways
  [[nodiscard]] double overlap_ratio() const {
    return points == 0 ? 0 : 1 - static_cast<double>(unmatched_elements.size()) / static_cast<double>(points);
  }
};

class RoomSections {
 public:
  // Cuts the mesh for the rooms whose `wanted` is set. Doors (they open), panes of glass and furniture (it moves) are left out; so is what
  // does not face a room. O(T log L + S) for T triangles, L floor levels and S points.
  RoomSections(const AGraph& graph, const std::vector<bool>& wanted, const SectionOptions& options);

  [[nodiscard]] std::span<const SectionPoint> Of(RoomId room) const {
    return {points_.data() + begin_[room.index()], points_.data() + begin_[room.index() + 1]};
  }

  // The points of `from` after `motion` (mesh frame) against those of `to`, and back.
  [[nodiscard]] SectionComparison Compare(RoomId from, const PlanarMotion& motion, RoomId to) const;

  [[nodiscard]] double step_m() const { return options_.step_m; }

 private:
  // Points of one room by cell, so that those near a place are found at once.
  struct Grid {
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    double cell_m = 1;
    int columns = 0, rows = 0;
    std::vector<uint32_t> begin;  // per height, row and column; positions in points_
  };
  class Cutter;
  static std::vector<std::span<const Triangle>> PartsOf(const std::vector<Triangle>& triangles);
  [[nodiscard]] std::vector<std::vector<std::pair<RoomId, SectionPoint>>> Find(const AGraph& graph, const std::vector<bool>& wanted) const;
  void BuildGrid(size_t room);
  [[nodiscard]] bool Coincides(RoomId room, const SectionPoint& p) const;
  void CompareOneWay(RoomId from, const PlanarMotion& motion, RoomId to, SectionComparison& out) const;

  SectionOptions options_;
  double min_cos_;
  size_t stride_ = 1;                 // every so many-th point of a room is compared
  std::vector<SectionPoint> points_;  // by room, then by cell of its grid
  std::vector<uint32_t> begin_;       // per room, and the end
  std::vector<Grid> grids_;           // per room
};

}  // namespace plumb::compiler
