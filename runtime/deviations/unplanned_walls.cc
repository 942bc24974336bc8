#include "runtime/deviations/unplanned_walls.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/deviations/panel.h"
#include "runtime/deviations/planned_walls.h"
#include "runtime/deviations/standing_walls.h"
#include "runtime/deviations/wall_candidates.h"
#include "runtime/matching/ray_caster.h"
#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kOpposite_cos = 0.99;
constexpr double kMinThickness_m = 0.03;
constexpr double kMinOverlap = 0.5;          // of the shorter of two faces
constexpr double kOn_m = 0.08, kBeyond_m = 0.25, kEdge_m = 0.15;
constexpr double kMinInRoom = 0.5;           // of a wall's length
constexpr double kParallel_cos = 0.94;
constexpr double kMaxExplained = 0.5;        // of a wall's length
constexpr double kMaxMirrored = 0.5;         // of the lines that end on it
constexpr double kMaxOver = 0.02;            // of the lines that meet it
constexpr double kMinStanding_m2 = 0.5;
constexpr double kSample_m = 0.1;
constexpr double kSameWall_m = 0.25, kSameWall_cos = 0.985;  // across and between two findings of one wall, which may be of either face

// Of a footprint, along its longest side.
Panel CentreLine(const UnplannedWall& wall) {
  Panel line;
  const std::vector<Eigen::Vector2d>& p = wall.polygon;
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d side = p[(i + 1) % p.size()] - p[i];
    if (side.squaredNorm() > longest.squaredNorm()) longest = side;
  }
  if (longest.isZero()) return line;
  line.along = longest.normalized();
  line.normal = {-line.along.y(), line.along.x()};
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector2d& q : p) extent.extend(Eigen::Vector2d(line.along.dot(q), line.normal.dot(q)));
  line.start = extent.min().x() * line.along + extent.center().y() * line.normal;
  line.length_m = extent.sizes().x();
  return line;
}

class Search {
 public:
  Search(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const JointResult& estimate,
         const UnplannedOptions& options)
      : map_(map),
        plan_(plan),
        options_(options),
        T_plan_map_(estimate.T_plan_map),
        caster_(plan.mesh),
        standing_(plan, estimate, kMinStanding_m2),
        planned_(plan, matches),
        faces_(UnmatchedFaces(map, matches, T_plan_map_)) {}

  std::vector<UnplannedWall> Run() {
    std::erase_if(faces_, [&](WallCandidate& c) { return !CouldBeWall(c); });
    if (faces_.empty()) return {};
    CountSights();
    std::erase_if(faces_, [&](const WallCandidate& c) {
      const double met = static_cast<double>(c.ended + c.passed);
      return c.ended == 0 || static_cast<double>(c.passed) > options_.max_passed_ratio * met ||
             static_cast<double>(c.mirrored) > kMaxMirrored * static_cast<double>(c.ended);
    });
    std::vector<UnplannedWall> walls;
    std::vector<bool> used(faces_.size(), false);
    for (size_t i = 0; i < faces_.size(); ++i) {
      if (used[i]) continue;
      const std::optional<size_t> back = OtherFace(i, used);
      if (!IsWall(faces_[i], back ? &faces_[*back] : nullptr)) continue;
      used[i] = true;
      if (back) used[*back] = true;
      walls.push_back(WallOf(faces_[i], back ? &faces_[*back] : nullptr));
    }
    return walls;
  }

 private:
  // Long enough, on the floor, in a room of the plan, and nothing that the plan has.
  bool CouldBeWall(WallCandidate& c) const {
    if (c.panel.length_m < options_.min_length_m || c.keyframes.size() < static_cast<size_t>(options_.min_keyframes)) return false;
    c.room = RoomOf(c);
    if (!c.room.valid()) return false;
    TrimTo(plan_.rooms[c.room.index()], &c);
    if (c.panel.length_m < options_.min_length_m) return false;
    const double floor_m = plan_.rooms[c.room.index()].floor_z_m;
    if (c.panel.z_min_m > floor_m + options_.max_bottom_m) return false;
    c.required_top_m = RequiredTop(c, floor_m);
    return PlannedShare(c, options_.plan_gate_m) < kMaxExplained;
  }

  // The room that half of it or more stands in.
  [[nodiscard]] RoomId RoomOf(const WallCandidate& c) const {
    const double z = 0.5 * (c.panel.z_min_m + c.panel.z_max_m);
    for (size_t r = 0; r < plan_.rooms.size(); ++r) {
      const Room& room = plan_.rooms[r];
      if (z < room.floor_z_m || z > room.ceiling_z_m) continue;
      const double inside = Share(c, [&](const Eigen::Vector2d& p) { return Contains(room, p); });
      if (inside >= kMinInRoom) return RoomId(r);
    }
    return {};
  }

