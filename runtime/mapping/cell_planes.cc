#include "runtime/mapping/cell_planes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "runtime/mapping/lack_of_fit.h"
#include "runtime/mapping/plane_fit.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kFlatness_m = 0.004;      // one sigma of a cell's mean about its plane, besides its points' noise
constexpr double kOnSigmas = 2.5;          // a cell is on a plane within this
constexpr double kCostSigmas = 2.0;        // a cell further off costs no more than at this: it may be another plane's
constexpr int kMaxPlanes = 4;
constexpr size_t kMaxHypotheses = 48;
constexpr double kSquare_m = 0.3;          // of joined cells
constexpr double kMaxGap_m = 0.2;
constexpr double kMinShare = 0.1;          // of a rough plane's cells that a plane must have
constexpr double kPatchRadius_m = 0.6;     // of the cells that a hypothesis is fitted to
constexpr size_t kMinPatchCells = 6;
constexpr int kRefinements = 3;
constexpr double kFlatShare = 0.95;        // of the cells on the common fit: no need to look for steps
constexpr double kMinAcross_m = 0.2;       // height of a wall segment
constexpr double kSureArea_m2 = 1.0, kMinFill = 0.25;  // a smaller segment whose cells are strewn over a larger rectangle is noise
constexpr double kMinCellPoints = 2;
constexpr double kMaxContested = 0.2;      // of a cell's points
constexpr double kMinSure = 0.5;           // of a segment's cells
constexpr double kMinCellShare = 0.25;     // of the median cell's points: less is noise beyond an edge
constexpr double kSureLength_m = 1.0;      // a longer segment is a wall even if it is not flat
constexpr double kMaxMisfit_m = 0.007, kMaxMisfitRatio = 3;  // of a shorter one (lack_of_fit.h)

struct Cell {
  const CellStats* stats;
  Eigen::Vector3d mean;
  double sigma_m;  // of the mean about the cell's plane

  [[nodiscard]] double Offset(const Plane& plane) const { return std::abs(plane.SignedDistance(mean)) / sigma_m; }
  [[nodiscard]] bool On(const Plane& plane) const { return Offset(plane) <= kOnSigmas; }
};

Cell MakeCell(const CellStats& stats, double sigma_m) {
  return {&stats, stats.centroid(), std::sqrt(kFlatness_m * kFlatness_m + sigma_m * sigma_m / stats.count())};
}

// Sum over the cells that pass, and their number.
struct CellSum {
  PlaneStats stats;
  size_t cells = 0;
};
template <class Keep>
CellSum SumOf(const std::vector<Cell>& cells, const Keep& keep) {
  CellSum sum;
  for (const Cell& cell : cells) {
    if (!keep(cell)) continue;
    sum.stats.Add(*cell.stats);
    ++sum.cells;
  }
  return sum;
}

struct Hypothesis {
  Plane plane;
  double cost = std::numeric_limits<double>::infinity();
};

// Starting from a fit to `start`, the plane that agrees with the cells on it.
Hypothesis Refined(const std::vector<Cell>& cells, const PlaneStats& start, const Eigen::Vector3d& normal) {
  Hypothesis h{FitPlane(start, normal).plane, 0};
  for (int i = 0; i < kRefinements; ++i) {
    const CellSum on = SumOf(cells, [&](const Cell& cell) { return cell.On(h.plane); });
    if (on.cells < 3) break;
    h.plane = FitPlane(on.stats, normal).plane;
  }
  for (const Cell& cell : cells) {
    const double offset = std::min(kCostSigmas, cell.Offset(h.plane));
    h.cost += offset * offset;
  }
  return h;
}

// The plane of least cost. Counting cells near a plane would not do: one that leans from a wall to a door leaf is near all of both.
Plane BestPlane(const std::vector<Cell>& cells, const Eigen::Vector3d& normal) {
  Hypothesis best = Refined(cells, SumOf(cells, [](const Cell&) { return true; }).stats, normal);
  const auto num_on = std::count_if(cells.begin(), cells.end(), [&](const Cell& cell) { return cell.On(best.plane); });
  if (static_cast<double>(num_on) >= kFlatShare * static_cast<double>(cells.size())) return best.plane;
  const size_t step = cells.size() / kMaxHypotheses + 1;
  for (size_t i = 0; i < cells.size(); i += step) {
    const CellSum patch = SumOf(cells, [&](const Cell& cell) { return (cell.mean - cells[i].mean).norm() < kPatchRadius_m; });
    if (patch.cells < kMinPatchCells) continue;
    const Hypothesis h = Refined(cells, patch.stats, normal);
    if (h.cost < best.cost) best = h;
  }
  return best.plane;
}

double MinCellCount(const std::vector<Cell>& cells) {
  std::vector<double> counts;
  counts.reserve(cells.size());
  for (const Cell& cell : cells) counts.push_back(cell.stats->count());
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  return std::max(kMinCellPoints, kMinCellShare * *middle);
}

