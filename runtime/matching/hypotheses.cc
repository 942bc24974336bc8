#include "runtime/matching/hypotheses.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

constexpr int kMaxYaws = 12;
constexpr double kYawPeakRatio = 0.35;       // of the highest peak: lower ones are not worth a search
constexpr double kYawSmoothing_rad = 0.035;
constexpr double kYawPeakWidth_rad = 0.06;   // over which a peak's centre is averaged
constexpr double kYawGate_rad = 0.09;        // a pair votes for a yaw this close to its own
constexpr double kYawSuppression_rad = 0.07;
constexpr double kMinOverlap_m = 0.3;
constexpr double kMinHeightOverlap_m = 0.3;    // or half of the wall's, if that is less
constexpr double kTypicalSensorHeight_m = 0.6;
constexpr double kPeakRatio = 0.35;          // of the highest cell
constexpr double kMaxCells = 4e6;            // of one grid; larger plans get larger cells

bool HeightsOverlap(const MapWall& wall, double z_m, const PlanFace& face) {
  const double overlap_m = std::min(wall.z_max_m + z_m, face.z_max_m) - std::max(wall.z_min_m + z_m, face.z_min_m);
  return overlap_m > std::min(kMinHeightOverlap_m, 0.5 * (wall.z_max_m - wall.z_min_m));
}

double YawOf(const MapWall& wall, const PlanFace& face) {
  return std::atan2(Cross(wall.normal, face.normal), wall.normal.dot(face.normal));
}

// Votes of one yaw and level over the position of the map's centre.
class VoteGrid {
 public:
  VoteGrid(const PlanIndex& plan, const MapView& map, const MatcherOptions& options) {
    Eigen::AlignedBox2d box;
    for (const PlanFace& f : plan.faces()) box.extend(f.start).extend(f.end);
    double reach_m = 1.0;
    for (const MapWall& w : map.walls) reach_m = std::max({reach_m, w.start.norm(), w.end.norm()});
    low_ = box.min().array() - reach_m;
    const Eigen::Vector2d size = box.sizes().array() + 2 * reach_m;
    cell_m_ = std::max(options.vote_cell_m, std::sqrt(size.prod() / kMaxCells));
    nx_ = static_cast<int>(size.x() / cell_m_) + 1;
    ny_ = static_cast<int>(size.y() / cell_m_) + 1;
    sigma_m_ = std::max(std::hypot(options.deviation_sigma_m, options.range_sigma_m), cell_m_);
    votes_.assign(static_cast<size_t>(nx_) * ny_, 0.0f);
    scratch_ = votes_;
  }

  // Where `face` takes the map wall from p to q (already turned to the plan): a band along the face, votes are overlapped metres.
  void Add(const PlanFace& face, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    const Eigen::Vector2d &n = face.normal, &u = face.along;
    const double b = -face.d_m - n.dot(0.5 * (p + q));
    const double s0 = std::min(u.dot(p), u.dot(q)), s1 = std::max(u.dot(p), u.dot(q));
    const double a0 = u.dot(face.start), a1 = u.dot(face.end);
    const double min_overlap = std::max(kMinOverlap_m, 0.3 * std::min(s1 - s0, a1 - a0));
    const double tau0 = a0 - s1 + min_overlap, tau1 = a1 - s0 - min_overlap;
    if (tau0 >= tau1) return;
    const double band = 2 * sigma_m_;
    // Ends of the band's axis; scan along the axis that the band runs along.
    const Eigen::Vector2d e0 = b * n + tau0 * u, e1 = b * n + tau1 * u;
    const int major = std::abs(u.x()) >= std::abs(u.y()) ? 0 : 1, minor = 1 - major;
    const double lo = std::min(e0[major], e1[major]) - band * std::abs(n[major]);
    const double hi = std::max(e0[major], e1[major]) + band * std::abs(n[major]);
    for (int i = CellFrom(lo, major); i <= CellTo(hi, major); ++i) {
      const double x = Center(i, major);
      const double mid = (b - n[major] * x) / n[minor], half = band / std::abs(n[minor]);
      for (int j = CellFrom(mid - half, minor); j <= CellTo(mid + half, minor); ++j) {
        Eigen::Vector2d t;
        t[major] = x;
        t[minor] = Center(j, minor);
        const double tau = u.dot(t), r = (n.dot(t) - b) / band;
        const double overlap = std::min(a1, s1 + tau) - std::max(a0, s0 + tau);
        if (overlap < min_overlap || std::abs(r) >= 1) continue;
        const double kernel = (1 - r * r) * (1 - r * r);
        const size_t cell = major == 0 ? Index(i, j) : Index(j, i);
        if (scratch_[cell] == 0) touched_.push_back(cell);
        scratch_[cell] += static_cast<float>(overlap * kernel);
      }
    }
  }

