#include "runtime/matching/refine.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace plumb::runtime {
namespace {

constexpr double kToleranceSigmas = 3;     // of MapView::wall_sigma_m; within: as planned
constexpr double kMostCounted_m = 0.06;    // ... but the wider, the more planes agree by chance: these count for a place
constexpr double kFullVoteLength_m = 2.0;  // longer walls do not count more: each may deviate as a whole
constexpr double kMinFaceOverlap_m = 0.5;
constexpr double kGroupWidthRatio = 2, kTruncationRatio = 4.0 / 3;  // of the tolerance
constexpr double kDirectionWidth_rad = 0.26;
constexpr double kMinMajority = 1.5, kMinMajorityMargin = 0.75;  // in walls
constexpr double kContestedSigma_m = 0.2;                        // of a wall in a direction whose walls do not agree on the displacement
constexpr size_t kMaxConsensusGroups = 24;

// The pairs of one physical wall: they move together, so they vote once.
struct WallGroup {
  std::vector<size_t> pairs;
  double weight = 0;  // in walls: 1 from kFullVoteLength_m on
  double overlap_m = 0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // of the first pair's face
};

double WeightOf(double overlap_m) { return std::min(1.0, overlap_m / kFullVoteLength_m); }

// Displacement of what the map has there from the plan's face, along its normal.
double PairDisplacement(const PlanFace& face, const WallPair& pair, const PlanarPose& pose) {
  return FaceDistance(face, pose, 0.5 * (pair.p + pair.q), nullptr);
}

// Parts of a wall that do not stand off alike (its ends and bends, a cupboard before it) make groups of their own.
std::vector<WallGroup> GroupByWall(const PlanIndex& plan, const std::vector<WallPair>& pairs, const PlanarPose& pose, double width_m) {
  std::vector<size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return pairs[a].overlap_m > pairs[b].overlap_m; });
  std::map<uint32_t, std::vector<WallGroup>> by_wall;
  for (size_t i : order) {
    const PlanFace& face = plan.faces()[pairs[i].face];
    std::vector<WallGroup>& some = by_wall[face.physical_wall];
    auto group = std::find_if(some.begin(), some.end(), [&](const WallGroup& g) {
      const double cosine = g.normal.dot(face.normal);
      if (std::abs(cosine) < 0.9) return false;
      const WallPair& first = pairs[g.pairs.front()];
      const double off_m =
          PairDisplacement(face, pairs[i], pose) - std::copysign(1.0, cosine) * PairDisplacement(plan.faces()[first.face], first, pose);
      return std::abs(off_m) < width_m;
    });
    if (group == some.end()) {
      group = some.insert(some.end(), WallGroup());
      group->normal = face.normal;
    }
    group->pairs.push_back(i);
    group->overlap_m += pairs[i].overlap_m;
  }
  std::vector<WallGroup> groups;
  for (const auto& [wall, some] : by_wall) groups.insert(groups.end(), some.begin(), some.end());
  for (WallGroup& group : groups) group.weight = WeightOf(group.overlap_m);
  std::stable_sort(groups.begin(), groups.end(), [](const WallGroup& a, const WallGroup& b) { return a.overlap_m > b.overlap_m; });
  return groups;
}

class WallProblem {
 public:
  WallProblem(const PlanIndex& plan, const MapView& map, const std::vector<WallPair>& pairs, const PlanarPose& pose)
      : plan_(plan), pairs_(pairs), sigma_m_(map.wall_sigma_m), groups_(GroupByWall(plan, pairs, pose, kGroupWidthRatio * tolerance_m())) {}

  // Of a wall as planned, and how far off it may stand.
  [[nodiscard]] double sigma_m() const { return sigma_m_; }
  [[nodiscard]] double tolerance_m() const { return kToleranceSigmas * sigma_m_; }

  [[nodiscard]] const std::vector<WallGroup>& groups() const { return groups_; }
  [[nodiscard]] const PlanFace& face(size_t pair) const { return plan_.faces()[pairs_[pair].face]; }
  [[nodiscard]] const WallPair& pair(size_t i) const { return pairs_[i]; }

