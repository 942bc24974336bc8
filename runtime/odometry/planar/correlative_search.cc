#include "runtime/odometry/planar/correlative_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace plumb::runtime {
namespace {

constexpr double kCell_m = 0.05;
constexpr int kNumLevels = 6;              // the coarsest cells are 1.6 m wide
constexpr int kPadding = 1 << (kNumLevels - 1);
constexpr double kSigma_m = 0.06;          // of a point about the map: noise, and where neither cells nor turns are finer
constexpr int kKernelRadius = 3;           // cells
constexpr double kPointNats = 0.5;         // a point on the map against one off it: less than its likelihood says, as neighbours err alike
constexpr double kFarRange_m = 12.0;       // points further off may move by more than a cell between turns
constexpr double kFreedom = 3.0;           // of Student's t

}  // namespace

double PlanarPrior::LogDensity(double distance2_m2, double turn_rad) const {
  // Position has two dimensions, heading one: the exponents of the t densities.
  return -0.5 * (kFreedom + 2) * std::log1p(distance2_m2 / (kFreedom * sigma_m * sigma_m)) -
         0.5 * (kFreedom + 1) * std::log1p(turn_rad * turn_rad / (kFreedom * sigma_rad * sigma_rad));
}

LikelihoodGrid::LikelihoodGrid(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& center, double max_range_m) {
  std::vector<Eigen::Vector2d> near;
  Eigen::Vector2d lo = center, hi = center;
  for (const Eigen::Vector2d& p : points) {
    if ((p - center).cwiseAbs().maxCoeff() > max_range_m) continue;
    near.push_back(p);
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  const double margin_m = kCell_m * (kPadding + kKernelRadius + 1);
  origin_ = lo.array() - margin_m;
  width_ = static_cast<int>((hi.x() - lo.x() + 2 * margin_m) / kCell_m) + 1;
  height_ = static_cast<int>((hi.y() - lo.y() + 2 * margin_m) / kCell_m) + 1;
  constexpr int kSide = 2 * kKernelRadius + 1;
  std::array<uint8_t, kSide * kSide> kernel{};
  for (int i = 0; i < kSide * kSide; ++i) {
    const int dx = i % kSide - kKernelRadius, dy = i / kSide - kKernelRadius;
    kernel[static_cast<size_t>(i)] =
        static_cast<uint8_t>(std::lround(255 * std::exp(-0.5 * (dx * dx + dy * dy) * std::pow(kCell_m / kSigma_m, 2))));
  }
  std::vector<uint8_t> finest(static_cast<size_t>(width_) * static_cast<size_t>(height_), 0);
  std::vector<bool> done(finest.size(), false);
  for (const Eigen::Vector2d& p : near) {
    const Eigen::Vector2i at = ((p - origin_) / kCell_m).cast<int>();
    const size_t cell = static_cast<size_t>(at.y() * width_ + at.x());
    if (done[cell]) continue;
    done[cell] = true;
    for (int i = 0; i < kSide * kSide; ++i) {
      uint8_t& value = finest[cell + static_cast<size_t>((i / kSide - kKernelRadius) * width_ + i % kSide - kKernelRadius)];
      value = std::max(value, kernel[static_cast<size_t>(i)]);
    }
  }
  levels_.push_back(std::move(finest));
  for (int level = 1; level < kNumLevels; ++level) {
    const std::vector<uint8_t>& finer = levels_.back();
    const int step = 1 << (level - 1);
    std::vector<uint8_t> across(finer), coarser(finer.size());
    for (size_t i = 0; i + static_cast<size_t>(step) < finer.size(); ++i)
      across[i] = std::max(finer[i], finer[i + static_cast<size_t>(step)]);
    coarser = across;
    const size_t down = static_cast<size_t>(step) * static_cast<size_t>(width_);
    for (size_t i = 0; i + down < finer.size(); ++i) coarser[i] = std::max(across[i], across[i + down]);
    levels_.push_back(std::move(coarser));
  }
}

// The scan turned, in cells.
struct LikelihoodGrid::Turned {
  double turn_rad = 0;
  std::vector<Eigen::Vector2i> cells;
};

// Shifts by (x, y) to (x, y) + 2^level - 1 cells.
struct LikelihoodGrid::Node {
  uint32_t turned = 0;
  int level = 0, x = 0, y = 0;
  double score = 0;  // of the best of them at most
  uint64_t number = 0;
  [[nodiscard]] bool operator<(const Node& other) const { return score != other.score ? score < other.score : number > other.number; }
};

double LikelihoodGrid::Score(const Turned& turned, const Node& node, const PlanarPrior& prior) const {
  int sum = 0;
  for (const Eigen::Vector2i& cell : turned.cells) sum += At(node.level, cell.x() + node.x, cell.y() + node.y);
  const int last = (1 << node.level) - 1;
  const double dx = std::clamp(0, node.x, node.x + last), dy = std::clamp(0, node.y, node.y + last);
  return kPointNats * sum / 255.0 + prior.LogDensity((dx * dx + dy * dy) * kCell_m * kCell_m, turned.turn_rad);
}

SearchResult LikelihoodGrid::Search(std::span<const Eigen::Vector2d> points, const PlanarPrior& prior, const SearchWindow& window) const {
  SearchResult result;
  result.pose = prior.mean;
  if (points.empty()) return result;
  double far_m = 1.0;
  for (const Eigen::Vector2d& p : points) far_m = std::max(far_m, std::min(p.norm(), kFarRange_m));
  const double step_rad = kCell_m / far_m;
  const int num_turns = static_cast<int>(std::ceil(window.half_rad / step_rad)),
            reach = static_cast<int>(std::ceil(window.half_m / kCell_m));
  std::vector<Turned> turns;
  for (int k = -num_turns; k <= num_turns; ++k) {
    Turned turned{k * step_rad, {}};
    turned.cells.reserve(points.size());
    const Pose2 at{prior.mean.t_m - origin_, prior.mean.yaw_rad + turned.turn_rad};
    const Eigen::Matrix2d R = at.Rotation();
    for (const Eigen::Vector2d& p : points) turned.cells.emplace_back(((R * p + at.t_m) / kCell_m).array().floor().cast<int>());
    turns.push_back(std::move(turned));
  }
  std::priority_queue<Node> open;
  uint64_t number = 0;
  const auto add = [&](uint32_t turned, int level, int x, int y) {
    if (x > reach || y > reach) return;
    Node node{turned, level, x, y, 0, number++};
    node.score = Score(turns[turned], node, prior);
    open.push(node);
  };
  int top = 0;
  while (top + 1 < kNumLevels && (1 << top) < reach) ++top;
  for (uint32_t turned = 0; turned < turns.size(); ++turned) {
    for (int y = -reach; y <= reach; y += 1 << top) {
      for (int x = -reach; x <= reach; x += 1 << top) add(turned, top, x, y);
    }
  }
  while (open.top().level > 0) {
    const Node node = open.top();
    open.pop();
    const int half = 1 << (node.level - 1);
    for (int k = 0; k < 4; ++k) add(node.turned, node.level - 1, node.x + (k % 2) * half, node.y + (k / 2) * half);
  }
  const Node& best = open.top();
  result.pose = {prior.mean.t_m + kCell_m * Eigen::Vector2d(best.x, best.y), WrapYaw(prior.mean.yaw_rad + turns[best.turned].turn_rad)};
  result.log_score = best.score;
  int sum = 0;
  for (const Eigen::Vector2i& cell : turns[best.turned].cells) sum += At(0, cell.x() + best.x, cell.y() + best.y);
  result.share = sum / (255.0 * static_cast<double>(points.size()));
  return result;
}

}  // namespace plumb::runtime
