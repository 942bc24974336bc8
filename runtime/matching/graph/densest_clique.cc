#include "runtime/matching/graph/densest_clique.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb::runtime {
namespace {

constexpr double kZero = 1e-9;    // entries below are none
constexpr double kShrink = 0.25;  // of a step that went down
constexpr int kMaxShrinks = 40, kPowerSteps = 50;

class Relaxation {
 public:
  Relaxation(const Eigen::MatrixXd& affinity, const DensestCliqueOptions& options)
      : affinity_(affinity), conflicts_((affinity.array() <= 0).cast<double>()), options_(options) {}

  // From `u`, which is no zero vector, to a maximum without conflicts.
  [[nodiscard]] Eigen::VectorXd Solve(Eigen::VectorXd u) const {
    u.normalize();
    double penalty = 0;
    for (int i = 0; i < options_.max_penalties; ++i) {
      const double more = Balance(u);
      if (more <= 0 && i > 0) break;
      penalty += more;
      u = Ascend(std::move(u), penalty);
    }
    return u;
  }

 private:
  // The penalty at which conflicts weigh as much as what speaks for them, mean over the entries that have any; 0 without conflicts.
  [[nodiscard]] double Balance(const Eigen::VectorXd& u) const {
    const Eigen::VectorXd gain = affinity_ * u, conflict = conflicts_ * u;
    double sum = 0;
    int count = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      if (u(i) <= kZero || conflict(i) <= kZero) continue;
      sum += gain(i) / conflict(i);
      ++count;
    }
    return count > 0 ? sum / count : 0;
  }

  [[nodiscard]] Eigen::VectorXd Ascend(Eigen::VectorXd u, double penalty) const {
    const auto gradient = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd { return affinity_ * at - penalty * (conflicts_ * at); };
    Eigen::VectorXd slope = gradient(u);
    double value = u.dot(slope);
    for (int step = 0; step < options_.max_steps; ++step) {
      Eigen::VectorXd next, next_slope;
      double length = 1;
      bool up = false;
      for (int shrink = 0; shrink < kMaxShrinks && !up; ++shrink, length *= kShrink) {
        next = (u + length * slope).cwiseMax(0.0);
        const double norm = next.norm();
        if (norm <= kZero) continue;
        next /= norm;
        next_slope = gradient(next);
        up = next.dot(next_slope) >= value;
      }
      if (!up) break;
      const double change = (next - u).cwiseAbs().maxCoeff();
      u = std::move(next);
      slope = std::move(next_slope);
      value = u.dot(slope);
      if (change < options_.tolerance) break;
    }
    return u;
  }

  const Eigen::MatrixXd& affinity_;
  const Eigen::MatrixXd conflicts_;
  const DensestCliqueOptions& options_;
};

Clique Round(const Eigen::MatrixXd& affinity, const Eigen::VectorXd& u) {
  std::vector<size_t> order(static_cast<size_t>(u.size()));
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return u(static_cast<Eigen::Index>(a)) > u(static_cast<Eigen::Index>(b)); });
  Clique clique;
  double weight = 0;  // of the members' part of the matrix
  for (size_t candidate : order) {
    double sum = 0;
    const bool agrees = std::all_of(clique.members.begin(), clique.members.end(), [&](size_t member) {
      const double w = affinity(static_cast<Eigen::Index>(candidate), static_cast<Eigen::Index>(member));
      sum += w;
      return w > 0;
    });
    const double denser = (weight + 2 * sum + 1) / static_cast<double>(clique.members.size() + 1);
    if (!agrees || denser <= clique.density) continue;
    clique.members.push_back(candidate);
    clique.density = denser;
    weight += 2 * sum + 1;
  }
  std::sort(clique.members.begin(), clique.members.end());
  return clique;
}

Eigen::VectorXd LeadingEigenvector(const Eigen::MatrixXd& affinity) {
  Eigen::VectorXd u = Eigen::VectorXd::Ones(affinity.rows());
  for (int i = 0; i < kPowerSteps; ++i) u = (affinity * u).normalized();
  return u;
}

std::vector<Eigen::Index> HeaviestFirst(const Eigen::MatrixXd& affinity) {
  const Eigen::VectorXd weights = affinity.rowwise().sum();
  std::vector<Eigen::Index> order(static_cast<size_t>(affinity.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return weights(a) > weights(b); });
  return order;
}

}  // namespace

Clique DensestClique(const Eigen::MatrixXd& affinity, const DensestCliqueOptions& options) {
  if (affinity.rows() == 0) return {};
  const Eigen::VectorXd leading = LeadingEigenvector(affinity);
  if ((affinity.array() > 0).all()) return Round(affinity, leading);  // without conflicts that is the maximum
  const Relaxation relaxation(affinity, options);
  const std::vector<Eigen::Index> heaviest = HeaviestFirst(affinity);
  Clique best = Round(affinity, relaxation.Solve(leading));
  for (size_t i = 0; i + 1 < static_cast<size_t>(options.starts) && i < heaviest.size(); ++i) {
    Clique clique = Round(affinity, relaxation.Solve(affinity.col(heaviest[i])));
    if (clique.density > best.density) best = std::move(clique);
  }
  return best;
}

std::vector<Clique> CoveringCliques(const Eigen::MatrixXd& affinity, const DensestCliqueOptions& options) {
  std::vector<Clique> cliques;
  std::vector<bool> covered(static_cast<size_t>(affinity.rows()), false);
  for (Eigen::Index seed : HeaviestFirst(affinity)) {
    if (covered[static_cast<size_t>(seed)]) continue;
    std::vector<Eigen::Index> near;
    for (Eigen::Index i = 0; i < affinity.rows(); ++i) {
      if (i != seed && affinity(seed, i) > 0) near.push_back(i);
    }
    // The densest clique of the neighbours, and the seed: it agrees with all of them.
    Clique clique = DensestClique(affinity(near, near), options);
    double to_seed = 0;
    for (size_t& member : clique.members) {
      member = static_cast<size_t>(near[member]);
      to_seed += affinity(seed, static_cast<Eigen::Index>(member));
    }
    const auto size = static_cast<double>(clique.members.size());
    clique.density = (size * clique.density + 2 * to_seed + 1) / (size + 1);
    clique.members.insert(std::upper_bound(clique.members.begin(), clique.members.end(), static_cast<size_t>(seed)),
                          static_cast<size_t>(seed));
    for (size_t member : clique.members) covered[member] = true;
    cliques.push_back(std::move(clique));
  }
  return cliques;
}

}  // namespace plumb::runtime
