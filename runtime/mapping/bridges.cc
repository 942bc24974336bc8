#include "runtime/mapping/bridges.h"

#include <algorithm>
#include <cmath>

#include "runtime/mapping/plane_fit.h"

namespace plumb::runtime {
namespace {

constexpr double kMinLeanCos = 0.99939, kMaxLeanCos = 0.94;  // 2 and 20 degrees
constexpr double kStart_m = 0.01;                            // a bridge starts within this of the larger one's plane
constexpr double kBandSigmas = 3.0, kMinSigma_m = 0.01;      // of the larger one's points about its plane
constexpr float kNear_m = 0.25F;                             // between a bridge's cells and its
constexpr double kMinShare = 0.75;                           // of a bridge's cells

bool IsNear(const Eigen::Vector3f& cell, const std::vector<Eigen::Vector3f>& cells) {
  return std::any_of(cells.begin(), cells.end(), [&](const auto& other) { return (other - cell).squaredNorm() < kNear_m * kNear_m; });
}

bool Bridges(const Segment& small, const Segment& large) {
  if (small.kind != large.kind || small.stats.count() >= large.stats.count()) return false;
  const double cos = small.plane.n.dot(large.plane.n);
  if (cos > kMinLeanCos || cos < kMaxLeanCos) return false;
  const double band_m = kBandSigmas * std::max(kMinSigma_m, FitPlane(large.stats, large.plane.n).rms_m);
  const auto off_m = [&](const Eigen::Vector3f& cell) { return std::abs(large.plane.SignedDistance(cell.cast<double>())); };
  const auto least =
      std::min_element(small.cells.begin(), small.cells.end(), [&](const auto& a, const auto& b) { return off_m(a) < off_m(b); });
  if (least == small.cells.end() || off_m(*least) > kStart_m) return false;
  const auto within = std::count_if(small.cells.begin(), small.cells.end(),
                                    [&](const auto& cell) { return off_m(cell) <= band_m && IsNear(cell, large.cells); });
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
