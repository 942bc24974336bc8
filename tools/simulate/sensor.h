// Spinning lidars as data: which beams fire when, and how well they measure.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::tools {

struct Beam {
  double elevation_rad = 0;  // above the sensor's xy plane
  uint16_t ring = 0;         // counted from the lowest beam up
  double delay_s = 0;        // fires this long after the azimuth step begins
};

struct SensorModel {
  std::string name;
  std::vector<Beam> beams;    // in firing order
  double rate_hz = 10;        // sweeps per second
  uint32_t azimuth_steps = 1800;  // per sweep; clockwise seen from above, from straight behind
  double fov_rad = 2 * std::numbers::pi;  // about straight ahead; behind it nothing is measured
  double noise_m = 0.02;      // sigma along the ray
  double min_range_m = 0.4, max_range_m = 100;
  double dropout = 0.005;     // share of returns lost at random
  double grazing_cos = 0.08;  // below this cosine of incidence returns fade out linearly

  [[nodiscard]] double period_s() const { return 1.0 / rate_hz; }
};

// vlp16, hdl32, os0-32 or planar, a safety scanner of one ring; figures from the makers' data sheets. None for another name.
[[nodiscard]] std::optional<SensorModel> FindSensor(std::string_view name);
[[nodiscard]] std::vector<std::string> SensorNames();

}  // namespace plumb::tools
