#include "tests/benchmarks/map_walls.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace plumb::benchmarks {

using runtime::MapSurface;
using runtime::Scan;
using runtime::SGraph;
using runtime::SurfaceKind;

namespace {

constexpr double kMinLength_m = 1.0, kSameDirection_rad = 0.2, kSamePlane_m = 0.15, kMinShare = 0.5;
constexpr double kTwice_m = 0.1, kTwiceOverlap_m = 0.5, kTwiceShare = 0.3;
constexpr uint32_t kMinScans = 20;
constexpr double kBin_m = 0.25, kOnFace_m = 0.06;  // of a wall's length, seen by a scan that has kMinBinPoints returns from it
constexpr int kMinBinPoints = 5;

// Where both are, along `a`, metres from its start; empty if second <= first.
std::pair<double, double> Overlap(const WallFace& a, const WallFace& b) {
  const double s = a.direction().dot(b.start - a.start), e = a.direction().dot(b.end - a.start);
  return {std::max(0.0, std::min(s, e)), std::min(a.length_m(), std::max(s, e))};
}

double TurnBetween_rad(const WallFace& a, const WallFace& b) {
  const Eigen::Vector2d u = a.direction(), v = b.direction();
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
}

// How far b stands off a, along a's normal, at a distance along a.
double OffsetAt_m(const WallFace& a, const WallFace& b, double along_m) {
  const Eigen::Vector2d p = a.start + along_m * a.direction();
  return b.normal().dot(b.start - p) / b.normal().dot(a.normal());
}

bool LiesOn(const WallFace& built, const WallFace& mapped) {
  const auto [from, to] = Overlap(built, mapped);
  return to > from && std::abs(TurnBetween_rad(built, mapped)) < kSameDirection_rad &&
         std::abs(OffsetAt_m(built, mapped, 0.5 * (from + to))) < kSamePlane_m;
}

// Share of the smaller one's cells that the other has, too: a window's frame lies in the hole of its wall, a wall mapped twice on itself.
double SharedCells(const MapSurface& a, const MapSurface& b) {
  const MapSurface &small = a.cells.size() < b.cells.size() ? a : b, &large = a.cells.size() < b.cells.size() ? b : a;
  const auto cell = [&](const MapSurface& s, const Eigen::Vector2f& c) {
    const Eigen::Vector2d p = s.start + static_cast<double>(c.x()) * (s.end - s.start).normalized();
    return std::array<int, 2>{static_cast<int>(std::floor(10 * (p - large.start).dot((large.end - large.start).normalized()))),
                              static_cast<int>(std::floor(10 * c.y()))};
  };
  std::set<std::array<int, 2>> known;
  for (const Eigen::Vector2f& c : large.cells) known.insert(cell(large, c));
  size_t shared = 0;
  for (const Eigen::Vector2f& c : small.cells) shared += known.count(cell(small, c));
  return small.cells.empty() ? 0 : static_cast<double>(shared) / static_cast<double>(small.cells.size());
}

}  // namespace

double WallFace::seen_m() const {
  return kBin_m *
         static_cast<double>(std::count_if(bin_scans.begin(), bin_scans.end(), [](uint32_t scans) { return scans >= kMinScans; }));
}

std::vector<WallFace> BuiltFaces(const AGraph& plan, const tools::SimulateSummary& simulated) {
  std::vector<WallFace> out;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& s = plan.surfaces[i];
    if (s.arc || s.storey != simulated.storey || simulated.surface_scans[i] < kMinScans || (s.end - s.start).norm() < kMinLength_m ||
        std::abs(s.normal.z()) > 0.1)
      continue;
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();  // the built face, given the planned one
    const Eigen::Vector2d mid = 0.5 * (s.start + s.end), normal = s.normal.head<2>().normalized();
    for (const tools::WallDisplacement& wall : simulated.walls) {
      for (const tools::SurfaceDisplacement& d : wall.surfaces) {
        if (d.surface == SurfaceId(i))
          T = Eigen::Translation2d(mid + d.translation_m * normal) * Eigen::Rotation2Dd(d.rotation_rad) * Eigen::Translation2d(-mid);
      }
    }
    out.push_back({T * s.start, T * s.end, s.z_min_m, s.z_max_m, i, 0, {}});
    out.back().bin_scans.resize(static_cast<size_t>(out.back().length_m() / kBin_m));
  }
  return out;
}

