#include "runtime/coupling/coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "runtime/coupling/face_assignment.h"
#include "runtime/coupling/face_candidates.h"
#include "runtime/coupling/furniture_fronts.h"
#include "runtime/coupling/level_matching.h"
#include "runtime/coupling/sight_lines.h"
#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_openings.h"
#include "runtime/coupling/wall_patch.h"
#include "runtime/coupling/wall_search.h"

namespace plumb::runtime {
namespace {

constexpr double kLeastBeside = 0.1;       // keeps what it divides finite
constexpr double kInOpeningRatio = 0.6;    // of an observation's extent either way: it is of what fills the opening
constexpr double kHalfExtentSigmas = 1.7;  // half the extent of evenly spread points
// Of walls that one patch runs along.
constexpr double kSameNormal_cos = 0.999, kMinShared_m2 = 0.5, kMaxFlush_m = 0.2, kMinSharedRatio = 0.5;

// What one view saw of a face, in the face's coordinates: along it from its start, and up.
struct ViewExtent {
  Eigen::Vector2d middle, reach;  // to both sides
};

std::vector<ViewExtent> ExtentsOnFace(const SGraph& map, const MapSurface& seen, const Surface& surface,
                                      const Eigen::Isometry3d& T_plan_map) {
  Eigen::Matrix<double, 4, 2> axes = Eigen::Matrix<double, 4, 2>::Zero();  // along and up, of homogeneous points
  axes.col(0).head<2>() = (surface.end - surface.start).normalized();
  axes(2, 1) = 1;
  // Sums of squares of a georeferenced plan's coordinates would leave nothing of the variance.
  const Eigen::Translation3d T_face_plan(-surface.start.x(), -surface.start.y(), 0);
  std::vector<ViewExtent> out;
  for (const Observation& o : seen.observations) {
    const PlaneStats stats = o.stats.Transformed(T_face_plan * T_plan_map * map.keyframes[o.keyframe].T_map_kf);
    const Eigen::Vector2d middle = axes.transpose() * stats.C.col(3) / stats.count();
    const Eigen::Vector2d variance = (axes.transpose() * stats.C * axes).diagonal() / stats.count() - middle.cwiseAbs2();
    out.push_back({middle, kHalfExtentSigmas * variance.cwiseMax(0.0).cwiseSqrt()});
  }
  return out;
}

// Does the view lie in one of the wall's openings for the most part?
bool IsInOpening(const ViewExtent& view, const Surface& surface, const std::vector<WallOpening>& openings) {
  const Eigen::Vector2d along = (surface.end - surface.start).normalized(), margin = Eigen::Vector2d::Constant(kOpeningMargin_m);
  return std::any_of(openings.begin(), openings.end(), [&](const WallOpening& w) {
    const double u = along.dot(w.middle - surface.start);
    const Eigen::Vector2d lo(u - 0.5 * w.width_m, w.z_min_m), hi(u + 0.5 * w.width_m, w.z_max_m);
    const Eigen::Vector2d covered = (view.middle + view.reach).cwiseMin(hi + margin) - (view.middle - view.reach).cwiseMax(lo - margin);
    return (covered.array() >= kInOpeningRatio * 2 * view.reach.array()).all();
  });
}

// Length of the face that the view saw.
double Seen_m(const ViewExtent& view, const Surface& surface) {
  return std::min(surface.length_m(), view.middle.x() + view.reach.x()) - std::max(0.0, view.middle.x() - view.reach.x());
}

AssignedFaces Assigned(const AGraph& plan, const std::vector<PlannedFace>& faces, const std::vector<Patch>& patches,
                       const std::vector<std::vector<WallOpening>>& openings, const SightLines& sight,
                       const std::vector<WallDeviation>& known, double max_offset_m, const CouplingOptions& options) {
  AssignedFaces candidates;
  for (const Patch& patch : patches) candidates.push_back(CandidatesOf(patch, faces, sight, known, max_offset_m, options));
  const auto is_seen_through = [&](const Patch& patch, SurfaceId id) {
    const Surface& surface = plan.surfaces[id.index()];
    return IsSeenThrough(patch, surface, openings[surface.wall.index()], sight);
  };
  return AssignFaces(patches, std::move(candidates), is_seen_through, options);
}

std::vector<FarWall> FarWalls(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Patch>& patches,
                              const AssignedFaces& assigned, const std::vector<std::vector<WallOpening>>& openings, const SightLines& sight,
                              const CouplingOptions& options) {
  std::vector<Patch> unmatched;
  std::vector<bool> matched(plan.walls.size(), false);
  for (size_t i = 0; i < patches.size(); ++i) {
    if (assigned[i].empty()) {
      unmatched.push_back(patches[i]);
    } else {
      matched[plan.surfaces[assigned[i].front().surface.index()].wall.index()] = true;
    }
  }
  return FindFarWalls(plan, frames, unmatched, matched, openings, sight, options);
}

// The chosen face, and those of other walls that the patch goes on along and that nothing else was matched to. `sides` gets theirs.
std::vector<FaceCandidate> FacesAlong(const AGraph& plan, const Patch& patch, const std::vector<FaceCandidate>& candidates,
                                      std::set<int>& sides) {
  std::vector<FaceCandidate> faces{candidates.front()};
  const auto beside = [&](const Surface& a, const Surface& b) {
    const Eigen::Vector2d along = (a.end - a.start).normalized();
    const double from = along.dot(b.start - a.start), to = along.dot(b.end - a.start);
    return a.normal.dot(b.normal) > kSameNormal_cos &&
           std::min(a.length_m(), std::max(from, to)) - std::max(0.0, std::min(from, to)) < kMinOverlap_m;
  };
  for (const FaceCandidate& c : candidates) {
    const Surface& surface = plan.surfaces[c.surface.index()];
    // What stands further in front of a wall, flush with the next, is as likely to be furniture in a recess.
    if (sides.contains(c.side) || c.offset_m > kMaxFlush_m || ExplainedRatio(patch, surface) * patch.area < kMinShared_m2) continue;
    const double a = (surface.end - surface.start).dot(patch.start - surface.start) / surface.length_m();
    const double b = (surface.end - surface.start).dot(patch.end - surface.start) / surface.length_m();
    if (std::min(surface.length_m(), std::max(a, b)) - std::max(0.0, std::min(a, b)) < kMinSharedRatio * surface.length_m()) continue;
    if (!std::all_of(faces.begin(), faces.end(), [&](const FaceCandidate& f) { return beside(plan.surfaces[f.surface.index()], surface); }))
      continue;
    faces.push_back(c);
    sides.insert(c.side);
  }
  return faces;
}

// Match::beside_ratio of the patch on the surface.
double BesideRatio(const std::vector<PlannedFace>& faces, const Patch& patch, const Surface& surface) {
  const Eigen::Vector2d along = (surface.end - surface.start).normalized(), n = surface.normal.head<2>();
  const auto [from, to] = std::minmax({along.dot(patch.start), along.dot(patch.end)});
  std::vector<std::pair<double, double>> beside;
  for (const PlannedFace& f : faces) {
    const Surface& s = *f.surface;
    if (s.normal.dot(surface.normal) < kSameNormal_cos || std::abs(n.dot(s.start - surface.start)) > kMapSigma_m ||
        s.z_max_m < patch.z_min || s.z_min_m > patch.z_max)
      continue;
    const auto [low, high] = std::minmax({along.dot(s.start), along.dot(s.end)});
    if (std::min(high, to) > std::max(low, from)) beside.emplace_back(std::max(low, from), std::min(high, to));
  }
  std::sort(beside.begin(), beside.end());
  double sum_m = 0, reached = from;
  for (const auto& [low, high] : beside) {
    sum_m += std::max(0.0, high - std::max(low, reached));
    reached = std::max(reached, high);
  }
  return std::max(kLeastBeside, sum_m / (to - from));
}

// One match per face; each view counts for the face of which it saw most.
void AddMatches(const SGraph& map, const AGraph& plan, const Patch& patch, const std::vector<FaceCandidate>& faces,
                const std::vector<PlannedFace>& planned, const std::vector<std::vector<WallOpening>>& openings,
                const Eigen::Isometry3d& T_plan_map, std::vector<Match>& matches) {
  const MapSurface& seen = map.surfaces[patch.map_surface];
  std::vector<std::vector<ViewExtent>> views;
  for (const FaceCandidate& c : faces) views.push_back(ExtentsOnFace(map, seen, plan.surfaces[c.surface.index()], T_plan_map));
  const auto face_of = [&](size_t view) {
    size_t best = 0;
    for (size_t k = 1; k < faces.size(); ++k) {
      if (Seen_m(views[k][view], plan.surfaces[faces[k].surface.index()]) >
          Seen_m(views[best][view], plan.surfaces[faces[best].surface.index()]))
        best = k;
    }
    return best;
  };
  for (size_t k = 0; k < faces.size(); ++k) {
    const Surface& surface = plan.surfaces[faces[k].surface.index()];
    std::vector<uint32_t> mistaken;
    for (uint32_t i = 0; i < seen.observations.size(); ++i) {
      if (face_of(i) != k || IsInOpening(views[k][i], surface, openings[surface.wall.index()])) mistaken.push_back(i);
    }
    if (mistaken.size() == seen.observations.size()) continue;
    const double beside = map.planar ? 1.0 : BesideRatio(planned, patch, surface);
    matches.push_back({patch.map_surface, faces[k].surface, RoomId(), faces[k].offset_m, faces[k].yaw_rad, std::move(mistaken), beside});
  }
}

}  // namespace

std::string CouplingOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"max_offset_m", max_offset_m},
                                                     {"planar_max_offset_m", planar_max_offset_m},
                                                     {"max_yaw_rad", max_yaw_rad},
                                                     {"far_offset_m", far_offset_m},
                                                     {"far_yaw_rad", far_yaw_rad},
                                                     {"max_level_offset_m", max_level_offset_m},
                                                     {"max_unknown_height_m", max_unknown_height_m},
                                                     {"max_step_m", max_step_m},
                                                     {"offset_tau0_m", offset_tau0_m},
                                                     {"offset_tau1_m", offset_tau1_m},
                                                     {"yaw_tau0_rad", yaw_tau0_rad},
                                                     {"yaw_tau1_rad", yaw_tau1_rad}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0)) return fmt::format("CouplingOptions.{} = {}; must be > 0", name, value);
  }
  const std::pair<const char*, double> ratios[] = {{"min_overlap_ratio", min_overlap_ratio},
                                                   {"min_height_overlap_ratio", min_height_overlap_ratio}};
  for (const auto& [name, value] : ratios) {
    if (!(value >= 0 && value <= 1)) return fmt::format("CouplingOptions.{} = {}; must be in [0, 1]", name, value);
  }
  if (!(deviated_ratio > 0 && deviated_ratio < 1))
    return fmt::format("CouplingOptions.deviated_ratio = {}; must be in (0, 1)", deviated_ratio);
  if (!(offset_tau1_m > offset_tau0_m)) return fmt::format("CouplingOptions.offset_tau1_m = {}; must be > offset_tau0_m", offset_tau1_m);
  if (!(yaw_tau1_rad > yaw_tau0_rad)) return fmt::format("CouplingOptions.yaw_tau1_rad = {}; must be > yaw_tau0_rad", yaw_tau1_rad);
  return {};
}

