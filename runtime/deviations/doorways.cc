#include "runtime/deviations/doorways.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/built_doorway.h"
#include "runtime/deviations/corner_jamb.h"
#include "runtime/deviations/panel.h"
#include "runtime/deviations/sights.h"

namespace plumb::runtime {
namespace {

constexpr double kReach_m = 0.5;        // of PanelGrid's cells
constexpr double kMinWall_m = 0.04;     // of plain wall beside a jamb: less, and the next wall's face is the jamb
constexpr double kCornerReach_m = 0.3;  // behind a corner nothing passes
constexpr double kMaxCorner_m = 0.02;   // a corner that is more off is its own wall's deviation
// A casing on the wall's faces narrows the opening by so much on both sides alike.
constexpr double kCasing_m = 0.12, kCasingUneven_m = 0.03;
constexpr double kOnFace_m = 0.05;      // of a face, 2.5 sigma of a range
constexpr double kBehind_m = 0.02;      // what is inside the wall is not on its far face
constexpr double kBeyond_m = 0.10;      // a line that goes on so far has passed the wall
constexpr double kBefore_m = 0.05;      // it starts so far from it
constexpr double kMaxSlant = 0.5;       // tangent; flatter lines smear a face's end along the wall
constexpr double kMinIncidence = 0.25;  // sine, of lines that pass
constexpr double kRange_m = 0.02;       // sigma of a range,
constexpr double kPlace_m = 0.006;      // of where a sweep was taken,
constexpr double kBeam_rad = 0.0015;    // and of a line's direction
constexpr size_t kAllPoints = SIZE_MAX;
// Walled up: what is seen in the opening is flush with the wall.
constexpr double kFlush_m = 0.015, kFlushRms_m = 0.035;
constexpr double kCell_m = 0.15;
constexpr double kMinFilled = 0.8;   // of the opening's columns
constexpr double kMaxPassed = 0.01;  // of its lines
constexpr int kMinFillLines = 100;

// What lies in the opening's plane on one of the wall's sides.
struct Filling {
  double lines = 0, depth = 0, depth2 = 0;
  std::vector<uint32_t> columns;

  [[nodiscard]] bool IsFlush() const {
    if (lines < kMinFillLines || columns.empty()) return false;
    const auto filled = std::count_if(columns.begin(), columns.end(), [](uint32_t n) { return n >= 3; });
    const double mean = depth / lines, rms = std::sqrt(std::max(0.0, depth2 / lines - mean * mean));
    return static_cast<double>(filled) >= kMinFilled * static_cast<double>(columns.size()) && std::abs(mean) <= kFlush_m &&
           rms <= kFlushRms_m;
  }
};

struct Site {
  BuiltDoorway at;
  std::optional<CornerJamb> right_corner, left_corner;
  double middle_m = 0;  // u between the planned jambs
  JambEvidence right, left;
  double passed = 0;
  Filling fillings[2] = {};

  Site(const BuiltDoorway& b, const std::optional<CornerJamb>& corner_at_right, const std::optional<CornerJamb>& corner_at_left)
      : at(b),
        right_corner(corner_at_right),
        left_corner(corner_at_left),
        middle_m(0.5 * (b.left.u_m + b.right.u_m)),
        right(b.right.outward_m, Inward()),
        left(b.left.outward_m, Inward()) {
    for (Filling& f : fillings) f.columns.assign(static_cast<size_t>(std::max(0.0, std::floor(Width() / kCell_m) - 1)), 0);
  }

  [[nodiscard]] double Width() const { return at.left.u_m - at.right.u_m; }
  [[nodiscard]] double Inward() const { return std::min(0.5, 0.6 * Width()); }

  [[nodiscard]] Panel Zone() const {
    Panel panel;
    const double from = at.right.u_m - at.right.outward_m;
    panel.start = at.origin + from * at.along;
    panel.along = at.along;
    panel.normal = at.across;
    panel.length_m = at.left.u_m + at.left.outward_m - from;
    panel.z_min_m = at.z_min_m;
    panel.z_max_m = at.z_max_m;
    return panel;
  }

