#include "runtime/rooms/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "runtime/numerics/distance_transform.h"
#include "runtime/rooms/free_span.h"

namespace plumb::runtime {
namespace {

constexpr double kNeckRatio = 1.5, kDoorInWallRatio = 1.05, kPassageInWallRatio = 1.3;

// Distances from the cells' centres to the near side of the nearest cell that is not free.
std::vector<float> ClearanceOf(const FreeSpace& space) {
  std::vector<uint8_t> blocked(space.cells.size());
  for (size_t i = 0; i < blocked.size(); ++i) blocked[i] = space.cells[i] == CellState::kFree ? 0 : 1;
  std::vector<float> clearance_m = SquaredCellDistances(blocked, static_cast<size_t>(space.grid.width));
  const auto cell_m = static_cast<float>(space.grid.cell_m);
  for (float& d : clearance_m) d = cell_m * std::max(0.0F, std::sqrt(d) - 0.5F);
  return clearance_m;
}

// The free cells, those with most clearance first, in classes of a fifth of a cell; the lower index first in a class.
std::vector<size_t> InOrder(const std::vector<float>& clearance_m, double cell_m) {
  const float per_m = static_cast<float>(5 / cell_m);
  size_t highest = 0;
  for (const float c : clearance_m) highest = std::max(highest, static_cast<size_t>(c * per_m));
  std::vector<size_t> start(highest + 2);
  for (const float c : clearance_m) start[highest - static_cast<size_t>(c * per_m) + 1] += c > 0 ? 1 : 0;
  for (size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<size_t> order(start.back());
  for (size_t i = 0; i < clearance_m.size(); ++i) {
    if (clearance_m[i] > 0) order[start[highest - static_cast<size_t>(clearance_m[i] * per_m)]++] = i;
  }
  return order;
}

class Watershed {
 public:
  Watershed(const FreeSpace& space, const RoomOptions& options, const std::vector<float>& clearance_m)
      : space_(space), options_(options), clearance_m_(clearance_m), label_(clearance_m.size(), Regions::kNone) {}

  // Basins by cell; those of one region have one root.
  void Flood() {
    for (const size_t cell : InOrder(clearance_m_, space_.grid.cell_m)) {
      std::array<int32_t, 8> roots;
      const size_t count = NeighbouringRoots(cell, roots);
      if (count == 0) {
        label_[cell] = static_cast<int32_t>(basins_.size());
        basins_.push_back({label_[cell], clearance_m_[cell]});
        continue;
      }
      for (size_t i = 0; i < count; ++i) {
        for (size_t k = i + 1; k < count; ++k) JoinUnlessApart(Root(roots[i]), Root(roots[k]), cell);
      }
      label_[cell] = Root(label_[Uphill(cell)]);
    }
  }

  std::vector<int32_t> RootLabels() {
    for (int32_t& label : label_) label = label < 0 ? label : Root(label);
    return std::move(label_);
  }

 private:
  struct Basin {
    int32_t parent;
    float peak_m;  // clearance
  };

  int32_t Root(int32_t b) {
    while (basins_[static_cast<size_t>(b)].parent != b) {
      int32_t& parent = basins_[static_cast<size_t>(b)].parent;
      parent = basins_[static_cast<size_t>(parent)].parent;
      b = parent;
    }
    return b;
  }

  size_t NeighbouringRoots(size_t cell, std::array<int32_t, 8>& roots) {
    const FloorGrid& grid = space_.grid;
    size_t count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = grid.X(cell) + dx, y = grid.Y(cell) + dy;
        if ((dx == 0 && dy == 0) || !grid.Contains(x, y)) continue;
        const int32_t label = label_[grid.Index(x, y)];
        if (label < 0) continue;
        const int32_t root = Root(label);
        if (std::find(roots.begin(), roots.begin() + static_cast<ptrdiff_t>(count), root) == roots.begin() + static_cast<ptrdiff_t>(count))
          roots[count++] = root;
      }
    }
    return count;
  }