std::vector<Match> MatchSurfaces(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                 const std::vector<WallDeviation>& known, const CouplingOptions& options) {
  const std::vector<WallFrame> frames = WallFrames(plan);
  const std::vector<Patch> patches = WallPatches(map, T_plan_map);
  const std::vector<std::vector<WallOpening>> openings = OpeningsOfWalls(plan);
  const SightLines sight(map, T_plan_map);
  const std::vector<PlannedFace> faces = PlannedFaces(plan, frames, openings);
  const double max_offset_m = map.planar ? options.planar_max_offset_m : options.max_offset_m;
  AssignedFaces assigned = Assigned(plan, faces, patches, openings, sight, known, max_offset_m, options);
  if (map.planar) {
    DropPlanarFronts(patches, assigned);
  } else if (const std::vector<FarWall> far = FarWalls(plan, frames, patches, assigned, openings, sight, options); !far.empty()) {
    std::vector<WallDeviation> supposed = known;
    supposed.resize(plan.walls.size());
    for (const FarWall& w : far) supposed[w.wall.index()] = w.deviation;
    assigned = Assigned(plan, faces, patches, openings, sight, supposed, max_offset_m, options);
  }

  std::vector<Match> matches = MatchLevels(map, plan, T_plan_map, options);
  std::set<int> sides;
  for (const auto& list : assigned) {
    if (!list.empty()) sides.insert(list.front().side);
  }
  for (size_t i = 0; i < patches.size(); ++i) {
    if (assigned[i].empty()) continue;
    const std::vector<FaceCandidate> along =
        map.planar ? std::vector{assigned[i].front()} : FacesAlong(plan, patches[i], assigned[i], sides);
    AddMatches(map, plan, patches[i], along, faces, openings, T_plan_map, matches);
  }
  if (!map.planar) DropLowFronts(plan, frames, patches, matches);
  std::sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    return std::pair(a.map_surface, a.plan_surface.value) < std::pair(b.map_surface, b.plan_surface.value);
  });
  return matches;
}

}  // namespace plumb::runtime
