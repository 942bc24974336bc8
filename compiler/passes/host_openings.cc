#include "compiler/passes/host_openings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "compiler/passes/assign_storeys.h"
#include "compiler/passes/opening_extent.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"

namespace plumb::compiler {
namespace {

constexpr double kThroughShare = 0.85;  // a void that takes less of the wall's thickness is a niche

bool IsFilling(const PlanElement& e) { return e.kind == ElementKind::kDoor || e.kind == ElementKind::kWindow; }

// An opening or a free door or window before it has a host.
struct Candidate {
  uint32_t opening = kNoIndex;
  std::vector<uint32_t> fillings;
  uint32_t wall = kNoIndex;
  std::vector<Eigen::Vector2d> outline;  // convex hull from above, of the void, else of the fillings: their vertices would take memory
  Eigen::AlignedBox3d box;
  bool has_void = false;
};

class Host {
 public:
  Host(const PlanIr& plan, const FloorIr& floors, const HostingOptions& options, const AGraph& graph, DiagnosticSink& sink)
      : plan_(plan), floors_(floors), options_(options), graph_(graph), sink_(sink) {
    for (uint32_t w = 0; w < floors.walls.size(); ++w) {
      for (uint32_t e : floors.walls[w].elements) wall_of_element_[e] = w;
    }
    for (const Floor& floor : floors.floors) levels_.push_back(floor.level);
    for (uint32_t e = 0; e < plan.elements.size(); ++e) {
      if (IsFilling(plan.elements[e]) && !plan.elements[e].guid.empty()) fillings_by_source_[SourceOf(plan.elements[e])].push_back(e);
    }
  }

  std::vector<HostedOpening> Run() {
    CollectCandidates();
    for (Candidate& c : candidates_) KeepToWall(c);
    PairLooseFillings();
    std::vector<HostedOpening> out;
    for (const Candidate& c : candidates_) {
      if (std::optional<HostedOpening> hosted = Place(c)) out.push_back(std::move(*hosted));
    }
    return out;
  }

 private:
  // Some programs give several doors one GlobalId.
  static std::pair<std::string, uint64_t> SourceOf(const PlanElement& e) { return {e.guid, e.location.step_id}; }

  // The element and the others of its source (panes).
  std::vector<uint32_t> WithPanes(uint32_t element) const {
    const auto it = fillings_by_source_.find(SourceOf(plan_.elements[element]));
    return it == fillings_by_source_.end() ? std::vector<uint32_t>{element} : it->second;
  }

  void CollectCandidates() {
    std::set<uint32_t> taken;
    for (uint32_t i = 0; i < plan_.openings.size(); ++i) {
      const PlanOpening& o = plan_.openings[i];
      // A curtain wall closes it, and its own doors lead through.
      if (o.filling != kNoIndex && !IsFilling(plan_.elements[o.filling])) continue;
      Candidate c;
      c.opening = i;
      if (const auto it = wall_of_element_.find(o.wall); it != wall_of_element_.end()) c.wall = it->second;
      if (o.filling != kNoIndex) c.fillings = WithPanes(o.filling);
      taken.insert(c.fillings.begin(), c.fillings.end());
      // An opening in a slab, a roof or a wall without solid.
      if (o.wall != kNoIndex && c.wall == kNoIndex && IsKnownAsNoWall(o.wall)) {
        if (IsWindow(c)) ReportInRoof(c);
        continue;
      }
      if (o.wall == kNoIndex && c.fillings.empty()) continue;
      AddCandidate(std::move(c));
    }
    for (uint32_t e = 0; e < plan_.elements.size(); ++e) {
      if (!IsFilling(plan_.elements[e]) || taken.contains(e)) continue;
      Candidate c;
      c.fillings = WithPanes(e);
      taken.insert(c.fillings.begin(), c.fillings.end());
      AddCandidate(std::move(c));
    }
  }

  bool IsKnownAsNoWall(uint32_t element) const {
    const ElementKind kind = plan_.elements[element].kind;
    return kind != ElementKind::kWall && kind != ElementKind::kCurtainWall && kind != ElementKind::kProxy;
  }

