// One sweep of a spinning lidar through the house as built.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "runtime/matching/ray_caster.h"
#include "runtime/sources/recording.h"
#include "schema/agraph.h"
#include "tools/simulate/random.h"
#include "tools/simulate/sensor.h"

namespace plumb::tools {

// A point of a sweep before noise: what was hit.
struct Echo {
  uint32_t triangle = 0;      // of the house as built
  Eigen::Vector3f position;   // mesh frame
};

struct Sweep {
  runtime::Scan scan;
  std::vector<Echo> echoes;  // one per point
};

// T_plan_sensor at a time after the recording's start.
using PoseFunction = std::function<Eigen::Isometry3d(double time_s)>;

class Lidar {
 public:
  Lidar(const AGraph& house, SensorModel model, double glass_transmission);

  // The sweep that begins `start_s` after the recording's start; each beam fires from the pose at its own time. Points in the sensor
  // frame at their firing. Ranges carry noise along the ray; some returns are lost. Thread-safe.
  [[nodiscard]] Sweep Take(double start_s, double stamp_s, const PoseFunction& pose, Random& random) const;

  [[nodiscard]] const SensorModel& model() const { return model_; }

 private:
  // The first thing that sends light back; panes let most of it through.
  [[nodiscard]] runtime::RayHit Return(runtime::Ray ray, Random& random) const;

  const AGraph& house_;
  const SensorModel model_;
  const double glass_transmission_;
  const runtime::RayCaster caster_;
};

}  // namespace plumb::tools
