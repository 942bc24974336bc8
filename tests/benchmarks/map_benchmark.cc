// How well the S-Graph maps a building, with no plan given to it: a drive simulated in each plan, then odometry, mapping and the final
// polish.
//   map_benchmark [--seconds S] [--noise M] [--clutter N] [--seed N] [--deviate SHARE] [--drop S] [--name] PLAN.agraph...
// --drop: so many seconds of scans are missing out of every 15. --name: says of which walls something is to be said (map_walls.h).
// One row for each plan. ATE: of the scans' positions, rms, with the first two seconds laid on the truth; up: of their heights alone.
// Walls: the plan's plane surfaces of which 20 scans or more have seen over 1 m, as built, against the map: found if half of what was seen
// of them is in the map. Where the map lies is not the walls' fault, so for them it is laid on the truth of the whole drive; from start:
// the same 95 % as with ATE's alignment, which turns with the noise of the first scans. Loop: where the robot comes by again, 20 m of way
// later or more and within 1 m, how far the second visit lies from where the first has it, rms: as mapped, and after the polish.
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
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
#include "tests/benchmarks/map_walls.h"
#include "tools/simulate/simulate.h"

namespace {

using namespace plumb;
using namespace plumb::runtime;
using namespace plumb::benchmarks;
using Clock = std::chrono::steady_clock;

constexpr size_t kStart_scans = 20;
constexpr double kDropPeriod_s = 15;
constexpr double kLoopWay_m = 20, kLoopDistance_m = 1;

double Since_ms(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

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

bool Drive(const std::string& folder, double drop_s, std::vector<BuiltFace>& built, Driven& out) {
  const auto recording = Recording::Open(folder);
  const auto truth = ReadTum(folder + "/truth.tum");
  if (!recording || !truth) return false;
  Odometry odometry;
  for (size_t i = 0; i < recording->size(); ++i) {
    const auto scan = recording->Read(i);
    const auto at = scan ? InterpolatePose(*truth, scan->stamp_s) : std::nullopt;
    if (!at || std::fmod(scan->stamp_s, kDropPeriod_s) > kDropPeriod_s - drop_s) continue;
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

// Lays the first `scans` on the truth: the mean turn, then the mean shift. One scan alone is turned by 0.1 degrees of noise.
Eigen::Isometry3d Aligned(const SGraph& map, const std::vector<ScanPlace>& places, size_t scans) {
  const size_t n = std::min(scans, places.size());
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

struct Ate {
  double all_m = 0, up_m = 0;
};

Ate AteOf(const SGraph& map, const std::vector<ScanPlace>& places) {
  const Eigen::Isometry3d T = Aligned(map, places, kStart_scans);
  Eigen::Vector3d sum_m2 = Eigen::Vector3d::Zero();
  for (const ScanPlace& p : places) sum_m2 += (T * PoseIn(map, p).translation() - p.truth.translation()).cwiseAbs2();
  sum_m2 /= static_cast<double>(places.size());
  return {std::sqrt(sum_m2.sum()), std::sqrt(sum_m2.z())};
}

// In the first visit's frame, by which the start's alignment cancels.
double Loop_m(const SGraph& map, const std::vector<ScanPlace>& places) {
  constexpr size_t kStep = 5;
  std::vector<double> way_m(places.size(), 0.0);
  for (size_t i = 1; i < places.size(); ++i) {
    way_m[i] = way_m[i - 1] + (places[i].truth.translation() - places[i - 1].truth.translation()).norm();
  }
  double sum_m2 = 0;
  size_t num_pairs = 0;
  for (size_t i = 0; i < places.size(); i += kStep) {
    for (size_t k = 0; k < i && way_m[i] - way_m[k] >= kLoopWay_m; k += kStep) {
      const Eigen::Isometry3d true_step = places[k].truth.inverse() * places[i].truth;
      if (true_step.translation().norm() > kLoopDistance_m) continue;
      const Eigen::Isometry3d step = PoseIn(map, places[k]).inverse() * PoseIn(map, places[i]);
      sum_m2 += (step.translation() - true_step.translation()).squaredNorm();
      ++num_pairs;
    }
  }
  return num_pairs > 0 ? std::sqrt(sum_m2 / static_cast<double>(num_pairs)) : 0;
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
  fmt::print(
      "{:<32} {:>6} {:>7} {:>8} {:>8} {:>8} {:>8} {:>12} {:>11} {:>6} {:>7} {:>9} {:>9} {:>10} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8}\n",
      "plan", "s", "m", "odo cm", "ATE cm", "up cm", "best cm", "loop cm", "walls", "twice", "phantom", "off mm", "95% mm", "from start",
      "turn deg", "95% deg", "tilt 95%", "odo ms", "p99 ms", "map ms", "polish s");
}

void PrintRow(const std::string& name, const tools::SimulateSummary& simulated, double odometry_m, Ate map, double best_m,
              std::pair<double, double> loop_m, const WallScore& walls, const WallScore& from_start, const Driven& driven,
              double polish_ms) {
  fmt::print(
      "{:<32} {:>6.0f} {:>7.1f} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f} {:>12} {:>11} {:>6} {:>7} {:>9.1f} {:>9.1f} {:>10.1f} {:>9.3f} "
      "{:>9.3f} {:>9.3f} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f}\n",
      name, simulated.duration_s, simulated.path_m, 100 * odometry_m, 100 * map.all_m, 100 * map.up_m, 100 * best_m,
      fmt::format("{:.2f}/{:.2f}", 100 * loop_m.first, 100 * loop_m.second), fmt::format("{}/{}", walls.found, walls.walls), walls.twice,
      walls.phantoms, 1000 * Percentile(walls.offsets_m, 0.5), 1000 * Percentile(walls.offsets_m, 0.95),
      1000 * Percentile(from_start.offsets_m, 0.95), Percentile(walls.turns_deg, 0.5), Percentile(walls.turns_deg, 0.95),
      Percentile(walls.tilts_deg, 0.95), Mean(driven.odometry_ms), Percentile(driven.odometry_ms, 0.99), Mean(driven.mapping_ms),
      polish_ms / 1000);
  std::fflush(stdout);  // beside what is said of single walls
}

bool Run(const std::string& path, const tools::SimulateOptions& options, double drop_s, bool name, const std::string& folder) {
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
  const std::optional<BuiltHouse> house = BuiltHouse::Build(*plan, options, simulated->storey);
  if (!house) return false;
  std::vector<BuiltFace> built = BuiltFaces(*plan, *simulated, *house);
  Driven driven;
  if (!Drive(folder, drop_s, built, driven)) return false;
  const double odometry_m = AteOf(driven.mapper.graph(), driven.places).all_m;
  const double mapped_loop_m = Loop_m(driven.mapper.graph(), driven.places);
  const auto start = Clock::now();
  const PolishResult polished = PolishMap(driven.mapper.graph());
  if (polished.usable) {
    for (size_t i = 0; i < polished.T_map_kf.size(); ++i) driven.mapper.mutable_graph().keyframes[i].T_map_kf = polished.T_map_kf[i];
    driven.mapper.OnPosesChanged(true);
  }
  const double polish_ms = Since_ms(start);
  const SGraph& map = driven.mapper.graph();
  const auto score = [&](size_t scans, bool say) {
    return ScoreWalls(built, MappedFaces(map, Aligned(map, driven.places, scans)), *house, say);
  };
  PrintRow(std::filesystem::path(path).stem().string(), *simulated, odometry_m, AteOf(map, driven.places), BestAte_m(map, driven.places),
           {mapped_loop_m, Loop_m(map, driven.places)}, score(driven.places.size(), name), score(kStart_scans, false), driven, polish_ms);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  tools::SimulateOptions options;
  options.min_duration_s = options.max_duration_s = 180;
  options.clutter = 10;
  double drop_s = 0;
  bool name = false;
  std::vector<std::string> plans;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const double value = i + 1 < argc ? std::strtod(argv[i + 1], nullptr) : 0;
    if (argument == "--name") {
      name = true;
      continue;
    }
    if (!argument.starts_with("--")) {
      plans.push_back(argument);
      continue;
    }
    ++i;
    if (argument == "--seconds") options.min_duration_s = options.max_duration_s = value;
    if (argument == "--drop") drop_s = value;
    if (argument == "--noise") options.noise_m = value;
    if (argument == "--clutter") options.clutter = static_cast<int>(value);
    if (argument == "--deviate") options.deviate_ratio = value;
    if (argument == "--seed") options.seed = static_cast<uint64_t>(value);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("plumb-map-benchmark-{}", getpid());
  PrintHead();
  bool fine = !plans.empty();
  for (const std::string& plan : plans) fine = Run(plan, options, drop_s, name, folder.string()) && fine;
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("seed {}, noise {} m, {} boxes; peak memory {} MB\n", options.seed, options.noise_m > 0 ? options.noise_m : 0.02,
             options.clutter, usage.ru_maxrss / 1024);
  return fine ? 0 : 2;
}