  // The neighbour in a basin that has most clearance.
  [[nodiscard]] size_t Uphill(size_t cell) const {
    size_t best = cell;
    const FloorGrid& grid = space_.grid;
    for (int y = std::max(0, grid.Y(cell) - 1); y <= std::min(grid.height - 1, grid.Y(cell) + 1); ++y) {
      for (int x = std::max(0, grid.X(cell) - 1); x <= std::min(grid.width - 1, grid.X(cell) + 1); ++x) {
        const size_t i = grid.Index(x, y);
        if (label_[i] >= 0 && (best == cell || clearance_m_[i] > clearance_m_[best])) best = i;
      }
    }
    return best;
  }

  void JoinUnlessApart(int32_t a, int32_t b, size_t cell) {
    if (a == b || KnownApart(a, b)) return;
    if (AreRooms(a, b, cell)) {
      apart_.emplace_back(a, b);
      return;
    }
    const auto [into, from] = std::minmax(a, b);
    basins_[static_cast<size_t>(from)].parent = into;
    basins_[static_cast<size_t>(into)].peak_m =
        std::max(basins_[static_cast<size_t>(into)].peak_m, basins_[static_cast<size_t>(from)].peak_m);
  }

  bool KnownApart(int32_t a, int32_t b) {
    return std::any_of(apart_.begin(), apart_.end(), [&](const std::pair<int32_t, int32_t>& p) {
      const int32_t first = Root(p.first), second = Root(p.second);
      return (first == a && second == b) || (first == b && second == a);
    });
  }

  bool AreRooms(int32_t a, int32_t b, size_t cell) {
    const double narrower_m =
        2 * static_cast<double>(std::min(basins_[static_cast<size_t>(a)].peak_m, basins_[static_cast<size_t>(b)].peak_m));
    const double at_cell_m = 2 * static_cast<double>(clearance_m_[cell]);
    if (narrower_m < kDoorInWallRatio * at_cell_m || at_cell_m > options_.passage_width_m) return false;
    const FreeSpan span = NarrowestSpan(space_, clearance_m_, cell, options_.passage_width_m);
    const double width_m = span.width_m(), ratio = narrower_m / width_m;
    if (width_m > options_.passage_width_m || !HasJambs(space_, span)) return false;
    const bool door_wide = width_m <= options_.door_width_m;
    if (door_wide && ratio >= kNeckRatio) return true;
    return ratio >= (door_wide ? kDoorInWallRatio : kPassageInWallRatio) && IsInWall(space_, span);
  }

  const FreeSpace& space_;
  const RoomOptions& options_;
  const std::vector<float>& clearance_m_;
  std::vector<int32_t> label_;
  std::vector<Basin> basins_;
  std::vector<std::pair<int32_t, int32_t>> apart_;
};

// Calls visit(i, k) for all pairs of cells that share a side and belong to different regions.
template <class Visit>
void ForBorders(const FloorGrid& grid, const std::vector<int32_t>& label, const Visit& visit) {
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const size_t i = grid.Index(x, y);
      if (label[i] < 0) continue;
      for (const auto& [nx, ny] : {std::pair(x + 1, y), std::pair(x, y + 1)}) {
        if (!grid.Contains(nx, ny)) continue;
        const size_t k = grid.Index(nx, ny);
        if (label[k] >= 0 && label[k] != label[i]) visit(i, k);
      }
    }
  }
}

// Numbers 0, 1, ... by first cell; their sizes.
std::vector<size_t> Renumber(std::vector<int32_t>& label) {
  std::vector<int32_t> number;
  std::vector<size_t> sizes;
  for (int32_t& l : label) {
    if (l < 0) continue;
    if (static_cast<size_t>(l) >= number.size()) number.resize(static_cast<size_t>(l) + 1, Regions::kNone);
    int32_t& n = number[static_cast<size_t>(l)];
    if (n < 0) {
      n = static_cast<int32_t>(sizes.size());
      sizes.push_back(0);
    }
    l = n;
    ++sizes[static_cast<size_t>(n)];
  }
  return sizes;
}

