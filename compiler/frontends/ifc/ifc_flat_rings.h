// Bounds of a face on a surface that comes back to where it began, laid out in the plane. Metres.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {

struct FlatRing {
  Ring2 flat;
  Ring3 points;                                    // of `flat`, in space
  Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // from its first point on to where the ring comes back to it: whole periods
  bool has_pole = false;                           // a point where the surface comes together, as the apex of a cone
};

// The whole periods that bring `from` closest to `to`.
[[nodiscard]] Eigen::Vector2d WholePeriods(const Eigen::Vector2d& periods, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

// Moves each inner ring by whole periods into the outer one, the first. Two rings that go once round the surface become the outer one: cut
// at a seam clear of the others, where a side leads from one to the other and back. An outer ring that goes round from a pole stays as it
// is: its sides all lead there. False: rings go round in another way, no seam is
// clear, or finding it takes more steps than the file is worth. O(points^2) for rings that go round, else O(points).
[[nodiscard]] bool PlaceRings(const IfcModel& model, const Eigen::Vector2d& periods, std::vector<FlatRing>& rings);

}  // namespace plumb::compiler
