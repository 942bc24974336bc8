// How far a keyframe saw, all around, at the heights that matter to a robot.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

struct HeightBand {
  double low_m = 0, high_m = 0;  // map frame
};

struct RangeProfile {
  struct Ray {
    Eigen::Vector2f step = Eigen::Vector2f::Zero();  // from the keyframe's position to the end; zero: nothing seen in this direction
    bool hit = false;                                // ended at something within the band; else it left the band or the range
  };

  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::vector<Ray> rays;  // one per bin of about half a degree

  // The farthest ray in the direction of `step`.
  [[nodiscard]] const Ray& Towards(const Eigen::Vector2d& step) const;
};

// From the keyframe's points. O(points).
[[nodiscard]] RangeProfile ProfileOf(const Keyframe& keyframe, const HeightBand& band, double max_range_m);

}  // namespace plumb::runtime