// Gives regions of fewer cells to the neighbour with the longest common border, the smallest first. Those without neighbours go.
void AbsorbSmall(const FloorGrid& grid, size_t min_cells, std::vector<int32_t>& label) {
  std::vector<size_t> sizes = Renumber(label);
  std::map<std::pair<int32_t, int32_t>, size_t> borders;  // both ways
  ForBorders(grid, label, [&](size_t i, size_t k) {
    ++borders[{label[i], label[k]}];
    ++borders[{label[k], label[i]}];
  });
  std::vector<int32_t> becomes(sizes.size());
  for (size_t r = 0; r < becomes.size(); ++r) becomes[r] = static_cast<int32_t>(r);
  std::vector<int32_t> small;
  for (size_t r = 0; r < sizes.size(); ++r) {
    if (sizes[r] < min_cells) small.push_back(static_cast<int32_t>(r));
  }
  std::stable_sort(small.begin(), small.end(),
                   [&](int32_t a, int32_t b) { return sizes[static_cast<size_t>(a)] < sizes[static_cast<size_t>(b)]; });
  for (const int32_t r : small) {
    if (sizes[static_cast<size_t>(r)] >= min_cells) continue;  // has grown
    std::map<int32_t, size_t> beside;
    for (auto it = borders.lower_bound({r, 0}); it != borders.end() && it->first.first == r; ++it) beside[it->first.second] = it->second;
    const auto most = std::max_element(beside.begin(), beside.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    const int32_t into = most == beside.end() ? Regions::kNone : most->first;
    becomes[static_cast<size_t>(r)] = into;
    for (const auto& [other, length] : beside) {
      borders.erase({r, other});
      borders.erase({other, r});
      if (other == into) continue;
      borders[{into, other}] += length;
      borders[{other, into}] += length;
    }
    if (into >= 0) sizes[static_cast<size_t>(into)] += sizes[static_cast<size_t>(r)];
  }
  for (int32_t& l : label) {
    while (l >= 0 && becomes[static_cast<size_t>(l)] != l) l = becomes[static_cast<size_t>(l)];
  }
}

bool Touch(const FloorGrid& grid, size_t a, size_t b) {
  return std::abs(grid.X(a) - grid.X(b)) <= 1 && std::abs(grid.Y(a) - grid.Y(b)) <= 1;
}

// One per connected stretch of border.
std::vector<Neck> FindNecks(const FloorGrid& grid, const Regions& regions) {
  std::vector<Neck> border;
  ForBorders(grid, regions.label, [&](size_t i, size_t k) {
    const auto [a, b] = std::minmax(regions.label[i], regions.label[k]);
    border.push_back({a, b, i});
    border.push_back({a, b, k});
  });
  const auto key = [](const Neck& n) { return std::tuple(n.region_a, n.region_b, n.cell); };
  std::sort(border.begin(), border.end(), [&](const Neck& a, const Neck& b) { return key(a) < key(b); });
  border.erase(std::unique(border.begin(), border.end(), [&](const Neck& a, const Neck& b) { return key(a) == key(b); }), border.end());
  std::vector<Neck> necks;
  std::vector<bool> taken(border.size());
  for (size_t first = 0; first < border.size(); ++first) {
    if (taken[first]) continue;
    std::vector<size_t> stretch = {first};
    taken[first] = true;
    Neck neck = border[first];
    for (size_t s = 0; s < stretch.size(); ++s) {
      const Neck& at = border[stretch[s]];
      if (regions.clearance_m[at.cell] > regions.clearance_m[neck.cell]) neck.cell = at.cell;
      for (size_t k = first + 1; k < border.size() && border[k].region_a == at.region_a && border[k].region_b == at.region_b; ++k) {
        if (taken[k] || !Touch(grid, border[k].cell, at.cell)) continue;
        taken[k] = true;
        stretch.push_back(k);
      }
    }
    necks.push_back(neck);
  }
  return necks;
}

}  // namespace

Regions FindRegions(const FreeSpace& space, const RoomOptions& options) {
  Regions regions;
  if (space.cells.empty()) return regions;
  regions.clearance_m = ClearanceOf(space);
  Watershed watershed(space, options, regions.clearance_m);
  watershed.Flood();
  regions.label = watershed.RootLabels();
  const double cell_m2 = space.grid.cell_m * space.grid.cell_m;
  AbsorbSmall(space.grid, static_cast<size_t>(options.min_room_area_m2 / cell_m2), regions.label);
  regions.count = static_cast<int32_t>(Renumber(regions.label).size());
  regions.necks = FindNecks(space.grid, regions);
  return regions;
}

}  // namespace plumb::runtime