  template <class F>
  static double Share(const WallCandidate& c, F&& holds) {
    int yes = 0, all = 0;
    for (double u = 0.5 * kSample_m; u < c.panel.length_m; u += kSample_m) {
      yes += holds(Eigen::Vector2d(c.panel.start + u * c.panel.along)) ? 1 : 0;
      ++all;
    }
    return all == 0 ? 0 : static_cast<double>(yes) / all;
  }

  // Below the lowest ceiling seen over it; by the plan's, a suspended ceiling would hide that a wall is one.
  [[nodiscard]] double RequiredTop(const WallCandidate& c, double floor_m) const {
    const Eigen::Vector2d middle = c.panel.start + 0.5 * c.panel.length_m * c.panel.along;
    const Eigen::Vector3d at = T_plan_map_.inverse() * Eigen::Vector3d(middle.x(), middle.y(), floor_m);
    double top_m = floor_m + options_.min_height_m;
    bool seen = false;
    for (const MapSurface& s : map_.surfaces) {
      const double ceiling_m = s.z_max_m - at.z();  // above the floor
      if (s.kind != SurfaceKind::kCeiling || s.observations.empty() || ceiling_m < options_.min_height_m) continue;
      if (at.x() < s.start.x() || at.x() > s.end.x() || at.y() < s.start.y() || at.y() > s.end.y()) continue;
      const double below_m = floor_m + ceiling_m - options_.below_ceiling_m;
      top_m = seen ? std::min(top_m, below_m) : below_m;
      seen = true;
    }
    return top_m;
  }

  // Share of its length at which the plan has something parallel within `gate_m`.
  [[nodiscard]] double PlannedShare(const WallCandidate& c, double gate_m) const {
    const double z = 0.5 * (c.panel.z_min_m + c.panel.z_max_m);
    const auto meets = [&](const Eigen::Vector2d& p, double side) {
      Ray ray;
      ray.origin = (Eigen::Vector3d(p.x(), p.y(), z) - plan_.origin).cast<float>();
      ray.direction = Eigen::Vector3d(side * c.panel.normal.x(), side * c.panel.normal.y(), 0).cast<float>();
      ray.max_range_m = static_cast<float>(gate_m);
      const RayHit hit = caster_.Cast(ray);
      return hit.hit() && std::abs(hit.normal.head<2>().cast<double>().dot(c.panel.normal)) > kParallel_cos;
    };
    return Share(c, [&](const Eigen::Vector2d& p) { return meets(p, 1) || meets(p, -1); });
  }

  void CountSights() {
    std::vector<Panel> panels;
    for (const WallCandidate& c : faces_) panels.push_back(c.panel);
    PanelGrid grid(panels, 0.5);
    std::vector<uint32_t> near;
    ForEachSight(map_, T_plan_map_, [&](const Sight& sight) {
      grid.Near(sight.from.head<2>(), sight.to.head<2>(), near);
      for (const uint32_t i : near) {
        WallCandidate& c = faces_[i];
        Meeting m;
        if (!Meet(c.panel, sight, &m) || m.from_m < kOn_m || m.to_m > kOn_m || c.panel.W(sight.from.head<2>()) < 0) continue;
        if (m.u < kEdge_m || m.u > c.panel.length_m - kEdge_m) continue;
        const auto column = std::min(static_cast<size_t>(m.u / kColumn_m), c.top_m.size() - 1);
        const bool goes_on = m.to_m < -kBeyond_m;
        if (goes_on && m.z > c.top_m[column] + kEdge_m && m.z < c.required_top_m) ++c.over;
        if (m.z < c.panel.z_min_m + kEdge_m || m.z > c.top_m[column] - kEdge_m) continue;
        if (goes_on) ++c.passed;
        if (m.to_m > -kOn_m) {
          ++c.ended;
          c.mirrored += standing_.InTheWay(sight) ? 1 : 0;
        }
      }
    });
  }

  // The face that looks the other way, a wall's thickness behind this one.
  [[nodiscard]] std::optional<size_t> OtherFace(size_t i, const std::vector<bool>& used) const {
    const Panel& a = faces_[i].panel;
    std::optional<size_t> best;
    double best_m = options_.max_thickness_m;
    for (size_t k = 0; k < faces_.size(); ++k) {
      const Panel& b = faces_[k].panel;
      if (k == i || used[k] || a.normal.dot(b.normal) > -kOpposite_cos) continue;
      const Eigen::Vector2d end = b.start + b.length_m * b.along;
      const double thickness_m = -a.W(0.5 * (b.start + end));
      const double overlap_m = std::min(a.length_m, std::max(a.U(b.start), a.U(end))) - std::max(0.0, std::min(a.U(b.start), a.U(end)));
      if (thickness_m < kMinThickness_m || thickness_m > best_m || overlap_m < kMinOverlap * std::min(a.length_m, b.length_m)) continue;
      best = k;
      best_m = thickness_m;
    }
    return best;
  }

