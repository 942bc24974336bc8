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
  size_t min_parallel = 256;                   // jobs (512 triangles, or a room) that are worth threads
  [[nodiscard]] std::string Check() const;
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

  // Each stands for `step_m` of section.
  [[nodiscard]] size_t NumPoints(RoomId room) const { return begin_[room.index() + 1] - begin_[room.index()]; }

  // The points of `from` after `motion` (mesh frame) against those of `to`, and back.
  [[nodiscard]] SectionComparison Compare(RoomId from, const PlanarMotion& motion, RoomId to) const;

  [[nodiscard]] double step_m() const { return options_.step_m; }

 private:
  // One triangle at one height. What its points share is kept once: of large buildings there are tens of millions.
  struct Cut {
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // unit, into the room
    uint32_t element = 0;
    uint32_t height = 0;  // position in SectionOptions::heights_m
  };
  struct Point {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();  // mesh frame: plan minus AGraph::origin
    uint32_t cut = 0;                              // position in cuts_
    uint32_t room = 0;
  };
  // Of a part of the mesh; its points' cuts are positions in its own.
  struct Found {
    std::vector<Cut> cuts;
    std::vector<Point> points;
  };
  // Points of one room by cell, so that those near a place are found at once.
  struct Grid {
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    double cell_m = 1;
    int columns = 0, rows = 0;
    std::vector<uint32_t> begin;  // per height, row and column; positions in points_
  };
  class Cutter;
  static std::vector<std::span<const Triangle>> PartsOf(const std::vector<Triangle>& triangles);
  [[nodiscard]] std::vector<Found> Find(const AGraph& graph, const std::vector<bool>& wanted) const;
  void BuildGrid(size_t room);
  [[nodiscard]] bool Coincides(RoomId room, const Eigen::Vector2d& place, const Eigen::Vector2d& normal, uint32_t height) const;
  void CompareOneWay(RoomId from, const PlanarMotion& motion, RoomId to, SectionComparison& out) const;

  SectionOptions options_;
  double min_cos_;
  size_t stride_ = 1;                 // every so many-th point of a room is compared
  std::vector<Cut> cuts_;             // in the order of the mesh
  std::vector<Point> points_;         // by room, then by cell of its grid
  std::vector<uint32_t> begin_;       // per room, and the end
  std::vector<Grid> grids_;           // per room
};

}  // namespace plumb::compiler
