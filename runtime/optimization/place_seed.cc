#include "runtime/optimization/place_seed.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/coupling/mixture.h"

namespace plumb::runtime {
namespace {

using Correction = Eigen::Vector4d;  // x, y, yaw of the place about the walls' centre; range bias

constexpr double kPlacePrior_rad = 0.2;  // with the options' prior of position: keeps what no wall tells near the given place
constexpr double kTruncation = 3.0;
constexpr double kMinSine = 0.3;
constexpr size_t kMaxProposers = 60, kMaxPolished = 12;
constexpr double kDistinct_m = 0.02;
constexpr double kKeepMargin_nats = 1.0;
constexpr double kSamePlace_m = 0.05;
constexpr double kNoRival_nats = 7.0;  // less than a thousandth of the given place's probability moves no interval of 95 %
constexpr std::array<double, 8> kToleranceSchedule_m{0.03, 0.02, 0.01, 0, 0, 0, 0, 0};

struct Row {
  Eigen::Vector2d e;
  Eigen::Matrix<double, 2, 4> J;  // of the measured deviation with respect to the correction
  Eigen::Matrix2d cov;
  double own_bias_m, own_bias_information;
  [[nodiscard]] Eigen::Vector2d At(const Correction& x) const { return e + J * x; }
  // Squared error, in sigmas, of the bias that the wall's own two faces show.
  [[nodiscard]] double BiasError2(const Correction& x) const { return own_bias_information * (x[3] - own_bias_m) * (x[3] - own_bias_m); }
};

std::vector<Row> Rows(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames, const Eigen::Vector2d& center) {
  std::vector<Row> rows;
  for (const WallMeasurement& w : walls) {
    const WallFrame& frame = frames[w.wall.index()];
    const Eigen::Vector2d n = frame.normal.head<2>(), arm = frame.pivot.head<2>() - center;
    Row row{w.deviation, Eigen::Matrix<double, 2, 4>::Zero(), w.covariance, w.own_bias_m, w.own_bias_information};
    row.J.row(0) << n.x(), n.y(), n.dot(Eigen::Vector2d(-arm.y(), arm.x())), w.bias_gain.x();
    row.J.row(1) << 0, 0, 1, w.bias_gain.y();
    rows.push_back(row);
  }
  return rows;
}

class Seeder {
 public:
  // `prior`: the place as known before.
  Seeder(std::vector<Row> rows, const Correction& prior, const JointOptions& options)
      : rows_(std::move(rows)), prior_(prior), options_(options) {}

  Correction Solve() const {
    // The given place, polished: unless that leads elsewhere, as it does where one deviated wall is nearly all that is seen along its
    // normal.
    Correction best = Polish(Correction::Zero());
    if (options_.place && best.head<2>().norm() > kSamePlace_m) best = Correction::Zero();
    double best_cost = Cost(best) - KeepMargin_nats();
    std::vector<Correction> proposals = Proposals();
    proposals.push_back(prior_);
    for (const Correction& proposal : proposals) {
      const Correction x = Polish(proposal);
      const double cost = Cost(x);
      if (cost < best_cost - 1e-9) {
        best = x;
        best_cost = cost;
      }
    }
    return best;
  }

  std::vector<RivalPlace> Rivals() const {
    const double given = Cost(Polish(Correction::Zero()));
    std::vector<RivalPlace> out;
    std::vector<Correction> proposals = Proposals();
    proposals.push_back(prior_);
    for (const Correction& proposal : proposals) {
      const Correction x = Polish(proposal);
      RivalPlace rival{given - Cost(x), Shifts(x)};
      const bool known = std::any_of(out.begin(), out.end(), [&](const RivalPlace& o) { return Same(o.shifts, rival.shifts); });
      if (rival.log_odds > -kNoRival_nats && !known &&
          !Same(rival.shifts, std::vector<Eigen::Vector2d>(rows_.size(), Eigen::Vector2d::Zero())))
        out.push_back(rival);
    }
    return out;
  }

 private:
  std::vector<Eigen::Vector2d> Shifts(const Correction& x) const {
    std::vector<Eigen::Vector2d> out;
    for (const Row& r : rows_) out.emplace_back(r.J * x);
    return out;
  }

  static bool Same(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
    return std::equal(a.begin(), a.end(), b.begin(),
                      [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) { return std::abs(p.x() - q.x()) < kDistinct_m; });
  }

  // By how much another place must be better than the given one. Where that is known from more than these walls, a single wall does not
  // overrule it: the margin is what one wall's word weighs, the odds of standing as planned against being anywhere else.
  double KeepMargin_nats() const {
    if (!options_.place) return kKeepMargin_nats;
    const CouplingOptions& c = options_.coupling;
    return std::log((1 - c.deviated_ratio) / (c.deviated_ratio / 3) * c.offset_tau1_m / c.offset_tau0_m);
  }