  // Mean square distance of a group's pairs at their two ends.
  [[nodiscard]] double SquaredDistance(const WallGroup& group, const PlanarPose& pose) const {
    double sum = 0;
    for (size_t i : group.pairs) sum += pairs_[i].overlap_m * SquaredDistance(pairs_[i], pose);
    return sum / group.overlap_m;
  }

  // The group without the pairs that are farther off: at rough ranges what stands before a wall may pass for a piece of it, and does not
  // make the wall deviate.
  [[nodiscard]] WallGroup PiecesWithin(const WallGroup& group, const PlanarPose& pose, double distance_m) const {
    WallGroup out = group;
    std::erase_if(out.pairs, [&](size_t i) { return SquaredDistance(pairs_[i], pose) > distance_m * distance_m; });
    out.overlap_m = 0;
    for (size_t i : out.pairs) out.overlap_m += pairs_[i].overlap_m;
    out.weight = WeightOf(out.overlap_m);
    return out;
  }

  // Mean displacement of the built wall along the group's normal.
  [[nodiscard]] double Displacement(const WallGroup& group, const PlanarPose& pose) const {
    double sum = 0;
    for (size_t i : group.pairs) {
      const double sign = face(i).normal.dot(group.normal) < 0 ? -1 : 1;
      sum += sign * pairs_[i].overlap_m * PairDisplacement(face(i), pairs_[i], pose);
    }
    return sum / group.overlap_m;
  }

  // Adds weight * (J^T J, J^T r) of a group, J by (x, y, yaw, scale).
  void AddNormalEquations(const WallGroup& group, const PlanarPose& pose, double weight, Eigen::Matrix4d& H, Eigen::Vector4d& g) const {
    for (size_t i : group.pairs) {
      const double w = weight * 0.5 * pairs_[i].overlap_m / group.overlap_m;
      for (const Eigen::Vector2d& x : {pairs_[i].p, pairs_[i].q}) {
        Eigen::Vector4d J;
        const double r = FaceDistance(face(i), pose, x, &J);
        H += w * J * J.transpose();
        g += w * J * r;
      }
    }
  }

 private:
  [[nodiscard]] double SquaredDistance(const WallPair& pair, const PlanarPose& pose) const {
    const PlanFace& f = plan_.faces()[pair.face];
    const double rp = FaceDistance(f, pose, pair.p, nullptr), rq = FaceDistance(f, pose, pair.q, nullptr);
    return 0.5 * (rp * rp + rq * rq);
  }

  const PlanIndex& plan_;
  const std::vector<WallPair>& pairs_;
  double sigma_m_;
  std::vector<WallGroup> groups_;
};

// Median of the pairs' own yaws, weighted by overlap.
double MedianYaw(const PlanIndex& plan, const MapView& map, const std::vector<WallPair>& pairs, double yaw_rad) {
  std::vector<std::pair<double, double>> off;  // from yaw_rad, weight
  double total = 0;
  for (const WallPair& pair : pairs) {
    const Eigen::Vector2d &s = map.walls[pair.wall].normal, &a = plan.faces()[pair.face].normal;
    off.emplace_back(WrapAngle(std::atan2(Cross(s, a), s.dot(a)) - yaw_rad), pair.overlap_m);
    total += pair.overlap_m;
  }
  std::sort(off.begin(), off.end());
  double below = 0;
  for (const auto& [off_rad, weight] : off) {
    below += weight;
    if (below >= 0.5 * total) return WrapAngle(yaw_rad + off_rad);
  }
  return yaw_rad;
}