  void Take(const Sight& sight, double max_sight_m) {
    const Eigen::Vector3d& from = sight.from;
    const double place_m2 = kPlace_m * kPlace_m + at.along.dot(sight.smear_m2 * at.along);
    const double u0 = at.U(from.head<2>()), w0 = at.W(from.head<2>()), u1 = at.U(sight.to.head<2>()), w1 = at.W(sight.to.head<2>());
    const double length_m = (sight.to - from).norm(), du = u1 - u0, dw = w1 - w0;
    if (dw == 0) return;
    const bool from_a = dw > 0;
    const double near = from_a ? at.w_a_m : at.w_b_m, far = from_a ? at.w_b_m : at.w_a_m;
    const double side = from_a ? 1.0 : -1.0, thickness_m = side * (far - near);
    const double before_m = side * (near - w0), depth_m = side * (w1 - near);
    const auto within = [&](double z) { return z > at.z_min_m && z < at.z_max_m; };
    if (depth_m > thickness_m + kBeyond_m) {
      if (before_m < kBefore_m || std::abs(dw) < kMinIncidence * length_m) return;
      const double t_near = (near - w0) / dw, t_far = (far - w0) / dw;
      const double z_near = from.z() + t_near * (sight.to.z() - from.z()), z_far = from.z() + t_far * (sight.to.z() - from.z());
      if (!within(z_near) || !within(z_far) || t_far * length_m > max_sight_m) return;
      const double a = u0 + t_near * du, b = u0 + t_far * du;
      const double sigma_m = std::hypot(std::sqrt(place_m2), kBeam_rad * t_far * length_m);
      right.AddPassed(std::min(a, b) - at.right.u_m, sigma_m, sight.keyframe);
      left.AddPassed(at.left.u_m - std::max(a, b), sigma_m, sight.keyframe);
      if (std::min(a, b) > at.right.u_m && std::max(a, b) < at.left.u_m) ++passed;
      return;
    }
    if (!within(sight.to.z()) || length_m > max_sight_m) return;
    const double sigma_m = std::hypot(std::sqrt(place_m2), kRange_m * du / length_m, kBeam_rad * length_m);
    const bool to_right = u1 < middle_m;
    const double x_m = to_right ? u1 - at.right.u_m : at.left.u_m - u1;
    JambEvidence& jamb = to_right ? right : left;
    if (std::abs(depth_m) <= kOnFace_m && before_m > kBefore_m) {
      if (std::abs(du) <= kMaxSlant * std::abs(dw)) jamb.AddFace(from_a ? 0 : 1, x_m, sigma_m, sight.keyframe);
      Fill(from_a ? 0 : 1, u1, depth_m);
    } else if (depth_m > kOnFace_m && depth_m < thickness_m - kBehind_m) {
      jamb.AddInside(x_m, sigma_m, sight.keyframe);
    }
  }

  void Fill(size_t side, double u_m, double depth_m) {
    Filling& f = fillings[side];
    const double column = std::floor((u_m - at.right.u_m) / kCell_m - 0.5);
    if (column < 0 || column >= static_cast<double>(f.columns.size())) return;
    ++f.columns[static_cast<size_t>(column)];
    f.lines += 1;
    f.depth += depth_m;
    f.depth2 += depth_m * depth_m;
  }

