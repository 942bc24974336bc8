#include "runtime/optimization/patch_agreement.h"

#include <Eigen/LU>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kLetGo = 3;          // of the loss's scale: Cauchy's weight is a tenth there
constexpr double kMostOdd = 1.0 / 3;  // of the wall's area: where more is odd, the rest may be what is wrong

// What one patch says of its wall.
struct Said {
  Eigen::Vector2d deviation;
  Eigen::Matrix2d information;
  double area_m2 = 0;
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

struct Agreement {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double chi_square = 0, freedom = 0;
  [[nodiscard]] bool contradicts() const { return freedom > 0 && chi_square > ChiSquareLimit(freedom); }
};

Agreement Compare(const std::vector<Said>& patches) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Said& p : patches) {
    information += p.information;
    sum += p.information * p.deviation;
  }
  Agreement out;
  out.mean = information.inverse() * sum;
  for (const Said& p : patches) out.chi_square += (p.deviation - out.mean).dot(p.information * (p.deviation - out.mean));
  out.freedom = 2.0 * static_cast<double>(patches.size() - 1);
  return out;
}

// The patches without the odd ones: those that agree best when left out, the smaller of two that are alike, as long as what is left out is
// no more than that area. All of them if the rest contradicts itself still.
std::vector<Said> WithoutOdd(const std::vector<Said>& all, double most_m2) {
  std::vector<Said> rest = all;
  while (rest.size() > 1 && Compare(rest).contradicts()) {
    size_t odd = rest.size();
    double least = 0;
    for (size_t i = 0; i < rest.size(); ++i) {
      if (rest[i].area_m2 > most_m2) continue;
      std::vector<Said> others = rest;
      others.erase(others.begin() + static_cast<ptrdiff_t>(i));
      const double chi_square = Compare(others).chi_square;
      const bool alike = odd < rest.size() && chi_square == least && rest[i].area_m2 < rest[odd].area_m2;
      if (odd < rest.size() && chi_square >= least && !alike) continue;
      odd = i;
      least = chi_square;
    }
    if (odd == rest.size()) return all;
    most_m2 -= rest[odd].area_m2;
    rest.erase(rest.begin() + static_cast<ptrdiff_t>(odd));
  }
  return rest;
}

// `estimate`: of (offset_m, yaw_rad), by the solve.
PatchDisagreement Disagreement(const SeenWall& seen, const Eigen::Vector2d& estimate) {
  PatchDisagreement out;
  if (seen.let_go_m2 > kMostOdd * seen.area_m2) out.added = seen.let_go_spread / seen.area_m2;
  if (seen.kept.size() < 2) return out;
  const Agreement all = Compare(seen.kept);
  if (!all.contradicts()) return out;
  const Agreement rest = Compare(WithoutOdd(seen.kept, kMostOdd * seen.area_m2 - seen.let_go_m2));
  if (rest.contradicts()) {
    out.variance_ratio = all.chi_square / all.freedom;
    out.mean = all.mean;
  } else {
    out.added += (estimate - rest.mean) * (estimate - rest.mean).transpose();
  }
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
      const MapSurface& patch = map.surfaces[match.map_surface];
      const auto views = static_cast<double>(patch.observations.size() - match.mistaken.size());
      const double area_m2 = patch.area_m2 * views / static_cast<double>(patch.observations.size());
      const Said said{m.At(bias_m) - Eigen::Vector2d(0.5 * side * estimate.z(), 0), m.covariance.inverse(), area_m2};
      const Eigen::Vector2d off = said.deviation - estimate.head<2>();
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
    const PatchDisagreement d = Disagreement(seen, estimates.at(wall).head<2>());
    if (d.variance_ratio > 1 || !d.added.isZero()) out.emplace(wall, d);
  }
  return out;
}

}  // namespace plumb::runtime