  void AddCandidate(Candidate c) {
    const auto add = [&c](const std::vector<Eigen::Vector3d>& vertices) {
      for (const auto& p : vertices) c.outline.push_back(p.head<2>()), c.box.extend(p);
    };
    if (c.opening != kNoIndex) add(plan_.openings[c.opening].body.vertices);
    c.has_void = !c.outline.empty();
    for (uint32_t e : c.fillings) {
      if (!c.has_void) add(plan_.elements[e].body.vertices);
    }
    c.outline = ConvexHull(std::move(c.outline));
    if (c.outline.empty()) {
      const SourceLocation& where = LocationOf(c);
      sink_.Emit(DiagnosticKind::kOpeningNotPlaced, where, fmt::format("{} has no solid to place it by; it is left out", where.ToString()));
      return;
    }
    candidates_.push_back(std::move(c));
  }

  bool IsWindow(const Candidate& c) const { return !c.fillings.empty() && plan_.elements[c.fillings[0]].kind == ElementKind::kWindow; }

  // Lies rather than stands: seen from above it has more area than from all sides.
  bool FacesUp(const Candidate& c) const {
    double up = 0, sideways = 0;
    for (const uint32_t e : c.fillings) {
      const Solid& body = plan_.elements[e].body;
      for (const Eigen::Vector3i& t : body.triangles) {
        const Eigen::Vector3d& a = body.vertices[static_cast<size_t>(t[0])];
        const Eigen::Vector3d n = (body.vertices[static_cast<size_t>(t[1])] - a).cross(body.vertices[static_cast<size_t>(t[2])] - a);
        up += std::abs(n.z());
        sideways += n.head<2>().norm();
      }
    }
    return up > sideways;
  }

  void ReportInRoof(const Candidate& c) const {
    const SourceLocation& where = LocationOf(c);
    sink_.Emit(DiagnosticKind::kWindowInRoof, where,
               fmt::format("{} lies in a roof or a slab; no wall has it, and it is in the triangles only", where.ToString()));
  }

  // Voids may reach far beyond their wall, in curved walls as wedges to the arc's centre: the middle of such a one is where both are.
  void KeepToWall(Candidate& c) const {
    if (!c.has_void || c.wall == kNoIndex) return;
    const size_t floor = LevelAt(levels_, c.box.min().z(), options_.storey_slack_m);
    const Footprint* footprint = FootprintOf(c.wall, floor);
    if (footprint == nullptr || Meets(c.box.center().head<2>(), c.wall, floor)) return;
    const Section section = CutSolid(plan_.openings[c.opening].body, c.box.center().z());
    const std::vector<Eigen::Vector2d> common = CommonCorners(section.rings, footprint->rings);
    if (common.empty()) return;
    const double z_min_m = c.box.min().z(), z_max_m = c.box.max().z();
    c.outline = ConvexHull(common);
    c.box.setEmpty();
    for (const auto& p : common) {
      for (double z : {z_min_m, z_max_m}) c.box.extend(Eigen::Vector3d(p.x(), p.y(), z));
    }
  }

  const SourceLocation& LocationOf(const Candidate& c) const {
    return c.fillings.empty() ? plan_.openings[c.opening].location : plan_.elements[c.fillings[0]].location;
  }

  // A door that the source ties to no wall, standing in an unfilled opening of one, fills it.
  void PairLooseFillings() {
    for (size_t i = 0; i < candidates_.size(); ++i) {
      Candidate& loose = candidates_[i];
      if (loose.has_void || loose.fillings.empty() || loose.wall != kNoIndex) continue;
      Candidate* best = nullptr;
      double best_m = options_.max_filling_offset_m;
      for (Candidate& c : candidates_) {
        if (!c.has_void || !c.fillings.empty() || c.wall == kNoIndex) continue;
        const double offset = (c.box.center() - loose.box.center()).norm();
        if (offset >= best_m) continue;
        best = &c;
        best_m = offset;
      }
      if (best == nullptr) continue;
      best->fillings = loose.fillings;
      if (loose.opening != kNoIndex) best->opening = Merged(best->opening, loose.opening);
      loose.outline.clear();  // spent
    }
  }

  // The one with the stated width speaks for both.
  uint32_t Merged(uint32_t of_void, uint32_t of_filling) const { return plan_.openings[of_filling].width_m ? of_filling : of_void; }

