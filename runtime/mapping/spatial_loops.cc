#include "runtime/mapping/spatial_loops.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/mapping/pose_graph.h"
#include "runtime/mapping/pose_motion.h"

namespace plumb::runtime {
namespace {

constexpr std::array<double, 7> kChi2 = {0, 6.63, 9.21, 11.34, 13.28, 15.09, 16.81};  // 99 %, by degrees of freedom
constexpr int kMinHeld = 5;                      // of six directions: a corridor's; less is a floor and some wall
constexpr double kFree_m = 100, kFree_rad = 10;  // along what the points do not hold
constexpr double kSearchSigmas = 3.0;
constexpr double kWayBetweenTries_m = 0.25;
constexpr double kWayToAgree_m = 5.0;                              // between the two keyframes of which one confirms the other
constexpr double kMergedSigma_m = 0.01, kMergedSigma_rad = 0.002;  // of a keyframe in the one that it was merged into

Matrix6d Diagonal(double sigma_m, double sigma_rad) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(sigma_rad * sigma_rad), Eigen::Vector3d::Constant(sigma_m * sigma_m);
  return variances.asDiagonal();
}

double HorizontalSigma_m(const Matrix6d& covariance) { return std::sqrt(std::max(covariance(3, 3), covariance(4, 4))); }

}  // namespace

std::string SpatialLoopOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"min_way_m", min_way_m},
                                                     {"max_distance_m", max_distance_m},
                                                     {"max_search_m", max_search_m},
                                                     {"min_overlap", min_overlap},
                                                     {"min_inlier_share", min_inlier_share},
                                                     {"floor_sigma_m", floor_sigma_m},
                                                     {"floor_sigma_rad", floor_sigma_rad},
                                                     {"way_between_m", way_between_m},
                                                     {"registration.range_sigma_m", registration.range_sigma_m},
                                                     {"registration.submap_way_m", registration.submap_way_m},
                                                     {"registration.keyframe_spacing_m", registration.keyframe_spacing_m},
                                                     {"registration.basin_m", registration.basin_m},
                                                     {"registration.basin_rad", registration.basin_rad},
                                                     {"registration.degenerate_ratio", registration.degenerate_ratio}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0)) return fmt::format("SpatialLoopOptions.{} = {}; must be > 0", name, value);
  }
  for (const auto& [name, value] : {std::pair{"min_overlap", min_overlap}, {"min_inlier_share", min_inlier_share}}) {
    if (value > 1) return fmt::format("SpatialLoopOptions.{} = {}; must be <= 1", name, value);
  }
  if (min_inliers < 1) return fmt::format("SpatialLoopOptions.min_inliers = {}; must be >= 1", min_inliers);
  return drift.Check();
}

bool PassesGate(const Eigen::Isometry3d& predicted, const Matrix6d& predicted_covariance, const Eigen::Isometry3d& found,
                const Matrix6d& found_covariance, int num_held) {
  const Vector6d off = Increment(predicted, found);
  const Matrix6d expected = predicted_covariance + found_covariance;
  return off.dot(expected.ldlt().solve(off)) <= kChi2[static_cast<size_t>(std::clamp(num_held, 0, 6))];
}

std::vector<SpatialEdge> SpatialLoops::EdgesOf(const SGraph& graph) const {
  std::vector<SpatialEdge> edges;
  edges.reserve(2 * graph.keyframes.size() + graph.loops.size());
  for (uint32_t i = 0; i < graph.keyframes.size(); ++i) {
    const Keyframe& keyframe = graph.keyframes[i];
    if (i > 0) {
      const Keyframe& last = graph.keyframes[i - 1];
      const StepSigma sigma = options_.drift.Between(last, keyframe);
      edges.push_back({i - 1, i, Between(last.T_odom_kf, keyframe.T_odom_kf), Diagonal(sigma.m, sigma.rad), false});
    }
    if (!keyframe.merged) continue;
    edges.push_back({keyframe.merged->into, i, keyframe.merged->T_into_kf, Diagonal(kMergedSigma_m, kMergedSigma_rad), false});
  }
  edges.insert(edges.end(), graph.loops.begin(), graph.loops.end());
  return edges;
}

