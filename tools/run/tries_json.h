// hypotheses.json: every try to find the map in the plan, with the places that it left open.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "schema/ids.h"

namespace plumb::tools {

// Where the robot may be.
struct HypothesisRow {
  double probability = 0;
  double log_likelihood = 0;  // nats, relative to "outside the plan"
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the sensor, plan frame, at the try's stamp
  double yaw_rad = 0;
  double sigma_xy_m = 0, sigma_yaw_rad = 0;
  std::string storey;
  std::optional<RoomId> room;  // that it stands in
  std::string room_name;
  int consistent_planes = 0;
  double consistent_ratio = 0, explained_ratio = 0, through_ratio = 0;  // matcher.h: Hypothesis
};

struct TryRow {
  double stamp_s = 0;
  std::string verdict;  // searching | ambiguous | unique
  std::string reason;   // why it is not unique
  double probability_outside = 0;
  std::vector<HypothesisRow> hypotheses;  // best first
};

[[nodiscard]] std::string TriesToJson(const std::vector<TryRow>& tries);

}  // namespace plumb::tools
