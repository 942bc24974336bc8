#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/deviations/deviations_keys.h"
#include "runtime/localizer/estimate_update.h"

namespace plumb::runtime {
namespace {

constexpr double kNews_m = 0.001, kNews_rad = 0.1 * std::numbers::pi / 180, kNewsProbability = 0.01;

bool IsNews(const SurfaceDeviation& now, const SurfaceDeviation& told) {
  return now.status != told.status || std::abs(now.translation_m - told.translation_m) >= kNews_m ||
         std::abs(now.sigma_translation_m - told.sigma_translation_m) >= kNews_m ||
         std::abs(now.rotation_rad - told.rotation_rad) >= kNews_rad || std::abs(now.p_deviated - told.p_deviated) >= kNewsProbability;
}

bool IsNews(const DoorwayDeviation& now, const DoorwayDeviation& told) {
  return now.status != told.status || std::abs(now.shift_m - told.shift_m) >= kNews_m ||
         std::abs(now.sigma_shift_m - told.sigma_shift_m) >= kNews_m || std::abs(now.width_deviation_m - told.width_deviation_m) >= kNews_m ||
         std::abs(now.sigma_width_m - told.sigma_width_m) >= kNews_m || std::abs(now.p_deviated - told.p_deviated) >= kNewsProbability;
}

Json DoorwayEntry(const DoorwayDeviation& d) {
  Json out;
  out["id"] = d.doorway.value;
  PutEstimate(d, out);
  return out;
}

Json SurfaceEntry(const SurfaceDeviation& d) {
  Json out;
  out["id"] = d.surface.value;
  PutEstimate(d, out);
  return out;
}

// Those that are news, which `told` then has.
template <class T, class F>
Json News(const std::vector<T>& now, std::vector<T>& told, F&& entry_of) {
  told.resize(now.size());
  Json out = Json::array();
  for (size_t i = 0; i < told.size(); ++i) {
    if (!IsNews(now[i], told[i])) continue;
    told[i] = now[i];
    out.push_back(entry_of(told[i]));
  }
  return out;
}

}  // namespace

std::string UpdateToJson(const EstimateUpdate& update, ToldDeviations& told) {
  Json out;
  out["t"] = Rounded(update.stamp_s, 1e6);
  out["verdict"] = VerdictName(update.verdict);
  out["T_plan_map"] = nullptr;
  if (update.T_plan_map) {
    const Eigen::Vector3d t = update.T_plan_map->translation();
    const Eigen::Matrix3d R = update.T_plan_map->linear();
    out["T_plan_map"] = {Metres(t.x()), Metres(t.y()), Metres(t.z()), Degrees(std::atan2(R(1, 0), R(0, 0)))};
  }
  out["surfaces"] = News(update.deviations.surfaces, told.surfaces, SurfaceEntry);
  out["doorways"] = News(update.deviations.doorways, told.doorways, DoorwayEntry);
  return out.dump() + "\n";
}

}  // namespace plumb::runtime