// Cells joined in squares of kSquare_m: their means say more surely which plane they are on.
struct Squares {
  std::vector<CellStats> stats;
  std::vector<Cell> cells;
  std::vector<uint32_t> of;  // each cell's
};
Squares Joined(const std::vector<Cell>& cells, const PlaneAxes& axes, double sigma_m) {
  Squares squares;
  VoxelIndex index;
  for (const Cell& cell : cells) {
    const uint32_t i = index.Insert(VoxelKey({axes.along.dot(cell.mean) / kSquare_m, axes.across.dot(cell.mean) / kSquare_m, 0})).first;
    if (i == squares.stats.size()) squares.stats.emplace_back();
    squares.stats[i].Add(*cell.stats);
    squares.of.push_back(i);
  }
  for (const CellStats& stats : squares.stats) squares.cells.push_back(MakeCell(stats, sigma_m));
  return squares;
}

// The largest group of cells with no gap above kMaxGap_m between neighbours.
std::vector<Cell> LargestGroup(const std::vector<Cell>& cells, const PlaneAxes& axes) {
  VoxelIndex index;
  std::vector<Eigen::Vector2d> squares;
  const auto at = [&](const Cell& cell) {
    return Eigen::Vector2d(axes.along.dot(cell.mean) / kMaxGap_m, axes.across.dot(cell.mean) / kMaxGap_m);
  };
  for (const Cell& cell : cells) {
    if (index.Insert(VoxelKey({at(cell).x(), at(cell).y(), 0})).second) squares.push_back(at(cell));
  }
  std::vector<int> group(squares.size(), -1);
  int num_groups = 0;
  for (size_t seed = 0; seed < squares.size(); ++seed) {
    if (group[seed] >= 0) continue;
    std::vector<size_t> queue = {seed};
    group[seed] = num_groups;
    while (!queue.empty()) {
      const Eigen::Vector2d from = squares[queue.back()];
      queue.pop_back();
      for (int k = 0; k < 9; ++k) {
        const uint32_t next = index.Find(VoxelKey({from.x() + k % 3 - 1, from.y() + k / 3 - 1, 0}));
        if (next == VoxelIndex::kNone || group[next] >= 0) continue;
        group[next] = num_groups;
        queue.push_back(next);
      }
    }
    ++num_groups;
  }
  std::vector<std::vector<Cell>> groups(static_cast<size_t>(num_groups));
  for (const Cell& cell : cells) groups[static_cast<size_t>(group[index.Find(VoxelKey({at(cell).x(), at(cell).y(), 0}))])].push_back(cell);
  const auto largest = std::max_element(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return largest == groups.end() ? std::vector<Cell>() : *largest;
}

// Which cells have others of the segment on both sides along it: what is at the end of one, as a jamb behind a wall's edge, strays into the
// last cell.
std::vector<bool> Inner(const std::vector<Cell>& cells, const PlaneAxes& axes, double min_count) {
  VoxelIndex index;
  const auto square = [&](const Cell& cell, int along, int across) {
    return VoxelKey({axes.along.dot(cell.mean) / kCell_m + along, axes.across.dot(cell.mean) / kCell_m + across, 0});
  };
  for (const Cell& cell : cells) {
    if (cell.stats->count() >= min_count) index.Insert(square(cell, 0, 0));
  }
  const auto has = [&](const Cell& cell, int along) {
    for (int across = -1; across <= 1; ++across) {
      if (index.Find(square(cell, along, across)) != VoxelIndex::kNone) return true;
    }
    return false;
  };
  std::vector<bool> inner;
  for (const Cell& cell : cells) inner.push_back(has(cell, -1) && has(cell, 1));
  return inner;
}

// Sum over the inner cells whose points are no other plane's: at a corner or a step, the noise of each strays into the other's,
// one-sidedly. Where these are few, over all that are no other plane's, or over the inner ones, or over all.
PlaneStats SureSum(const std::vector<Cell>& cells, const PlaneAxes& axes, double min_count) {
  const std::vector<bool> inner = Inner(cells, axes, min_count);
  const auto is_inner = [&](const Cell& cell) { return inner[static_cast<size_t>(&cell - cells.data())]; };
  const auto is_own = [](const Cell& cell) { return cell.stats->contested <= kMaxContested * cell.stats->count(); };
  for (const auto& [only_inner, only_own] : {std::pair{true, true}, {false, true}, {true, false}}) {
    const CellSum sum = SumOf(cells, [&](const Cell& cell) { return (!only_inner || is_inner(cell)) && (!only_own || is_own(cell)); });
    if (static_cast<double>(sum.cells) >= kMinSure * static_cast<double>(cells.size())) return sum.stats;
  }
  return SumOf(cells, [](const Cell&) { return true; }).stats;
}

// Whether the plane lies over what is none: narrow faces that it passes through one after the other.
bool IsRagged(const std::vector<Cell>& cells, const Plane& plane, const PlaneAxes& axes) {
  std::vector<PlaneStats> stats;
  stats.reserve(cells.size());
  for (const Cell& cell : cells) stats.push_back(*cell.stats);
  const LackOfFit misfit = LackOfFitOf(stats, plane, axes.along);
  return misfit.rms_m > kMaxMisfit_m && misfit.ratio > kMaxMisfitRatio;
}

// The segment of cells on a plane, or none if it is too small or no plane.
std::optional<Segment> SegmentOf(const std::vector<Cell>& cells, SurfaceKind kind, const Eigen::Vector3d& normal, const PlaneAxes& axes,
                                 double min_count, const MapperOptions& options) {
  Segment segment;
  segment.kind = kind;
  segment.stats = SureSum(cells, axes, min_count);
  if (segment.stats.count() < options.min_segment_points) return std::nullopt;
  segment.plane = FitPlane(segment.stats, normal).plane;
  Eigen::Vector2d lo = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const Cell& cell : cells) {
    if (cell.stats->count() < min_count) continue;
    const Eigen::Vector2d at(axes.along.dot(cell.mean), axes.across.dot(cell.mean));
    lo = lo.cwiseMin(at);
    hi = hi.cwiseMax(at);
    segment.cells.push_back(cell.mean.cast<float>());
  }
  const double area_m2 = kCell_m * kCell_m * static_cast<double>(segment.cells.size());
  if (segment.cells.empty() || area_m2 < options.min_segment_extent_m * options.min_segment_extent_m) return std::nullopt;
  const Eigen::Vector2d size_m = hi - lo + Eigen::Vector2d::Constant(kCell_m);
  const double min_across_m =
      kind == SurfaceKind::kWall ? std::min(kMinAcross_m, options.min_segment_extent_m) : options.min_segment_extent_m;
  if (size_m.x() < options.min_segment_extent_m || size_m.y() < min_across_m) return std::nullopt;
  if (area_m2 < kSureArea_m2 && area_m2 < kMinFill * size_m.prod()) return std::nullopt;
  if (kind == SurfaceKind::kWall && size_m.x() < kSureLength_m && IsRagged(cells, segment.plane, axes)) return std::nullopt;
  return segment;
}

