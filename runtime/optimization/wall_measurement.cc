#include "runtime/optimization/wall_measurement.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>

namespace plumb::runtime {
namespace {

constexpr double kLoosePrior_m = 1.0, kLoosePrior_rad = 0.35;  // a short patch leaves the yaw open

// Least squares over one wall's (offset, yaw, thickness error) and the range bias.
enum Unknown : int { kOffset, kYaw, kThickness, kBias };
struct NormalEquations {
  Eigen::Matrix4d lhs = Eigen::Matrix4d::Zero();
  Eigen::Vector4d rhs = Eigen::Vector4d::Zero();

  explicit NormalEquations(double thickness_sigma_m) {
    lhs.diagonal() << 1 / (kLoosePrior_m * kLoosePrior_m), 1 / (kLoosePrior_rad * kLoosePrior_rad),
        1 / (thickness_sigma_m * thickness_sigma_m), 0;
  }
  void AddRow(const Eigen::Vector4d& a, double value, double weight) {
    lhs += weight * weight * a * a.transpose();
    rhs += weight * weight * value * a;
  }
};

// The rows of one view, in plan coordinates: the planned face moved with its wall and seen through the bias must contain the view.
void AddView(const PlaneView& view, const Eigen::Isometry3d& T_plan_kf, const Face& face, NormalEquations& ne) {
  const Eigen::Vector3d c = T_plan_kf * view.center, turned = Eigen::Vector3d::UnitZ().cross(face.normal);
  const double side = face.wall_normal.dot(face.normal);
  ne.AddRow({side, -turned.dot(c - face.pivot), 0.5, 1.0}, face.normal.dot(c - face.point), view.weight_center);
  for (const auto& [direction, weight] : {std::pair(view.u, view.weight_u), std::pair(view.v, view.weight_v)}) {
    const Eigen::Vector3d e = T_plan_kf.linear() * direction;
    ne.AddRow({0, e.dot(turned), 0, 0}, -e.dot(face.normal), weight);
  }
}

// Marginalises the thickness, then splits the rest into the deviation given the bias and what is left to say about the bias.
WallMeasurement Split(WallId wall, const NormalEquations& ne) {
  const Eigen::Vector4d thickness = ne.lhs.col(kThickness) / ne.lhs(kThickness, kThickness);
  const Eigen::Matrix4d lhs = ne.lhs - thickness * ne.lhs.row(kThickness);
  const Eigen::Vector4d rhs = ne.rhs - thickness * ne.rhs[kThickness];
  WallMeasurement m;
  m.wall = wall;
  m.covariance = lhs.topLeftCorner<2, 2>().inverse();
  m.deviation = m.covariance * rhs.head<2>();
  m.bias_gain = -m.covariance * lhs.block<2, 1>(0, kBias);
  m.own_bias_information = std::max(0.0, lhs(kBias, kBias) + lhs.block<2, 1>(0, kBias).dot(m.bias_gain));
  if (m.own_bias_information > 0) m.own_bias_m = (rhs[kBias] + m.bias_gain.dot(rhs.head<2>())) / m.own_bias_information;
  m.covariance.diagonal() += Eigen::Vector2d(kPoseSigma_m * kPoseSigma_m, kPoseSigma_rad * kPoseSigma_rad);
  return m;
}

}  // namespace

ViewNoise NoiseOf(const JointOptions& options, const Keyframe& seen_from) {
  ViewNoise noise = NoiseOf(options);
  noise.smear = seen_from.smear;
  return noise;
}

ViewNoise NoiseOf(const JointOptions& options, const Keyframe& seen_from, const Match& match) {
  ViewNoise noise = NoiseOf(options, seen_from);
  // As of a patch no longer than what lies beside the face: its variance goes with the square of its length.
  noise.edge_m2 /= match.beside_ratio * match.beside_ratio;
  return noise;
}

ViewNoise NoiseOf(const JointOptions& options) {
  return {.point_sigma_m = options.point_sigma_m,
          .correlation = options.correlation,
          .floor_m = options.observation_floor_m,
          .floor_rad = options.observation_floor_rad,
          .edge_m2 = options.edge_m2};
}

std::vector<WallMeasurement> MeasureWalls(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames,
                                          const std::vector<Match>& matches, const std::vector<Eigen::Isometry3d>& T_map_kf,
                                          const Eigen::Isometry3d& T_plan_map, const JointOptions& options) {
  std::map<WallId, NormalEquations> walls;
  for (const Match& match : matches) {
    if (!match.plan_surface.valid()) continue;
    const Surface& surface = plan.surfaces[match.plan_surface.index()];
    const Face face = MakeFace(frames[surface.wall.index()], surface);
    const std::vector<Observation>& observations = map.surfaces[match.map_surface].observations;
    for (size_t i = 0; i < observations.size(); ++i) {
      const Observation& o = observations[i];
      if (match.IsMistaken(i)) continue;
      AddView(PlaneView(o.stats, NoiseOf(options, map.keyframes[o.keyframe], match), observations.size()),
              T_plan_map * T_map_kf[o.keyframe], face, walls.try_emplace(surface.wall, options.thickness_sigma_m).first->second);
    }
  }
  std::vector<WallMeasurement> out;
  for (const auto& [wall, ne] : walls) out.push_back(Split(wall, ne));
  return out;
}

}  // namespace plumb::runtime
