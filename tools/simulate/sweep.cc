#include "tools/simulate/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::tools {
namespace {

constexpr float kPast_m = 1e-3f;      // a ray goes on this far behind a pane's face
constexpr float kPane_m = 0.1f;       // both faces of a pane lie within this distance along the ray
constexpr int kMaxFaces = 64;

// Brightness 0 to 255: each element has its own reflectivity, dimmer at flat incidence.
float Intensity(uint32_t element, double incidence_cos) {
  const double reflectivity = 20 + static_cast<double>(Random(element).Index(80));
  return static_cast<float>(std::round(reflectivity * (0.3 + 0.7 * incidence_cos)));
}

}  // namespace

Lidar::Lidar(const AGraph& house, SensorModel model, double glass_transmission)
    : house_(house), model_(std::move(model)), glass_transmission_(glass_transmission), caster_(house.mesh) {}

runtime::RayHit Lidar::Return(runtime::Ray ray, Random& random) const {
  const Eigen::Vector3f start = ray.origin;
  float behind_m = 0, pane_from_m = -1;
  uint32_t pane = 0xffffffffu;
  for (int i = 0; i < kMaxFaces; ++i) {
    runtime::RayHit hit = caster_.Cast(ray);
    if (!hit.hit()) return hit;
    hit.range_m += behind_m;
    const uint32_t element = house_.mesh.triangles[hit.triangle].element;
    if (house_.elements[element].material != Material::kGlass) return hit;
    // The second face of a pane that the ray is already in costs nothing more.
    const bool same_pane = element == pane && hit.range_m - pane_from_m < kPane_m;
    if (!same_pane) {
      if (random.Uniform() >= glass_transmission_) return hit;
      pane = element;
      pane_from_m = hit.range_m;
    }
    const float past_m = hit.range_m + kPast_m;
    ray.max_range_m -= past_m - behind_m;
    behind_m = past_m;
    ray.origin = start + behind_m * ray.direction;
    if (ray.max_range_m <= 0) return {};
  }
  return {};
}

Sweep Lidar::Take(double start_s, double stamp_s, const PoseFunction& pose, Random& random) const {
  Sweep sweep;
  sweep.scan.stamp_s = stamp_s;
  const double step_s = model_.period_s() / model_.azimuth_steps, step_rad = 2 * std::numbers::pi / model_.azimuth_steps;
  for (uint32_t step = 0; step < model_.azimuth_steps; ++step) {
    const double azimuth_rad = std::numbers::pi - step * step_rad;
    if (std::abs(azimuth_rad) > 0.5 * model_.fov_rad) continue;
    const double cos_azimuth = std::cos(azimuth_rad), sin_azimuth = std::sin(azimuth_rad);
    for (const Beam& beam : model_.beams) {
      const double time_s = step * step_s + beam.delay_s;
      const Eigen::Isometry3d T = pose(start_s + time_s);
      const double flat = std::cos(beam.elevation_rad);
      const Eigen::Vector3d direction(flat * cos_azimuth, flat * sin_azimuth, std::sin(beam.elevation_rad));
      runtime::Ray ray;
      ray.origin = (T.translation() - house_.origin).cast<float>();
      ray.direction = (T.linear() * direction).cast<float>();
      ray.max_range_m = static_cast<float>(model_.max_range_m);
      const runtime::RayHit hit = Return(ray, random);
      if (!hit.hit()) continue;
      const double incidence_cos = std::abs(static_cast<double>(hit.normal.dot(ray.direction)));
      const double lost = std::max(model_.dropout, 1 - incidence_cos / model_.grazing_cos);
      const double range_m = static_cast<double>(hit.range_m) + model_.noise_m * random.Normal();
      if (random.Uniform() < lost || range_m < model_.min_range_m || range_m > model_.max_range_m) continue;
      sweep.scan.points.push_back((range_m * direction).cast<float>());
      sweep.scan.ring.push_back(beam.ring);
      sweep.scan.time_s.push_back(static_cast<float>(time_s));
      sweep.scan.intensity.push_back(Intensity(house_.mesh.triangles[hit.triangle].element, incidence_cos));
      sweep.echoes.push_back({hit.triangle, ray.origin + hit.range_m * ray.direction});
    }
  }
  return sweep;
}

}  // namespace plumb::tools
