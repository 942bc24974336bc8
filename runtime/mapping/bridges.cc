#include "runtime/mapping/bridges.h"

#include <algorithm>
#include <cmath>

#include "runtime/mapping/plane_fit.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kMinLeanCos = 0.99939, kMaxLeanCos = 0.94;  // 2 and 20 degrees
constexpr double kStart_m = 0.01;                            // a bridge starts within this of the larger one's plane
constexpr double kBandSigmas = 3.0, kMinSigma_m = 0.01;      // of the larger one's points about its plane
constexpr double kNear_m = 0.25;                             // between its cells and those of a bridge, or up to twice that
constexpr double kMinShare = 0.75;                           // of a bridge's cells

class Neighbourhood {
 public:
  explicit Neighbourhood(const std::vector<Eigen::Vector3f>& cells) {
    for (const Eigen::Vector3f& cell : cells) {
      for (int k = 0; k < 27; ++k) voxels_.Insert(VoxelKey(At(cell) + Eigen::Vector3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
    }
  }
  [[nodiscard]] bool Has(const Eigen::Vector3f& cell) const { return voxels_.Find(VoxelKey(At(cell))) != VoxelIndex::kNone; }

 private:
  static Eigen::Vector3d At(const Eigen::Vector3f& cell) { return cell.cast<double>() / kNear_m; }
  VoxelIndex voxels_;
};

bool Bridges(const Segment& small, const Segment& large) {
  if (small.kind != large.kind || small.stats.count() >= large.stats.count()) return false;
  const double cos = small.plane.n.dot(large.plane.n);
  if (cos > kMinLeanCos || cos < kMaxLeanCos) return false;
  const double band_m = kBandSigmas * std::max(kMinSigma_m, FitPlane(large.stats, large.plane.n).rms_m);
  const auto off_m = [&](const Eigen::Vector3f& cell) { return std::abs(large.plane.SignedDistance(cell.cast<double>())); };
  const auto least =
      std::min_element(small.cells.begin(), small.cells.end(), [&](const auto& a, const auto& b) { return off_m(a) < off_m(b); });
  if (least == small.cells.end() || off_m(*least) > kStart_m) return false;
  const Neighbourhood near(large.cells);
  const auto within =
      std::count_if(small.cells.begin(), small.cells.end(), [&](const auto& cell) { return off_m(cell) <= band_m && near.Has(cell); });
  return static_cast<double>(within) >= kMinShare * static_cast<double>(small.cells.size());
}

}  // namespace

void DropBridges(std::vector<Segment>* segments) {
  std::vector<bool> bridges;
  for (const Segment& small : *segments) {
    bridges.push_back(std::any_of(segments->begin(), segments->end(), [&](const Segment& large) { return Bridges(small, large); }));
  }
  size_t kept = 0;
  for (size_t i = 0; i < bridges.size(); ++i) {
    if (bridges[i]) continue;
    if (kept != i) (*segments)[kept] = std::move((*segments)[i]);
    ++kept;
  }
  segments->resize(kept);
}

}  // namespace plumb::runtime