  // A map wall votes for a cell with no more than its own length, however many plan faces lie there.
  void EndWall(double length_m) {
    for (size_t cell : touched_) {
      votes_[cell] += std::min(scratch_[cell], static_cast<float>(length_m));
      scratch_[cell] = 0;
    }
    touched_.clear();
  }

  void AppendPeaks(double yaw_rad, double z_m, size_t level, std::vector<Proposal>& out) const {
    const float floor = static_cast<float>(kPeakRatio) * *std::max_element(votes_.begin(), votes_.end());
    if (floor <= 0) return;
    for (int y = 1; y + 1 < ny_; ++y) {
      for (int x = 1; x + 1 < nx_; ++x) {
        const float v = votes_[Index(x, y)];
        if (v < floor || !IsPeak(x, y)) continue;
        out.push_back({{yaw_rad, {Center(x, 0), Center(y, 1)}, z_m}, level, v});
      }
    }
  }

 private:
  [[nodiscard]] size_t Index(int x, int y) const { return static_cast<size_t>(y) * nx_ + x; }
  [[nodiscard]] double Center(int i, int axis) const { return low_[axis] + (i + 0.5) * cell_m_; }
  [[nodiscard]] int CellFrom(double v, int axis) const { return std::max(0, static_cast<int>(std::floor((v - low_[axis]) / cell_m_))); }
  [[nodiscard]] int CellTo(double v, int axis) const {
    return std::min((axis == 0 ? nx_ : ny_) - 1, static_cast<int>(std::floor((v - low_[axis]) / cell_m_)));
  }
  // Of equal neighbours the first is the peak.
  [[nodiscard]] bool IsPeak(int x, int y) const {
    const float v = votes_[Index(x, y)];
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const float other = votes_[Index(x + dx, y + dy)];
        const bool before = dy < 0 || (dy == 0 && dx < 0);
        if (other > v || (before && other == v)) return false;
      }
    }
    return true;
  }

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double cell_m_ = 0.1, sigma_m_ = 0.1;
  int nx_ = 0, ny_ = 0;
  std::vector<float> votes_, scratch_;
  std::vector<size_t> touched_;
};

std::vector<Proposal> VoteAt(const PlanIndex& plan, const MapView& map, const MatcherOptions& options, double yaw_rad, size_t level) {
  PlanarPose pose;
  pose.yaw_rad = yaw_rad;
  pose.z_m = HeightOnLevel(map, plan.levels()[level]);
  const Eigen::Matrix2d R = pose.rotation();
  VoteGrid grid(plan, map, options);
  for (const MapWall& wall : map.walls) {
    for (const PlanFace& face : plan.faces()) {
      if (!HeightsOverlap(wall, pose.z_m, face)) continue;
      if (std::abs(WrapAngle(YawOf(wall, face) - yaw_rad)) < kYawGate_rad) grid.Add(face, R * wall.start, R * wall.end);
    }
    grid.EndWall(wall.length_m);
  }
  std::vector<Proposal> proposals;
  grid.AppendPeaks(yaw_rad, pose.z_m, level, proposals);
  return proposals;
}

