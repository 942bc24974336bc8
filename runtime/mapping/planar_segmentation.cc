#include "runtime/mapping/planar_segmentation.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "runtime/mapping/cell_planes.h"
#include "runtime/numerics/symmetric_eigen.h"
#include "runtime/odometry/planar/planar_scan.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

constexpr double kMaxGap_m = 0.3;            // along a run, ...
constexpr double kGrazing_rad = 0.17;        // ... or what neighbouring beams leave on a wall seen as flat as this
constexpr double kMaxBendSigmas = 3.0;       // between a run and its chord
constexpr double kBandSigmas = 3.0;          // between points and the line fitted to the run
constexpr size_t kMinRunPoints = 6;
constexpr double kMinCosIncidence = 0.15;    // flatter rays are biased by the beam's width
constexpr double kMaxJoinedBend_rad = 0.05;

struct Line {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero(), normal = Eigen::Vector2d::UnitX();
  double rms_m = 0, from_m = 0, to_m = 0;  // extent along Perpendicular(normal) from the mean

  void Fit(const Eigen::Vector2d& towards) {
    mean.setZero();
    for (const Eigen::Vector2d& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& p : points) scatter += (p - mean) * (p - mean).transpose();
    const SymmetricEigen<2> eigen = EigenOf(Eigen::Matrix2d(scatter / static_cast<double>(points.size())));
    normal = eigen.vectors.col(0);
    if (normal.dot(towards) < 0) normal = -normal;
    rms_m = std::sqrt(std::max(0.0, eigen.values[0]));
    from_m = to_m = 0;
    for (const Eigen::Vector2d& p : points) {
      from_m = std::min(from_m, Along(p));
      to_m = std::max(to_m, Along(p));
    }
  }
  [[nodiscard]] double Along(const Eigen::Vector2d& p) const { return Perpendicular(normal).dot(p - mean); }
  [[nodiscard]] double Across(const Eigen::Vector2d& p) const { return normal.dot(p - mean); }
  [[nodiscard]] double length_m() const { return to_m - from_m; }
};

// Splits a chain of neighbouring points where it is furthest from its chord, until all parts are straight.
void Split(std::span<const Eigen::Vector2d> chain, double max_bend_m, std::vector<std::span<const Eigen::Vector2d>>* runs) {
  if (chain.size() < kMinRunPoints) return;
  const Eigen::Vector2d chord = chain.back() - chain.front();
  const Eigen::Vector2d normal = chord.norm() > 0 ? Eigen::Vector2d(Perpendicular(chord).normalized()) : Eigen::Vector2d::UnitX();
  size_t furthest = 0;
  double most_m = max_bend_m;
  for (size_t i = 1; i + 1 < chain.size(); ++i) {
    const double off_m = std::abs(normal.dot(chain[i] - chain.front()));
    if (off_m <= most_m) continue;
    most_m = off_m;
    furthest = i;
  }
  if (furthest == 0) {
    runs->push_back(chain);
    return;
  }
  Split(chain.first(furthest), max_bend_m, runs);
  Split(chain.subspan(furthest), max_bend_m, runs);
}

// A line through a run's inner part, without the rounding at its ends; nothing if it is none.
void AddLine(std::span<const Eigen::Vector2d> run, const Eigen::Vector2d& sensor, const MapperOptions& options, std::vector<Line>* lines) {
  Line line;
  line.points.assign(run.begin(), run.end());
  const Eigen::Vector2d towards = sensor - run[run.size() / 2];
  line.Fit(towards);
  const double band_m = kBandSigmas * std::clamp(line.rms_m, 0.01, options.plane_sigma_m);
  std::erase_if(line.points, [&](const Eigen::Vector2d& p) {
    return std::abs(line.Across(p)) > band_m || line.normal.dot(sensor - p) < kMinCosIncidence * (sensor - p).norm();
  });
  if (line.points.size() < kMinRunPoints) return;
  line.Fit(towards);
  if (line.rms_m <= options.plane_sigma_m) lines->push_back(std::move(line));
}