  [[nodiscard]] bool IsWall(const WallCandidate& front, const WallCandidate* back) const {
    // Beside a planned wall only what has two faces is another wall; else it is the front of something, or the planned wall itself.
    if (!back && PlannedShare(front, options_.wall_gate_m) >= kMaxExplained) return false;
    Panel middle = front.panel;
    if (back) middle.start += 0.5 * front.panel.W(back->panel.start + 0.5 * back->panel.length_m * back->panel.along) * front.panel.normal;
    if (planned_.MayBeUnmatchedOne(middle, options_.wall_gate_m)) return false;
    const auto as_high_as_walls = [&](const WallCandidate& c) {
      return LengthAbove(c, c.required_top_m) >= std::max(options_.min_length_m, 0.5 * c.panel.length_m);
    };
    if (as_high_as_walls(front) || (back && as_high_as_walls(*back))) return true;
    if (!back) return false;
    const double seen_m = plan_.rooms[front.room.index()].floor_z_m + options_.min_seen_height_m;
    const auto seen_high = [&](const WallCandidate& c) {
      return LengthAbove(c, seen_m) >= std::max(options_.min_length_m, 0.5 * c.panel.length_m);
    };
    const auto seen_over = [&](const WallCandidate& c) { return static_cast<double>(c.over) > kMaxOver * static_cast<double>(c.ended); };
    const double thickness_m = -front.panel.W(back->panel.start + 0.5 * back->panel.length_m * back->panel.along);
    return thickness_m <= options_.max_thin_m && (seen_high(front) || seen_high(*back)) && !seen_over(front) && !seen_over(*back);
  }

  [[nodiscard]] UnplannedWall WallOf(const WallCandidate& front, const WallCandidate* back) const {
    double from = 0, to = front.panel.length_m, depth_m = options_.single_thickness_m, top_m = front.panel.z_max_m;
    if (back) {
      const Eigen::Vector2d end = back->panel.start + back->panel.length_m * back->panel.along;
      from = std::min({from, front.panel.U(back->panel.start), front.panel.U(end)});
      to = std::max({to, front.panel.U(back->panel.start), front.panel.U(end)});
      depth_m = -front.panel.W(0.5 * (back->panel.start + end));
      top_m = std::max(top_m, back->panel.z_max_m);
    }
    const Eigen::Vector2d a = front.panel.start + from * front.panel.along, b = front.panel.start + to * front.panel.along;
    const Eigen::Vector2d behind = depth_m * front.panel.normal;
    return {{a - behind, b - behind, b, a}, top_m - plan_.rooms[front.room.index()].floor_z_m, front.room};
  }

  const SGraph& map_;
  const AGraph& plan_;
  const UnplannedOptions& options_;
  const Eigen::Isometry3d T_plan_map_;
  const RayCaster caster_;
  StandingWalls standing_;
  const PlannedWalls planned_;
  std::vector<WallCandidate> faces_;
};

}  // namespace

std::string UnplannedOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"min_length_m", min_length_m}, {"below_ceiling_m", below_ceiling_m},
                                                     {"min_height_m", min_height_m}, {"min_seen_height_m", min_seen_height_m},
                                                     {"max_bottom_m", max_bottom_m}, {"max_thickness_m", max_thickness_m},
                                                     {"max_thin_m", max_thin_m},     {"single_thickness_m", single_thickness_m},
                                                     {"plan_gate_m", plan_gate_m},   {"wall_gate_m", wall_gate_m}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("UnplannedOptions.{} = {}; must be a positive number", name, value);
  }
  if (!(max_passed_ratio >= 0 && max_passed_ratio <= 1))
    return fmt::format("UnplannedOptions.max_passed_ratio = {}; must be in [0, 1]", max_passed_ratio);
  if (min_keyframes < 1) return fmt::format("UnplannedOptions.min_keyframes = {}; must be >= 1", min_keyframes);
  return {};
}

bool SameWall(const UnplannedWall& a, const UnplannedWall& b) {
  Panel longer = CentreLine(a), shorter = CentreLine(b);
  if (longer.length_m < shorter.length_m) std::swap(longer, shorter);
  if (std::abs(longer.along.dot(shorter.along)) < kSameWall_cos) return false;
  const Eigen::Vector2d end = shorter.start + shorter.length_m * shorter.along;
  if (std::abs(longer.W(0.5 * (shorter.start + end))) > kSameWall_m) return false;
  const double from = longer.U(shorter.start), to = longer.U(end);
  return std::max(from, to) > 0 && std::min(from, to) < longer.length_m;
}

std::vector<UnplannedWall> FindUnplannedWalls(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                              const JointResult& estimate, const UnplannedOptions& options) {
  if (map.planar) return {};
  return Search(map, plan, matches, estimate, options).Run();
}

}  // namespace plumb::runtime
