#include "runtime/optimization/seen_walls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kMinHeightOverlap = 0.5;  // of the lower of a patch and a face
constexpr double kSameSide = 0.9;          // cosine between normals of faces of one side of a wall
constexpr double kMostLonger_m = 0.6;      // than planned at either end, however far off the wall is
constexpr double kStep_m = 0.1;

// Of the points of a match's patch, those that say something of its wall.
double ShareThatCounts(const SGraph& map, const Match& m) {
  const std::vector<Observation>& observations = map.surfaces[m.map_surface].observations;
  double counts = 0, all = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    all += observations[i].stats.count();
    if (!m.IsMistaken(i)) counts += observations[i].stats.count();
  }
  return all > 0 ? counts / all : 0;
}

// By how much the wall may be longer at an end: as much as it is off there.
double Longer_m(const WallEstimate& wall, const WallFrame& frame, const Eigen::Vector2d& at) {
  const Eigen::Vector2d arm = at - frame.pivot.head<2>();
  const double off_m = wall.deviation.offset_m + wall.deviation.yaw_rad * frame.normal.head<2>().dot(Eigen::Vector2d(-arm.y(), arm.x()));
  return std::min(std::abs(off_m), kMostLonger_m);
}

// A face of one side of a wall: from where to where it is planned along the wall, and may have been built: a wall that is off meets the
// next one as much earlier or later.
struct FaceRange {
  SurfaceId face;
  double from, to, may_from, may_to;
  double share = 0;
};

// At the height of the patch, whatever the storey: storeys may be half a floor apart.
std::vector<FaceRange> FacesOfSide(const AGraph& plan, const Match& m, const MapSurface& patch, double z_shift_m, const WallEstimate& wall,
                                   const WallFrame& frame) {
  const Surface& matched = plan.surfaces[m.plan_surface.index()];
  const Eigen::Vector2d along = (matched.end - matched.start).normalized();
  const double z_min_m = patch.z_min_m + z_shift_m, z_max_m = patch.z_max_m + z_shift_m;
  std::vector<FaceRange> out;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& face = plan.surfaces[i];
    if (face.wall != matched.wall || face.arc || face.normal.dot(matched.normal) < kSameSide) continue;
    const double common_m = std::min(face.z_max_m, z_max_m) - std::max(face.z_min_m, z_min_m);
    const double shorter_m = std::min(face.z_max_m - face.z_min_m, z_max_m - z_min_m);
    if (&face != &matched && common_m < kMinHeightOverlap * shorter_m) continue;
    const bool forth = along.dot(face.end - face.start) > 0;
    const Eigen::Vector2d &low = forth ? face.start : face.end, &high = forth ? face.end : face.start;
    const double from = along.dot(low), to = along.dot(high);
    out.push_back({SurfaceId(i), from, to, from - Longer_m(wall, frame, low), to + Longer_m(wall, frame, high)});
  }
  return out;
}

// Where along the wall the patch was seen, evenly.
std::vector<double> SeenAt(const MapSurface& patch, const Eigen::Vector2d& along, const Eigen::Isometry3d& T_plan_map) {
  const auto u = [&](const Eigen::Vector2d& at) { return along.dot((T_plan_map * Eigen::Vector3d(at.x(), at.y(), 0)).head<2>()); };
  const double start = u(patch.start), end = u(patch.end), length_m = patch.length_m();
  std::vector<double> out;
  for (const Eigen::Vector2f& cell : patch.cells) out.push_back(start + cell.x() / length_m * (end - start));
  constexpr int kParts = 100;
  for (int i = 0; i < kParts && patch.cells.empty(); ++i) out.push_back(start + (i + 0.5) / kParts * (end - start));
  return out;
}