void AddLines(std::vector<Eigen::Vector2d> points, const Eigen::Vector2d& sensor, const MapperOptions& options, std::vector<Line>* lines) {
  const auto azimuth = [&](const Eigen::Vector2d& p) { return std::atan2(p.y() - sensor.y(), p.x() - sensor.x()); };
  std::stable_sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return azimuth(a) < azimuth(b); });
  std::vector<std::span<const Eigen::Vector2d>> runs;
  size_t first = 0;
  for (size_t i = 1; i <= points.size(); ++i) {
    if (i < points.size()) {
      const double range_m = std::min((points[i] - sensor).norm(), (points[i - 1] - sensor).norm());
      const double between_rad = azimuth(points[i]) - azimuth(points[i - 1]);
      const double gap_m = std::min(kMaxGap_m, 3 * options.plane_sigma_m + range_m * between_rad / kGrazing_rad);
      if ((points[i] - points[i - 1]).norm() <= gap_m) continue;
    }
    Split(std::span(points).subspan(first, i - first), kMaxBendSigmas * options.plane_sigma_m, &runs);
    first = i;
  }
  for (const auto& run : runs) AddLine(run, sensor, options, lines);
}

// Whether b continues a.
bool OneLine(const Line& a, const Line& b, const MapperOptions& options) {
  if (a.normal.dot(b.normal) < std::cos(kMaxJoinedBend_rad)) return false;
  const double band_m = options.merge_distance_m;
  const Eigen::Vector2d along = Perpendicular(b.normal);
  const Eigen::Vector2d start = b.mean + b.from_m * along, end = b.mean + b.to_m * along;
  if (std::abs(a.Across(start)) > band_m || std::abs(a.Across(end)) > band_m) return false;
  const double lo_m = std::min(a.Along(start), a.Along(end)), hi_m = std::max(a.Along(start), a.Along(end));
  return lo_m <= a.to_m + options.merge_gap_m && hi_m >= a.from_m - options.merge_gap_m;
}

// Longest first; shorter ones that continue a longer one become part of it.
std::vector<Line> Joined(std::vector<Line> lines, const MapperOptions& options) {
  std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.length_m() > b.length_m(); });
  std::vector<Line> joined;
  for (Line& line : lines) {
    const auto into = std::find_if(joined.begin(), joined.end(), [&](const Line& longer) { return OneLine(longer, line, options); });
    if (into == joined.end()) {
      joined.push_back(std::move(line));
      continue;
    }
    into->points.insert(into->points.end(), line.points.begin(), line.points.end());
    into->Fit(into->normal);
  }
  return joined;
}

Segment SegmentOf(const Line& line, const Eigen::Matrix3d& leveling) {
  const auto lifted = [&](const Eigen::Vector2d& p, double z_m) -> Eigen::Vector3d {
    return leveling.transpose() * Eigen::Vector3d(p.x(), p.y(), z_m);
  };
  Segment segment;
  segment.plane.n = lifted(line.normal, 0);
  segment.plane.d = -line.normal.dot(line.mean);
  VoxelIndex index;
  std::vector<Eigen::Vector3d> cells;  // sum, count
  // Points spread evenly over the height count as half of them at either of two heights with that variance.
  const double half_m = kSeenHalfHeight_m / std::sqrt(3.0);
  for (const Eigen::Vector2d& p : line.points) {
    segment.stats.Add(lifted(p, half_m));
    segment.stats.Add(lifted(p, -half_m));
    const uint32_t cell = index.Insert(VoxelKey({line.Along(p) / kCell_m, 0, 0})).first;
    if (cell == cells.size()) cells.emplace_back(0, 0, 0);
    cells[cell] += Eigen::Vector3d(p.x(), p.y(), 1);
  }
  segment.stats.C *= 0.5;
  segment.cell_height_m = kLineHeight_m;
  for (const Eigen::Vector3d& cell : cells) segment.cells.push_back(lifted(cell.head<2>() / cell.z(), 0).cast<float>());
  return segment;
}

}  // namespace

std::vector<Segment> ExtractLineSegments(const KeyframeWindow& window, const MapperOptions& options) {
  const Eigen::Matrix3d leveling = Leveled(window.T_odom_kf()).leveling;
  std::vector<Line> lines;
  for (const View& view : window.views()) {
    std::vector<Eigen::Vector2d> points;
    points.reserve(view.points.size());
    for (const Eigen::Vector3f& p : view.points) points.emplace_back((leveling * p.cast<double>()).head<2>());
    AddLines(std::move(points), (leveling * view.sensor).head<2>(), options, &lines);
  }
  std::vector<Segment> segments;
  for (const Line& line : Joined(std::move(lines), options)) {
    if (line.length_m() < options.min_segment_extent_m || static_cast<int>(line.points.size()) < options.min_line_points) continue;
    segments.push_back(SegmentOf(line, leveling));
  }
  return segments;
}

}  // namespace plumb::runtime
