#include "tools/simulate/simulate.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <numbers>

#include "schema/files.h"
#include "tools/simulate/as_built.h"
#include "tools/simulate/clutter.h"
#include "tools/simulate/seen_area.h"
#include "tools/simulate/surface_counter.h"
#include "tools/simulate/sweep.h"
#include "tools/simulate/tour.h"
#include "tools/simulate/truth_json.h"
#include "tools/simulate/wall_changes.h"
#include "tools/simulate/wheel_odometry.h"

namespace plumb::tools {
namespace {

namespace fs = std::filesystem;

constexpr size_t kRaysPerCounted = 8;  // that are tried for going through doorways

// The one asked for, else the one with most rooms; none if there is no such storey with a room.
StoreyId ChooseStorey(const AGraph& plan, int wanted) {
  std::vector<size_t> rooms(plan.storeys.size(), 0);
  for (const Room& room : plan.rooms) {
    if (room.storey.valid()) ++rooms[room.storey.index()];
  }
  if (rooms.empty()) return {};
  const size_t most = static_cast<size_t>(std::max_element(rooms.begin(), rooms.end()) - rooms.begin());
  const size_t chosen = wanted < 0 ? most : static_cast<size_t>(wanted);
  return chosen < rooms.size() && rooms[chosen] > 0 ? StoreyId(chosen) : StoreyId();
}

// An empty scans folder and no files of an earlier recording: they would be taken for some of this one, should it be broken off.
Expected<void> PrepareFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "scans", error);
  if (error) return Fail(ErrorCode::kFileUnwritable, fmt::format("cannot make `{}`: {}", (folder / "scans").string(), error.message()));
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "scans", error)) {
    if (entry.path().extension() == ".pcd") old.push_back(entry.path());
  }
  for (const char* name : {"odometry.tum", "truth.tum", "truth.json"}) old.push_back(folder / name);
  for (const fs::path& path : old) fs::remove(path, error);
  // Tells a simulation that was broken off from scans of others.
  if (auto written = WriteFileAtomically((folder / "truth.json").string(), std::string_view("{\"version\": 1, \"incomplete\": true}\n"));
      !written)
    return written;
  if (error) return Fail(ErrorCode::kFileUnwritable, fmt::format("cannot clear `{}`: {}", (folder / "scans").string(), error.message()));
  return {};
}

// To the nanosecond of the scan's file name, so that stamps read back as they were used.
double StampOf(const SimulateOptions& options, const SensorModel& sensor, size_t scan) {
  return std::round((options.start_stamp_s + static_cast<double>(scan) * sensor.period_s()) * 1e9) / 1e9;
}

// Takes and writes all sweeps. Each has a random stream of its own, so the threads' order does not matter.
class Recorder {
 public:
  Recorder(const AGraph& plan, StoreyId storey, const AsBuilt& built, const Drive& drive, const SensorModel& sensor,
           const SimulateOptions& options)
      : plan_(plan), counter_(plan, built), drive_(drive), lidar_(built.house, sensor, options.glass_transmission), options_(options),
        house_(built.house), origin_(plan.origin), surface_points_(plan.surfaces.size(), 0), surface_scans_(plan.surfaces.size(), 0) {
    const std::vector<WallBody> bodies = FindWallBodies(plan);
    for (const WallId wall : built.missing) {
      missing_.push_back({wall, 0});
      missing_bodies_.push_back(bodies[wall.index()]);
    }
    for (BuiltDoorway& truth : DoorwaysOf(plan, storey, built)) {
      const Doorway& d = built.doorways[truth.doorway.index()];
      const Eigen::Vector2d along(-std::sin(d.yaw_rad), std::cos(d.yaw_rad));
      const Rectangle opening{d.position.head<2>(), along, 0.5 * d.width_m, 0.5 * plan.walls[d.wall.index()].thickness_m};
      openings_.push_back({opening.Moved(built.motions[d.wall.index()]), d.position.z(), d.position.z() + d.height_m, false});
      doorways_.push_back(truth);
    }
    for (const AddedWall& wall : built.unplanned) {
      const auto corners = wall.footprint.Corners();
      unplanned_.push_back({{corners.begin(), corners.end()}, wall.height_m, 0});
      unplanned_elements_.push_back(wall.element);
    }
  }

