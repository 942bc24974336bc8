#include "runtime/odometry/planar/submap.h"

namespace plumb::runtime {

LikelihoodGrid GridOf(std::span<const PlacedScan> scans, const Eigen::Vector2d& center) {
  std::vector<Eigen::Vector2d> points;
  for (const PlacedScan& placed : scans) {
    const Eigen::Matrix2d R = placed.pose.Rotation();
    for (const PlanarPoint& point : *placed.scan) points.emplace_back(R * point.p + placed.pose.t_m);
  }
  return {points, center, kSearchRange_m};
}

LineMap LinesOf(std::span<const PlacedScan> scans, double sigma_m) {
  LineMap map(sigma_m);
  for (const PlacedScan& placed : scans) map.Insert(*placed.scan, placed.pose);
  map.Fit();
  return map;
}

std::vector<Eigen::Vector2d> SearchPoints(const PlanarScan& scan) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(scan.size());
  for (const PlanarPoint& point : scan) {
    if (point.p.norm() <= kSearchRange_m) points.push_back(point.p);
  }
  return points;
}

}  // namespace plumb::runtime
