#include "tools/report/deviation_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "tools/drawing/floor_plan.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kBand_m = 0.06;  // surfaces are drawn as bands of this width on the free side

int Gravity(const SurfaceEntry& s) {
  if (s.status == "deviated") return 3;
  if (s.status == "missing") return 2;
  return s.status == "as_planned" ? 1 : 0;
}

// Where the ends of the surface stand as built, minus where they are planned.
std::pair<Vector2d, Vector2d> EndDisplacements(const Surface& s, const SurfaceEntry& entry) {
  const double angle_rad = entry.rotation_deg * std::numbers::pi / 180;
  const Vector2d half = 0.5 * (s.end - s.start), shift = entry.translation_m * s.normal.head<2>();
  const Vector2d turned(std::cos(angle_rad) * half.x() - std::sin(angle_rad) * half.y(),
                        std::sin(angle_rad) * half.x() + std::cos(angle_rad) * half.y());
  return {shift - turned + half, shift + turned - half};
}

Ring Footprint(const Wall& wall) {
  const Vector2d along = (wall.axis_end - wall.axis_start).normalized(), half = 0.5 * wall.thickness_m * Vector2d(-along.y(), along.x());
  return {wall.axis_start - half, wall.axis_end - half, wall.axis_end + half, wall.axis_start + half};
}

std::string Planned(const Surface& s, const SurfaceEntry& entry, const Sheet& sheet) {
  const char* style = entry.status == "as_planned" ? "as-planned" : "unobserved";
  if (s.arc) {
    std::string curve;
    const Ring points = PointsAlong(s);
    for (size_t i = 0; i < points.size(); ++i) curve += fmt::format("{}{}", i == 0 ? "M" : "L", sheet.At(points[i]));
    return fmt::format("<path class=\"{}\" fill=\"none\" d=\"{}\"/>\n", style, curve);
  }
  const Vector2d inset = 0.5 * kBand_m * s.normal.head<2>();
  return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, sheet.Line(s.start + inset, s.end + inset));
}

// The parts of deviated surfaces, in the order in which they are drawn. What became wall comes below what became free, so that a wall that
// moved by more than its thickness is seen where it stands.
struct DeviatedLayers {
  std::string wall_now, free_now, planned, built;
};

void AddDeviated(const Surface& s, const SurfaceEntry& entry, double limit_m, const Sheet& sheet, DeviatedLayers& layers) {
  const auto [start, end] = EndDisplacements(s, entry);
  const std::string data =
      fmt::format("style=\"--dev:{}\" data-a=\"{}\" data-b=\"{}\" data-da=\"{} {}\" data-db=\"{} {}\"",
                  DeviationColor(entry.translation_m, limit_m), sheet.At(s.start), sheet.At(s.end), Decimal(sheet.Length(start.x())),
                  Decimal(-sheet.Length(start.y())), Decimal(sheet.Length(end.x())), Decimal(-sheet.Length(end.y())));
  const std::string area = sheet.Closed({s.start, s.end, s.end + end, s.start + start});
  if (entry.translation_m > 0) {
    layers.wall_now += fmt::format("<path class=\"dev wall-now\" d=\"{}\" {}/>\n", area, data);
  } else {
    layers.free_now += fmt::format("<path class=\"dev free-now\" d=\"{}\" {}/>\n", area, data);
  }
  layers.planned += fmt::format("<path class=\"planned\" d=\"{}\"/>\n", sheet.Line(s.start, s.end));
  layers.built += fmt::format("<path class=\"dev built\" d=\"{}\" {}/>\n", sheet.Line(s.start + start, s.end + end), data);
}

}  // namespace

bool Deviates(const SurfaceEntry& surface) { return surface.status == "deviated" || surface.status == "missing"; }

std::vector<WallRow> WallRows(const AGraph& graph, const Deviations& deviations) {
  std::map<WallId, const SurfaceEntry*> speakers;
  for (const SurfaceEntry& s : deviations.surfaces) {
    const SurfaceEntry*& speaker = speakers[graph.surfaces[s.id.index()].wall];
    if (!speaker || std::tuple(Gravity(s), s.points) > std::tuple(Gravity(*speaker), speaker->points)) speaker = &s;
  }
  std::vector<WallRow> rows;
  for (const auto& [wall, surface] : speakers) rows.push_back({wall, surface, 0});
  std::stable_sort(rows.begin(), rows.end(), [](const WallRow& a, const WallRow& b) {
    return std::tuple(Gravity(*a.surface), std::abs(a.surface->translation_m)) >
           std::tuple(Gravity(*b.surface), std::abs(b.surface->translation_m));
  });
  for (size_t i = 0; i < rows.size() && Deviates(*rows[i].surface); ++i) rows[i].number = static_cast<int>(i) + 1;
  return rows;
}