  // A leaf that is shut is flush with one side at most.
  [[nodiscard]] bool IsWalledUp(bool has_leaf) const {
    const bool a = fillings[0].IsFlush(), b = fillings[1].IsFlush();
    return passed <= kMaxPassed * (fillings[0].lines + fillings[1].lines) && (has_leaf ? a && b : a || b);
  }
};

// Of the plan's place along a direction, at a point of the plan.
double PlaceVariance_m2(const JointResult& estimate, const Eigen::Vector2d& along, const Eigen::Vector2d& at) {
  const Eigen::Vector2d arm = at - estimate.T_plan_map.translation().head<2>();
  const Eigen::Vector3d j(along.x(), along.y(), along.dot(Eigen::Vector2d(-arm.y(), arm.x())));
  return j.dot(estimate.cov_xy_yaw * j);
}

double Density(double e_m, double variance_m2) { return std::exp(-0.5 * e_m * e_m / variance_m2) / std::sqrt(variance_m2); }

// Shift and width are each as planned or not; the three cases in which one is not share the prior.
double ProbabilityDeviated(const DoorwayDeviation& d, const DoorwayOptions& options) {
  const auto likelihood = [&](double e_m, double sigma_m, double spread_m) {
    return Density(e_m, sigma_m * sigma_m + spread_m * spread_m);
  };
  const double shift[] = {likelihood(d.shift_m, d.sigma_shift_m, options.tolerance_m),
                          likelihood(d.shift_m, d.sigma_shift_m, options.typical_deviation_m)};
  const double width[] = {likelihood(d.width_deviation_m, d.sigma_width_m, options.tolerance_m),
                          likelihood(d.width_deviation_m, d.sigma_width_m, options.typical_deviation_m)};
  const double planned = (1 - options.prior) * shift[0] * width[0];
  const double deviated = options.prior / 3 * (shift[1] * width[0] + shift[0] * width[1] + shift[1] * width[1]);
  return deviated > 0 ? deviated / (planned + deviated) : 1;
}

DoorwayStatus StatusOf(const DoorwayDeviation& d, const DoorwayOptions& options) {
  constexpr double kNoncentrality = 17.1;  // alpha 0.1 %, power 80 %
  const double tolerance_m2 = options.tolerance_m * options.tolerance_m, worst_m = std::max(d.sigma_shift_m, d.sigma_width_m);
  if (kNoncentrality * (worst_m * worst_m + tolerance_m2) > options.max_mdb_m * options.max_mdb_m) return DoorwayStatus::kUnobserved;
  const bool large = std::max(std::abs(d.shift_m), std::abs(d.width_deviation_m)) >= options.min_deviation_m;
  return large && d.p_deviated >= options.min_p_deviated ? DoorwayStatus::kDeviated : DoorwayStatus::kAsPlanned;
}

JambEstimate JambAt(const JambEvidence& evidence, const PlannedJamb& planned, const std::optional<CornerJamb>& corner,
                    const JambOptions& options) {
  return corner ? ConfirmJamb(evidence, corner->x_m, corner->sigma_m, options) : EstimateJamb(evidence, planned.step_m, options);
}

// Both sides in by the same, and the reveal not seen to be there.
bool MayBeCasing(const JambEstimate& right, const JambEstimate& left, double least_m) {
  const double in_m = 0.5 * (right.x_m + left.x_m);
  return in_m >= 0.5 * least_m && in_m <= kCasing_m && std::abs(right.x_m - left.x_m) <= kCasingUneven_m && !right.on_reveal &&
         !left.on_reveal;
}

DoorwayDeviation Judge(const Site& site, const AGraph& plan, const JointResult& estimate, const DoorwayOptions& options) {
  DoorwayDeviation out;
  out.doorway = site.at.doorway;
  if (site.IsWalledUp(plan.doorways[out.doorway.index()].has_leaf)) {
    out.status = DoorwayStatus::kMissing;
    return out;
  }
  const JambEstimate right = JambAt(site.right, site.at.right, site.right_corner, options.jamb);
  const JambEstimate left = JambAt(site.left, site.at.left, site.left_corner, options.jamb);
  if (!right.known || !left.known || MayBeCasing(right, left, options.min_deviation_m)) return out;
  const double variance_m2 = right.sigma_m * right.sigma_m + left.sigma_m * left.sigma_m;
  out.shift_m = 0.5 * (right.x_m - left.x_m);
  out.sigma_shift_m = std::sqrt(0.25 * variance_m2 + PlaceVariance_m2(estimate, site.at.along, site.at.origin));
  out.width_deviation_m = -(right.x_m + left.x_m);
  out.sigma_width_m = std::sqrt(variance_m2);
  out.p_deviated = ProbabilityDeviated(out, options);
  out.status = StatusOf(out, options);
  if (out.status == DoorwayStatus::kUnobserved) return {.doorway = out.doorway};
  return out;
}

// Which doorways can be judged, and where their jambs are looked for.
class SiteFinder {
 public:
  // `walls`: by wall; null: nothing is known about it.
  SiteFinder(const AGraph& plan, const std::vector<const WallEstimate*>& walls)
      : plan_(plan), walls_(walls), frames_(WallFrames(plan)), planned_(plan) {}

  [[nodiscard]] std::optional<Site> SiteOf(DoorwayId id) const {
    const WallId wall = plan_.doorways[id.index()].wall;
    if (!wall.valid() || !frames_[wall.index()].valid()) return std::nullopt;
    WallEstimate as_planned;
    as_planned.wall = wall;
    as_planned.reference = frames_[wall.index()].reference;
    const WallEstimate* estimate = walls_[wall.index()];
    const std::optional<BuiltDoorway> planned = planned_.Built(id, as_planned);
    std::optional<BuiltDoorway> built = planned && estimate ? planned_.Built(id, *estimate) : planned;
    if (!built) return std::nullopt;
    const bool right_ends = built->right.outward_m < kMinWall_m, left_ends = built->left.outward_m < kMinWall_m;
    // A wall that is hardly more than its lintel was not matched; corners on both sides hold its doorway.
    if (!estimate && !(right_ends && left_ends)) return std::nullopt;
    std::optional<CornerJamb> right, left;
    if (right_ends && !(right = Corner(*planned, *built, -1))) return std::nullopt;
    if (left_ends && !(left = Corner(*planned, *built, 1))) return std::nullopt;
    if (right) built->right.outward_m = kCornerReach_m;
    if (left) built->left.outward_m = kCornerReach_m;
    return Site(*built, right, left);
  }