void CountSeen(const Scan& deskewed, const Eigen::Isometry3d& T_plan_lidar, std::vector<WallFace>& built) {
  const Eigen::Isometry3f T = T_plan_lidar.cast<float>();
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : deskewed.points) points.push_back(T * p);
  std::vector<int> returns;
  for (WallFace& face : built) {
    const Eigen::Vector2f start = face.start.cast<float>(), along = face.direction().cast<float>(), normal = face.normal().cast<float>();
    if (normal.dot(T.translation().head<2>() - start) <= 0) continue;
    returns.assign(face.bin_scans.size(), 0);
    for (const Eigen::Vector3f& p : points) {
      const Eigen::Vector2f off = p.head<2>() - start;
      if (std::abs(normal.dot(off)) > kOnFace_m || p.z() < face.z_min_m || p.z() > face.z_max_m) continue;
      const double bin = static_cast<double>(along.dot(off)) / kBin_m;
      if (bin >= 0 && bin < static_cast<double>(returns.size())) ++returns[static_cast<size_t>(bin)];
    }
    for (size_t i = 0; i < returns.size(); ++i) face.bin_scans[i] += returns[i] >= kMinBinPoints;
  }
}

std::vector<WallFace> MappedFaces(const SGraph& map, const Eigen::Isometry3d& T_plan_map) {
  std::vector<WallFace> out;
  for (size_t i = 0; i < map.surfaces.size(); ++i) {
    const MapSurface& s = map.surfaces[i];
    if (s.kind != SurfaceKind::kWall || s.observations.empty()) continue;
    // The ends are known to 5 cm, the plane between them better.
    const double middle_m = 0.5 * (s.z_min_m + s.z_max_m);
    const auto to_plan = [&](const Eigen::Vector2d& end) -> Eigen::Vector2d {
      const Eigen::Vector3d p(end.x(), end.y(), middle_m);
      return (T_plan_map * (p - s.plane.SignedDistance(p) * s.plane.n)).head<2>();
    };
    const double z_m = T_plan_map.translation().z();
    out.push_back({to_plan(s.start), to_plan(s.end), s.z_min_m + z_m, s.z_max_m + z_m, i, s.num_points, {}});
  }
  return out;
}

WallScore ScoreWalls(const std::vector<WallFace>& built, const std::vector<WallFace>& mapped, const SGraph& map) {
  WallScore out;
  for (const WallFace& b : built) {
    if (b.seen_m() < kMinLength_m) continue;
    ++out.walls;
    std::vector<bool> mapped_bins(b.bin_scans.size());
    double most = 0;
    const WallFace* best = nullptr;  // the one with most returns: of a wall with windows, not the panes
    for (const WallFace& m : mapped) {
      if (!LiesOn(b, m)) continue;
      const auto [from, to] = Overlap(b, m);
      for (size_t i = 0; i < mapped_bins.size(); ++i) {
        const double middle_m = kBin_m * (static_cast<double>(i) + 0.5);
        if (middle_m > from && middle_m < to && b.bin_scans[i] >= kMinScans) mapped_bins[i] = true;
      }
      const double points = m.points * (to - from) / m.length_m();
      if (points <= most) continue;
      most = points;
      best = &m;
    }
    if (kBin_m * static_cast<double>(std::count(mapped_bins.begin(), mapped_bins.end(), true)) < kMinShare * b.seen_m()) {
      fmt::print(stderr, "  missed: ({:.2f} {:.2f}) to ({:.2f} {:.2f}), of which {:.2f} m were seen\n", b.start.x(), b.start.y(), b.end.x(),
                 b.end.y(), b.seen_m());
      continue;
    }
    ++out.found;
    const auto [from, to] = Overlap(b, *best);
    out.offsets_m.push_back(std::abs(OffsetAt_m(b, *best, 0.5 * (from + to))));
    out.turns_deg.push_back(std::abs(TurnBetween_rad(b, *best)) * 57.29578);
  }
  std::vector<WallFace> walls;  // of the map, without furniture
  std::copy_if(mapped.begin(), mapped.end(), std::back_inserter(walls), [&](const WallFace& m) {
    return std::any_of(built.begin(), built.end(), [&](const WallFace& b) { return LiesOn(b, m); });
  });
  for (size_t i = 0; i < walls.size(); ++i) {
    for (size_t j = i + 1; j < walls.size(); ++j) {
      const WallFace &a = walls[i], &b = walls[j];
      const auto [from, to] = Overlap(a, b);
      if (to - from < kTwiceOverlap_m || std::abs(TurnBetween_rad(a, b)) > kSameDirection_rad) continue;
      if (std::abs(OffsetAt_m(a, b, 0.5 * (from + to))) > kTwice_m ||
          SharedCells(map.surfaces[a.surface], map.surfaces[b.surface]) < kTwiceShare)
        continue;
      ++out.twice;
      for (const WallFace& f : {a, b}) {
        fmt::print(stderr, "  twice: ({:.2f} {:.2f}) to ({:.2f} {:.2f}) from {:.2f} m to {:.2f} m high\n", f.start.x(), f.start.y(),
                   f.end.x(), f.end.y(), f.z_min_m, f.z_max_m);
      }
    }
  }
  return out;
}

}  // namespace plumb::benchmarks