  std::optional<HostedOpening> Place(const Candidate& c) {
    if (c.outline.empty()) return std::nullopt;
    HostedOpening out;
    out.opening = c.opening;
    out.fillings = c.fillings;
    if (!c.fillings.empty()) out.use = plan_.elements[c.fillings[0]].kind == ElementKind::kDoor ? OpeningUse::kDoor : OpeningUse::kWindow;
    out.z_min_m = c.box.min().z();
    out.z_max_m = c.box.max().z();
    out.floor = LevelAt(levels_, out.z_min_m, options_.storey_slack_m);
    out.storey = StoreyOf(c, levels_[out.floor], out.z_min_m);
    out.center = c.box.center().head<2>();
    const bool stated = c.wall != kNoIndex && Meets(out.center, c.wall, out.floor);
    if (c.wall != kNoIndex && !stated && out.use == OpeningUse::kUnfilled) return std::nullopt;
    const uint32_t wall = stated ? c.wall : NearestWall(out);
    if (wall == kNoIndex) {
      if (out.use == OpeningUse::kUnfilled) return std::nullopt;
      if (IsWindow(c) && FacesUp(c)) {
        ReportInRoof(c);
        return std::nullopt;
      }
      const SourceLocation& where = LocationOf(c);
      sink_.Emit(
          DiagnosticKind::kOpeningWithoutWall, where,
          fmt::format("no wall within {:.2f} m of {}; doors and windows stand in walls", options_.max_host_distance_m, where.ToString()));
      AlignToSelf(c, out);
      return out;
    }
    out.wall = WallId(wall);
    AlignToWall(c, out);
    return out;
  }

  StoreyId StoreyOf(const Candidate& c, const Level& level, double z_min_m) const {
    if (!c.fillings.empty()) {
      const uint32_t stated = plan_.elements[c.fillings[0]].storey;
      if (stated >= level.first_storey && stated <= level.last_storey) return StoreyId(stated);
    }
    uint32_t best = level.first_storey;
    for (uint32_t s = level.first_storey; s <= level.last_storey; ++s) {
      if (plan_.storeys[s].elevation_m <= z_min_m + options_.storey_slack_m) best = s;
    }
    return StoreyId(best);
  }

  // The wall's footprint on the given floor, else on any.
  const Footprint* FootprintOf(uint32_t wall, size_t floor) const {
    const Footprint* any = nullptr;
    for (size_t f = 0; f < floors_.floors.size(); ++f) {
      for (const Footprint& footprint : floors_.floors[f].footprints) {
        if (footprint.wall != wall) continue;
        if (f == floor) return &footprint;
        if (any == nullptr) any = &footprint;
      }
    }
    return any;
  }

  // Whether the wall that the source states is anywhere near.
  bool Meets(const Eigen::Vector2d& center, uint32_t wall, size_t floor) const {
    const Footprint* footprint = FootprintOf(wall, floor);
    if (footprint == nullptr) return true;
    return WindingNumber(footprint->rings, center) != 0 || DistanceToRings(center, footprint->rings) <= options_.max_host_distance_m;
  }

  uint32_t NearestWall(const HostedOpening& o) const {
    uint32_t best = kNoIndex;
    double best_m = options_.max_host_distance_m;
    for (const Footprint& f : floors_.floors[o.floor].footprints) {
      if (f.wall == kNoIndex || floors_.walls[f.wall].z_max_m <= o.z_min_m || floors_.walls[f.wall].z_min_m >= o.z_max_m) continue;
      const double distance = WindingNumber(f.rings, o.center) != 0 ? 0 : DistanceToRings(o.center, f.rings);
      if (distance > best_m || (distance == best_m && best != kNoIndex)) continue;
      best = f.wall;
      best_m = distance;
    }
    return best;
  }

  void AlignToSelf(const Candidate& c, HostedOpening& out) const {
    const Ring box = LeastRectangle(c.outline);
    if (box.size() < 4) return;
    const Eigen::Vector2d u = box[1] - box[0], v = box[2] - box[1];
    out.along = (u.norm() >= v.norm() ? u : v).normalized();
    out.width_m = std::max(u.norm(), v.norm());
    out.depth_m = std::min(u.norm(), v.norm());
    out.center = 0.5 * (box[0] + box[2]);
  }

