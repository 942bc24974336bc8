// Odometry and mapping: error against truth, time per scan, and what the map looks like.
//   odometry_benchmark                  a synthetic drive through the test house
//   odometry_benchmark REC              a recording folder; compares with REC/truth.tum if there is one
//   ... --given                         uses REC/odometry.tum as a prior
//   ... --surfaces                      lists the map's surfaces
//   ... --points FILE                   writes the map's points, one `x y z` a line, in the truth's frame if there is one
#include <fmt/core.h>
#include <fmt/os.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mapping/mapper.h"
#include "runtime/odometry/odometry.h"
#include "runtime/rooms/rooms.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace {

using namespace plumb;
using namespace plumb::runtime;

struct Input {
  size_t num_scans = 0;
  std::function<std::optional<Scan>(size_t)> read;
  std::function<std::optional<Eigen::Isometry3d>(double)> truth_at, given_at;
};

class Timer {
 public:
  void Start() { start_ = std::chrono::steady_clock::now(); }
  void Stop() { times_ms_.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count()); }
  [[nodiscard]] std::string Summary(const char* per = "scan") {
    std::sort(times_ms_.begin(), times_ms_.end());
    double sum_ms = 0;
    for (const double ms : times_ms_) sum_ms += ms;
    if (times_ms_.empty()) return "no scans";
    const auto n = times_ms_.size();
    return fmt::format("{:.2f} ms/{} mean, {:.2f} p95, {:.2f} max", sum_ms / static_cast<double>(n), per, times_ms_[n * 95 / 100],
                       times_ms_.back());
  }

 private:
  std::chrono::steady_clock::time_point start_;
  std::vector<double> times_ms_;
};

Input SyntheticInput() {
  const auto lidar = std::make_shared<test::SyntheticLidar>(test::MakeHouse());
  const auto drive = std::make_shared<test::Drive>(test::HouseDrive());
  Input input;
  input.num_scans = static_cast<size_t>(drive->duration_s() / 0.1) - 1;
  input.read = [=](size_t i) { return lidar->Sweep([&](double t) { return drive->At(t); }, 0.1 * static_cast<double>(i)); };
  input.truth_at = [=](double t) { return drive->At(t); };
  return input;
}

std::optional<Input> RecordingInput(const std::string& folder, bool with_given) {
  Expected<Recording> opened = Recording::Open(folder);
  if (!opened) {
    fmt::print(stderr, "{}\n", opened.error().message);
    return std::nullopt;
  }
  const auto recording = std::make_shared<Recording>(std::move(*opened));
  Input input;
  input.num_scans = recording->size();
  input.read = [=](size_t i) -> std::optional<Scan> {
    Expected<Scan> scan = recording->Read(i);
    return scan ? std::optional<Scan>(std::move(*scan)) : std::nullopt;
  };
  if (Expected<Trajectory> truth = ReadTum(folder + "/truth.tum")) {
    input.truth_at = [t = std::move(*truth)](double stamp_s) { return InterpolatePose(t, stamp_s); };
  }
  if (with_given) input.given_at = [=](double stamp_s) { return InterpolatePose(recording->odometry(), stamp_s); };
  return input;
}

std::optional<Odometry::GivenMotion> Given(const Input& input, const Scan& scan) {
  if (!input.given_at) return std::nullopt;
  const double end_s = scan.stamp_s + (scan.time_s.empty() ? 0.0 : *std::max_element(scan.time_s.begin(), scan.time_s.end()));
  const auto start = input.given_at(scan.stamp_s), end = input.given_at(end_s);
  if (!start || !end) return std::nullopt;
  return Odometry::GivenMotion{*start, *end};
}

struct Errors {
  double square_sum_m2 = 0, worst_m = 0, worst_z_m = 0, worst_rad = 0;
  int count = 0;
  void Add(const Eigen::Isometry3d& off) {
    const double error_m = off.translation().norm();
    square_sum_m2 += error_m * error_m;
    worst_m = std::max(worst_m, error_m);
    worst_z_m = std::max(worst_z_m, std::abs(off.translation().z()));
    worst_rad = std::max(worst_rad, Eigen::AngleAxisd(off.linear()).angle());
    ++count;
  }
};

// A registered scan by the keyframe that was the newest when it came, as the localizer has it.
struct ScanPlace {
  size_t keyframe = 0;
  Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Vector3d> truth;
};