  Expected<void> Run(const fs::path& folder, size_t scans, const SimulateProgress& progress) {
    tbb::parallel_for(size_t{0}, scans, [&](size_t i) { RecordOne(folder, i, scans, progress); });
    if (error_) return tl::unexpected(*error_);
    return {};
  }

  void Report(SimulateSummary& summary) const {
    summary.points = points_;
    summary.surface_points = surface_points_;
    summary.surface_scans = surface_scans_;
    summary.surface_seen_m2 = seen_area_.PerSurface_m2(plan_.surfaces.size());
    summary.missing = missing_;
    summary.unplanned = unplanned_;
    summary.doorways = doorways_;
  }

 private:
  void RecordOne(const fs::path& folder, size_t i, size_t scans, const SimulateProgress& progress) {
    const double stamp_s = StampOf(options_, lidar_.model(), i);
    Random random(options_.seed, static_cast<uint64_t>(RandomStream::kSweeps) + i);
    const auto pose = [this](double time_s) { return drive_.PoseAt(time_s); };
    const Sweep sweep = lidar_.Take(stamp_s - options_.start_stamp_s, stamp_s, pose, random);
    std::vector<uint32_t> seen(plan_.surfaces.size(), 0);
    std::vector<SurfaceHit> hits;
    for (const Echo& echo : sweep.echoes) {
      hits.push_back(counter_.HitOf(echo));
      if (hits.back().surface.valid()) ++seen[hits.back().surface.index()];
    }
    const Changes changes = CountChanges(sweep, pose(stamp_s - options_.start_stamp_s).translation());
    const Expected<void> written = runtime::WritePcd(sweep.scan, (folder / "scans" / runtime::ScanFileName(stamp_s)).string());
    const std::lock_guard lock(mutex_);
    if (!written && !error_) error_ = written.error();
    for (size_t s = 0; s < seen.size(); ++s) {
      surface_points_[s] += seen[s];
      surface_scans_[s] += seen[s] >= kMinScanPoints ? 1 : 0;
    }
    seen_area_.Add(hits);
    for (size_t w = 0; w < missing_.size(); ++w) missing_[w].rays_through += changes.rays_through[w];
    for (size_t w = 0; w < unplanned_.size(); ++w) unplanned_[w].points += changes.points[w];
    for (size_t d = 0; d < doorways_.size(); ++d) doorways_[d].rays_through += changes.rays_in[d];
    points_ += sweep.scan.points.size();
    if (progress) progress(++done_, scans);
  }

  // What one sweep saw of walls left out and added, and of doorways.
  struct Changes {
    std::vector<uint64_t> rays_through, points, rays_in;
  };
  [[nodiscard]] Changes CountChanges(const Sweep& sweep, const Eigen::Vector3d& sensor) const {
    Changes changes{std::vector<uint64_t>(missing_bodies_.size(), 0), std::vector<uint64_t>(unplanned_elements_.size(), 0),
                    std::vector<uint64_t>(openings_.size(), 0)};
    for (const Echo& echo : sweep.echoes) {
      for (size_t w = 0; w < missing_bodies_.size(); ++w) {
        changes.rays_through[w] += PassesThrough(missing_bodies_[w], sensor, echo.position.cast<double>() + origin_) ? 1 : 0;
      }
      for (size_t w = 0; w < unplanned_elements_.size(); ++w) {
        changes.points[w] += house_.mesh.triangles[echo.triangle].element == unplanned_elements_[w] ? 1 : 0;
      }
    }
    for (size_t i = 0; i < sweep.echoes.size(); i += kRaysPerCounted) {
      const Eigen::Vector3d to = sweep.echoes[i].position.cast<double>() + origin_;
      for (size_t d = 0; d < openings_.size(); ++d) changes.rays_in[d] += PassesThrough(openings_[d], sensor, to) ? 1 : 0;
    }
    return changes;
  }

