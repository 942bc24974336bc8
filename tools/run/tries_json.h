// hypotheses.json: every try to find the map in the plan, with the places that it left open.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "schema/error.h"
#include "schema/ids.h"

namespace plumb::tools {

// Where the robot may be.
struct HypothesisRow {
  double probability = 0;
  double log_likelihood = 0;  // nats, relative to "outside the plan"
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the sensor, plan frame, at the try's stamp
  double yaw_rad = 0;
  std::optional<double> sigma_xy_m, sigma_yaw_rad;  // none: the walls that agree leave it open
  std::string storey;
  std::optional<RoomId> room;  // that it stands in
  std::string room_name;
  int consistent_planes = 0;
  double consistent_ratio = 0, explained_ratio = 0, through_ratio = 0, in_front_ratio = 0;  // matcher.h: Hypothesis
};

// Where to drive so that the places are told apart.
struct DriveToRow {
  std::vector<std::optional<RoomId>> rooms;  // that it is under each of the places compared, best first
  std::vector<std::string> room_names;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // under the best place, plan frame
  double bearing_rad = 0;                                // counter-clockwise from where the robot looks
  double distance_m = 0, expected_nats = 0;
  int rivals_split = 0;
};

struct GuidanceRow {
  int rivals = 0;                      // places compared with the best one
  std::optional<DriveToRow> drive_to;  // none: nothing in reach tells them apart
};

struct TryRow {
  double stamp_s = 0;
  std::string verdict;  // searching | ambiguous | unique
  std::string reason;   // why it is not unique
  double probability_outside = 0;
  std::vector<HypothesisRow> hypotheses;  // best first
  std::optional<GuidanceRow> guidance;    // where places are open
};

[[nodiscard]] std::string TriesToJson(const std::vector<TryRow>& tries);
// `source` names the file in errors. Errors: kBadRunFolder, with the key.
[[nodiscard]] Expected<std::vector<TryRow>> ParseTries(const std::string& json, const std::string& source);

// What a person does to have the places told apart, in a sentence.
[[nodiscard]] std::string Advice(const GuidanceRow& guidance);

}  // namespace plumb::tools
