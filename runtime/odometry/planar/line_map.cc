#include "runtime/odometry/planar/line_map.h"

#include <cmath>
#include <limits>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kCell_m = 0.25;
constexpr double kSameFacingCos = 0.75;     // of points in one line's statistics, and of a point and its line
constexpr double kMinPoints = 4;
constexpr double kMaxRmsSigmas = 2.0;       // of points about a line
constexpr double kMinAlong_m = 0.02;        // standard deviation along the line
constexpr double kMaxAlong_m = 0.25;        // from a line's mean to its points
constexpr double kAlongWeight = 0.05;       // a point goes to the line nearest across, among equals to the one nearest along

uint64_t CellKey(const Eigen::Vector2d& p) { return VoxelKey({p.x() / kCell_m, p.y() / kCell_m, 0}); }

}  // namespace

double LineSurfel::DistanceVariance(const Eigen::Vector2d& p, double sigma_m) const {
  const double along_m = Perpendicular(normal).dot(p - mean), variance_m2 = std::max(var_across_m2, sigma_m * sigma_m);
  return variance_m2 * (1 + (1 + along_m * along_m / var_along_m2) / count);
}

void LineMap::Insert(const PlanarScan& scan, const Pose2& pose) {
  const Eigen::Matrix2d R = pose.Rotation();
  for (const PlanarPoint& point : scan) {
    if (!point.has_normal()) continue;
    const Eigen::Vector2d p = R * point.p + pose.t_m, normal = R * point.normal;
    const auto [cell, is_new] = index_.Insert(CellKey(p));
    if (is_new) first_.push_back(VoxelIndex::kNone);
    uint32_t at = first_[cell];
    while (at != VoxelIndex::kNone && lines_[at].normal_sum.dot(normal) < kSameFacingCos * lines_[at].normal_sum.norm())
      at = lines_[at].next;
    if (at == VoxelIndex::kNone) {
      at = static_cast<uint32_t>(lines_.size());
      lines_.emplace_back().next = first_[cell];
      first_[cell] = at;
    }
    LineSurfel& line = lines_[at];
    line.count += 1;
    line.sum += p;
    line.outer += p * p.transpose();
    line.normal_sum += normal;
  }
}

void LineMap::Fit() {
  for (LineSurfel& line : lines_) {
    line.fitted = false;
    if (line.count < kMinPoints) continue;
    line.mean = line.sum / line.count;
    const SymmetricEigen<2> eigen = EigenOf(Eigen::Matrix2d(line.outer / line.count - line.mean * line.mean.transpose()));
    line.var_across_m2 = std::max(eigen.values[0], 1e-10);
    line.var_along_m2 = eigen.values[1];
    line.normal = eigen.vectors.col(0);
    if (line.normal.dot(line.normal_sum) < 0) line.normal = -line.normal;
    line.fitted = line.var_along_m2 >= kMinAlong_m * kMinAlong_m && line.var_across_m2 <= std::pow(kMaxRmsSigmas * sigma_m_, 2) &&
                  line.normal.dot(line.normal_sum) >= kSameFacingCos * line.normal_sum.norm();
  }
}

const LineSurfel* LineMap::Nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal, const Eigen::Vector2d& sensor) const {
  const LineSurfel* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 9; ++k) {
    const uint32_t cell = index_.Find(CellKey(p + kCell_m * Eigen::Vector2d(k % 3 - 1, k / 3 - 1)));
    if (cell == VoxelIndex::kNone) continue;
    for (uint32_t at = first_[cell]; at != VoxelIndex::kNone; at = lines_[at].next) {
      const LineSurfel& line = lines_[at];
      if (!line.fitted || line.normal.dot(normal) < kSameFacingCos || line.normal.dot(sensor - p) <= 0) continue;
      const Eigen::Vector2d d = p - line.mean;
      const double across_m = line.normal.dot(d), along_m = Perpendicular(line.normal).dot(d);
      if (std::abs(along_m) > kMaxAlong_m) continue;
      const double cost = across_m * across_m + kAlongWeight * along_m * along_m;
      if (cost >= least) continue;
      least = cost;
      best = &line;
    }
  }
  return best;
}

}  // namespace plumb::runtime