// Of the translations that put two non-parallel walls exactly onto their plan, and of none, the one with the smallest truncated cost.
Eigen::Vector2d ConsensusTranslation(const WallProblem& problem, const PlanarPose& pose) {
  const std::vector<WallGroup>& groups = problem.groups();
  const size_t n = std::min(groups.size(), kMaxConsensusGroups);
  std::vector<double> displacement(groups.size());
  for (size_t i = 0; i < groups.size(); ++i) displacement[i] = problem.Displacement(groups[i], pose);
  const double truncation_m = kTruncationRatio * problem.tolerance_m();
  const auto cost = [&](const Eigen::Vector2d& shift) {
    double sum = 1e-3 * shift.norm();  // of equals, the nearest
    for (size_t i = 0; i < groups.size(); ++i) {
      const double r = (displacement[i] + groups[i].normal.dot(shift)) / truncation_m;
      sum += groups[i].weight * std::min(r * r, 1.0);
    }
    return sum;
  };
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double best_cost = cost(best);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      Eigen::Matrix2d N;
      N << groups[i].normal.transpose(), groups[j].normal.transpose();
      if (std::abs(N.determinant()) < 0.5) continue;
      const Eigen::Vector2d shift = N.inverse() * Eigen::Vector2d(-displacement[i], -displacement[j]);
      if (shift.norm() > 1.5 * kMaxPairOffset_m) continue;
      const double c = cost(shift);
      if (c < best_cost) {
        best_cost = c;
        best = shift;
      }
    }
  }
  return pose.t_m + best;
}

// Least squares with the Geman-McClure kernel, its width shrunk step by step to the wall tolerance.
PlanarPose SolveGraduated(const WallProblem& problem, PlanarPose pose) {
  const double least_m = problem.tolerance_m();
  for (double width_m : {4 * least_m, 2 * least_m, least_m, least_m}) {
    for (int i = 0; i < 3; ++i) {
      // A weak prior holds directions that no wall fixes.
      Eigen::Matrix4d H = Eigen::Vector4d(1e-4, 1e-4, 1e-4, 0).asDiagonal();
      Eigen::Vector4d g = Eigen::Vector4d::Zero();
      for (const WallGroup& group : problem.groups()) {
        const double kernel = 1 / (1 + problem.SquaredDistance(group, pose) / (width_m * width_m));
        problem.AddNormalEquations(group, pose, group.weight * kernel * kernel, H, g);
      }
      const Eigen::Vector3d step = -H.topLeftCorner<3, 3>().ldlt().solve(g.head<3>());
      pose.t_m += step.head<2>();
      pose.yaw_rad = WrapAngle(pose.yaw_rad + step.z());
      if (step.norm() < 1e-7) break;
    }
  }
  return pose;
}

// Marks groups in whose direction clearly more walls stand as planned than stand together somewhere else. Only these may fix the pose:
// elsewhere "the walls are as planned" and "they all moved" explain the map equally well.
std::vector<bool> InMajorityDirection(const WallProblem& problem, const PlanarPose& pose) {
  const std::vector<WallGroup>& groups = problem.groups();
  const double tolerance_m = problem.tolerance_m();
  std::vector<bool> clear(groups.size(), false), done(groups.size(), false);
  for (size_t i = 0; i < groups.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::pair<double, double>> walls;  // displacement along the direction, weight
    std::vector<size_t> members;
    for (size_t j = i; j < groups.size(); ++j) {
      const double cosine = groups[j].normal.dot(groups[i].normal);
      if (done[j] || std::abs(cosine) < std::cos(kDirectionWidth_rad)) continue;
      done[j] = true;
      members.push_back(j);
      walls.emplace_back(std::copysign(1.0, cosine) * problem.Displacement(groups[j], pose), groups[j].weight);
    }
    const auto support = [&](double at_m) {
      double sum = 0;
      for (const auto& [x_m, w] : walls) sum += std::abs(x_m - at_m) < tolerance_m ? w : 0;
      return sum;
    };
    const double here = support(0);
    double elsewhere = 0;
    for (const auto& [x_m, w] : walls) {
      if (std::abs(x_m) >= tolerance_m) elsewhere = std::max(elsewhere, support(x_m));
    }
    if (here < kMinMajority || here - elsewhere < kMinMajorityMargin) continue;
    for (size_t j : members) clear[j] = true;
  }
  return clear;
}

