#include "compiler/passes/assign_storeys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/passes/section.h"

namespace plumb::compiler {
namespace {

// Feet of walls reach into the slab below by up to this.
constexpr double kFootSlack_m = 0.5;

bool IsWall(const PlanElement& e) { return e.kind == ElementKind::kWall || e.kind == ElementKind::kCurtainWall; }

void AddMissingStorey(PlanIr& plan, DiagnosticSink& sink) {
  double lowest = std::numeric_limits<double>::infinity(), lowest_wall = lowest;
  for (const PlanElement& e : plan.elements) {
    const Eigen::AlignedBox3d box = Bounds(e.body.empty() ? e.uncut : e.body);
    if (box.isEmpty()) continue;
    lowest = std::min(lowest, box.min().z());
    if (IsWall(e)) lowest_wall = std::min(lowest_wall, box.min().z());
  }
  PlanStorey storey;
  storey.name = "Storey";
  storey.elevation_m = std::isfinite(lowest_wall) ? lowest_wall : std::isfinite(lowest) ? lowest : 0.0;
  sink.Emit(DiagnosticKind::kStoreyMissing, {},
            fmt::format("the plan has no storey; one at {:.3f} m is assumed", storey.elevation_m + plan.origin.z()));
  plan.storeys.push_back(storey);
}

// The highest storey whose zero is at or below the foot.
uint32_t StoreyOfFoot(const PlanIr& plan, double z_m) {
  uint32_t out = 0;
  for (uint32_t s = 0; s < plan.storeys.size(); ++s) {
    if (plan.storeys[s].elevation_m <= z_m + kFootSlack_m) out = s;
  }
  return out;
}

double NextElevation(const PlanIr& plan, uint32_t storey) {
  for (size_t s = storey + 1; s < plan.storeys.size(); ++s) {
    if (plan.storeys[s].elevation_m > plan.storeys[storey].elevation_m) return plan.storeys[s].elevation_m;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

std::string StoreyOptions::Check() const {
  if (!(min_storey_height_m > 0)) return fmt::format("StoreyOptions.min_storey_height_m = {}; must be positive", min_storey_height_m);
  if (!(containment_slack_m >= 0)) return fmt::format("StoreyOptions.containment_slack_m = {}; must not be negative", containment_slack_m);
  return {};
}

void AssignStoreys(PlanIr& plan, const StoreyOptions& options, DiagnosticSink& sink) {
  const bool has_storeys = !plan.storeys.empty();
  if (!has_storeys) AddMissingStorey(plan, sink);
  for (PlanElement& e : plan.elements) {
    const Eigen::AlignedBox3d box = Bounds(e.body.empty() ? e.uncut : e.body);
    if (box.isEmpty()) {
      if (e.storey == kNoIndex) e.storey = 0;
      continue;
    }
    const uint32_t by_geometry = StoreyOfFoot(plan, box.min().z());
    if (e.storey == kNoIndex) {
      e.storey = by_geometry;
      if (has_storeys && IsWall(e)) {
        sink.Emit(DiagnosticKind::kStoreyFromGeometry, e.location,
                  fmt::format("{} is contained in no storey; its foot at {:.2f} m puts it on `{}`", e.location.ToString(),
                              box.min().z() + plan.origin.z(), plan.storeys[by_geometry].name));
      }
      continue;
    }
    const double below = plan.storeys[e.storey].elevation_m - box.max().z(), above = box.min().z() - NextElevation(plan, e.storey);
    if (std::max(below, above) <= options.containment_slack_m) continue;
    sink.Emit(DiagnosticKind::kElementInWrongStorey, e.location,
              fmt::format("{} is contained in storey `{}` but lies {:.2f} m {} it; it counts to `{}`", e.location.ToString(),
                          plan.storeys[e.storey].name, std::max(below, above), below > above ? "below" : "above",
                          plan.storeys[by_geometry].name));
    e.storey = by_geometry;
  }
  for (PlanSpace& s : plan.spaces) {
    const Eigen::AlignedBox3d box = Bounds(s.body);
    if (s.storey == kNoIndex) s.storey = box.isEmpty() ? 0 : StoreyOfFoot(plan, box.min().z());
  }
}

std::vector<Level> GroupStoreys(const PlanIr& plan, double section_height_m, const StoreyOptions& options) {
  std::vector<Level> out;
  for (uint32_t s = 0; s < plan.storeys.size(); ++s) {
    const double z = plan.storeys[s].elevation_m;
    if (out.empty() || z - out.back().base_z_m >= options.min_storey_height_m) out.push_back({s, s, z, z, z});
    out.back().last_storey = s;
    out.back().section_z_m = z + section_height_m;
  }
  double highest = std::numeric_limits<double>::lowest();
  for (const PlanElement& e : plan.elements) {
    if (!IsWall(e)) continue;
    const Eigen::AlignedBox3d box = Bounds(e.uncut.empty() ? e.body : e.uncut);
    if (!box.isEmpty()) highest = std::max(highest, box.max().z());
  }
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].top_z_m = i + 1 < out.size() ? out[i + 1].base_z_m : std::max(highest, out[i].section_z_m);
  }
  return out;
}

size_t LevelAt(const std::vector<Level>& levels, double z_m, double slack_m) {
  size_t out = 0;
  for (size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].base_z_m <= z_m + slack_m) out = i;
  }
  return out;
}

}  // namespace plumb::compiler