  double TruncatedYaw(double yaw) const {
    double sum = 0;
    for (const Row& r : rows_) {
      const double variance = r.cov(1, 1) + options_.coupling.yaw_tau0_rad * options_.coupling.yaw_tau0_rad, e = r.e.y() + yaw;
      sum += std::min(e * e / variance, kTruncation * kTruncation);
    }
    return sum;
  }

  double TruncatedOffset(const Correction& x) const {
    const double tolerance2 =
        options_.coupling.offset_tau0_m * options_.coupling.offset_tau0_m + options_.bias_sigma_m * options_.bias_sigma_m;
    double sum = 0;
    for (const Row& r : rows_) {
      const double e = r.At(x).x();
      sum += std::min(e * e / (r.cov(0, 0) + tolerance2), kTruncation * kTruncation);
    }
    return sum;
  }

  double ConsensusYaw() const {
    double best = 0, best_score = TruncatedYaw(0);
    for (const Row& r : rows_) {
      const double score = TruncatedYaw(-r.e.y());
      if (score < best_score - 1e-9) {
        best_score = score;
        best = -r.e.y();
      }
    }
    double sum = 0, weights = 0;  // refit on those that agree
    for (const Row& r : rows_) {
      const double variance = r.cov(1, 1) + options_.coupling.yaw_tau0_rad * options_.coupling.yaw_tau0_rad, e = r.e.y() + best;
      if (e * e > kTruncation * kTruncation * variance) continue;
      sum += e / variance;
      weights += 1 / variance;
    }
    return weights > 0 ? best - sum / weights : best;
  }

  // Best first, by truncated cost; no two closer than kDistinct_m.
  std::vector<Correction> Proposals() const {
    std::vector<size_t> proposers(rows_.size());
    for (size_t i = 0; i < proposers.size(); ++i) proposers[i] = i;
    std::stable_sort(proposers.begin(), proposers.end(), [&](size_t a, size_t b) { return rows_[a].cov(0, 0) < rows_[b].cov(0, 0); });
    if (proposers.size() > kMaxProposers) proposers.resize(kMaxProposers);

    std::vector<std::pair<double, Correction>> scored;
    for (const double yaw : {ConsensusYaw(), 0.0}) {
      for (size_t i = 0; i < proposers.size(); ++i) {
        const Row& a = rows_[proposers[i]];
        const Eigen::Vector2d na = a.J.block<1, 2>(0, 0);
        const double ea = a.e.x() + yaw * a.J(0, 2);
        const auto propose = [&](const Eigen::Vector2d& d) {
          const Correction x(d.x(), d.y(), yaw, 0);
          scored.emplace_back(TruncatedOffset(x), x);
        };
        propose(-ea * na);
        for (size_t j = i + 1; j < proposers.size(); ++j) {
          const Row& b = rows_[proposers[j]];
          Eigen::Matrix2d n;
          n << na.transpose(), b.J.block<1, 2>(0, 0);
          if (std::abs(n.determinant()) > kMinSine) propose(-n.inverse() * Eigen::Vector2d(ea, b.e.x() + yaw * b.J(0, 2)));
        }
      }
    }
    std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Correction> out;
    for (const auto& [score, x] : scored) {
      const bool seen =
          std::any_of(out.begin(), out.end(), [&x = x](const Correction& o) { return (o - x).head<2>().norm() < kDistinct_m; });
      if (!seen) out.push_back(x);
      if (out.size() == kMaxPolished) break;
    }
    return out;
  }

  Eigen::Vector4d PriorPrecision() const {
    const double place = 1 / (options_.place_sigma_m * options_.place_sigma_m);
    return {place, place, 1 / (kPlacePrior_rad * kPlacePrior_rad), 1 / (options_.bias_sigma_m * options_.bias_sigma_m)};
  }

  // EM on the wall-level mixture; the tolerance of "as planned" starts wide enough for the bias and shrinks.
  Correction Polish(Correction x) const {
    CouplingOptions mixture = options_.coupling;
    for (const double extra : kToleranceSchedule_m) {
      mixture.offset_tau0_m = std::min(std::hypot(options_.coupling.offset_tau0_m, extra), 0.5 * options_.coupling.offset_tau1_m);
      Eigen::Matrix4d lhs = PriorPrecision().asDiagonal();
      Eigen::Vector4d rhs = PriorPrecision().cwiseProduct(prior_);
      for (const Row& r : rows_) {
        const Eigen::Vector2d precision = PriorInformation(AssessMixture(r.At(x), r.cov, mixture), mixture);
        Eigen::Matrix2d s = r.cov;
        s.diagonal() += precision.cwiseInverse();
        const Eigen::Matrix<double, 4, 2> weighted = r.J.transpose() * s.inverse();
        lhs += weighted * r.J;
        rhs -= weighted * r.e;
        // Cauchy weight: faces of which one is wrongly associated show any thickness.
        const double weight = r.own_bias_information / (1 + r.BiasError2(x) / (kTruncation * kTruncation));
        lhs(3, 3) += weight;
        rhs[3] += weight * r.own_bias_m;
      }
      x = lhs.ldlt().solve(rhs);
    }
    return x;
  }