double ColorLimit(const Deviations& deviations) {
  double largest_m = 0.10;
  for (const SurfaceEntry& s : deviations.surfaces) {
    if (Deviates(s)) largest_m = std::max(largest_m, std::abs(s.translation_m));
  }
  return std::ceil(largest_m / 0.05 - 1e-9) * 0.05;
}

std::string DeviationStyle() {
  return R"(.plan .as-planned{stroke:#4f9d8f;stroke-width:6;stroke-opacity:.75;fill:none}
.plan .unobserved{stroke:var(--soft);stroke-width:2.5;stroke-dasharray:2 9;stroke-linecap:round;fill:none}
.plan .missing{stroke:#d32f2f;stroke-width:5;stroke-dasharray:16 9;fill:var(--paper);fill-opacity:.7}
.plan .unplanned{stroke:#1565c0;stroke-width:3;fill:#1565c0;fill-opacity:.85}
.plan .wall-now{fill:var(--dev);fill-opacity:.5}
.plan .free-now{fill:var(--floor)}
.plan .planned{stroke:var(--ink);stroke-width:1.4;stroke-dasharray:9 6;fill:none}
.plan .built{stroke:var(--dev);stroke-width:7;fill:none}
.plan .tag circle{fill:var(--paper);stroke:var(--dev);stroke-width:3.5}
.plan .tag text{font-weight:700}
.plan .tag .amount{paint-order:stroke;stroke:var(--paper);stroke-width:7;stroke-linejoin:round;font-weight:600}
)";
}

std::string DrawSurfaces(const AGraph& graph, StoreyId storey, const Deviations& deviations, double limit_m, const Sheet& sheet) {
  std::string planned, missing;
  DeviatedLayers deviated;
  std::set<WallId> outlined;
  for (const SurfaceEntry& entry : deviations.surfaces) {
    const Surface& s = graph.surfaces[entry.id.index()];
    if (s.storey != storey) continue;
    if (entry.status == "missing") {
      if (outlined.insert(s.wall).second)
        missing += fmt::format("<path class=\"missing\" d=\"{}\"/>\n", sheet.Closed(Footprint(graph.walls[s.wall.index()])));
    } else if (entry.status == "deviated") {
      AddDeviated(s, entry, limit_m, sheet, deviated);
    } else {
      planned += Planned(s, entry, sheet);
    }
  }
  return planned + deviated.wall_now + deviated.free_now + deviated.planned + deviated.built + missing;
}

std::string DrawUnplanned(const AGraph& graph, StoreyId storey, const Deviations& deviations, const Sheet& sheet) {
  std::string out;
  for (const UnplannedEntry& wall : deviations.unplanned) {
    if (wall.room.valid() && graph.rooms[wall.room.index()].storey != storey) continue;
    fmt::format_to(std::back_inserter(out), "<path class=\"unplanned\" d=\"{}\"/>\n", sheet.Closed(wall.polygon));
  }
  return out;
}

std::string DrawWallNumbers(const AGraph& graph, StoreyId storey, const std::vector<WallRow>& rows, const Sheet& sheet) {
  std::string out;
  for (const WallRow& row : rows) {
    const Surface& s = graph.surfaces[row.surface->id.index()];
    if (row.number == 0 || s.storey != storey) continue;
    // On the free side, clear of the built surface.
    const double clear_m = 0.32 + std::max(0.0, row.surface->translation_m);
    const Vector2d at = s.midpoint() + clear_m * s.normal.head<2>();
    const double x = sheet.x(at.x()), y = sheet.y(at.y());
    const std::string color = row.surface->status == "missing" ? kMissingColor : DeviationColor(row.surface->translation_m, 0.01);
    const std::string amount =
        row.surface->status == "missing" ? std::string("missing") : Signed(100 * row.surface->translation_m, 1) + " cm";
    fmt::format_to(
        std::back_inserter(out),
        "<g class=\"tag\" style=\"--dev:{}\"><circle cx=\"{}\" cy=\"{}\" r=\"16\"/><text x=\"{}\" y=\"{}\" font-size=\"19\">{}</text>"
        "<text class=\"amount\" x=\"{}\" y=\"{}\" font-size=\"18\">{}</text></g>\n",
        color, Decimal(x), Decimal(y), Decimal(x), Decimal(y + 6.5), row.number, Decimal(x), Decimal(y + 36), amount);
  }
  return out;
}

}  // namespace plumb::tools