// Planes of the plan that the map agrees with over at least kMinFaceOverlap_m; coplanar faces count once.
int CountPlanes(const PlanIndex& plan, const std::vector<double>& overlap_m) {
  std::vector<std::pair<size_t, double>> planes;  // first face, overlap
  for (size_t k = 0; k < overlap_m.size(); ++k) {
    if (overlap_m[k] <= 0) continue;
    const auto known =
        std::find_if(planes.begin(), planes.end(), [&](const auto& p) { return AreCoplanar(plan.faces()[p.first], plan.faces()[k]); });
    if (known == planes.end())
      planes.emplace_back(k, overlap_m[k]);
    else
      known->second += overlap_m[k];
  }
  return static_cast<int>(std::count_if(planes.begin(), planes.end(), [](const auto& p) { return p.second >= kMinFaceOverlap_m; }));
}

void Assess(const PlanIndex& plan, const MapView& map, const WallProblem& problem, WallFit& fit) {
  const std::vector<WallGroup>& groups = problem.groups();
  const std::vector<bool> clear = InMajorityDirection(problem, fit.pose);
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero(), H_clear = Eigen::Matrix4d::Zero(), H_contested = Eigen::Matrix4d::Zero();
  Eigen::Vector4d g = Eigen::Vector4d::Zero(), unused = Eigen::Vector4d::Zero();
  std::vector<double> overlap_m(plan.faces().size(), 0.0);
  double consistent_m = 0;
  const double tolerance_m = problem.tolerance_m(), counted_m = std::min(tolerance_m, kMostCounted_m);
  for (size_t i = 0; i < groups.size(); ++i) {
    const WallGroup group = problem.PiecesWithin(groups[i], fit.pose, tolerance_m);
    const double weight = group.weight / (problem.sigma_m() * problem.sigma_m());
    problem.AddNormalEquations(group, fit.pose, weight, H, g);
    if (clear[i]) {
      problem.AddNormalEquations(group, fit.pose, weight, H_clear, unused);
    } else {
      problem.AddNormalEquations(group, fit.pose, group.weight / (kContestedSigma_m * kContestedSigma_m), H_contested, unused);
    }
    for (size_t k : problem.PiecesWithin(group, fit.pose, counted_m).pairs) {
      overlap_m[problem.pair(k).face] += problem.pair(k).overlap_m;
      consistent_m += problem.pair(k).overlap_m;
    }
  }
  fit.consistent_planes = CountPlanes(plan, overlap_m);
  fit.consistent_ratio = map.wall_length_m > 0 ? std::min(1.0, consistent_m / map.wall_length_m) : 0;
  fit.information = H_clear.topLeftCorner<3, 3>();
  fit.place_information = (H_clear + H_contested).topLeftCorner<3, 3>();
  // With a weak prior, so that what no wall measures comes out as unknown instead of as a division by zero.
  const Eigen::Matrix4d covariance = (H + Eigen::Matrix4d(Eigen::Vector4d(1e-4, 1e-4, 1e-4, 1e-4).asDiagonal())).inverse();
  fit.sigma_scale = std::sqrt(covariance(3, 3));
  fit.scale_error = covariance.row(3).dot(g);  // the map must shrink by -s to fit
}

}  // namespace

WallFit RefineOnWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& start) {
  PlanarPose pose = start;
  for (int round = 0; round < 3; ++round) {
    const std::vector<WallPair> pairs = PairWalls(plan, map, pose);
    if (pairs.empty()) break;
    const WallProblem problem(plan, map, pairs, pose);
    if (round < 2) {
      pose.yaw_rad = MedianYaw(plan, map, pairs, pose.yaw_rad);
      pose.t_m = ConsensusTranslation(problem, pose);
    }
    pose = SolveGraduated(problem, pose);
  }
  return AssessOnWalls(plan, map, pose);
}

WallFit AssessOnWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& pose) {
  WallFit fit;
  fit.pose = pose;
  fit.pairs = PairWalls(plan, map, pose);
  Assess(plan, map, WallProblem(plan, map, fit.pairs, pose), fit);
  return fit;
}

}  // namespace plumb::runtime
