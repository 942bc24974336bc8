#include "runtime/deviations/corner_jamb.h"

#include <algorithm>
#include <cmath>

#include "runtime/coupling/wall_frame.h"

namespace plumb::runtime {
namespace {

constexpr double kMinSquare = 0.94;  // cos 20 deg, between the face's normal and the wall that the doorway is in
constexpr double kAtJamb_m = 0.05;
constexpr double kBeside_m = 0.1;  // the face may begin so far from the wall's own

WallFrame FrameOf(const AGraph& plan, SurfaceId reference) {
  const Surface& s = plan.surfaces[reference.index()];
  return {reference, {s.midpoint().x(), s.midpoint().y(), 0.5 * (s.z_min_m + s.z_max_m)}, s.normal};
}

}  // namespace

SurfaceId CornerBeside(const AGraph& plan, const BuiltDoorway& planned, double side) {
  const double u_m = side < 0 ? planned.right.u_m : planned.left.u_m, w_min_m = planned.w_a_m - kBeside_m,
               w_max_m = planned.w_b_m + kBeside_m;
  SurfaceId best;
  double best_m = kAtJamb_m;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& s = plan.surfaces[i];
    if (s.wall == planned.wall || !s.wall.valid() || s.arc || -side * s.normal.head<2>().dot(planned.along) < kMinSquare) continue;
    if (s.z_min_m > planned.z_min_m || s.z_max_m < planned.z_max_m) continue;
    const double w0 = planned.W(s.start), w1 = planned.W(s.end);
    if (std::max(w0, w1) < w_min_m || std::min(w0, w1) > w_max_m) continue;
    const double off_m = std::abs(planned.U(s.start) + (planned.U(s.end) - planned.U(s.start)) * (-w0 / (w1 - w0)) - u_m);
    if (off_m > best_m || (best.valid() && off_m == best_m)) continue;
    best_m = off_m;
    best = SurfaceId(i);
  }
  return best;
}

std::optional<CornerJamb> PlaceCorner(const AGraph& plan, const BuiltDoorway& planned, const BuiltDoorway& built, double side,
                                      SurfaceId face, const WallEstimate& wall) {
  const Surface& s = plan.surfaces[face.index()];
  const WallFrame frame = FrameOf(plan, wall.reference);
  if (!IsFace(frame, s)) return std::nullopt;
  const double parameters[kNumWallParameters] = {wall.deviation.offset_m, wall.deviation.yaw_rad, 0, wall.thickness_error_m};
  Plane plane;
  BuiltPlane(MakeFace(frame, s), parameters, &plane.n, &plane.d);
  const double slope = plane.n.head<2>().dot(built.along);
  if (-side * slope < kMinSquare) return std::nullopt;
  const Eigen::Vector2d n = s.normal.head<2>();
  const double planned_m = n.dot(s.start - planned.origin) / n.dot(planned.along);
  const double built_m = -plane.SignedDistance({built.origin.x(), built.origin.y(), 0.5 * (s.z_min_m + s.z_max_m)}) / slope;
  const double arm_m = (built.origin - frame.pivot.head<2>()).dot(Eigen::Vector2d(-frame.normal.y(), frame.normal.x()));
  const double variance_m2 = wall.cov(0, 0) + 2 * std::abs(arm_m * wall.cov(0, 1)) + arm_m * arm_m * wall.cov(1, 1);
  return CornerJamb{-side * (built_m - planned_m), std::sqrt(variance_m2)};
}

}  // namespace plumb::runtime
