#include "runtime/mapping/view_alignment.h"

#include <Eigen/Cholesky>
#include <vector>

#include "runtime/mapping/plane_fit.h"
#include "runtime/mapping/plane_view.h"
#include "runtime/mapping/pose_motion.h"
#include "runtime/mapping/view_equations.h"

namespace plumb::runtime {
namespace {

// Of the graph's poses, that saw the same surfaces as they stand. Headings rest on the length of walls, tilts and heights on the narrow
// band that a lidar sees of them.
constexpr double kAcross_m = 0.01, kHeight_m = 0.02, kTilt_rad = 0.01, kHeading_rad = 0.002;
constexpr double kLossSigmas = 3.0;  // Cauchy scale of a pair of views
constexpr int kIterations = 5;

using Matrix36d = Eigen::Matrix<double, 3, 6>;

struct Pair {
  PlaneView into, keyframe;  // each in its keyframe's frame
  Plane plane;               // frame of `into`, roughly
  Eigen::Vector3d at;        // a point of the surface there
};

std::vector<Pair> PairsOf(const SGraph& graph, uint32_t keyframe, uint32_t into, const MapperOptions& options) {
  const Keyframe &a = graph.keyframes[into], &b = graph.keyframes[keyframe];
  const Eigen::Isometry3d T_into_map = a.T_map_kf.inverse();
  const auto view = [&](const Observation& o, const Keyframe& from) {
    return PlaneView(o.stats, {.point_sigma_m = options.plane_sigma_m, .edge_m2 = 0, .smear = from.smear});
  };
  std::vector<Pair> pairs;
  for (const MapSurface& surface : graph.surfaces) {
    const Observation* const of_a = FindObservation(surface, into);
    const Observation* const of_b = FindObservation(surface, keyframe);
    if (of_a == nullptr || of_b == nullptr) continue;
    pairs.push_back({view(*of_a, a), view(*of_b, b), surface.plane.Transformed(T_into_map), of_a->stats.centroid()});
  }
  return pairs;
}

struct PoseEquations {
  Matrix6d H;
  Vector6d g;
};

// The plane eliminated.
void AddPair(const Pair& pair, const Eigen::Isometry3d& T_into_kf, PoseEquations* sum) {
  const ViewEquations a = EquationsOf(pair.into, Eigen::Isometry3d::Identity(), pair.plane, pair.at);
  const ViewEquations b = EquationsOf(pair.keyframe, T_into_kf, pair.plane, pair.at);
  const Eigen::Matrix3d plane = a.by_plane.transpose() * a.by_plane + b.by_plane.transpose() * b.by_plane + Eigen::Matrix3d::Identity();
  const Eigen::LDLT<Eigen::Matrix3d> solver(plane);
  const Eigen::Vector3d plane_g = a.by_plane.transpose() * a.residual + b.by_plane.transpose() * b.residual;
  const Matrix36d mixed = b.by_plane.transpose() * b.by_pose;
  const double cost = a.residual.squaredNorm() + b.residual.squaredNorm() - plane_g.dot(solver.solve(plane_g));
  const double weight = 1 / (1 + cost / (kLossSigmas * kLossSigmas));
  sum->H += weight * (b.by_pose.transpose() * b.by_pose - mixed.transpose() * solver.solve(mixed));
  sum->g += weight * (b.by_pose.transpose() * b.residual - mixed.transpose() * solver.solve(plane_g));
}

// Of an increment of a pose in a keyframe that is turned by R_map_kf.
Matrix6d GraphsInformation(const Eigen::Matrix3d& R_map_kf) {
  const auto diagonal = [&](double across, double along_z) {
    const Eigen::Vector3d information(1 / (across * across), 1 / (across * across), 1 / (along_z * along_z));
    return Eigen::Matrix3d(R_map_kf.transpose() * information.asDiagonal() * R_map_kf);
  };
  Matrix6d out = Matrix6d::Zero();
  out.topLeftCorner<3, 3>() = diagonal(kTilt_rad, kHeading_rad);
  out.bottomRightCorner<3, 3>() = diagonal(kAcross_m, kHeight_m);
  return out;
}

}  // namespace

Eigen::Isometry3d AlignedPose(const SGraph& graph, uint32_t keyframe, uint32_t into, const MapperOptions& options) {
  const Eigen::Isometry3d predicted = Between(graph.keyframes[into].T_map_kf, graph.keyframes[keyframe].T_map_kf);
  const std::vector<Pair> pairs = PairsOf(graph, keyframe, into, options);
  const Matrix6d information = GraphsInformation(graph.keyframes[into].T_map_kf.linear());
  Eigen::Isometry3d T = predicted;
  for (int i = 0; i < kIterations; ++i) {
    PoseEquations sum{information, information * Increment(predicted, T)};
    for (const Pair& pair : pairs) AddPair(pair, T, &sum);
    T = Moved(T, sum.H.ldlt().solve(-sum.g), T.translation());
  }
  return T.matrix().allFinite() ? T : predicted;
}

}  // namespace plumb::runtime