  double Cost(const Correction& x) const {
    const Correction off = x - prior_;
    double sum = 0.5 * off.dot(PriorPrecision().cwiseProduct(off));
    for (const Row& r : rows_) {
      sum += AssessMixture(r.At(x), r.cov, options_.coupling).cost_nats;
      sum += 0.5 * kTruncation * kTruncation * std::log1p(r.BiasError2(x) / (kTruncation * kTruncation));
    }
    return sum;
  }

  std::vector<Row> rows_;
  Correction prior_;
  const JointOptions& options_;
};

Eigen::Vector3d CenterOf(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const WallMeasurement& w : walls) center.head<2>() += frames[w.wall.index()].pivot.head<2>();
  return center / static_cast<double>(walls.size());
}

Seeder MakeSeeder(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames, const Eigen::Isometry3d& T_plan_map,
                  const JointOptions& options) {
  const Eigen::Vector3d c = CenterOf(walls, frames);
  Correction prior = Correction::Zero();
  if (options.place) {
    const Eigen::Isometry3d off = *options.place * T_plan_map.inverse();
    prior << (off * c - c).head<2>(), std::atan2(off.linear()(1, 0), off.linear()(0, 0)), 0;
  }
  return {Rows(walls, frames, c.head<2>()), prior, options};
}

}  // namespace

std::vector<RivalPlace> RivalPlaces(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames,
                                    const Eigen::Isometry3d& T_plan_map, const JointOptions& options) {
  return walls.empty() ? std::vector<RivalPlace>() : MakeSeeder(walls, frames, T_plan_map, options).Rivals();
}

PlaceSeed SeedPlace(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames, const Eigen::Isometry3d& T_plan_map,
                    const JointOptions& options) {
  if (walls.empty()) return {T_plan_map, 0};
  const Eigen::Vector3d c = CenterOf(walls, frames);
  const Correction x = MakeSeeder(walls, frames, T_plan_map, options).Solve();
  const Eigen::Isometry3d turn = Eigen::Translation3d(c + Eigen::Vector3d(x[0], x[1], 0)) *
                                 Eigen::AngleAxisd(x[2], Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-c);
  return {turn * T_plan_map, x[3]};
}

std::vector<DirectionSupport> SupportByDirection(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames,
                                                 double bias_m, const CouplingOptions& options) {
  constexpr double kSameAxis_rad = 0.175;
  struct Group {
    DirectionSupport support;
    Eigen::Vector2d axis;
    std::vector<std::pair<double, double>> others;  // (offset along the axis, its variance)
  };
  std::vector<Group> groups;
  for (const WallMeasurement& w : walls) {
    const Eigen::Vector2d n = frames[w.wall.index()].normal.head<2>().normalized();
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return std::abs(g.axis.dot(n)) > std::cos(kSameAxis_rad); });
    if (group == groups.end()) {
      group = groups.emplace(groups.end());
      const double angle = std::fmod(std::atan2(n.y(), n.x()) + 2 * std::numbers::pi, std::numbers::pi);
      // An axis along x may come out just below pi by rounding.
      group->support.axis_rad = angle > std::numbers::pi - 1e-9 ? 0 : angle;
      group->axis = {std::cos(group->support.axis_rad), std::sin(group->support.axis_rad)};
    }
    const Eigen::Vector2d e = w.At(bias_m);
    const double variance = w.covariance(0, 0) + options.offset_tau0_m * options.offset_tau0_m;
    if (e.x() * e.x() <= kTruncation * kTruncation * variance) {
      ++group->support.consistent;
    } else {
      group->others.emplace_back(e.x() * group->axis.dot(n), variance);
    }
  }
  std::vector<DirectionSupport> out;
  for (Group& g : groups) {
    for (const auto& [at, variance] : g.others) {
      const auto agree = std::count_if(g.others.begin(), g.others.end(), [&, at = at, variance = variance](const auto& o) {
        return (o.first - at) * (o.first - at) <= kTruncation * kTruncation * (o.second + variance);
      });
      g.support.next_cluster = std::max(g.support.next_cluster, static_cast<int>(agree));
    }
    out.push_back(g.support);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.axis_rad < b.axis_rad; });
  return out;
}

}  // namespace plumb::runtime
