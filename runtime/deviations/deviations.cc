#include "runtime/deviations/deviations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/room_deviation.h"
#include "runtime/deviations/wall_verdicts.h"

namespace plumb::runtime {
namespace {

SurfaceDeviation DeviationOfFace(const Face& face, const WallEstimate& wall, const DeviationOptions& options) {
  const double parameters[kNumWallParameters] = {wall.deviation.offset_m, wall.deviation.yaw_rad, wall.tilt_rad, wall.thickness_error_m};
  Plane built;
  BuiltPlane(face, parameters, &built.n, &built.d);
  const FaceDeviation d = CompareToPlan(face, built);
  // First order: how the displacement at the face's midpoint follows from the wall's parameters. Tilt acts at half height: not at all.
  const Eigen::Vector4d gain(face.wall_normal.dot(face.normal), face.normal.dot(Eigen::Vector3d::UnitZ().cross(face.point - face.pivot)), 0,
                             0.5);
  SurfaceDeviation out;
  out.translation_m = d.offset_m;
  out.rotation_rad = d.yaw_rad;
  out.tilt_rad = d.tilt_rad;
  out.sigma_translation_m = std::sqrt(std::max(0.0, gain.dot(wall.cov_all * gain)));
  out.sigma_rotation_rad = std::sqrt(std::max(0.0, wall.cov(1, 1)));
  out.p_deviated = wall.p_deviated;
  out.mdb_m = MinimalDetectable_m(TestVariance_m2(wall, gain.head<2>(), options));
  return out;
}

// Doorways that deviate from where a wall would have them that is not believed itself.
void LeaveOutDoubtful(const AGraph& plan, const std::vector<const WallEstimate*>& by_wall, const std::vector<WallVerdict>& verdicts,
                      const JointResult& estimate, std::vector<DoorwayDeviation>& doorways) {
  for (DoorwayDeviation& d : doorways) {
    const WallId wall = plan.doorways[d.doorway.index()].wall;
    if (d.status != DoorwayStatus::kDeviated || !wall.valid() || !by_wall[wall.index()]) continue;
    const auto at = static_cast<size_t>(by_wall[wall.index()] - estimate.walls.data());
    if (verdicts[at].status == SurfaceStatus::kUnobserved) d = {.doorway = d.doorway};
  }
}

// A wall that is not there has no deviation, only the evidence that it is not.
void MarkMissing(const AGraph& plan, const WallChanges& changes, DeviationReport& report) {
  for (size_t w = 0; w < changes.presence.size(); ++w) {
    if (!changes.presence[w].missing) continue;
    for (size_t i = 0; i < plan.surfaces.size(); ++i) {
      if (plan.surfaces[i].wall != WallId(w)) continue;
      report.surfaces[i] = {};
      report.surfaces[i].surface = SurfaceId(i);
      report.surfaces[i].status = SurfaceStatus::kMissing;
      report.surfaces[i].unjudged = Unjudged::kNone;
    }
    for (const FacePresence& face : changes.presence[w].faces) {
      report.surfaces[face.surface.index()].observed_m2 = face.open_m2 + face.closed_m2;
      report.surfaces[face.surface.index()].points = face.lines;
    }
  }
}

// " 3 of 20 seen walls deviate, 1 is missing.", by the surfaces' status.
std::string CountsText(const AGraph& plan, const DeviationReport& report) {
  std::vector<SurfaceStatus> gravest(plan.walls.size(), SurfaceStatus::kUnobserved);
  for (const SurfaceDeviation& d : report.surfaces) {
    const WallId wall = plan.surfaces[d.surface.index()].wall;
    if (wall.valid() && d.status != SurfaceStatus::kUnobserved) gravest[wall.index()] = d.status;
  }
  const auto count = [&](SurfaceStatus status) { return std::count(gravest.begin(), gravest.end(), status); };
  const auto deviated = count(SurfaceStatus::kDeviated), missing = count(SurfaceStatus::kMissing);
  std::string text =
      fmt::format(" {} of {} seen walls {}", deviated, deviated + count(SurfaceStatus::kAsPlanned), deviated == 1 ? "deviates" : "deviate");
  if (missing > 0) text += fmt::format(", {} {} missing", missing, missing == 1 ? "is" : "are");
  return text + ".";
}

// "Seen and not judged: 5 that may be 10 cm off by what was seen; 1 ...", of walls that were seen; the faces of a wall share its verdict.
std::string UnjudgedText(const AGraph& plan, const DeviationReport& report, const DeviationOptions& options) {
  const std::pair<Unjudged, std::string> reasons[] = {
      {Unjudged::kUncertain, fmt::format("that may be {:.0f} cm off by what was seen", 100 * options.max_undecided_m)},
      {Unjudged::kUndecided, "probably off, but not surely"},
      {Unjudged::kSeenTooLittle, fmt::format("seen on less than {:.1f} m2", options.min_observed_m2)},
      {Unjudged::kMayBeFurniture, "where what was seen may be furniture"},
      {Unjudged::kOtherShape, "where what was seen is another shape of the plan"},
      {Unjudged::kNoCovariance, "with nothing to tell how sure they are"}};
  std::vector<Unjudged> why(plan.walls.size(), Unjudged::kNone);
  for (const SurfaceDeviation& d : report.surfaces) {
    const WallId wall = plan.surfaces[d.surface.index()].wall;
    if (wall.valid() && d.unjudged != Unjudged::kNotAFace) why[wall.index()] = d.unjudged;
  }
  std::string text;
  for (const auto& [reason, says] : reasons) {
    const auto count = std::count(why.begin(), why.end(), reason);
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "Seen and not judged: " : "; ", count, says);
  }
  return text.empty() ? "" : text + ".";
}

}  // namespace