  // Of the wall's arc at p; none: the wall is straight there.
  std::optional<Eigen::Vector2d> TangentAt(uint32_t w, const Eigen::Vector2d& p) const {
    double best_m = graph_.walls[w].thickness_m + options_.max_host_distance_m;
    std::optional<Eigen::Vector2d> best;
    for (const Arc& arc : floors_.walls[w].arcs) {
      const Eigen::Vector2d out = p - arc.center;
      const double off_rad = std::remainder(std::atan2(out.y(), out.x()) - arc.start_rad - 0.5 * arc.sweep_rad, 2 * std::numbers::pi);
      const double distance = std::abs(out.norm() - arc.radius_m);
      if (std::abs(off_rad) > 0.5 * std::abs(arc.sweep_rad) || distance >= best_m) continue;
      best_m = distance;
      best = Rot90Ccw(out.normalized());
    }
    return best;
  }

  Eigen::Vector2d DirectionAt(uint32_t w, const std::vector<Ring>& rings, const Eigen::Vector2d& p) const {
    if (const std::optional<Eigen::Vector2d> tangent = TangentAt(w, p)) return *tangent;
    const Wall& wall = graph_.walls[w];
    const Eigen::Vector2d axis = wall.axis_end - wall.axis_start;
    const double off_axis = axis.norm() > 0 ? std::abs(Cross(axis.normalized(), p - wall.axis_start)) : 0;
    const bool curved = !floors_.walls[w].arcs.empty() || off_axis > wall.thickness_m;
    if (axis.norm() == 0) return SideNextTo(rings, p).value_or(Eigen::Vector2d::UnitX());
    return curved ? SideNextTo(rings, p).value_or(axis.normalized()) : Eigen::Vector2d(axis.normalized());
  }

  void AlignToWall(const Candidate& c, HostedOpening& out) const {
    const uint32_t w = out.wall.value;
    const Footprint* footprint = FootprintOf(w, out.floor);
    const std::vector<Ring> rings = footprint != nullptr ? footprint->rings : std::vector<Ring>{};
    out.along = DirectionAt(w, rings, out.center);
    const Eigen::Vector2d across = Rot90Ccw(out.along);
    Eigen::AlignedBox2d extent;
    for (const auto& p : c.outline) extent.extend(Eigen::Vector2d(out.along.dot(p), across.dot(p)));
    extent = WithinWall(extent, out.along, rings);
    out.width_m = extent.sizes().x();
    const double u = extent.center().x();
    // The wall's piece at this place: the interval of the line across it next to the opening.
    const Eigen::Vector2d at = u * out.along + extent.center().y() * across;
    const Wall& wall = graph_.walls[w];
    const double offset = across.dot(wall.axis_start - at);
    const auto [lo, hi] =
        SolidInterval(rings, at, across).value_or(std::pair(offset - 0.5 * wall.thickness_m, offset + 0.5 * wall.thickness_m));
    out.center = at + 0.5 * (lo + hi) * across;
    out.depth_m = hi - lo;
    const double half = 0.5 * extent.sizes().y();
    const double taken = std::min(hi, half) - std::max(lo, -half);
    out.through = out.use != OpeningUse::kUnfilled || taken >= kThroughShare * out.depth_m;
  }

  const PlanIr& plan_;
  const FloorIr& floors_;
  const HostingOptions& options_;
  const AGraph& graph_;
  DiagnosticSink& sink_;
  std::map<uint32_t, uint32_t> wall_of_element_;
  std::map<std::pair<std::string, uint64_t>, std::vector<uint32_t>> fillings_by_source_;
  std::vector<Level> levels_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::string HostingOptions::Check() const {
  if (!(max_host_distance_m > 0)) return fmt::format("HostingOptions.max_host_distance_m = {}; must be positive", max_host_distance_m);
  if (!(max_filling_offset_m > 0)) return fmt::format("HostingOptions.max_filling_offset_m = {}; must be positive", max_filling_offset_m);
  if (!(storey_slack_m >= 0)) return fmt::format("HostingOptions.storey_slack_m = {}; must not be negative", storey_slack_m);
  return {};
}

std::vector<HostedOpening> HostOpenings(const PlanIr& plan, const FloorIr& floors, const HostingOptions& options, const AGraph& graph,
                                        DiagnosticSink& sink) {
  return Host(plan, floors, options, graph, sink).Run();
}

}  // namespace plumb::compiler