// The rigid motion that takes `from` to `to` best (Umeyama, without scale).
Eigen::Isometry3d Aligned(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  Eigen::Matrix3Xd a(3, from.size()), b(3, to.size());
  for (size_t i = 0; i < from.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = from[i];
    b.col(static_cast<Eigen::Index>(i)) = to[i];
  }
  return Eigen::Isometry3d(Eigen::umeyama(a, b, false));
}

// Position errors after alignment; returns the alignment.
std::optional<Eigen::Isometry3d> PrintAligned(const char* what, const std::vector<ScanPlace>& places,
                                              const std::function<Eigen::Vector3d(const ScanPlace&)>& position) {
  std::vector<Eigen::Vector3d> estimated, truth;
  for (const ScanPlace& place : places) {
    if (!place.truth) continue;
    estimated.push_back(position(place));
    truth.push_back(*place.truth);
  }
  if (truth.size() < 3) return std::nullopt;
  const Eigen::Isometry3d T = Aligned(estimated, truth);
  double sum_m2 = 0, worst_m = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const double error_m = (T * estimated[i] - truth[i]).norm();
    sum_m2 += error_m * error_m;
    worst_m = std::max(worst_m, error_m);
  }
  fmt::print("error of {}, best aligned: {:.4f} m rms, {:.4f} m worst\n", what, std::sqrt(sum_m2 / static_cast<double>(truth.size())),
             worst_m);
  return T;
}

// How thick walls come out: points' rms about their surface, over all its keyframes; the middle surface by points.
void PrintThickness(const SGraph& graph) {
  std::vector<std::pair<double, double>> walls;  // rms, points
  double points = 0;
  for (const MapSurface& s : graph.surfaces) {
    if (s.kind != SurfaceKind::kWall || s.observations.empty() || s.length_m() < 1.0) continue;
    PlaneStats sum;
    for (const Observation& o : s.observations) sum.Add(o.stats.Transformed(graph.keyframes[o.keyframe].T_map_kf));
    const Eigen::Vector4d plane(s.plane.n.x(), s.plane.n.y(), s.plane.n.z(), s.plane.d);
    walls.emplace_back(std::sqrt(std::max(0.0, plane.dot(sum.C * plane) / sum.count())), sum.count());
    points += sum.count();
  }
  std::sort(walls.begin(), walls.end());
  double so_far = 0;
  for (const auto& [rms_m, count] : walls) {
    so_far += count;
    if (so_far < 0.5 * points) continue;
    fmt::print("walls:    {} longer than 1 m, {:.4f} m rms across the middle one\n", walls.size(), rms_m);
    return;
  }
}

void WritePoints(const std::string& path, const SGraph& graph, const Eigen::Isometry3d& T) {
  fmt::ostream out = fmt::output_file(path);
  for (const Keyframe& keyframe : graph.keyframes) {
    for (const Eigen::Vector3f& point : keyframe.points) {
      const Eigen::Vector3d p = T * keyframe.T_map_kf * point.cast<double>();
      out.print("{:.3f} {:.3f} {:.3f}\n", p.x(), p.y(), p.z());
    }
  }
}

void PrintSurfaces(const SGraph& graph, const Eigen::Isometry3d& T_plan_map) {
  for (const MapSurface& s : graph.surfaces) {
    if (s.observations.empty()) continue;
    const Plane plane = s.plane.Transformed(T_plan_map);
    const Eigen::Vector3d a = T_plan_map * Eigen::Vector3d(s.start.x(), s.start.y(), s.z_min_m);
    const Eigen::Vector3d b = T_plan_map * Eigen::Vector3d(s.end.x(), s.end.y(), s.z_max_m);
    fmt::print(
        "{:4} {} n ({:6.3f} {:6.3f} {:6.3f}) d {:7.3f} from ({:.2f} {:.2f} {:.2f}) to ({:.2f} {:.2f} {:.2f}), {:.2f} m2, {} keyframes, "
        "{:.0f} points\n",
        s.id,
        s.kind == SurfaceKind::kWall    ? "wall   "
        : s.kind == SurfaceKind::kFloor ? "floor  "
                                        : "ceiling",
        plane.n.x(), plane.n.y(), plane.n.z(), plane.d, a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), s.area_m2, s.observations.size(),
        s.num_points);
  }
}

