// Simulated recordings: a house built from its plan with some walls off, and a robot with a spinning lidar that drives through it.
//
// The as-built house (as_built.h), the drive (tour.h, drive.h), the sweeps (sweep.h) and the odometry (wheel_odometry.h) all follow from
// the plan, the options and the seed: same input, same bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

struct SimulateOptions {
  uint64_t seed = 1;
  int deviate = 3;                                            // walls that are built off the plan, ...
  double deviate_ratio = 0;                                   // ... or, if positive, this share of those that may be, as far as they can
  int missing = 0;                                            // planned walls that were not built
  int unplanned = 0;                                          // walls that were built and are not in the plan
  int doorways = 0;                                           // doorways that are elsewhere in their wall, or narrower or wider, ...
  double doorways_ratio = 0;                                  // ... or, if positive, this share of those that may be, as far as they can
  double min_doorway_m = 0.03, max_doorway_m = 0.3;           // shift of the middle, and what the width is off, either way
  double min_translation_m = 0.05, max_translation_m = 0.35;  // along the wall's normal, either way
  double min_rotation_rad = 0, max_rotation_rad = 0.0873;     // yaw about the middle of the wall's longest room surface, either way
  std::string sensor = "vlp16";                               // see sensor.h
  double noise_m = 0;                                         // sigma of a range; 0: the sensor's own
  int storey = -1;                                            // index of the storey to drive on; -1: the one with most rooms
  double speed_m_s = 0.5;
  double sensor_height_m = 0.6;                               // above the floor
  double min_duration_s = 120;                                // goes on visiting rooms until then
  double max_duration_s = 900;                                // stops then, wherever it is
  double wobble_rad = 0.005;                                  // largest roll and pitch of the moving robot
  double glass_transmission = 0.9;                            // chance that a ray passes a pane
  int clutter = 0;                                            // boxes that stand about and are not in the plan
  double start_stamp_s = 1000;                                // stamp of the first sweep

  // Drift of the wheel odometry. The two sigmas are of errors drawn once per recording.
  double odometry_rate_hz = 20;
  double odometry_scale_sigma = 0.015;             // of distance
  double odometry_yaw_bias_sigma_rad_s = 0.0003;   // about 1 deg per minute
  double odometry_yaw_walk_rad_sqrt_s = 0.0015;    // random walk: about 0.7 deg in a minute
  double odometry_slip = 0.01;                     // noise of each step, share of its length

  // Empty if all is well, else "SimulateOptions.field = value; must be ...".
  [[nodiscard]] std::string Check() const;
};

// One surface of a wall that is off: displacement at the planned midpoint, + along the planned normal; yaw about +z.
struct SurfaceDisplacement {
  SurfaceId surface;
  double translation_m = 0, rotation_rad = 0;
};

struct WallDisplacement {
  WallId wall;
  SurfaceId reference;          // the wall's longest surface towards a room of the storey
  double translation_m = 0;     // of the reference surface
  double rotation_rad = 0;
  std::vector<SurfaceDisplacement> surfaces;  // every surface of the wall
};

struct MissingWall {
  WallId wall;
  uint64_t rays_through = 0;  // rays that went right through where the plan has it
};

struct UnplannedWall {
  std::vector<Eigen::Vector2d> polygon;  // footprint, plan frame
  double height_m = 0;
  uint64_t points = 0;                   // returns from it
};

// A doorway of the storey, in a straight wall. The shift is along the built wall, + to the left of who passes from room_a to room_b, from
// where the doorway would be had its wall moved along its own normal and turned about the middle of its longest surface, taken on the line
// through its doorways.
struct BuiltDoorway {
  DoorwayId doorway;
  double shift_m = 0, width_deviation_m = 0;
  uint64_t rays_through = 0;  // of every eighth ray those that went through it as built
};

struct SimulateSummary {
  StoreyId storey;
  size_t scans = 0, points = 0;
  double duration_s = 0, path_m = 0;
  double robot_radius_m = 0;                  // of the robot that fits through every doorway it has to
  RoomId start_room;
  std::vector<RoomId> visited, not_visited;   // rooms of the storey
  std::vector<uint64_t> surface_points;       // per plan surface: returns from it,
  std::vector<uint32_t> surface_scans;        // scans with at least kMinScanPoints of them,
  std::vector<double> surface_seen_m2;        // and how much of it they came from (seen_area.h)
  std::vector<WallDisplacement> walls;
  std::vector<MissingWall> missing;
  std::vector<UnplannedWall> unplanned;
  std::vector<BuiltDoorway> doorways;         // all that are in straight walls of the storey
  size_t doorways_changed = 0;
  int boxes = 0;                              // clutter that found a place
};

inline constexpr uint32_t kMinScanPoints = 20;

// Called from one thread at a time with the sweeps done so far and in all.
using SimulateProgress = std::function<void(size_t done, size_t total)>;

// Writes scans/, odometry.tum, truth.tum and truth.json into `out_folder` (made where absent; old scans in it are removed).
// Errors: kBadOption, kPlanUnsuitable (no room to drive in, no way through a doorway, too few walls that can deviate or be left out, no
// place for one more), kFileUnwritable. Time: about 10 million rays a second and core.
[[nodiscard]] Expected<SimulateSummary> Simulate(const AGraph& plan, const SimulateOptions& options, const std::string& out_folder,
                                                 const SimulateProgress& progress = {});

}  // namespace plumb::tools
