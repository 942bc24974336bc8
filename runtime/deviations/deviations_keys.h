// How deviations are written as JSON, at the end of a run and while it goes on. Internal: only files that write JSON include it.
#pragma once

#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/deviations/deviations.h"
#include "runtime/numerics/rounded.h"

namespace plumb::runtime {

using Json = nlohmann::ordered_json;

inline double Metres(double v) { return Rounded(v, 1e5); }
inline double Degrees(double rad) { return Rounded(rad * 180 / std::numbers::pi, 1e4); }

// Status and estimate: what both files tell of a surface.
inline void PutEstimate(const SurfaceDeviation& d, Json& out) {
  out["status"] = StatusName(d.status);
  out["translation_m"] = Metres(d.translation_m);
  out["sigma_translation_m"] = Metres(d.sigma_translation_m);
  out["rotation_deg"] = Degrees(d.rotation_rad);
  out["sigma_rotation_deg"] = Degrees(d.sigma_rotation_rad);
  out["p_deviated"] = Rounded(d.p_deviated, 1e6);
}

// Likewise of a doorway; what was not measured is null.
inline void PutEstimate(const DoorwayDeviation& d, Json& out) {
  const bool measured = d.status == DoorwayStatus::kAsPlanned || d.status == DoorwayStatus::kDeviated;
  const auto metres = [measured](double v) { return measured ? Json(Metres(v)) : Json(nullptr); };
  out["status"] = StatusName(d.status);
  out["shift_m"] = metres(d.shift_m);
  out["sigma_shift_m"] = metres(d.sigma_shift_m);
  out["width_deviation_m"] = metres(d.width_deviation_m);
  out["sigma_width_m"] = metres(d.sigma_width_m);
  out["p_deviated"] = Rounded(d.p_deviated, 1e6);
}

}  // namespace plumb::runtime
