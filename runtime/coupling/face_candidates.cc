#include "runtime/coupling/face_candidates.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/coupling/mixture.h"

namespace plumb::runtime {
namespace {

constexpr double kMaxOpenRatio = 0.5;  // of a patch's cells: with more of them in openings it is leaves, panes and frames
constexpr double kRecess_m = 0.02;     // leaves, panes and frames lie at least this far behind the wall's face
constexpr double kOffPlan_m = 0.06;    // a wall further off its plan must stop the lines of sight, ...
constexpr double kOffPlan_rad = 0.087;
constexpr double kMinExplained = 0.4;  // ... and is what most of the patch is of: what goes far beyond a wall is another
constexpr double kMinExplainedHeight = 0.25;
constexpr double kLeastExplained = 0.01;

// How much of the patch's height the face has. Walls of two storeys often lie in one plane, and a stair hall shows both.
double HeightRatio(const Patch& patch, const Surface& face) {
  const double height_m = std::min(patch.z_max, face.z_max_m) - std::max(patch.z_min, face.z_min_m);
  return std::max(0.0, height_m) / std::max(patch.z_max - patch.z_min, 1e-3);
}

// Is what the patch is of the face for the most part, and no skirting or ledge on it?
bool IsMostOf(const PlannedFace& face, const std::vector<PlannedFace>& faces, const Patch& patch) {
  // Rooms divide one side of a wall into several faces, and a patch may run along all of them.
  double explained = 0;
  for (const PlannedFace& f : faces) explained += f.side == face.side ? ExplainedRatio(patch, *f.surface) : 0;
  return explained >= kMinExplained && HeightRatio(patch, *face.surface) >= kMinExplainedHeight;
}

std::optional<FaceCandidate> Compare(const Patch& patch, const PlannedFace& face, const std::vector<PlannedFace>& faces,
                                     const WallDeviation& known, const SightLines& sight, double max_offset_m,
                                     const CouplingOptions& options) {
  const Surface& surface = *face.surface;
  const WallFrame& frame = *face.frame;
  const std::vector<WallOpening>& openings = *face.openings;
  const Eigen::Vector3d& n = surface.normal;
  const double yaw = std::atan2(n.x() * patch.normal.y() - n.y() * patch.normal.x(), n.head<2>().dot(patch.normal.head<2>()));
  if (std::abs(yaw - known.yaw_rad) > options.max_yaw_rad) return std::nullopt;
  if (OverlapRatio(patch.z_min, patch.z_max, surface.z_min_m, surface.z_max_m) < options.min_height_overlap_ratio) return std::nullopt;

  const Eigen::Vector2d along = (surface.end - surface.start).normalized();
  const double a0 = along.dot(patch.start - surface.start), a1 = along.dot(patch.end - surface.start);
  const double from = std::max(0.0, std::min(a0, a1)), to = std::min(surface.length_m(), std::max(a0, a1));
  if (to - from < kMinOverlap_m || OverlapRatio(std::min(a0, a1), std::max(a0, a1), 0, surface.length_m()) < options.min_overlap_ratio) {
    return std::nullopt;
  }
  const double middle = 0.5 * (from + to);
  const Eigen::Vector2d on_patch = patch.start + (middle - a0) / (a1 - a0) * (patch.end - patch.start);
  const Eigen::Vector2d on_plan = surface.start + middle * along;

  FaceCandidate c;
  c.surface = face.id;
  c.side = face.side;
  c.glass = face.glass;
  c.offset_m = n.head<2>().dot(on_patch - on_plan);
  c.yaw_rad = yaw;
  const Eigen::Vector2d arm = on_plan - frame.pivot.head<2>();
  const double expected = known.offset_m * frame.normal.dot(n) + known.yaw_rad * n.head<2>().dot(Eigen::Vector2d(-arm.y(), arm.x()));
  const Eigen::Vector2d residual(c.offset_m - expected, yaw - known.yaw_rad);
  if (std::abs(residual.x()) > max_offset_m) return std::nullopt;
  if (OpenRatio(patch, openings, along, std::min(c.offset_m, residual.x()) < -kRecess_m) > kMaxOpenRatio) return std::nullopt;
  const bool off_plan = std::abs(c.offset_m) > kOffPlan_m;
  if ((off_plan || std::abs(yaw) > kOffPlan_rad) && !IsMostOf(face, faces, patch)) return std::nullopt;
  if (off_plan && !face.glass && IsSeenThrough(patch, surface, openings, sight)) return std::nullopt;
  const double yaw_sigma = kMapSigma_m / std::max(patch.length(), 0.3);
  const Eigen::Matrix2d covariance = Eigen::Vector2d(kMapSigma_m * kMapSigma_m, yaw_sigma * yaw_sigma).asDiagonal();
  const double explained = ExplainedRatio(patch, surface) * HeightRatio(patch, surface);
  c.cost_nats = AssessMixture(residual, covariance, options).cost_nats - std::log(std::max(explained, kLeastExplained));
  return c;
}

// With panes that are no windows or doors in them.
std::vector<bool> GlassWalls(const AGraph& plan) {
  std::vector<bool> glass(plan.walls.size(), false);
  for (const Element& e : plan.elements) {
    const bool in_opening = e.kind == ElementKind::kDoor || e.kind == ElementKind::kWindow || e.doorway.valid();
    if (e.wall.valid() && e.material == Material::kGlass && !in_opening) glass[e.wall.index()] = true;
  }
  return glass;
}

}  // namespace

std::vector<PlannedFace> PlannedFaces(const AGraph& plan, const std::vector<WallFrame>& frames,
                                      const std::vector<std::vector<WallOpening>>& openings) {
  const std::vector<bool> glass = GlassWalls(plan);
  std::vector<PlannedFace> faces;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& surface = plan.surfaces[i];
    if (!surface.wall.valid() || !IsFace(frames[surface.wall.index()], surface)) continue;
    const WallFrame& frame = frames[surface.wall.index()];
    faces.push_back({SurfaceId(i), &surface, &frame, &openings[surface.wall.index()], SideOf(frame, surface), glass[surface.wall.index()]});
  }
  return faces;
}

std::vector<FaceCandidate> CandidatesOf(const Patch& patch, const std::vector<PlannedFace>& faces, const SightLines& sight,
                                        const std::vector<WallDeviation>& known, double max_offset_m, const CouplingOptions& options) {
  std::vector<FaceCandidate> out;
  for (const PlannedFace& face : faces) {
    const size_t wall = face.surface->wall.index();
    const WallDeviation deviation = wall < known.size() ? known[wall] : WallDeviation{};
    if (auto candidate = Compare(patch, face, faces, deviation, sight, max_offset_m, options)) out.push_back(*candidate);
  }
  return out;
}

}  // namespace plumb::runtime