const char* StatusName(SurfaceStatus status) {
  switch (status) {
    case SurfaceStatus::kAsPlanned: return "as_planned";
    case SurfaceStatus::kDeviated: return "deviated";
    case SurfaceStatus::kMissing: return "missing";
    case SurfaceStatus::kUnobserved: break;
  }
  return "unobserved";
}

const char* UnjudgedName(Unjudged why) {
  switch (why) {
    case Unjudged::kNone: break;
    case Unjudged::kNotAFace: return "not_a_face";
    case Unjudged::kNotSeen: return "not_seen";
    case Unjudged::kSeenTooLittle: return "seen_too_little";
    case Unjudged::kUncertain: return "uncertain";
    case Unjudged::kUndecided: return "undecided";
    case Unjudged::kMayBeFurniture: return "may_be_furniture";
    case Unjudged::kOtherShape: return "other_shape";
    case Unjudged::kNoCovariance: return "no_covariance";
    case Unjudged::kPlanarLaser: return "planar_laser";
  }
  return "";
}

std::string DeviationOptions::Check() const {
  if (!(false_discovery_rate > 0 && false_discovery_rate < 1)) {
    return fmt::format("DeviationOptions.false_discovery_rate = {}; must be in (0, 1)", false_discovery_rate);
  }
  const std::pair<const char*, double> probabilities[] = {{"min_p_deviated", min_p_deviated}, {"max_p_as_planned", max_p_as_planned}};
  for (const auto& [name, value] : probabilities) {
    if (!(value >= 0 && value <= 1)) return fmt::format("DeviationOptions.{} = {}; must be in [0, 1]", name, value);
  }
  const std::pair<const char*, double> magnitudes[] = {{"tolerance_offset_m", tolerance_offset_m},
                                                       {"tolerance_yaw_rad", tolerance_yaw_rad},
                                                       {"min_offset_m", min_offset_m},
                                                       {"min_yaw_rad", min_yaw_rad},
                                                       {"min_observed_m2", min_observed_m2},
                                                       {"max_mdb_m", max_mdb_m},
                                                       {"max_undecided_m", max_undecided_m},
                                                       {"turned_rad", turned_rad},
                                                       {"min_turned_m2", min_turned_m2},
                                                       {"min_turned_m", min_turned_m}};
  for (const auto& [name, value] : magnitudes) {
    if (!(value >= 0)) return fmt::format("DeviationOptions.{} = {}; must be >= 0", name, value);
  }
  if (std::string fault = presence.Check(); !fault.empty()) return fault;
  if (std::string fault = doorways.Check(); !fault.empty()) return fault;
  return unplanned.Check();
}

DeviationReport AssessDeviations(const AGraph& plan, const JointResult& estimate, const DeviationOptions& options,
                                 const WallChanges& changes) {
  DeviationReport report;
  report.gauge = estimate.gauge;
  report.surfaces.resize(plan.surfaces.size());
  for (size_t i = 0; i < plan.surfaces.size(); ++i) report.surfaces[i].surface = SurfaceId(i);

  const std::vector<WallFrame> frames = WallFrames(plan);
  const std::vector<WallVerdict> verdicts = JudgeWalls(plan, frames, estimate, options);
  std::vector<const WallEstimate*> by_wall(plan.walls.size(), nullptr);
  for (const WallEstimate& w : estimate.walls) by_wall[w.wall.index()] = &w;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& surface = plan.surfaces[i];
    if (!surface.wall.valid() || !IsFace(frames[surface.wall.index()], surface)) {
      report.surfaces[i].unjudged = Unjudged::kNotAFace;
      continue;
    }
    if (!by_wall[surface.wall.index()]) continue;
    const WallEstimate& wall = *by_wall[surface.wall.index()];
    SurfaceDeviation d = DeviationOfFace(MakeFace(frames[surface.wall.index()], surface), wall, options);
    d.surface = SurfaceId(i);
    const WallVerdict& verdict = verdicts[static_cast<size_t>(&wall - estimate.walls.data())];
    d.status = verdict.status;
    d.unjudged = verdict.unjudged;
    const size_t w = surface.wall.index();
    if (d.status == SurfaceStatus::kDeviated && w < changes.on_other_shape.size() && changes.on_other_shape[w]) {
      d.status = SurfaceStatus::kUnobserved;
      d.unjudged = Unjudged::kOtherShape;
    }
    for (const SeenSurface& seen : wall.seen) {
      if (seen.surface != d.surface) continue;
      d.observed_m2 = seen.observed_m2;
      d.points = seen.num_points;
    }
    report.surfaces[i] = d;
  }
  MarkMissing(plan, changes, report);
  report.unplanned = changes.unplanned;
  report.doorways = changes.doorways;
  LeaveOutDoubtful(plan, by_wall, verdicts, estimate, report.doorways);
  for (size_t i = report.doorways.size(); i < plan.doorways.size(); ++i) report.doorways.push_back({.doorway = DoorwayId(i)});
  report.unjudged = UnjudgedText(plan, report, options);
  if (!report.gauge.empty()) report.gauge += CountsText(plan, report) + (report.unjudged.empty() ? "" : " " + report.unjudged);
  for (size_t r = 0; r < plan.rooms.size(); ++r) report.rooms.push_back(DeviationOfRoom(plan, RoomId(r), report.surfaces, options));
  return report;
}

}  // namespace plumb::runtime