 private:
  [[nodiscard]] std::optional<CornerJamb> Corner(const BuiltDoorway& planned, const BuiltDoorway& built, double side) const {
    const SurfaceId face = CornerBeside(plan_, planned, side);
    const WallEstimate* wall = face.valid() ? walls_[plan_.surfaces[face.index()].wall.index()] : nullptr;
    const std::optional<CornerJamb> corner = wall ? PlaceCorner(plan_, planned, built, side, face, *wall) : std::nullopt;
    return corner && std::abs(corner->x_m) <= kMaxCorner_m ? corner : std::nullopt;
  }

  const AGraph& plan_;
  const std::vector<const WallEstimate*>& walls_;
  const std::vector<WallFrame> frames_;
  const PlannedDoorways planned_;
};

std::vector<Site> Sites(const AGraph& plan, const JointResult& estimate, const std::vector<WallPresence>& presence,
                        const DoorwayOptions& options) {
  std::vector<const WallEstimate*> by_wall(plan.walls.size(), nullptr);
  for (const WallEstimate& w : estimate.walls) {
    const bool missing = w.wall.index() < presence.size() && presence[w.wall.index()].missing;
    if (!missing && std::sqrt(w.cov(0, 0)) <= options.max_wall_sigma_m) by_wall[w.wall.index()] = &w;
  }
  const SiteFinder finder(plan, by_wall);
  std::vector<Site> sites;
  for (size_t i = 0; i < plan.doorways.size(); ++i) {
    const WallId wall = plan.doorways[i].wall;
    const bool missing = wall.valid() && wall.index() < presence.size() && presence[wall.index()].missing;
    if (std::optional<Site> site = missing ? std::nullopt : finder.SiteOf(DoorwayId(i))) sites.push_back(std::move(*site));
  }
  return sites;
}

}  // namespace

const char* StatusName(DoorwayStatus status) {
  switch (status) {
    case DoorwayStatus::kAsPlanned: return "as_planned";
    case DoorwayStatus::kDeviated: return "deviated";
    case DoorwayStatus::kMissing: return "missing";
    case DoorwayStatus::kUnobserved: break;
  }
  return "unobserved";
}

std::string DoorwayOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"tolerance_m", tolerance_m},
                                                     {"typical_deviation_m", typical_deviation_m},
                                                     {"max_mdb_m", max_mdb_m},
                                                     {"max_wall_sigma_m", max_wall_sigma_m},
                                                     {"max_sight_m", max_sight_m}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0 && std::isfinite(value))) return fmt::format("DoorwayOptions.{} = {}; must be a positive number", name, value);
  }
  if (!(min_deviation_m >= 0)) return fmt::format("DoorwayOptions.min_deviation_m = {}; must be >= 0", min_deviation_m);
  if (!(prior > 0 && prior < 1)) return fmt::format("DoorwayOptions.prior = {}; must be in (0, 1)", prior);
  if (!(min_p_deviated >= 0 && min_p_deviated <= 1))
    return fmt::format("DoorwayOptions.min_p_deviated = {}; must be in [0, 1]", min_p_deviated);
  return jamb.Check();
}

std::vector<DoorwayDeviation> JudgeDoorways(const SGraph& map, const AGraph& plan, const JointResult& estimate,
                                            const std::vector<WallPresence>& presence, const DoorwayOptions& options) {
  std::vector<DoorwayDeviation> out(plan.doorways.size());
  for (size_t i = 0; i < out.size(); ++i) out[i].doorway = DoorwayId(i);
  if (map.planar || !estimate.covariances_exact) return out;
  std::vector<Site> sites = Sites(plan, estimate, presence, options);
  std::vector<Panel> zones;
  for (const Site& site : sites) zones.push_back(site.Zone());
  PanelGrid grid(zones, kReach_m);
  std::vector<uint32_t> near;
  const auto take = [&](const Sight& sight) {
    grid.Near(sight.from.head<2>(), sight.to.head<2>(), near);
    for (const uint32_t i : near) sites[i].Take(sight, options.max_sight_m);
  };
  ForEachSight(map, estimate.T_plan_map, take, kAllPoints);
  for (const Site& site : sites) out[site.at.doorway.index()] = Judge(site, plan, estimate, options);
  return out;
}

}  // namespace plumb::runtime
