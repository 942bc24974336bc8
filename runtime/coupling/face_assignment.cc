#include "runtime/coupling/face_assignment.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kMinSizeShare = 0.5;           // a line behind another is the wall if it has this share of the front's area, ...
constexpr double kHigher_m = 0.10;              // ... or is seen this much higher up
constexpr double kFrontPenalty_nats = 8;        // for taking a surface with a wall visible behind it for the wall
constexpr double kSeenThroughPenalty_nats = 8;  // for taking a surface for the wall past which other lines of sight go on
constexpr double kSameDirection_rad = 0.052, kDirectionSigmas = 2;  // patches of one line are parallel to this
constexpr double kStepPerMetre = 0.01;                              // lines are compared at a distance: allow for their direction errors

// Collinear patches on one side of one wall.
struct Line {
  std::vector<size_t> patches;  // the first is the largest and gives the line
  double area = 0, z_max = -1e300;
};

// Of one direction, as far as patches of their lengths can tell?
bool IsParallel(const Patch& a, const Patch& b) {
  const double turn = std::atan2(a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x(), a.normal.head<2>().dot(b.normal.head<2>()));
  return std::abs(turn) < kSameDirection_rad + kDirectionSigmas * kMapSigma_m * (1 / a.length() + 1 / b.length());
}

// Signed distance of b's middle from a's line, + in front of it (into the free space), beyond what their distance excuses.
double Step(const Patch& a, const Patch& b, double max_step_m) {
  const Eigen::Vector2d arm = b.midpoint() - a.midpoint();
  const double step = a.normal.head<2>().normalized().dot(arm);
  const double excess = std::abs(step) - kStepPerMetre * arm.norm();
  return excess > max_step_m ? std::copysign(excess, step) : 0.0;
}

class Assignment {
 public:
  Assignment(const std::vector<Patch>& patches, AssignedFaces candidates, const IsSeenThroughBy& is_seen_through,
             const CouplingOptions& options)
      : patches_(patches), candidates_(std::move(candidates)), is_seen_through_(is_seen_through), options_(options) {
    for (auto& list : candidates_) {
      std::erase_if(list, [&](const FaceCandidate& c) { return c.cost_nats > options_.unmatched_cost_nats; });
      std::stable_sort(list.begin(), list.end(), [](const FaceCandidate& a, const FaceCandidate& b) { return a.cost_nats < b.cost_nats; });
    }
  }

  // Each patch takes its cheapest candidate; sides whose patches do not line up keep one line and the others move on. Every turn removes
  // at least one candidate, so it ends.
  const AssignedFaces& Solve() {
    while (ResolveOneSide()) {
    }
    return candidates_;
  }

 private:
  bool ResolveOneSide() {
    std::vector<std::pair<int, size_t>> by_side;
    for (size_t i = 0; i < patches_.size(); ++i) {
      if (!candidates_[i].empty()) by_side.emplace_back(candidates_[i].front().side, i);
    }
    std::sort(by_side.begin(), by_side.end());
    for (size_t from = 0, to = 0; from < by_side.size(); from = to) {
      std::vector<size_t> members;
      for (to = from; to < by_side.size() && by_side[to].first == by_side[from].first; ++to) members.push_back(by_side[to].second);
      const std::vector<Line> lines = Lines(members);
      if (lines.size() < 2) continue;
      const size_t wall = ChooseWall(lines, by_side[from].first);
      for (size_t k = 0; k < lines.size(); ++k) {
        if (k != wall)
          for (size_t i : lines[k].patches) DropSide(i, by_side[from].first);
      }
      return true;
    }
    return false;
  }

  void DropSide(size_t patch, int side) {
    std::erase_if(candidates_[patch], [&](const FaceCandidate& c) { return c.side == side; });
  }

  std::vector<Line> Lines(std::vector<size_t> members) const {
    std::stable_sort(members.begin(), members.end(), [&](size_t a, size_t b) { return patches_[a].area > patches_[b].area; });
    std::vector<Line> lines;
    for (size_t i : members) {
      auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
        const Patch& first = patches_[l.patches.front()];
        return Step(first, patches_[i], options_.max_step_m) == 0 && IsParallel(first, patches_[i]);
      });
      if (line == lines.end()) line = lines.emplace(lines.end());
      line->patches.push_back(i);
      line->area += patches_[i].area;
      line->z_max = std::max(line->z_max, patches_[i].z_max);
    }
    return lines;
  }

  // Mean cost of a line's patches on this side, or of their best candidates elsewhere.
  double Cost(const Line& line, int side, bool elsewhere) const {
    double sum = 0;
    for (size_t i : line.patches) {
      const auto& list = candidates_[i];
      const auto other = std::find_if(list.begin(), list.end(), [&](const FaceCandidate& c) { return c.side != side; });
      sum += !elsewhere ? list.front().cost_nats : other == list.end() ? options_.unmatched_cost_nats : other->cost_nats;
    }
    return sum / static_cast<double>(line.patches.size());
  }

  // Is `behind` a wall seen past `front`?
  bool Hides(const Line& front, const Line& behind) const {
    const Patch &f = patches_[front.patches.front()], &b = patches_[behind.patches.front()];
    const bool is_behind = b.normal.head<2>().dot(b.midpoint() - f.midpoint()) < 0;
    return is_behind && (behind.z_max > front.z_max + kHigher_m || behind.area >= kMinSizeShare * front.area);
  }

  size_t ChooseWall(const std::vector<Line>& lines, int side) const {
    size_t best = 0;
    double best_cost = 1e300;
    for (size_t k = 0; k < lines.size(); ++k) {
      const size_t first = lines[k].patches.front();
      const FaceCandidate& face = candidates_[first].front();
      double cost = Cost(lines[k], side, false);
      bool hides = false;
      for (size_t j = 0; j < lines.size(); ++j) {
        if (j == k) continue;
        const double elsewhere = Cost(lines[j], side, true);
        cost += elsewhere;
        hides |= elsewhere >= options_.unmatched_cost_nats && Hides(lines[k], lines[j]);
      }
      if (hides && !face.glass) cost += kFrontPenalty_nats;
      // Of a wall that is turned, part of a line where it was planned is in front: what is seen beyond the other part tells.
      if (!face.glass && is_seen_through_(patches_[first], face.surface)) cost += kSeenThroughPenalty_nats;
      if (cost < best_cost - 1e-9) {
        best_cost = cost;
        best = k;
      }
    }
    return best;
  }

  const std::vector<Patch>& patches_;
  AssignedFaces candidates_;
  const IsSeenThroughBy& is_seen_through_;
  const CouplingOptions& options_;
};

}  // namespace

AssignedFaces AssignFaces(const std::vector<Patch>& patches, AssignedFaces candidates, const IsSeenThroughBy& is_seen_through,
                          const CouplingOptions& options) {
  return Assignment(patches, std::move(candidates), is_seen_through, options).Solve();
}

}  // namespace plumb::runtime