// Rooms divide one side of a wall into several faces: how much of a match's patch lies on each. What goes on beyond the wall is no part of
// it, so the shares add up to one at most.
std::vector<FaceRange> SharesOfFaces(const SGraph& map, const AGraph& plan, const Match& m, const WallEstimate& wall,
                                     const WallFrame& frame, const Eigen::Isometry3d& T_plan_map) {
  const Surface& matched = plan.surfaces[m.plan_surface.index()];
  const Eigen::Vector2d along = (matched.end - matched.start).normalized();
  const MapSurface& patch = map.surfaces[m.map_surface];
  std::vector<FaceRange> faces = FacesOfSide(plan, m, patch, T_plan_map.translation().z(), wall, frame);
  const std::vector<double> seen_at = SeenAt(patch, along, T_plan_map);
  double of_wall = 0, on_faces = 0;
  for (const double at : seen_at) {
    of_wall += std::any_of(faces.begin(), faces.end(), [&](const FaceRange& f) { return at >= f.may_from && at <= f.may_to; }) ? 1 : 0;
    for (FaceRange& f : faces) {
      if (at < f.from || at > f.to) continue;
      ++f.share;
      ++on_faces;
    }
  }
  for (FaceRange& f : faces) f.share *= on_faces > 0 ? of_wall / (on_faces * static_cast<double>(seen_at.size())) : 0;
  std::erase_if(faces, [](const FaceRange& f) { return f.share <= 0; });
  return faces;
}

// Where along itself a wall was seen: between the ends of its patches, and which steps of it.
struct Span {
  double from = 1e300, to = -1e300;
  std::set<int> steps;
};

// Where along its wall the match's patch lies, within the wall's faces: it may go on along the next wall.
void AddSpan(const SGraph& map, const AGraph& plan, const Match& m, const WallEstimate& wall, const WallFrame& frame,
             const Eigen::Isometry3d& T_plan_map, Span& span) {
  const MapSurface& patch = map.surfaces[m.map_surface];
  const Eigen::Vector2d direction(-frame.normal.y(), frame.normal.x());
  const auto along = [&](const Eigen::Vector2d& at) { return (at - frame.pivot.head<2>()).dot(direction); };
  double face_from = 1e300, face_to = -1e300;
  for (const FaceRange& f : FacesOfSide(plan, m, patch, T_plan_map.translation().z(), wall, frame)) {
    const Surface& face = plan.surfaces[f.face.index()];
    face_from = std::min({face_from, along(face.start), along(face.end)});
    face_to = std::max({face_to, along(face.start), along(face.end)});
  }
  if (face_from > face_to) return;
  for (const Eigen::Vector2d& end : {patch.start, patch.end}) {
    const double u = std::clamp(along((T_plan_map * Eigen::Vector3d(end.x(), end.y(), 0)).head<2>()), face_from, face_to);
    span.from = std::min(span.from, u);
    span.to = std::max(span.to, u);
  }
  for (const double at : SeenAt(patch, direction, T_plan_map)) {
    const double u = at - direction.dot(frame.pivot.head<2>());
    if (u > face_from && u < face_to) span.steps.insert(static_cast<int>(std::floor(u / kStep_m)));
  }
}

// `walls` by id; it is one of them.
WallEstimate& EstimateOf(WallId wall, std::vector<WallEstimate>& walls) {
  return *std::lower_bound(walls.begin(), walls.end(), wall, [](const WallEstimate& a, WallId b) { return a.wall < b; });
}

}  // namespace

void CountSeen(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
               const Eigen::Isometry3d& T_plan_map, std::vector<WallEstimate>& walls) {
  std::map<SurfaceId, SeenSurface> seen;
  std::map<WallId, Span> spans;
  for (const Match& m : matches) {
    if (!m.plan_surface.valid()) continue;
    const double counts = m.mistaken.empty() ? 1.0 : ShareThatCounts(map, m);
    const WallEstimate& wall = EstimateOf(plan.surfaces[m.plan_surface.index()].wall, walls);
    for (const FaceRange& f : SharesOfFaces(map, plan, m, wall, frames[wall.wall.index()], T_plan_map)) {
      SeenSurface& s = seen[f.face];
      s.surface = f.face;
      s.num_points += counts * f.share * map.surfaces[m.map_surface].num_points;
      s.observed_m2 += counts * f.share * map.surfaces[m.map_surface].area_m2;
    }
    AddSpan(map, plan, m, wall, frames[wall.wall.index()], T_plan_map, spans[wall.wall]);
  }
  for (const auto& [id, s] : seen) {
    const WallId wall = plan.surfaces[id.index()].wall;
    WallEstimate& e = EstimateOf(wall, walls);
    e.seen.push_back(s);
    e.num_points += s.num_points;
    e.observed_m2 += s.observed_m2;
    const Span& span = spans[wall];
    e.span_m = span.to - span.from;
    e.seen_m = kStep_m * static_cast<double>(span.steps.size());
  }
}

}  // namespace plumb::runtime
