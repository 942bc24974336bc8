// Which rooms have one shape, doorways included, and the rigid motions that take one onto the other.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compiler/passes/planar_motion.h"
#include "schema/agraph.h"

namespace plumb::compiler {

struct TwinOptions {
  double tolerance_m = 0.06;          // between the boundaries of two rooms of one shape
  double height_tolerance_m = 0.1;    // between their clear heights
  double doorway_tolerance_m = 0.3;   // between the places and the widths of their doorways
  [[nodiscard]] std::string Check() const;
};

// Frame: mesh (plan minus AGraph::origin).
class RoomShapes {
 public:
  RoomShapes(const AGraph& graph, const TwinOptions& options);

  // Cheap and necessary: area, perimeter, height and number of doorways.
  [[nodiscard]] bool MayBeTwins(RoomId a, RoomId b) const;
  // Those that may be twins of another room, in no particular order. O(n log n), and the pairs of like ways and perimeter that are none.
  [[nodiscard]] std::vector<RoomId> WithLikelyTwins() const;
  // True if `motion` takes the boundary, floor, height and doorways of `a` onto those of `b`. O(E^2) for E edges.
  [[nodiscard]] bool TakesOnto(RoomId a, const PlanarMotion& motion, RoomId b) const;
  // All motions, at most 16, that do. No reflection is among them. If a == b, the first is the identity.
  [[nodiscard]] std::vector<PlanarMotion> MotionsOnto(RoomId a, RoomId b) const;

  [[nodiscard]] const Eigen::Vector3d& Center(RoomId room) const { return shapes_[room.index()].center; }
  // Rooms next door, through doorways and open boundaries, ascending, each once.
  [[nodiscard]] const std::vector<RoomId>& Neighbours(RoomId room) const { return shapes_[room.index()].neighbours; }
  // Number of doorways and open boundaries, those to the outside too.
  [[nodiscard]] size_t Ways(RoomId room) const { return shapes_[room.index()].openings.size(); }
  [[nodiscard]] const TwinOptions& options() const { return options_; }

 private:
  struct Opening {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    double width_m = 0;
  };
  struct Shape {
    std::vector<Ring> rings;
    std::vector<Opening> openings;
    std::vector<RoomId> neighbours;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double area_m2 = 0, perimeter_m = 0, height_m = 0;
  };
  void AddOpening(RoomId a, RoomId b, const Eigen::Vector2d& at, double width_m);
  [[nodiscard]] bool BoundaryOnto(const Shape& a, const PlanarMotion& motion, const Shape& b) const;
  [[nodiscard]] bool OpeningsOnto(const Shape& a, const PlanarMotion& motion, const Shape& b) const;

  TwinOptions options_;
  std::vector<Shape> shapes_;
};

}  // namespace plumb::compiler
