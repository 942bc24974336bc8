#include "runtime/coupling/sight_lines.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr size_t kPerKeyframe = 400;
constexpr double kMinFront_m = 0.1;   // a keyframe closer to the plane may be on either side of it
constexpr double kOn_m = 0.06;        // two sigmas of a point
constexpr double kBeyond_m = 0.15;
// Lines start at the keyframe, while points were seen up to half a metre further on: near edges and openings they may miss or pass.
// Those of a planar laser are level: they miss the ends of a face, not its top.
constexpr double kEdge_m = 0.3;

}  // namespace

SightLines::SightLines(const SGraph& map, const Eigen::Isometry3d& T_plan_map)
    : origin_(T_plan_map.translation()), vertical_edge_m_(map.planar ? 0 : kEdge_m) {
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.merged) continue;
    const Eigen::Isometry3f T = (Eigen::Translation3d(-origin_) * T_plan_map * keyframe.T_map_kf).cast<float>();
    const size_t step = std::max<size_t>(1, keyframe.points.size() / kPerKeyframe);
    for (size_t i = 0; i < keyframe.points.size(); i += step) lines_.push_back({T.translation(), T * keyframe.points[i]});
  }
}

SightLines::Count SightLines::Meeting(const SupposedFace& face) const {
  const Surface& planned = *face.planned;
  const Eigen::Vector2f n = face.normal.cast<float>(), p = (face.point - origin_.head<2>()).cast<float>();
  const Eigen::Vector2d along = (planned.end - planned.start).normalized();
  const double start = along.dot(planned.start), origin = along.dot(origin_.head<2>());
  Count count;
  for (const Line& line : lines_) {
    const float from = n.dot(line.from.head<2>() - p), to = n.dot(line.to.head<2>() - p);
    if (from < kMinFront_m || to > kOn_m) continue;
    const Eigen::Vector3f at = line.from + from / (from - to) * (line.to - line.from);
    const double u = origin + along.dot(at.head<2>().cast<double>()), z_m = origin_.z() + at.z();
    if (u < start + kEdge_m || u > start + planned.length_m() - kEdge_m || z_m < planned.z_min_m + vertical_edge_m_ ||
        z_m > planned.z_max_m - vertical_edge_m_)
      continue;
    if (InOpening(*face.openings, along, u, z_m, kEdge_m)) continue;
    if (to > -kOn_m) ++count.ended;
    if (to < -kBeyond_m) ++count.passed;
  }
  return count;
}

}  // namespace plumb::runtime