// Keeps the strongest of those that are near each other.
std::vector<Proposal> Suppress(std::vector<Proposal> proposals, const MatcherOptions& options) {
  std::stable_sort(proposals.begin(), proposals.end(), [](const Proposal& a, const Proposal& b) { return a.votes > b.votes; });
  std::vector<Proposal> kept;
  for (const Proposal& p : proposals) {
    const bool near = std::any_of(kept.begin(), kept.end(), [&](const Proposal& k) {
      return k.level == p.level && std::abs(WrapAngle(k.pose.yaw_rad - p.pose.yaw_rad)) < kYawSuppression_rad &&
             (k.pose.t_m - p.pose.t_m).norm() < options.nms_radius_m;
    });
    if (near) continue;
    kept.push_back(p);
    if (static_cast<int>(kept.size()) == options.max_hypotheses) break;
  }
  return kept;
}

}  // namespace

double HeightOnLevel(const MapView& map, const PlanLevel& level) {
  if (map.floor_z_m) return level.floor_z_m - *map.floor_z_m;
  if (map.ceiling_z_m) return level.ceiling_z_m - *map.ceiling_z_m;
  return level.floor_z_m - (map.sensor_z_m - kTypicalSensorHeight_m);
}

std::vector<double> YawPeaks(const PlanIndex& plan, const MapView& map, const MatcherOptions& options) {
  const int bins = std::max(36, static_cast<int>(std::lround(2 * std::numbers::pi / options.yaw_bin_rad)));
  const double bin_rad = 2 * std::numbers::pi / bins;
  struct Vote {
    double yaw_rad, weight;
  };
  std::vector<Vote> votes;
  std::vector<double> histogram(bins, 0.0), smooth(bins, 0.0);
  for (const MapWall& wall : map.walls) {
    for (const PlanFace& face : plan.faces()) {
      votes.push_back({YawOf(wall, face), std::min(wall.length_m, face.length_m)});
      const int bin = static_cast<int>(std::floor((votes.back().yaw_rad + std::numbers::pi) / bin_rad));
      histogram[std::clamp(bin, 0, bins - 1)] += votes.back().weight;
    }
  }
  const int reach = static_cast<int>(std::ceil(2 * kYawSmoothing_rad / bin_rad));
  for (int i = 0; i < bins; ++i) {
    for (int k = -reach; k <= reach; ++k) {
      const double x = k * bin_rad / kYawSmoothing_rad;
      smooth[i] += std::exp(-0.5 * x * x) * histogram[((i + k) % bins + bins) % bins];
    }
  }
  std::vector<double> peaks;
  const double highest = *std::max_element(smooth.begin(), smooth.end());
  while (static_cast<int>(peaks.size()) < kMaxYaws) {
    const int top = static_cast<int>(std::max_element(smooth.begin(), smooth.end()) - smooth.begin());
    if (smooth[top] <= 0 || smooth[top] < kYawPeakRatio * highest) break;
    double yaw_rad = (top + 0.5) * bin_rad - std::numbers::pi;
    double sum = 0, weight = 0;
    for (const Vote& v : votes) {
      const double off_rad = WrapAngle(v.yaw_rad - yaw_rad);
      if (std::abs(off_rad) > kYawPeakWidth_rad) continue;
      sum += v.weight * off_rad;
      weight += v.weight;
    }
    if (weight > 0) yaw_rad = WrapAngle(yaw_rad + sum / weight);
    peaks.push_back(yaw_rad);
    for (int i = 0; i < bins; ++i) {
      const double off_rad = WrapAngle((i - top) * bin_rad);
      if (std::abs(off_rad) < kYawSuppression_rad) smooth[i] = 0;
    }
  }
  return peaks;
}

std::vector<Proposal> ProposePoses(const PlanIndex& plan, const MapView& map, const MatcherOptions& options) {
  if (plan.faces().empty() || map.walls.empty()) return {};
  const std::vector<double> yaws = YawPeaks(plan, map, options);
  const size_t jobs = yaws.size() * plan.levels().size();
  std::vector<std::vector<Proposal>> found(jobs);
  oneapi::tbb::parallel_for(size_t{0}, jobs, [&](size_t job) {
    found[job] = VoteAt(plan, map, options, yaws[job % yaws.size()], job / yaws.size());
  });
  std::vector<Proposal> all;
  for (const std::vector<Proposal>& some : found) all.insert(all.end(), some.begin(), some.end());
  return Suppress(std::move(all), options);
}

}  // namespace plumb::runtime
