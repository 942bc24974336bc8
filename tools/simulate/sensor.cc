#include "tools/simulate/sensor.h"

#include <numbers>

namespace plumb::tools {
namespace {

constexpr double Rad(double deg) { return deg * std::numbers::pi / 180; }

// Beams evenly spread from `lowest_deg` up.
std::vector<Beam> EvenBeams(int count, double lowest_deg, double step_deg) {
  std::vector<Beam> beams;
  for (int i = 0; i < count; ++i) beams.push_back({Rad(lowest_deg + step_deg * i), static_cast<uint16_t>(i), 0});
  return beams;
}

// Fires the beams of the lower and the upper half in turn, one each `delay_s`.
std::vector<Beam> Interleaved(const std::vector<Beam>& even, double delay_s) {
  std::vector<Beam> beams;
  for (size_t i = 0; i < even.size(); ++i) {
    beams.push_back(even[i % 2 == 0 ? i / 2 : even.size() / 2 + i / 2]);
    beams.back().delay_s = static_cast<double>(i) * delay_s;
  }
  return beams;
}

SensorModel Vlp16() {
  SensorModel model;
  model.name = "vlp16";
  model.beams = Interleaved(EvenBeams(16, -15, 2), 2.304e-6);
  return model;
}

SensorModel Hdl32() {
  SensorModel model;
  model.name = "hdl32";
  model.beams = Interleaved(EvenBeams(32, -30.67, 4.0 / 3), 1.152e-6);
  model.azimuth_steps = 2170;
  model.max_range_m = 80;
  return model;
}

SensorModel Os0With32Beams() {
  SensorModel model;
  model.name = "os0-32";
  model.beams = EvenBeams(32, -45, 90.0 / 31);
  model.azimuth_steps = 1024;
  model.noise_m = 0.015;
  model.max_range_m = 35;
  return model;
}

SensorModel Planar() {
  SensorModel model;
  model.name = "planar";
  model.beams = EvenBeams(1, 0, 0);
  model.rate_hz = 15;
  model.azimuth_steps = 720;
  model.fov_rad = Rad(270);
  model.min_range_m = 0.05;
  model.max_range_m = 25;
  return model;
}

}  // namespace

std::vector<std::string> SensorNames() { return {"vlp16", "hdl32", "os0-32", "planar"}; }

std::optional<SensorModel> FindSensor(std::string_view name) {
  if (name == "vlp16") return Vlp16();
  if (name == "hdl32") return Hdl32();
  if (name == "os0-32") return Os0With32Beams();
  if (name == "planar") return Planar();
  return std::nullopt;
}

}  // namespace plumb::tools
