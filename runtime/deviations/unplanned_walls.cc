#include "runtime/deviations/unplanned_walls.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "runtime/deviations/panel.h"
#include "runtime/deviations/standing_walls.h"
#include "runtime/matching/ray_caster.h"
#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kSameLine_m = 0.06, kSameDirection_cos = 0.995;  // pieces of one face
constexpr double kMaxGap_m = 0.5;
constexpr double kOpposite_cos = 0.99;
constexpr double kMinThickness_m = 0.03;
constexpr double kMinOverlap = 0.5;          // of the shorter of two faces
constexpr double kColumn_m = 0.1;            // of MapSurface::cells ...
constexpr int kMinCells = 3;                 // ... of one column of a surface that stands there
constexpr double kMaxTrimGap_m = 0.3;
constexpr double kOn_m = 0.08, kBeyond_m = 0.25, kEdge_m = 0.15;
constexpr double kMinInRoom = 0.5;           // of a wall's length
constexpr double kUnseen = -std::numeric_limits<double>::infinity();
constexpr double kParallel_cos = 0.94;
constexpr double kMaxExplained = 0.5;        // of a wall's length
constexpr double kMaxMirrored = 0.5;         // of the lines that end on it
constexpr double kMaxOver = 0.02;            // of the lines that meet it
constexpr double kMinStanding_m2 = 0.5;
constexpr double kSample_m = 0.1;
constexpr double kSameWall_m = 0.5;

// One face of something upright, of one map surface or several on one line. The panel's normal is into the free space.
struct Candidate {
  Panel panel;
  double area_m2 = 0;
  std::vector<double> top_m;     // per kColumn_m of its length the highest that was seen there, in the room; -inf: nothing
  std::set<uint32_t> keyframes;
  RoomId room;
  double required_top_m = 0;     // to be as high as a wall
  size_t ended = 0, passed = 0, over = 0, mirrored = 0;  // lines of sight
};

Candidate CandidateOf(const MapSurface& s, const Eigen::Isometry3d& T_plan_map) {
  Candidate c;
  const auto in_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d((T_plan_map * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>()); };
  const double up_m = T_plan_map.translation().z();
  const Eigen::Vector2d start = in_plan(s.start), end = in_plan(s.end);
  c.panel.along = (end - start).normalized();
  c.panel.normal = {-c.panel.along.y(), c.panel.along.x()};
  c.panel.start = start;
  c.panel.length_m = (end - start).norm();
  c.panel.z_min_m = s.z_min_m + up_m;
  c.panel.z_max_m = s.z_max_m + up_m;
  c.area_m2 = s.area_m2;
  c.top_m.assign(static_cast<size_t>(std::ceil(c.panel.length_m / kColumn_m)), kUnseen);
  std::vector<int> cells(c.top_m.size(), 0);
  for (const Eigen::Vector2f& cell : s.cells) {
    const auto column = static_cast<size_t>(std::max(0.0, std::floor(static_cast<double>(cell.x()) / kColumn_m)));
    if (column >= c.top_m.size()) continue;
    c.top_m[column] = std::max(c.top_m[column], static_cast<double>(cell.y()) + up_m);
    ++cells[column];
  }
  // What only touches the surface's plane, such as the floor beyond its end, is none of it.
  for (size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] < kMinCells) c.top_m[i] = kUnseen;
  }
  for (const Observation& o : s.observations) c.keyframes.insert(o.keyframe);
  return c;
}

// Do the two lie on one line, one going on where the other ends?
bool Continues(const Candidate& a, const Candidate& b) {
  if (a.panel.normal.dot(b.panel.normal) < kSameDirection_cos) return false;
  const Eigen::Vector2d b_end = b.panel.start + b.panel.length_m * b.panel.along;
  const double from = a.panel.U(b.panel.start), to = a.panel.U(b_end);
  const double gap_m = std::max({0.0, std::min(from, to) - a.panel.length_m, -std::max(from, to)});
  if (gap_m > kMaxGap_m) return false;
  return std::abs(a.panel.W(0.5 * (b.panel.start + b_end))) < kSameLine_m;
}

