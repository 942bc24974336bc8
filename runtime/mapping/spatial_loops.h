// Loop closure of 3D lidars: finds places that the robot has been at before.
//
// A keyframe is registered on what was seen about an earlier one (place_registration.h) that is near by within what the covariance along
// the graph's surest path between the two allows. It closes a loop if
//   (a) enough of its points lie on the surfaces there,
//   (b) it is no further from the prediction than that covariance and the registration's allow (chi square, 99 %, as many degrees of
//       freedom as the points hold directions), and
//   (c) the keyframe before it that passed these says the same.
// Directions that the points do not hold are left open in the edge: a corridor closes across, never along (runtime/METHOD.md, Loops).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/mapping/odometry_drift.h"
#include "runtime/mapping/place_registration.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

struct SpatialLoopOptions {
  OdometryDrift drift;
  double min_way_m = 20;          // of the robot since the earlier keyframe: odometry's own map takes care of what is nearer
  double max_distance_m = 2;      // between the two keyframes, ...
  double max_search_m = 6;        // ... and three sigma more, but no more than this in all
  double min_overlap = 0.6;       // share of points that meet a surface, ...
  double min_inlier_share = 0.6;  // ... and of these of those that lie on it
  int min_inliers = 300;
  double floor_sigma_m = 0.005, floor_sigma_rad = 0.0005;  // of a loop, whatever the points say: the older place is bent by its own drift
  double way_between_m = 1.0;                              // from one loop to the next
  PlaceRegistrationOptions registration;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

class SpatialLoops {
 public:
  explicit SpatialLoops(const SpatialLoopOptions& options) : options_(options) {}

  // After the graph's newest keyframe was added. Returns the loops that are now sure, none to two; they are not yet in the graph.
  // O(keyframes log keyframes), plus one registration if there is a place to look at. Keeps nothing of the keyframes.
  [[nodiscard]] std::vector<SpatialEdge> Add(const SGraph& graph);

  // Odometry's steps, what merged keyframes are tied to, and the graph's loops.
  [[nodiscard]] std::vector<SpatialEdge> EdgesOf(const SGraph& graph) const;

 private:
  [[nodiscard]] std::optional<SpatialEdge> Find(const SGraph& graph) const;
  [[nodiscard]] bool Agree(const SpatialEdge& a, const SpatialEdge& b, const std::vector<Keyframe>& keyframes) const;

  SpatialLoopOptions options_;
  std::optional<SpatialEdge> last_;  // that passed (a) and (b)
  bool last_told_ = false;
  double tried_at_m_ = 0, closed_at_m_ = 0;  // way of the robot by then
};

// Whether a motion measured as `found` is what `predicted` allows, the covariances being of their increments: chi square, 99 %, of
// `num_held` degrees of freedom.
[[nodiscard]] bool PassesGate(const Eigen::Isometry3d& predicted, const Matrix6d& predicted_covariance, const Eigen::Isometry3d& found,
                              const Matrix6d& found_covariance, int num_held);

}  // namespace plumb::runtime