  const AGraph& plan_;
  const SurfaceCounter counter_;
  const Drive& drive_;
  const Lidar lidar_;
  const SimulateOptions& options_;
  const AGraph& house_;
  const Eigen::Vector3d origin_;
  std::vector<WallBody> missing_bodies_;      // of missing_
  std::vector<WallBody> openings_;            // of doorways_, as built
  std::vector<uint32_t> unplanned_elements_;  // of unplanned_
  std::mutex mutex_;  // guards all below
  std::optional<Error> error_;
  std::vector<uint64_t> surface_points_;
  std::vector<uint32_t> surface_scans_;
  SeenArea seen_area_;
  std::vector<MissingWall> missing_;
  std::vector<UnplannedWall> unplanned_;
  std::vector<BuiltDoorway> doorways_;
  size_t points_ = 0, done_ = 0;
};

runtime::Trajectory TruthAtScans(const Drive& drive, const SensorModel& sensor, const SimulateOptions& options, size_t scans) {
  runtime::Trajectory truth;
  for (size_t i = 0; i < scans; ++i) {
    runtime::StampedPose pose;
    pose.stamp_s = StampOf(options, sensor, i);
    pose.T = drive.PoseAt(pose.stamp_s - options.start_stamp_s);
    truth.push_back(pose);
  }
  return truth;
}

TourOptions ToTourOptions(const SimulateOptions& options) {
  TourOptions tour;
  tour.drive.speed_m_s = options.speed_m_s;
  tour.drive.sensor_height_m = options.sensor_height_m;
  tour.drive.wobble_rad = options.wobble_rad;
  tour.min_duration_s = options.min_duration_s;
  tour.max_duration_s = options.max_duration_s;
  return tour;
}

}  // namespace

std::string SimulateOptions::Check() const {
  const auto bad = [](const char* field, auto value, const char* rule) {
    return fmt::format("SimulateOptions.{} = {}; must be {}", field, value, rule);
  };
  if (deviate < 0) return bad("deviate", deviate, ">= 0");
  if (!(deviate_ratio >= 0 && deviate_ratio <= 1)) return bad("deviate_ratio", deviate_ratio, "from 0 to 1");
  if (missing < 0) return bad("missing", missing, ">= 0");
  if (unplanned < 0) return bad("unplanned", unplanned, ">= 0");
  if (doorways < 0) return bad("doorways", doorways, ">= 0");
  if (!(doorways_ratio >= 0 && doorways_ratio <= 1)) return bad("doorways_ratio", doorways_ratio, "from 0 to 1");
  if (!(min_doorway_m >= 0)) return bad("min_doorway_m", min_doorway_m, ">= 0");
  if (!(max_doorway_m >= min_doorway_m && max_doorway_m <= 1)) return bad("max_doorway_m", max_doorway_m, "from min_doorway_m to 1");
  if (!(min_translation_m >= 0)) return bad("min_translation_m", min_translation_m, ">= 0");
  if (!(max_translation_m >= min_translation_m && max_translation_m <= 2)) {
    return bad("max_translation_m", max_translation_m, "from min_translation_m to 2");
  }
  if (!(min_rotation_rad >= 0)) return bad("min_rotation_rad", min_rotation_rad, ">= 0");
  if (!(max_rotation_rad >= min_rotation_rad && max_rotation_rad <= 0.53)) {
    return bad("max_rotation_rad", max_rotation_rad, "from min_rotation_rad to 0.53");
  }
  if (!FindSensor(sensor)) return bad("sensor", sensor, fmt::format("one of {}", fmt::join(SensorNames(), ", ")).c_str());
  if (!(noise_m >= 0 && noise_m <= 0.5)) return bad("noise_m", noise_m, "from 0 to 0.5");
  if (!(speed_m_s >= 0.05 && speed_m_s <= 3)) return bad("speed_m_s", speed_m_s, "from 0.05 to 3");
  if (!(sensor_height_m >= 0.1 && sensor_height_m <= 3)) return bad("sensor_height_m", sensor_height_m, "from 0.1 to 3");
  if (!(min_duration_s >= 0 && min_duration_s <= 36000)) return bad("min_duration_s", min_duration_s, "from 0 to 36000");
  if (!(max_duration_s >= std::max(1.0, min_duration_s)))
    return bad("max_duration_s", max_duration_s, ">= 1 and no less than the duration asked for");
  if (!(wobble_rad >= 0 && wobble_rad <= 0.1)) return bad("wobble_rad", wobble_rad, "from 0 to 0.1");
  if (!(glass_transmission >= 0 && glass_transmission <= 1)) return bad("glass_transmission", glass_transmission, "from 0 to 1");
  if (clutter < 0 || clutter > 1000) return bad("clutter", clutter, "from 0 to 1000");
  if (!(start_stamp_s >= 1 && start_stamp_s < 9e9)) return bad("start_stamp_s", start_stamp_s, "from 1 to 9e9");
  if (!(odometry_rate_hz >= 1 && odometry_rate_hz <= 1000)) return bad("odometry_rate_hz", odometry_rate_hz, "from 1 to 1000");
  return {};
}

