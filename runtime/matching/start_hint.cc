#include "runtime/matching/start_hint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kRoomMargin_m = 0.5;

bool IsNearRoom(const Room& room, const Eigen::Vector3d& p) {
  if (p.z() < room.floor_z_m - kRoomMargin_m || p.z() > room.ceiling_z_m + kRoomMargin_m) return false;
  return Contains(room, p.head<2>()) || DistanceToRing(room.polygon, p.head<2>()) <= kRoomMargin_m;
}

// Relative to 1 / (area of all rooms).
double RelativeDensity(const AGraph& plan, const StartHint& hint, const Eigen::Vector3d& p, double area_m2) {
  double density = 1;
  if (hint.near_m) {
    const double variance_m2 = hint.near_sigma_m * hint.near_sigma_m;
    const double num_storeys = std::max<double>(1, static_cast<double>(plan.storeys.size()));
    density *= area_m2 / num_storeys / (2 * std::numbers::pi * variance_m2) *
               std::exp(-0.5 * (p.head<2>() - *hint.near_m).squaredNorm() / variance_m2);
  }
  if (!hint.rooms.empty()) {
    double rooms_m2 = 0;
    for (const RoomId room : hint.rooms) rooms_m2 += plan.rooms[room.index()].area_m2;
    const bool near =
        std::any_of(hint.rooms.begin(), hint.rooms.end(), [&](RoomId room) { return IsNearRoom(plan.rooms[room.index()], p); });
    density *= near && rooms_m2 > 0 ? area_m2 / rooms_m2 : 0;
  }
  return density;
}

}  // namespace

std::string StartHint::Check() const {
  const auto bad = [](const char* name, double value, const char* rule) {
    return fmt::format("StartHint.{} = {}; must be {}", name, value, rule);
  };
  if (near_m && !near_m->allFinite()) return bad("near_m", near_m->x(), "finite");
  if (!(near_sigma_m >= 0.1 && near_sigma_m <= 1000)) return bad("near_sigma_m", near_sigma_m, "from 0.1 to 1000");
  if (!(trust > 0 && trust < 1)) return bad("trust", trust, "in (0, 1)");
  return {};
}

double LogPrior(const AGraph& plan, const StartHint& hint, const Eigen::Vector3d& position_m) {
  if (!hint.given()) return 0;
  double area_m2 = 0;
  for (const Room& room : plan.rooms) area_m2 += room.area_m2;
  if (!(area_m2 > 0)) return 0;
  return std::log(hint.trust * RelativeDensity(plan, hint, position_m, area_m2) + 1 - hint.trust);
}

}  // namespace plumb::runtime