void Run(const Input& input, bool surfaces, const std::string& points_path) {
  Odometry odometry;
  Mapper mapper;
  Timer odometry_timer, mapper_timer;
  Errors errors;
  std::optional<Eigen::Isometry3d> T_plan_odom;
  int failed = 0;
  double length_m = 0, iterations = 0;
  std::optional<Eigen::Vector3d> last;
  std::vector<ScanPlace> places;
  for (size_t i = 0; i < input.num_scans; ++i) {
    const std::optional<Scan> scan = input.read(i);
    if (!scan) continue;
    const std::optional<Odometry::GivenMotion> given = Given(input, *scan);
    odometry_timer.Start();
    const OdometryResult r = odometry.Register(*scan, given);
    odometry_timer.Stop();
    mapper_timer.Start();
    if (r.ok) mapper.AddScan(r.deskewed, r.T_odom_lidar, r.planar ? std::optional(r.step_covariance) : std::nullopt);
    mapper_timer.Stop();
    failed += r.ok ? 0 : 1;
    iterations += r.iterations;
    if (last) length_m += (r.T_odom_lidar.translation() - *last).norm();
    last = r.T_odom_lidar.translation();
    const std::optional<Eigen::Isometry3d> truth = input.truth_at ? input.truth_at(scan->stamp_s) : std::nullopt;
    if (truth && !T_plan_odom) T_plan_odom = *truth * r.T_odom_lidar.inverse();
    const size_t num_keyframes = mapper.graph().keyframes.size();
    places.push_back({num_keyframes > 0 ? num_keyframes - 1 : 0, r.T_odom_lidar,
                      truth ? std::optional<Eigen::Vector3d>(truth->translation()) : std::nullopt});
    if (truth) errors.Add(truth->inverse() * *T_plan_odom * r.T_odom_lidar);
  }
  mapper.Flush();
  fmt::print("{} scans ({} failed), {:.1f} m\n", input.num_scans, failed, length_m);
  if (errors.count > 0) {
    fmt::print("error, aligned at the start: {:.4f} m rms, {:.4f} m worst (z {:.4f} m), {:.3f} deg worst\n",
               std::sqrt(errors.square_sum_m2 / errors.count), errors.worst_m, errors.worst_z_m, errors.worst_rad * 57.29578);
  }
  PrintAligned("odometry", places, [](const ScanPlace& place) -> Eigen::Vector3d { return place.T_odom_lidar.translation(); });
  const std::vector<Keyframe>& keyframes = mapper.graph().keyframes;
  std::optional<Eigen::Isometry3d> T_truth_map;
  if (!keyframes.empty()) {
    T_truth_map = PrintAligned("the map", places, [&](const ScanPlace& place) -> Eigen::Vector3d {
      const Keyframe& keyframe = keyframes[place.keyframe];
      return keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar.translation();
    });
  }
  fmt::print("odometry: {}; {:.1f} iterations\n", odometry_timer.Summary(), iterations / static_cast<double>(input.num_scans));
  fmt::print("mapper:   {}; {} keyframes, {} surfaces\n", mapper_timer.Summary(), mapper.graph().keyframes.size(),
             std::count_if(mapper.graph().surfaces.begin(), mapper.graph().surfaces.end(),
                           [](const MapSurface& s) { return !s.observations.empty(); }));
  PrintThickness(mapper.graph());
  if (!points_path.empty()) WritePoints(points_path, mapper.graph(), T_truth_map.value_or(Eigen::Isometry3d::Identity()));
  Timer rooms_timer;
  rooms_timer.Start();
  const UpperLayers layers = DeriveUpperLayers(mapper.graph());
  rooms_timer.Stop();
  fmt::print("rooms:    {}; {} floors, {} rooms, {} doorways, {} corridors\n", rooms_timer.Summary("run"), layers.floors.size(),
             layers.rooms.size(), layers.doorways.size(), layers.corridors.size());
  if (surfaces) PrintSurfaces(mapper.graph(), T_plan_odom.value_or(Eigen::Isometry3d::Identity()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto has = [&](const char* flag) { return std::find(arguments.begin(), arguments.end(), flag) != arguments.end(); };
  const bool synthetic = arguments.empty() || arguments[0].starts_with("--");
  const std::optional<Input> input = synthetic ? std::optional<Input>(SyntheticInput()) : RecordingInput(arguments[0], has("--given"));
  if (!input) return 2;
  const auto points = std::find(arguments.begin(), arguments.end(), "--points");
  Run(*input, has("--surfaces"), points != arguments.end() && points + 1 != arguments.end() ? points[1] : "");
}