// Lengthens `a`, whose line stays.
void Append(const Candidate& b, Candidate* a) {
  const Eigen::Vector2d b_end = b.panel.start + b.panel.length_m * b.panel.along;
  const double from = std::min(0.0, a->panel.U(b.panel.start)), to = std::max(a->panel.length_m, a->panel.U(b_end));
  std::vector<double> top_m(static_cast<size_t>(std::ceil((to - from) / kColumn_m)), kUnseen);
  const auto put = [&](const std::vector<double>& tops, double at) {
    for (size_t i = 0; i < tops.size(); ++i) {
      const auto column = static_cast<size_t>(std::clamp((at - from) / kColumn_m + static_cast<double>(i), 0.0, static_cast<double>(top_m.size()) - 1));
      top_m[column] = std::max(top_m[column], tops[i]);
    }
  };
  put(a->top_m, 0);
  put(b.top_m, a->panel.U(b.panel.start));
  a->top_m = std::move(top_m);
  a->panel.start += from * a->panel.along;
  a->panel.length_m = to - from;
  a->panel.z_min_m = std::min(a->panel.z_min_m, b.panel.z_min_m);
  a->panel.z_max_m = std::max(a->panel.z_max_m, b.panel.z_max_m);
  a->area_m2 += b.area_m2;
  a->keyframes.insert(b.keyframes.begin(), b.keyframes.end());
}

// What matched nothing, in pieces as long as they go.
std::vector<Candidate> UnmatchedFaces(const SGraph& map, const std::vector<Match>& matches, const Eigen::Isometry3d& T_plan_map) {
  std::set<uint32_t> matched;
  for (const Match& m : matches) matched.insert(m.map_surface);
  std::vector<Candidate> faces;
  for (size_t i = 0; i < map.surfaces.size(); ++i) {
    const MapSurface& s = map.surfaces[i];
    if (s.kind == SurfaceKind::kWall && !s.observations.empty() && s.length_m() > kColumn_m && !matched.contains(static_cast<uint32_t>(i))) {
      faces.push_back(CandidateOf(s, T_plan_map));
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Candidate& a, const Candidate& b) { return a.area_m2 > b.area_m2; });
  std::vector<Candidate> out;
  for (const Candidate& face : faces) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Candidate& c) { return Continues(c, face); });
    if (same == out.end()) {
      out.push_back(face);
    } else {
      Append(face, &*same);
    }
  }
  return out;
}

// Length of it that was seen up to the height.
double LengthAbove(const Candidate& c, double top_m) {
  return kColumn_m * static_cast<double>(std::count_if(c.top_m.begin(), c.top_m.end(), [&](double top) { return top >= top_m; }));
}

// Leaves of it the longest part that was seen without a long gap.
void Trim(Candidate* c) {
  const auto max_gap = static_cast<size_t>(std::lround(kMaxTrimGap_m / kColumn_m));
  size_t best_from = 0, best_to = 0;
  for (size_t i = 0; i < c->top_m.size();) {
    size_t from = i, to = i, gap = 0;
    for (; i < c->top_m.size() && gap <= max_gap; ++i) {
      gap = std::isfinite(c->top_m[i]) ? 0 : gap + 1;
      if (gap == 0) to = i + 1;
    }
    while (from < to && !std::isfinite(c->top_m[from])) ++from;
    if (to - from > best_to - best_from) {
      best_from = from;
      best_to = to;
    }
  }
  const double length_m = std::min(c->panel.length_m, kColumn_m * static_cast<double>(best_to));
  c->panel.start += kColumn_m * static_cast<double>(best_from) * c->panel.along;
  c->panel.length_m = std::max(0.0, length_m - kColumn_m * static_cast<double>(best_from));
  c->top_m = {c->top_m.begin() + static_cast<std::ptrdiff_t>(best_from), c->top_m.begin() + static_cast<std::ptrdiff_t>(best_to)};
}

class Search {
 public:
  Search(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const JointResult& estimate, const UnplannedOptions& options)
      : map_(map), plan_(plan), options_(options), T_plan_map_(estimate.T_plan_map), caster_(plan.mesh), standing_(plan, estimate, kMinStanding_m2),
        faces_(UnmatchedFaces(map, matches, T_plan_map_)) {}