// A plane and how far its cells reach along.
struct Reached {
  Plane plane;
  double from_m, to_m;
  [[nodiscard]] bool Has(const Cell& cell, const PlaneAxes& axes) const {
    const double at_m = axes.along.dot(cell.mean);
    return at_m >= from_m && at_m <= to_m && cell.On(plane);
  }
};

Reached ReachOf(const Plane& plane, const std::vector<Cell>& on, const PlaneAxes& axes) {
  Reached out{plane, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Cell& cell : on) {
    out.from_m = std::min(out.from_m, axes.along.dot(cell.mean));
    out.to_m = std::max(out.to_m, axes.along.dot(cell.mean));
  }
  return out;
}

}  // namespace

PlaneAxes AxesOf(const Plane& plane, SurfaceKind kind, const Eigen::Vector3d& up) {
  PlaneAxes axes;
  if (kind == SurfaceKind::kWall) {
    axes.along = plane.n.cross(up).normalized();
    axes.across = axes.along.cross(plane.n);
    return axes;
  }
  axes.along = (Eigen::Vector3d::UnitX() - plane.n.x() * plane.n).normalized();
  axes.across = plane.n.cross(axes.along);
  return axes;
}

std::vector<Segment> SplitCells(const std::vector<CellStats>& cells, SurfaceKind kind, const Eigen::Vector3d& normal, const PlaneAxes& axes,
                                double sigma_m, const MapperOptions& options) {
  std::vector<Cell> remaining;
  for (const CellStats& cell : cells) {
    if (cell.count() >= kMinCellPoints) remaining.push_back(MakeCell(cell, sigma_m));
  }
  if (remaining.empty()) return {};
  const double min_count = MinCellCount(remaining);
  const size_t min_cells = std::max<size_t>(kMinPatchCells, static_cast<size_t>(kMinShare * static_cast<double>(remaining.size())));
  std::vector<Segment> segments;
  std::vector<Reached> before;
  for (int i = 0; i < kMaxPlanes && remaining.size() >= min_cells; ++i) {
    const Squares squares = Joined(remaining, axes, sigma_m);
    const Plane plane = BestPlane(squares.cells, normal);
    // A single cell may be too noisy to tell its plane from one a step further.
    std::vector<Cell> on, off;
    for (size_t k = 0; k < remaining.size(); ++k) {
      const bool is_on = remaining[k].On(plane) && squares.cells[squares.of[k]].On(plane);
      (is_on ? on : off).push_back(remaining[k]);
    }
    // What is left by a first plane is often just its roughest cells, strewn all over.
    if (i > 0) on = LargestGroup(on, axes);
    if (on.size() < min_cells) break;
    remaining = std::move(off);
    // Squares of a wall that bows, within it: no wall of their own.
    const auto same = std::count_if(on.begin(), on.end(), [&](const Cell& cell) {
      return std::any_of(before.begin(), before.end(), [&](const Reached& other) { return other.Has(cell, axes); });
    });
    if (2 * static_cast<size_t>(same) > on.size()) continue;
    before.push_back(ReachOf(plane, on, axes));
    if (std::optional<Segment> segment = SegmentOf(on, kind, normal, axes, min_count, options)) segments.push_back(std::move(*segment));
  }
  return segments;
}

}  // namespace plumb::runtime
