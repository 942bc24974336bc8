#include "runtime/rooms/range_profile.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr int kBinsPerQuadrant = 180;
constexpr float kMinRange_m = 0.05f;

// Directions by the side of a square instead of the angle: no trigonometry, and bins between 0.3 and 0.6 degrees wide.
size_t BinOf(float x, float y) {
  const float sum = std::abs(x) + std::abs(y);
  const float t = x >= 0 ? (y >= 0 ? y / sum : 3 + x / sum) : (y >= 0 ? 1 - x / sum : 2 - y / sum);
  return static_cast<size_t>(t * kBinsPerQuadrant) % (4 * kBinsPerQuadrant);
}

}  // namespace

const RangeProfile::Ray& RangeProfile::Towards(const Eigen::Vector2d& step) const {
  return rays[BinOf(static_cast<float>(step.x()), static_cast<float>(step.y()))];
}

RangeProfile ProfileOf(const Keyframe& keyframe, const HeightBand& band, double max_range_m) {
  RangeProfile profile;
  profile.at = keyframe.T_map_kf.translation().head<2>();
  profile.rays.resize(4 * kBinsPerQuadrant);
  const Eigen::Matrix3f R = keyframe.T_map_kf.linear().cast<float>();
  const double z_m = keyframe.T_map_kf.translation().z();
  const float low = static_cast<float>(band.low_m - z_m), high = static_cast<float>(band.high_m - z_m),
              max_range = static_cast<float>(max_range_m);
  for (const Eigen::Vector3f& point : keyframe.points) {
    const Eigen::Vector3f p = R * point;
    const float range = p.head<2>().norm();
    if (range < kMinRange_m) continue;
    // The share of the way to the point after which the ray has left the band for good.
    float share = 1;
    if (p.z() < low) share = low / p.z();
    if (p.z() > high) share = high / p.z();
    if (share <= 0 || share > 1) continue;  // the sensor is on the same side of the band
    bool hit = share == 1;
    if (share * range > max_range) {
      share = max_range / range;
      hit = false;
    }
    RangeProfile::Ray& ray = profile.rays[BinOf(p.x(), p.y())];
    const Eigen::Vector2f step = share * p.head<2>();
    if (step.squaredNorm() > ray.step.squaredNorm()) ray = {step, hit};
  }
  return profile;
}

}  // namespace plumb::runtime
