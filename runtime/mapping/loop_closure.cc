#include "runtime/mapping/loop_closure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "runtime/odometry/planar/submap.h"

namespace plumb::runtime {
namespace {

constexpr double kMinWay_m = 20.0;         // travelled since: odometry's own map reaches back less far
constexpr double kMaxDistance_m = 3.0;     // to the earlier keyframe, beyond two sigma
constexpr double kSpacing_m = 4.0;         // of way between the earlier keyframes that are tried
constexpr size_t kMaxCandidates = 2;
constexpr double kMinWayBetween_m = 1.0;   // from one loop to the next
constexpr uint32_t kSubmapReach = 15;      // keyframes either side
constexpr double kMaxWindow_m = 4.0, kMaxWindow_rad = 0.8, kMinWindow_m = 0.2, kMinWindow_rad = 0.1;
constexpr double kMinShare = 0.75;         // of likelihood
constexpr int kMinInliers = 50;
constexpr double kMinInlierShare = 0.6;
constexpr double kMaxChi2 = 16.27;         // three degrees of freedom, 99.9 %
constexpr double kFloor_m = 0.02, kFloor_rad = 0.005;  // of a loop: the submap is bent by drift of its own
constexpr double kFree_m = 1.0, kFree_rad = 0.5;       // along what the lines do not hold the search's word is not taken

Eigen::Vector3d Variances(double sigma_m, double sigma_rad) { return {sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad}; }

}  // namespace

void LoopCloser::Move(const Pose2& T_odom_scan, const Eigen::Matrix3d& step_covariance) {
  if (moved_) {
    const Pose2 step = Between(last_, T_odom_scan);
    if (opened_) since_open_ = ComposedCovariance(Between(open_, last_), since_open_, step, step_covariance);
    last_travelled_m_ += step.t_m.norm();
  }
  last_ = T_odom_scan;
  moved_ = true;
}

void LoopCloser::Open() {
  const bool continues = !kept_ && !keyframes_.empty();
  to_open_ = continues ? ComposedCovariance(Between(keyframes_.back().T_odom_kf, open_), to_open_, Between(open_, last_), since_open_)
                       : since_open_;
  since_open_.setZero();
  open_ = last_;
  open_travelled_m_ = last_travelled_m_;
  opened_ = true;
  kept_ = false;
}

bool LoopCloser::Add(PlanarScan scan, const std::vector<Pose2>& poses) {
  kept_ = true;
  keyframes_.push_back({std::move(scan), open_, open_travelled_m_});
  if (keyframes_.size() < 2) return false;
  const auto newest = static_cast<uint32_t>(keyframes_.size() - 1);
  edges_.push_back({newest - 1, newest, Between(keyframes_[newest - 1].T_odom_kf, open_), to_open_, false});
  if (open_travelled_m_ - closed_at_m_ < kMinWayBetween_m) return false;
  const size_t before = edges_.size();
  const std::vector<Eigen::Matrix3d> covariances = RelativeCovariances(poses, edges_, newest);
  for (const uint32_t candidate : Candidates(poses)) {
    if (std::optional<PoseEdge> loop = Match(candidate, poses, covariances[candidate])) edges_.push_back(std::move(*loop));
  }
  if (edges_.size() == before) return false;
  closed_at_m_ = open_travelled_m_;
  return true;
}

// The nearest keyframes of other passes.
std::vector<uint32_t> LoopCloser::Candidates(const std::vector<Pose2>& poses) const {
  std::vector<std::pair<double, uint32_t>> near;
  for (uint32_t i = 0; i + 1 < keyframes_.size(); ++i) {
    if (open_travelled_m_ - keyframes_[i].travelled_m < kMinWay_m) break;
    const double distance_m = (poses[i].t_m - poses.back().t_m).norm();
    if (distance_m <= kMaxDistance_m) near.emplace_back(distance_m, i);
  }
  std::sort(near.begin(), near.end());
  std::vector<uint32_t> chosen;
  for (const auto& [distance_m, index] : near) {
    const uint32_t i = index;
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](uint32_t other) {
      return std::abs(keyframes_[i].travelled_m - keyframes_[other].travelled_m) >= kSpacing_m;
    });
    if (apart) chosen.push_back(i);
    if (chosen.size() == kMaxCandidates) break;
  }
  return chosen;
}

// The newest keyframe on the scans about `candidate`. `covariance`: of the candidate's pose in the newest.
std::optional<PoseEdge> LoopCloser::Match(uint32_t candidate, const std::vector<Pose2>& poses, const Eigen::Matrix3d& covariance) const {
  const auto newest = static_cast<uint32_t>(keyframes_.size() - 1);
  const Pose2& origin = keyframes_[candidate].T_odom_kf;
  std::vector<PlacedScan> placed;
  for (uint32_t i = candidate - std::min(candidate, kSubmapReach); i <= candidate + kSubmapReach && i < newest; ++i) {
    if (open_travelled_m_ - keyframes_[i].travelled_m < 0.5 * kMinWay_m) break;
    placed.push_back({&keyframes_[i].scan, Between(origin, keyframes_[i].T_odom_kf)});
  }
  PlanarPrior prior;
  prior.mean = Between(poses[candidate], poses[newest]);
  prior.sigma_m = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)) + kFloor_m * kFloor_m);
  prior.sigma_rad = std::sqrt(covariance(2, 2) + kFloor_rad * kFloor_rad);
  const SearchWindow window{std::clamp(3 * prior.sigma_m, kMinWindow_m, kMaxWindow_m),
                            std::clamp(3 * prior.sigma_rad, kMinWindow_rad, kMaxWindow_rad)};
  const PlanarScan& scan = keyframes_[newest].scan;
  const SearchResult found = GridOf(placed, prior.mean.t_m).Search(SearchPoints(scan), prior, window);
  if (found.share < kMinShare) return std::nullopt;
  PlanarRegistrationOptions options;
  options.sigma_m = sigma_m_;
  options.initial_kernel_m = 0.1;
  const PlanarRegistration fine = RegisterPlanar(scan, LinesOf(placed, sigma_m_), found.pose, prior, options);
  if (!fine.ok || fine.num_inliers < kMinInliers || fine.inlier_share < kMinInlierShare) return std::nullopt;
  PoseEdge loop{candidate, newest, fine.pose, {}, true};
  const Eigen::Matrix3d known = fine.information + Eigen::Matrix3d(Variances(kFree_m, kFree_rad).cwiseInverse().asDiagonal());
  loop.covariance = known.ldlt().solve(Eigen::Matrix3d::Identity());
  loop.covariance += Variances(kFloor_m, kFloor_rad).asDiagonal();
  Eigen::Vector3d off;
  off << fine.pose.t_m - prior.mean.t_m, WrapYaw(fine.pose.yaw_rad - prior.mean.yaw_rad);
  const Eigen::Matrix3d expected = InverseCovariance(Between(poses[newest], poses[candidate]), covariance) + loop.covariance;
  if (off.dot(expected.ldlt().solve(off)) > kMaxChi2) return std::nullopt;
  return loop;
}

}  // namespace plumb::runtime