Expected<SimulateSummary> Simulate(const AGraph& plan, const SimulateOptions& options, const std::string& out_folder,
                                   const SimulateProgress& progress) {
  if (const std::string fault = options.Check(); !fault.empty()) return Fail(ErrorCode::kBadOption, fault);
  SimulateSummary summary;
  summary.storey = ChooseStorey(plan, options.storey);
  if (!summary.storey.valid()) return Fail(ErrorCode::kPlanUnsuitable, "the plan has no room on the storey to drive on");
  Expected<AsBuilt> built = BuildWithDeviations(plan, summary.storey, options);
  if (!built) return tl::unexpected(built.error());
  summary.walls = built->walls;
  summary.doorways_changed = built->doorway_changes.size();
  if (const auto done = LeaveOutWalls(plan, summary.storey, options.missing, options.seed, *built); !done)
    return tl::unexpected(done.error());
  if (const auto done = AddWalls(plan, summary.storey, options.unplanned, options.seed, *built); !done) return tl::unexpected(done.error());
  if (options.clutter > 0) summary.boxes = AddClutter(*built, summary.storey, options.clutter, options.seed);

  const FreeSpace space(built->house, summary.storey, built->passages);
  const Reach reach = FindReach(built->house, summary.storey, space);
  Random random(options.seed, static_cast<uint64_t>(RandomStream::kTour));
  const Expected<Tour> tour = PlanTour(built->house, space, reach, ToTourOptions(options), random);
  if (!tour) return tl::unexpected(tour.error());
  summary.start_room = tour->start_room;
  summary.visited = tour->visited;
  summary.not_visited = tour->not_visited;
  summary.path_m = tour->path_m;
  summary.robot_radius_m = reach.robot_radius_m;

  SensorModel sensor = *FindSensor(options.sensor);
  if (options.noise_m > 0) sensor.noise_m = options.noise_m;
  const fs::path folder(out_folder);
  summary.scans = static_cast<size_t>(std::floor(tour->drive.duration_s() * sensor.rate_hz));
  summary.duration_s = static_cast<double>(summary.scans) * sensor.period_s();
  if (const Expected<void> ready = PrepareFolder(folder); !ready) return tl::unexpected(ready.error());
  Recorder recorder(plan, summary.storey, *built, tour->drive, sensor, options);
  if (const Expected<void> run = recorder.Run(folder, summary.scans, progress); !run) return tl::unexpected(run.error());
  recorder.Report(summary);

  const std::pair<const char*, std::string> files[] = {
      {"odometry.tum", runtime::WriteTum(SimulateOdometry(tour->drive, options))},
      {"truth.tum", runtime::WriteTum(TruthAtScans(tour->drive, sensor, options, summary.scans))},
      {"truth.json", TruthToJson(plan, options, summary)}};
  for (const auto& [name, text] : files) {
    const Expected<void> written = WriteFileAtomically((folder / name).string(), text);
    if (!written) return tl::unexpected(written.error());
  }
  return summary;
}

}  // namespace plumb::tools
