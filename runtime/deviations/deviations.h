// What was built otherwise: per surface and room, from the joint estimate; and its JSON.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "runtime/deviations/doorways.h"
#include "runtime/deviations/unplanned_walls.h"
#include "runtime/deviations/wall_presence.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// kMissing: the plan has it, the building does not.
enum class SurfaceStatus : uint8_t { kAsPlanned, kDeviated, kMissing, kUnobserved };
[[nodiscard]] const char* StatusName(SurfaceStatus status);  // as_planned | deviated | missing | unobserved

// Why a surface is unobserved.
enum class Unjudged : uint8_t {
  kNone,            // it is judged
  kNotAFace,        // the end of a wall, or curved: those never are
  kNotSeen,         // nothing that was seen is known to be its wall
  kSeenTooLittle,   // of its wall, all faces together
  kUncertain,       // what was seen leaves a large deviation possible, or would not have shown it
  kUndecided,       // its wall probably deviates, but not surely
  kMayBeFurniture,  // what was seen is so small, or so far off, that it may be anything
  kOtherShape,      // what was seen lies on another shape of the plan
  kNoCovariance,    // the estimate has none, so nothing can be tested
  kPlanarLaser,     // sees walls and furniture alike
};
[[nodiscard]] const char* UnjudgedName(Unjudged why);  // not_a_face | not_seen | ...; nothing for kNone

struct DeviationOptions {
  double false_discovery_rate = 0.01;  // Benjamini-Hochberg over the observed walls
  double tolerance_offset_m = 0.005;   // construction tolerance (standard deviation) that the test allows for
  double tolerance_yaw_rad = 0.0035;
  double min_offset_m = 0.02;  // smaller deviations are as planned, however certain
  double min_yaw_rad = 0.0087;
  double min_observed_m2 = 0.5;                     // less, over all faces of a wall, was not seen well enough to judge
  double turned_rad = 0.0873, min_turned_m2 = 1.0;  // ... nor was a wall turned so far: boxes have faces of that size at any angle, ...
  double min_turned_m = 1.5;                        // ... but are not so long, and stand in front of walls, not behind them
  double min_p_deviated = 0.97;                     // three in a hundred of those reported may be wrong
  double max_p_as_planned = 0.5;                    // nor is one as planned that more likely is not
  double max_mdb_m = 0.2;                           // a wall of which only larger deviations would have been found was not tested; ...
  double max_undecided_m = 0.1;  // ... nor one that may be so far off by what was seen (95 %), whatever is likely beforehand
  PresenceOptions presence;
  UnplannedOptions unplanned;
  DoorwayOptions doorways;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct SurfaceDeviation {
  SurfaceId surface;
  SurfaceStatus status = SurfaceStatus::kUnobserved;
  Unjudged unjudged = Unjudged::kNotSeen;             // kNone unless unobserved
  double translation_m = 0, sigma_translation_m = 0;  // at the surface's midpoint, + along its planned normal
  double rotation_rad = 0, sigma_rotation_rad = 0;    // + counter-clockwise about +z
  double tilt_rad = 0;                                // + the normal turns upwards
  double p_deviated = 0;
  double mdb_m = std::numeric_limits<double>::infinity();  // minimal detectable deviation: what the test would find with 80 % (alpha 0.1 %)
  double observed_m2 = 0;                                  // of this surface alone; missing: of its place
  double points = 0;                                       // missing: of those seen through it
};

// Rigid motion of the room in the plane, about its centre: what its walls moved, all in all.
struct RoomDeviation {
  RoomId room;
  SurfaceStatus status = SurfaceStatus::kUnobserved;
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();
  double rotation_rad = 0;
  double sigma_m = 0;  // of the translation, per axis
};

struct DeviationReport {
  std::string gauge;
  std::string unjudged;                    // how many walls were seen and not judged, and why; empty if there are none
  std::vector<SurfaceDeviation> surfaces;  // one per plan surface
  std::vector<RoomDeviation> rooms;        // one per plan room
  std::vector<UnplannedWall> unplanned;
  std::vector<DoorwayDeviation> doorways;  // one per plan doorway
};

// What is there without a plan, and what is not there.
struct WallChanges {
  std::vector<WallPresence> presence;  // per plan wall; empty: not judged
  std::vector<UnplannedWall> unplanned;
  std::vector<bool> on_other_shape = {};        // per plan wall (planned_shapes.h); empty: not judged
  std::vector<DoorwayDeviation> doorways = {};  // per plan doorway; empty: not judged
  [[nodiscard]] bool IsMissing(WallId wall) const {
    return wall.valid() && wall.index() < presence.size() && presence[wall.index()].missing;
  }
};

// Every face of a wall carries the wall's deviation, moved to the face's own midpoint and normal, plus its share of the thickness, and the
// wall's status; ends of walls and curved surfaces stay unobserved. A wall deviates if Benjamini-Hochberg rejects "as planned" on the
// chi-square (2 dof) of its evidence of (offset, yaw) plus tolerance, and it exceeds a minimum magnitude, and p_deviated is high. Where
// neither it nor a deviation of max_mdb_m could have been told, or what was seen leaves one of max_undecided_m possible, the wall is
// unobserved, however much of it was seen. So is a wall that was hardly seen and seems to have turned as boxes do, and a wall off its face
// whose shape is as planned: what was seen there is in the plan, but is not this face. The faces of a wall that `changes` calls missing are
// missing, whatever the estimate. A doorway that deviates from where a wall would have it that is not believed itself is unobserved. The
// gauge says how many walls deviate, are missing, or were seen and are not judged.
[[nodiscard]] DeviationReport AssessDeviations(const AGraph& plan, const JointResult& estimate, const DeviationOptions& options = {},
                                               const WallChanges& changes = {});

// deviations.json, version 1.
[[nodiscard]] std::string DeviationsToJson(const AGraph& plan, const DeviationReport& report);

}  // namespace plumb::runtime
