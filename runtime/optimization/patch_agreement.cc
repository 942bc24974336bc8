#include "runtime/optimization/patch_agreement.h"

#include <Eigen/LU>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kLetGo = 3;            // of the loss's scale: Cauchy's weight is a tenth there
constexpr double kMostLetGo = 1.0 / 3;  // of the wall's area: where more is let go of, the rest may be what is wrong

// What one patch says of its wall.
struct Said {
  Eigen::Vector2d deviation;
  Eigen::Matrix2d information;
};

// What was seen of one wall.
struct SeenWall {
  std::vector<Said> kept;
  double area_m2 = 0, let_go_m2 = 0;
  Eigen::Matrix2d let_go_spread = Eigen::Matrix2d::Zero();  // sum of area * square of how far off it is
};

// What a chi-square exceeds with 1 % (Wilson and Hilferty).
double ChiSquareLimit(double freedom) {
  const double spread = 2 / (9 * freedom);
  return freedom * std::pow(1 - spread + 2.3263 * std::sqrt(spread), 3);
}

PatchDisagreement Compare(const std::vector<Said>& patches) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Said& p : patches) {
    information += p.information;
    sum += p.information * p.deviation;
  }
  PatchDisagreement out;
  out.mean = information.inverse() * sum;
  double chi_square = 0;
  for (const Said& p : patches) chi_square += (p.deviation - out.mean).dot(p.information * (p.deviation - out.mean));
  const double freedom = 2.0 * static_cast<double>(patches.size() - 1);
  out.variance_ratio = chi_square > ChiSquareLimit(freedom) ? chi_square / freedom : 1.0;
  return out;
}

}  // namespace

std::map<WallId, PatchDisagreement> FindDisagreements(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames,
                                                      const std::vector<Match>& matches, const std::vector<Eigen::Isometry3d>& T_map_kf,
                                                      const Eigen::Isometry3d& T_plan_map,
                                                      const std::map<WallId, Eigen::Vector3d>& estimates, double bias_m,
                                                      const JointOptions& options) {
  const double reach = kLetGo * options.observation_loss;
  std::map<WallId, SeenWall> walls;
  for (const Match& match : matches) {
    if (!match.plan_surface.valid()) continue;
    for (const WallMeasurement& m : MeasureWalls(map, plan, frames, {match}, T_map_kf, T_plan_map, options)) {
      const Eigen::Vector3d& estimate = estimates.at(m.wall);
      const double side = MakeFace(frames[m.wall.index()], plan.surfaces[match.plan_surface.index()]).side();
      const Said said{m.At(bias_m) - Eigen::Vector2d(0.5 * side * estimate.z(), 0), m.covariance.inverse()};
      const Eigen::Vector2d off = said.deviation - estimate.head<2>();
      const MapSurface& patch = map.surfaces[match.map_surface];
      const auto views = static_cast<double>(patch.observations.size() - match.mistaken.size());
      const double area_m2 = patch.area_m2 * views / static_cast<double>(patch.observations.size());
      SeenWall& seen = walls[m.wall];
      seen.area_m2 += area_m2;
      if (off.dot(said.information * off) <= reach * reach * views) {
        seen.kept.push_back(said);
      } else {
        seen.let_go_m2 += area_m2;
        seen.let_go_spread += area_m2 * off * off.transpose();
      }
    }
  }
  std::map<WallId, PatchDisagreement> out;
  for (const auto& [wall, seen] : walls) {
    PatchDisagreement d;
    if (seen.kept.size() > 1) d = Compare(seen.kept);
    if (seen.let_go_m2 > kMostLetGo * seen.area_m2) d.let_go = seen.let_go_spread / seen.area_m2;
    if (d.variance_ratio > 1 || !d.let_go.isZero()) out.emplace(wall, d);
  }
  return out;
}

}  // namespace plumb::runtime