  std::vector<UnplannedWall> Run() {
    std::erase_if(faces_, [&](Candidate& c) { return !CouldBeWall(c); });
    if (faces_.empty()) return {};
    CountSights();
    std::erase_if(faces_, [&](const Candidate& c) {
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
  bool CouldBeWall(Candidate& c) const {
    if (c.panel.length_m < options_.min_length_m || c.keyframes.size() < static_cast<size_t>(options_.min_keyframes)) return false;
    c.room = RoomOf(c);
    if (!c.room.valid()) return false;
    for (size_t i = 0; i < c.top_m.size(); ++i) {
      const Eigen::Vector2d p = c.panel.start + kColumn_m * (static_cast<double>(i) + 0.5) * c.panel.along;
      if (!Contains(plan_.rooms[c.room.index()], p)) c.top_m[i] = kUnseen;
    }
    Trim(&c);
    if (c.panel.length_m < options_.min_length_m) return false;
    const double floor_m = plan_.rooms[c.room.index()].floor_z_m;
    if (c.panel.z_min_m > floor_m + options_.max_bottom_m) return false;
    c.required_top_m = RequiredTop(c, floor_m);
    return PlannedShare(c, options_.plan_gate_m) < kMaxExplained;
  }

  // The room that half of it or more stands in.
  [[nodiscard]] RoomId RoomOf(const Candidate& c) const {
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
  static double Share(const Candidate& c, F&& holds) {
    int yes = 0, all = 0;
    for (double u = 0.5 * kSample_m; u < c.panel.length_m; u += kSample_m) {
      yes += holds(Eigen::Vector2d(c.panel.start + u * c.panel.along)) ? 1 : 0;
      ++all;
    }
    return all == 0 ? 0 : static_cast<double>(yes) / all;
  }

  // Below the lowest ceiling seen over it; by the plan's, a suspended ceiling would hide that a wall is one.
  [[nodiscard]] double RequiredTop(const Candidate& c, double floor_m) const {
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
  [[nodiscard]] double PlannedShare(const Candidate& c, double gate_m) const {
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
    for (const Candidate& c : faces_) panels.push_back(c.panel);
    PanelGrid grid(panels, 0.5);
    std::vector<uint32_t> near;
    ForEachSight(map_, T_plan_map_, [&](const Sight& sight) {
      grid.Near(sight.from.head<2>(), sight.to.head<2>(), near);
      for (const uint32_t i : near) {
        Candidate& c = faces_[i];
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

  [[nodiscard]] bool IsWall(const Candidate& front, const Candidate* back) const {
    // Beside a planned wall only what has two faces is another wall; else it is the front of something, or the planned wall itself.
    if (!back && PlannedShare(front, options_.wall_gate_m) >= kMaxExplained) return false;
    const auto as_high_as_walls = [&](const Candidate& c) { return LengthAbove(c, c.required_top_m) >= std::max(options_.min_length_m, 0.5 * c.panel.length_m); };
    if (as_high_as_walls(front) || (back && as_high_as_walls(*back))) return true;
    if (!back) return false;
    const double seen_m = plan_.rooms[front.room.index()].floor_z_m + options_.min_seen_height_m;
    const auto seen_high = [&](const Candidate& c) { return LengthAbove(c, seen_m) >= std::max(options_.min_length_m, 0.5 * c.panel.length_m); };
    const auto seen_over = [&](const Candidate& c) { return static_cast<double>(c.over) > kMaxOver * static_cast<double>(c.ended); };
    const double thickness_m = -front.panel.W(back->panel.start + 0.5 * back->panel.length_m * back->panel.along);
    return thickness_m <= options_.max_thin_m && (seen_high(front) || seen_high(*back)) && !seen_over(front) && !seen_over(*back);
  }

  [[nodiscard]] UnplannedWall WallOf(const Candidate& front, const Candidate* back) const {
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
  std::vector<Candidate> faces_;
};

}  // namespace

std::string UnplannedOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"min_length_m", min_length_m}, {"below_ceiling_m", below_ceiling_m}, {"min_height_m", min_height_m},
      {"min_seen_height_m", min_seen_height_m}, {"max_bottom_m", max_bottom_m}, {"max_thickness_m", max_thickness_m}, {"max_thin_m", max_thin_m},
      {"single_thickness_m", single_thickness_m}, {"plan_gate_m", plan_gate_m}, {"wall_gate_m", wall_gate_m}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("UnplannedOptions.{} = {}; must be a positive number", name, value);
  }
  if (!(max_passed_ratio >= 0 && max_passed_ratio <= 1)) return fmt::format("UnplannedOptions.max_passed_ratio = {}; must be in [0, 1]", max_passed_ratio);
  if (min_keyframes < 1) return fmt::format("UnplannedOptions.min_keyframes = {}; must be >= 1", min_keyframes);
  return {};
}

bool SameWall(const UnplannedWall& a, const UnplannedWall& b) {
  const auto middle = [](const UnplannedWall& w) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : w.polygon) sum += p;
    return Eigen::Vector2d(sum / static_cast<double>(std::max<size_t>(1, w.polygon.size())));
  };
  return (middle(a) - middle(b)).norm() < kSameWall_m;
}

std::vector<UnplannedWall> FindUnplannedWalls(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const JointResult& estimate,
                                              const UnplannedOptions& options) {
  if (map.planar) return {};
  return Search(map, plan, matches, estimate, options).Run();
}

}  // namespace plumb::runtime
