// A drive in time: where the sensor is at every moment.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/simulate/free_space.h"
#include "tools/simulate/random.h"
#include "tools/simulate/route.h"

namespace plumb::tools {

struct DriveOptions {
  double speed_m_s = 0.5;
  double acceleration_m_s2 = 0.4;
  double yaw_rate_rad_s = 0.9;             // below 60 deg/s, with what smoothing adds
  double yaw_acceleration_rad_s2 = 1.8;
  double rest_s = 1.0;                     // stands still at the start and at the end
  double sensor_height_m = 0.6;            // above the floor
  double wobble_rad = 0.005;               // largest roll and pitch
};

// Something that the robot does: drive along a line (starting where it is), then turn in place.
struct Manoeuvre {
  Polyline line;        // may be empty
  double turn_rad = 0;  // counter-clockwise
};

class Drive {
 public:
  static constexpr double kStep_s = 0.01;

  // Corners are rounded where there is room for it, else the robot stops and turns in place.
  Drive(const std::vector<Manoeuvre>& manoeuvres, double start_yaw_rad, const FreeSpace& space, double radius_m,
        const DriveOptions& options, Random& random);

  [[nodiscard]] double duration_s() const { return static_cast<double>(positions_.size() - 1) * kStep_s; }
  // T_plan_sensor; rests outside [0, duration_s()].
  [[nodiscard]] Eigen::Isometry3d PoseAt(double time_s) const;
  // Everything after is forgotten.
  void CutAt(double time_s);

 private:
  std::vector<Eigen::Vector3d> positions_;         // one each kStep_s
  std::vector<Eigen::Quaterniond> orientations_;   // neighbours on the same half of the sphere
};

}  // namespace plumb::tools
