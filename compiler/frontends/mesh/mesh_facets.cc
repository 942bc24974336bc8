#include "compiler/frontends/mesh/mesh_facets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kMinCosine = 0.87, kMaxCosine = 0.99995;  // between two facets
constexpr double kMeet_m = 0.03, kThickness_m = 0.03;
constexpr uint32_t kNone = 0xffffffffu;

// Columns with something in them, one after the other.
struct Stretch {
  uint32_t grid = 0;
  Columns columns;
};

// 2i is the start of stretch i, 2i + 1 its end.
class FacetChains {
 public:
  FacetChains(const std::vector<FaceDirection>& directions, std::vector<WallGrid>& grids) : directions_(directions), grids_(grids) {
    for (uint32_t g = 0; g < grids.size(); ++g) {
      for (size_t j = 0; j < grids[g].size(); ++j) {
        if (grids[g].state(j) == WallState::kEmpty) continue;
        Columns run{j, j};
        while (run.last + 1 < grids[g].size() && grids[g].state(run.last + 1) != WallState::kEmpty) ++run.last;
        j = run.last;
        stretches_.push_back({g, run});
      }
    }
    FindMates();
  }

  void Hold(double max_opening_m) {
    std::vector<bool> seen(stretches_.size(), false);
    for (const bool closed : {false, true}) {
      for (uint32_t i = 0; i < stretches_.size(); ++i) {
        for (const uint32_t end : {2 * i, 2 * i + 1}) {
          if (seen[i] || (!closed && mate_[end] != kNone) || (mate_[2 * i] == kNone && mate_[2 * i + 1] == kNone)) continue;
          HoldAlong(Walk(end, seen), closed, max_opening_m);
        }
      }
    }
  }

 private:
  struct Place {
    uint32_t stretch;
    size_t column;
  };

  const WallGrid& GridOf(uint32_t stretch) const { return grids_[stretches_[stretch].grid]; }

  Vector2d EndAt(uint32_t end) const {
    const Stretch& s = stretches_[end / 2];
    const WallGrid& grid = grids_[s.grid];
    const double s_m = end % 2 == 0 ? grid.Start(s.columns.first) : grid.End(s.columns.last);
    return directions_[grid.band().direction].At(s_m, 0.5 * (grid.band().c0_m + grid.band().c1_m));
  }

  // Each end's closest that goes on askew, if that is so both ways.
  void FindMates() {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (uint32_t e = 0; e < 2 * stretches_.size(); ++e) boxes.emplace_back(EndAt(e));
    const BoxTree<2> tree(std::move(boxes));
    std::vector<uint32_t> closest(2 * stretches_.size(), kNone);
    for (uint32_t e = 0; e < closest.size(); ++e) {
      const Band& b = GridOf(e / 2).band();
      const Vector2d at = EndAt(e), reach = Vector2d::Constant(kMeet_m + 0.5 * (b.c1_m - b.c0_m));
      double least_m = reach.x();
      tree.ForEachIn({at - reach, at + reach}, [&](uint32_t f) {
        const double off_m = (EndAt(f) - at).norm();
        if (f / 2 == e / 2 || !GoOn(e, f) || off_m > least_m || (off_m == least_m && f > closest[e])) return;
        least_m = off_m;
        closest[e] = f;
      });
    }
    mate_.assign(closest.size(), kNone);
    for (uint32_t e = 0; e < closest.size(); ++e) {
      if (closest[e] != kNone && closest[closest[e]] == e) mate_[e] = closest[e];
    }
  }

  bool GoOn(uint32_t e, uint32_t f) const {
    const Band &a = GridOf(e / 2).band(), &b = GridOf(f / 2).band();
    const double thickness_m = a.c1_m - a.c0_m;
    if (a.group != b.group || a.direction == b.direction || std::abs(b.c1_m - b.c0_m - thickness_m) > kThickness_m) return false;
    const Vector2d u = directions_[a.direction].along, v = directions_[b.direction].along;
    const double cosine = (e % 2 == 0 ? -1 : 1) * (f % 2 == 0 ? 1 : -1) * u.dot(v);  // of the way out of e and into f
    const double reach_m = kMeet_m + 0.5 * thickness_m * std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return cosine > kMinCosine && cosine < kMaxCosine && (EndAt(e) - EndAt(f)).norm() < reach_m;
  }

  // All columns of the chain that begins with this end, in order.
  std::vector<Place> Walk(uint32_t start, std::vector<bool>& seen) const {
    std::vector<Place> out;
    for (uint32_t end = start; end != kNone && !seen[end / 2]; end = mate_[end ^ 1u]) {
      seen[end / 2] = true;
      const Columns& c = stretches_[end / 2].columns;
      for (size_t k = 0; k <= c.last - c.first; ++k) out.push_back({end / 2, end % 2 == 0 ? c.first + k : c.last - k});
    }
    return out;
  }

  void HoldAlong(std::vector<Place> chain, bool closed, double max_opening_m) {
    const auto is_core = [&](const Place& p) { return GridOf(p.stretch).state(p.column) == WallState::kCore; };
    const auto first = std::find_if(chain.begin(), chain.end(), is_core);
    if (first == chain.end()) return;
    if (closed) {
      std::rotate(chain.begin(), first, chain.end());
      chain.push_back(chain.front());
    }
    size_t core = chain.size();
    double open_m = 0;
    for (size_t k = 0; k < chain.size(); ++k) {
      const WallGrid& grid = GridOf(chain[k].stretch);
      if (!is_core(chain[k])) {
        open_m += grid.End(chain[k].column) - grid.Start(chain[k].column);
        continue;
      }
      const bool askew = core < k && chain[core].stretch != chain[k].stretch;
      for (size_t i = core + 1; askew && open_m <= max_opening_m && i < k; ++i) grids_[stretches_[chain[i].stretch].grid].Hold(chain[i].column);
      core = k;
      open_m = 0;
    }
  }

  const std::vector<FaceDirection>& directions_;
  std::vector<WallGrid>& grids_;
  std::vector<Stretch> stretches_;
  std::vector<uint32_t> mate_;  // by end: the one that it goes on in
};

}  // namespace

void HoldFacets(const std::vector<FaceDirection>& directions, double max_opening_m, std::vector<WallGrid>& grids) {
  FacetChains(directions, grids).Hold(max_opening_m);
}

}  // namespace plumb::compiler