std::vector<SpatialEdge> SpatialLoops::Add(const SGraph& graph) {
  const double way_m = graph.keyframes.back().travelled_m;
  const bool confirmed = last_ && last_told_;
  if (way_m < options_.min_way_m || way_m - tried_at_m_ < kWayBetweenTries_m) return {};
  if (confirmed && way_m - closed_at_m_ < options_.way_between_m) return {};
  tried_at_m_ = way_m;
  std::optional<SpatialEdge> found = Find(graph);
  if (!found) return {};
  std::vector<SpatialEdge> sure;
  const bool agree = last_ && Agree(*last_, *found, graph.keyframes);
  if (agree) {
    if (!last_told_) sure.push_back(*last_);
    sure.push_back(*found);
    closed_at_m_ = way_m;
  }
  last_ = std::move(found);
  last_told_ = agree;
  return sure;
}

// Of the newest keyframe, on the nearest place of another pass.
std::optional<SpatialEdge> SpatialLoops::Find(const SGraph& graph) const {
  const std::vector<Keyframe>& keyframes = graph.keyframes;
  const Keyframe& newest = keyframes.back();
  const auto old_and_within = [&](const Keyframe& k, double distance_m) {
    return !k.merged && newest.travelled_m - k.travelled_m >= options_.min_way_m &&
           (k.T_map_kf.translation() - newest.T_map_kf.translation()).norm() <= distance_m;
  };
  if (std::none_of(keyframes.begin(), keyframes.end(), [&](const Keyframe& k) { return old_and_within(k, options_.max_search_m); })) {
    return std::nullopt;
  }
  const std::vector<Matrix6d> covariances = RelativeCovariances(keyframes, EdgesOf(graph), newest.id);
  const Keyframe* place = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Keyframe& k : keyframes) {
    const double reach_m = options_.max_distance_m + kSearchSigmas * HorizontalSigma_m(covariances[k.id]);
    const double distance_m = (k.T_map_kf.translation() - newest.T_map_kf.translation()).norm();
    if (distance_m >= nearest_m || !old_and_within(k, std::min(reach_m, options_.max_search_m))) continue;
    nearest_m = distance_m;
    place = &k;
  }
  if (place == nullptr) return std::nullopt;
  const Matrix6d covariance = InverseCovariance(Between(newest.T_map_kf, place->T_map_kf), covariances[place->id]);
  const PlaceRegistration r = RegisterToPlace(keyframes, place->id, newest.id, covariance, options_.min_way_m, options_.registration);
  if (!r.ok || r.num_held < kMinHeld || r.num_inliers < options_.min_inliers) return std::nullopt;
  if (r.inlier_ratio < options_.min_inlier_share || r.overlap_ratio < options_.min_overlap) return std::nullopt;
  const Matrix6d known = r.information + Matrix6d(Diagonal(kFree_m, kFree_rad).diagonal().cwiseInverse().asDiagonal());
  SpatialEdge edge{place->id, newest.id, r.T_place_kf, known.ldlt().solve(Matrix6d::Identity()), true};
  edge.covariance += Diagonal(options_.floor_sigma_m, options_.floor_sigma_rad);
  if (!PassesGate(Between(place->T_map_kf, newest.T_map_kf), covariance, edge.T_from_to, edge.covariance, r.num_held)) return std::nullopt;
  return edge;
}

// Whether b is where a and the way from a's keyframes to b's have it.
bool SpatialLoops::Agree(const SpatialEdge& a, const SpatialEdge& b, const std::vector<Keyframe>& keyframes) const {
  const Keyframe &a_from = keyframes[a.from], &a_to = keyframes[a.to], &b_from = keyframes[b.from], &b_to = keyframes[b.to];
  if (b_to.travelled_m - a_to.travelled_m > kWayToAgree_m) return false;
  const Eigen::Isometry3d back = Between(b_from.T_map_kf, a_from.T_map_kf), on = Between(a_to.T_odom_kf, b_to.T_odom_kf);
  const bool forth = a_from.id <= b_from.id;
  const StepSigma back_sigma = forth ? options_.drift.Between(a_from, b_from) : options_.drift.Between(b_from, a_from);
  const StepSigma on_sigma = options_.drift.Between(a_to, b_to);
  const Matrix6d to_a = ComposedCovariance(back, Diagonal(back_sigma.m, back_sigma.rad), a.T_from_to, a.covariance);
  const Matrix6d predicted = ComposedCovariance(back * a.T_from_to, to_a, on, Diagonal(on_sigma.m, on_sigma.rad));
  return PassesGate(back * a.T_from_to * on, predicted, b.T_from_to, b.covariance, 6);
}

}  // namespace plumb::runtime
