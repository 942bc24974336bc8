// How well the S-Graph maps a building, with no plan given to it: a drive simulated in each plan, then odometry, mapping and the final
// polish.
//   map_benchmark [--seconds S] [--noise M] [--clutter N] [--seed N] PLAN.agraph...
// One row for each plan. ATE: of the scans' positions, rms, with the first two seconds laid on the truth. Walls: the plan's plane surfaces
// of which 20 scans or more have seen over 1 m, as built, against the map after that alignment: found if half of what was seen of them is
// in the map.
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "runtime/optimization/map_polish.h"
#include "schema/agraph_reader.h"
#include "tools/simulate/simulate.h"

namespace {

using namespace plumb;
using namespace plumb::runtime;
using Clock = std::chrono::steady_clock;

constexpr double kMinLength_m = 1.0, kSameDirection_rad = 0.2, kSamePlane_m = 0.15, kMinShare = 0.5;
constexpr double kTwice_m = 0.1, kTwiceOverlap_m = 0.5, kTwiceShare = 0.3;
constexpr uint32_t kMinScans = 20;
constexpr double kBin_m = 0.25, kOnFace_m = 0.06;  // of a wall's length, seen by a scan that has kMinBinPoints returns from it
constexpr int kMinBinPoints = 5;
constexpr size_t kStart_scans = 20;

double Since_ms(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

// A wall's face seen from above: from `start` to `end`, free space on the left.
struct Face {
  Eigen::Vector2d start, end;
  double z_min_m = 0, z_max_m = 0;
  size_t surface = 0;  // of the map or the plan
  double points = 0;   // of the map: returns from it
  std::vector<uint32_t> bin_scans;  // of the plan: how many scans saw each kBin_m of it
  [[nodiscard]] Eigen::Vector2d direction() const { return (end - start).normalized(); }
  [[nodiscard]] double length_m() const { return (end - start).norm(); }
  [[nodiscard]] Eigen::Vector2d normal() const { return {-direction().y(), direction().x()}; }
  [[nodiscard]] double seen_m() const {
    return kBin_m *
           static_cast<double>(std::count_if(bin_scans.begin(), bin_scans.end(), [](uint32_t scans) { return scans >= kMinScans; }));
  }
};

// Where both are, along `a`, metres from its start; empty if second <= first.
std::pair<double, double> Overlap(const Face& a, const Face& b) {
  const double s = a.direction().dot(b.start - a.start), e = a.direction().dot(b.end - a.start);
  return {std::max(0.0, std::min(s, e)), std::min(a.length_m(), std::max(s, e))};
}

double TurnBetween_rad(const Face& a, const Face& b) {
  const Eigen::Vector2d u = a.direction(), v = b.direction();
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
}

// How far b stands off a, along a's normal, at a distance along a.
double OffsetAt_m(const Face& a, const Face& b, double along_m) {
  const Eigen::Vector2d p = a.start + along_m * a.direction();
  return b.normal().dot(b.start - p) / b.normal().dot(a.normal());
}

std::vector<Face> BuiltFaces(const AGraph& plan, const tools::SimulateSummary& simulated) {
  std::vector<Face> out;
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

// Counts a scan for the parts of the built faces that it saw.
void CountSeen(const Scan& deskewed, const Eigen::Isometry3d& T_plan_lidar, std::vector<Face>& built) {
  const Eigen::Isometry3f T = T_plan_lidar.cast<float>();
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : deskewed.points) points.push_back(T * p);
  std::vector<int> returns;
  for (Face& face : built) {
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

std::vector<Face> MappedFaces(const SGraph& map, const Eigen::Isometry3d& T_plan_map) {
  std::vector<Face> out;
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

bool LiesOn(const Face& built, const Face& mapped) {
  const auto [from, to] = Overlap(built, mapped);
  return to > from && std::abs(TurnBetween_rad(built, mapped)) < kSameDirection_rad &&
         std::abs(OffsetAt_m(built, mapped, 0.5 * (from + to))) < kSamePlane_m;
}

struct WallScore {
  int walls = 0, found = 0, twice = 0;
  std::vector<double> offsets_m, turns_deg;  // absolute
};

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

WallScore ScoreWalls(const std::vector<Face>& built, const std::vector<Face>& mapped, const SGraph& map) {
  WallScore out;
  for (const Face& b : built) {
    if (b.seen_m() < kMinLength_m) continue;
    ++out.walls;
    std::vector<bool> mapped_bins(b.bin_scans.size());
    double most = 0;
    const Face* best = nullptr;  // the one with most returns: of a wall with windows, not the panes
    for (const Face& m : mapped) {
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
  std::vector<Face> walls;  // of the map, without furniture
  std::copy_if(mapped.begin(), mapped.end(), std::back_inserter(walls), [&](const Face& m) {
    return std::any_of(built.begin(), built.end(), [&](const Face& b) { return LiesOn(b, m); });
  });
  for (size_t i = 0; i < walls.size(); ++i) {
    for (size_t j = i + 1; j < walls.size(); ++j) {
      const Face &a = walls[i], &b = walls[j];
      const auto [from, to] = Overlap(a, b);
      if (to - from < kTwiceOverlap_m || std::abs(TurnBetween_rad(a, b)) > kSameDirection_rad) continue;
      if (std::abs(OffsetAt_m(a, b, 0.5 * (from + to))) > kTwice_m ||
          SharedCells(map.surfaces[a.surface], map.surfaces[b.surface]) < kTwiceShare)
        continue;
      ++out.twice;
      for (const Face& f : {a, b}) {
        fmt::print(stderr, "  twice: ({:.2f} {:.2f}) to ({:.2f} {:.2f}) from {:.2f} m to {:.2f} m high\n", f.start.x(), f.start.y(),
                   f.end.x(), f.end.y(), f.z_min_m, f.z_max_m);
      }
    }
  }
  return out;
}

// A registered scan by the keyframe that was the newest when it came, as the localizer has it.
struct ScanPlace {
  size_t keyframe = 0;
  Eigen::Isometry3d T_odom_lidar, truth;
};

Eigen::Isometry3d PoseIn(const SGraph& map, const ScanPlace& place) {
  const Keyframe& keyframe = map.keyframes[place.keyframe];
  return keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar;
}

struct Driven {
  Mapper mapper;
  std::vector<ScanPlace> places;
  std::vector<double> odometry_ms, mapping_ms;
};

bool Drive(const std::string& folder, std::vector<Face>& built, Driven& out) {
  const auto recording = Recording::Open(folder);
  const auto truth = ReadTum(folder + "/truth.tum");
  if (!recording || !truth) return false;
  Odometry odometry;
  for (size_t i = 0; i < recording->size(); ++i) {
    const auto scan = recording->Read(i);
    const auto at = scan ? InterpolatePose(*truth, scan->stamp_s) : std::nullopt;
    if (!at) continue;
    auto start = Clock::now();
    const OdometryResult r = odometry.Register(*scan, std::nullopt);
    out.odometry_ms.push_back(Since_ms(start));
    start = Clock::now();
    if (r.ok) out.mapper.AddScan(r.deskewed, r.T_odom_lidar);
    out.mapping_ms.push_back(Since_ms(start));
    if (r.ok) CountSeen(r.deskewed, *at, built);
    const size_t keyframes = out.mapper.graph().keyframes.size();
    out.places.push_back({keyframes > 0 ? keyframes - 1 : 0, r.T_odom_lidar, *at});
  }
  out.mapper.Flush();
  return !out.places.empty() && !out.mapper.graph().keyframes.empty();
}

// As much as the map's first pose lets it be: what is left after the best alignment is the map's own.
double BestAte_m(const SGraph& map, const std::vector<ScanPlace>& places) {
  Eigen::Matrix3Xd a(3, places.size()), b(3, places.size());
  for (size_t i = 0; i < places.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = PoseIn(map, places[i]).translation();
    b.col(static_cast<Eigen::Index>(i)) = places[i].truth.translation();
  }
  const Eigen::Isometry3d T(Eigen::umeyama(a, b, false));
  return std::sqrt((T * a - b).squaredNorm() / static_cast<double>(places.size()));
}

// Lays the first kStart_scans on the truth: the mean turn, then the mean shift. One scan alone is turned by 0.1 degrees of noise.
Eigen::Isometry3d StartAligned(const SGraph& map, const std::vector<ScanPlace>& places) {
  const size_t n = std::min(kStart_scans, places.size());
  Eigen::Matrix4d turns = Eigen::Matrix4d::Zero();
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Quaterniond q(places[i].truth.linear() * PoseIn(map, places[i]).linear().transpose());
    turns += q.coeffs() * q.coeffs().transpose();
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::Quaterniond(Eigen::Vector4d(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(turns).eigenvectors().col(3))).toRotationMatrix();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < n; ++i) shift += places[i].truth.translation() - T.linear() * PoseIn(map, places[i]).translation();
  T.translation() = shift / static_cast<double>(n);
  return T;
}

double Ate_m(const SGraph& map, const std::vector<ScanPlace>& places) {
  const Eigen::Isometry3d T = StartAligned(map, places);
  double sum_m2 = 0;
  for (const ScanPlace& p : places) sum_m2 += (T * PoseIn(map, p).translation() - p.truth.translation()).squaredNorm();
  return std::sqrt(sum_m2 / static_cast<double>(places.size()));
}

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

void PrintHead() {
  fmt::print("{:<32} {:>6} {:>7} {:>8} {:>8} {:>8} {:>11} {:>6} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8}\n", "plan", "s", "m", "odo cm",
             "ATE cm", "best cm", "walls", "twice", "off mm", "95% mm", "turn deg", "95% deg", "odo ms", "p99 ms", "polish s");
}

void PrintRow(const std::string& name, const tools::SimulateSummary& simulated, double odometry_m, double map_m, double best_m,
              WallScore& walls, const Driven& driven, double polish_ms) {
  fmt::print(
      "{:<32} {:>6.0f} {:>7.1f} {:>8.2f} {:>8.2f} {:>8.2f} {:>11} {:>6} {:>9.1f} {:>9.1f} {:>9.3f} {:>9.3f} {:>8.2f} {:>8.2f} {:>8.2f}\n",
      name, simulated.duration_s, simulated.path_m, 100 * odometry_m, 100 * map_m, 100 * best_m,
      fmt::format("{}/{}", walls.found, walls.walls), walls.twice, 1000 * Percentile(walls.offsets_m, 0.5),
      1000 * Percentile(walls.offsets_m, 0.95), Percentile(walls.turns_deg, 0.5), Percentile(walls.turns_deg, 0.95),
      Mean(driven.odometry_ms), Percentile(driven.odometry_ms, 0.99), polish_ms / 1000);
}

bool Run(const std::string& path, const tools::SimulateOptions& options, const std::string& folder) {
  const auto plan = ReadAGraphFile(path);
  if (!plan) {
    fmt::print(stderr, "{}\n", plan.error().message);
    return false;
  }
  const auto simulated = tools::Simulate(*plan, options, folder);
  if (!simulated) {
    fmt::print("{:<32} {}\n", std::filesystem::path(path).stem().string(), simulated.error().message);
    return true;
  }
  std::vector<Face> built = BuiltFaces(*plan, *simulated);
  Driven driven;
  if (!Drive(folder, built, driven)) return false;
  const double odometry_m = Ate_m(driven.mapper.graph(), driven.places);
  const auto start = Clock::now();
  const PolishResult polished = PolishMap(driven.mapper.graph());
  if (polished.usable) {
    for (size_t i = 0; i < polished.T_map_kf.size(); ++i) driven.mapper.mutable_graph().keyframes[i].T_map_kf = polished.T_map_kf[i];
    driven.mapper.OnPosesChanged();
  }
  const double polish_ms = Since_ms(start);
  const SGraph& map = driven.mapper.graph();
  const Eigen::Isometry3d T_plan_map = StartAligned(map, driven.places);
  WallScore walls = ScoreWalls(built, MappedFaces(map, T_plan_map), map);
  PrintRow(std::filesystem::path(path).stem().string(), *simulated, odometry_m, Ate_m(map, driven.places), BestAte_m(map, driven.places),
           walls, driven, polish_ms);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  tools::SimulateOptions options;
  options.min_duration_s = options.max_duration_s = 180;
  options.clutter = 10;
  std::vector<std::string> plans;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const double value = i + 1 < argc ? std::strtod(argv[i + 1], nullptr) : 0;
    if (!argument.starts_with("--")) { plans.push_back(argument); continue; }
    ++i;
    if (argument == "--seconds") options.min_duration_s = options.max_duration_s = value;
    if (argument == "--noise") options.noise_m = value;
    if (argument == "--clutter") options.clutter = static_cast<int>(value);
    if (argument == "--seed") options.seed = static_cast<uint64_t>(value);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("plumb-map-benchmark-{}", getpid());
  PrintHead();
  bool fine = !plans.empty();
  for (const std::string& plan : plans) fine = Run(plan, options, folder.string()) && fine;
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("seed {}, noise {} m, {} boxes; peak memory {} MB\n", options.seed, options.noise_m > 0 ? options.noise_m : 0.02,
             options.clutter, usage.ru_maxrss / 1024);
  return fine ? 0 : 2;
}
