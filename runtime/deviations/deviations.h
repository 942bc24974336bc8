// What was built otherwise: per surface and room, from the joint estimate; and its JSON.
#pragma once

#include <string>
#include <vector>

#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

enum class SurfaceStatus : uint8_t { kAsPlanned, kDeviated, kMissing, kUnobserved };

struct DeviationOptions {
  double false_discovery_rate = 0.01;   // Benjamini-Hochberg over the observed walls
  double min_offset_m = 0.02;           // tolerance: smaller deviations are as planned
  double min_yaw_rad = 0.0087;
  double min_observed_m2 = 0.5;         // less was not seen well enough to judge
  double min_p_deviated = 0.95;
  [[nodiscard]] std::string Check() const;
};

struct SurfaceDeviation {
  SurfaceId surface;
  SurfaceStatus status = SurfaceStatus::kUnobserved;
  double translation_m = 0, sigma_translation_m = 0;  // at the surface's midpoint, + along its planned normal
  double rotation_rad = 0, sigma_rotation_rad = 0;
  double tilt_rad = 0;
  double p_deviated = 0;
  double observed_m2 = 0;
  double points = 0;
};

struct RoomDeviation {
  RoomId room;
  SurfaceStatus status = SurfaceStatus::kUnobserved;
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();
  double rotation_rad = 0;
  double sigma_m = 0;
};

struct DeviationReport {
  std::string gauge;
  std::vector<SurfaceDeviation> surfaces;  // one per plan surface
  std::vector<RoomDeviation> rooms;        // one per plan room
};

// Every surface of a wall carries the wall's deviation, moved to the surface's own midpoint and normal, plus its share of the thickness.
[[nodiscard]] DeviationReport AssessDeviations(const AGraph& plan, const JointResult& estimate, const DeviationOptions& options = {});

// deviations.json, version 1.
[[nodiscard]] std::string DeviationsToJson(const AGraph& plan, const DeviationReport& report);

}  // namespace plumb::runtime
