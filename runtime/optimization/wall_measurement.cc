#include "runtime/optimization/wall_measurement.h"

#include <Eigen/LU>
#include <map>

namespace plumb::runtime {
namespace {

constexpr double kPoseSigma_m = 0.003, kPoseSigma_rad = 0.0015;  // between walls: what the poses add to their own observations
constexpr double kLoosePrior_m = 1.0, kLoosePrior_rad = 0.35;   // a short patch leaves the yaw open

struct NormalEquations {
  Eigen::Matrix2d lhs = Eigen::Vector2d(1 / (kLoosePrior_m * kLoosePrior_m), 1 / (kLoosePrior_rad * kLoosePrior_rad)).asDiagonal();
  Eigen::Vector2d rhs = Eigen::Vector2d::Zero(), bias_rhs = Eigen::Vector2d::Zero();

  void AddRow(double offset, double yaw, double value, double bias, double weight) {
    const Eigen::Vector2d a = weight * weight * Eigen::Vector2d(offset, yaw);
    lhs += a * Eigen::RowVector2d(offset, yaw);
    rhs += a * value;
    bias_rhs += a * bias;
  }
};

// The rows of one view, in plan coordinates: the planned face moved by (offset, yaw) and seen through the bias must contain the view.
void AddView(const PlaneView& view, const Eigen::Isometry3d& T_plan_kf, const Face& face, NormalEquations& ne) {
  const Eigen::Vector3d c = T_plan_kf * view.center, turned = Eigen::Vector3d::UnitZ().cross(face.normal);
  const double side = face.wall_normal.dot(face.normal);
  ne.AddRow(side, -turned.dot(c - face.pivot), face.normal.dot(c - face.point), -1.0, view.weight_center);
  for (const auto& [direction, weight] : {std::pair(view.u, view.weight_u), std::pair(view.v, view.weight_v)}) {
    const Eigen::Vector3d e = T_plan_kf.linear() * direction;
    ne.AddRow(0, e.dot(turned), -e.dot(face.normal), 0, weight);
  }
}

}  // namespace

ViewNoise NoiseOf(const JointOptions& options) {
  return {options.point_sigma_m, options.correlation, options.observation_floor_m, options.observation_floor_rad};
}

std::vector<WallMeasurement> MeasureWalls(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames,
                                          const std::vector<Match>& matches, const std::vector<Eigen::Isometry3d>& T_map_kf,
                                          const Eigen::Isometry3d& T_plan_map, const JointOptions& options) {
  std::map<WallId, NormalEquations> walls;
  for (const Match& match : matches) {
    if (!match.plan_surface.valid()) continue;
    const Surface& surface = plan.surfaces[match.plan_surface.index()];
    const Face face = MakeFace(frames[surface.wall.index()], surface);
    for (const Observation& o : map.surfaces[match.map_surface].observations) {
      AddView(PlaneView(o.stats, NoiseOf(options)), T_plan_map * T_map_kf[o.keyframe], face, walls[surface.wall]);
    }
  }
  std::vector<WallMeasurement> out;
  for (const auto& [wall, ne] : walls) {
    WallMeasurement m;
    m.wall = wall;
    m.covariance = ne.lhs.inverse();
    m.deviation = m.covariance * ne.rhs;
    m.bias_gain = m.covariance * ne.bias_rhs;
    m.covariance.diagonal() += Eigen::Vector2d(kPoseSigma_m * kPoseSigma_m, kPoseSigma_rad * kPoseSigma_rad);
    out.push_back(m);
  }
  return out;
}

}  // namespace plumb::runtime
