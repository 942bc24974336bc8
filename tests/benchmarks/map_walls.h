// The walls of a building as built against those of an S-Graph of it: what the map benchmark scores.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/matching/ray_caster.h"
#include "runtime/sources/recording.h"
#include "schema/agraph.h"
#include "tools/simulate/simulate.h"

namespace plumb::benchmarks {

// The house that a simulation drove through, to the triangle.
class BuiltHouse {
 public:
  // As Simulate() built it from the same plan and options; none if it could not.
  [[nodiscard]] static std::optional<BuiltHouse> Build(const AGraph& plan, const tools::SimulateOptions& options, StoreyId storey);
  // How far in front of p, along n, the face nearest to p stands, within `reach_m` before and behind; none if there is none. Plan frame.
  [[nodiscard]] std::optional<double> FaceNear_m(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double reach_m) const;

 private:
  BuiltHouse(const AGraph& house, const Eigen::Vector3d& origin) : origin_(origin), caster_(house.mesh) {}
  Eigen::Vector3d origin_;
  runtime::RayCaster caster_;
};

// A plan surface as built, seen from above: from `start` to `end`, free space on the left. Squares of it from `start` on, row by row from
// z_min_m up.
struct BuiltFace {
  struct Square {
    bool built = false;             // not a window, a doorway or behind a sill: the house has its face right there
    uint32_t scans = 0;             // that saw it
    double returns = 0, sum_m = 0;  // nearby, and how far before it together
  };
  Eigen::Vector2d start, end;
  double z_min_m = 0, z_max_m = 0;
  size_t columns = 0, rows = 0;
  std::vector<Square> squares;
  [[nodiscard]] Eigen::Vector2d direction() const { return (end - start).normalized(); }
  [[nodiscard]] double length_m() const { return (end - start).norm(); }
  [[nodiscard]] Eigen::Vector3d normal() const { return {-direction().y(), direction().x(), 0}; }
  // The square before which p stands; none beside the face.
  [[nodiscard]] std::optional<size_t> SquareAt(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool Seen(size_t square) const;  // built, by enough scans, and not only something close to it
  [[nodiscard]] double seen_m() const;           // of its length
};

// A wall of the map in the plan's frame.
struct MappedFace {
  runtime::Plane plane;
  Eigen::Vector2d start, end;
  double z_min_m = 0, z_max_m = 0, points = 0;
  size_t views = 0;
  std::vector<Eigen::Vector3d> cells;  // on the plane
};

// The plan's plane surfaces of the storey that the drive sees, as the simulation built them.
[[nodiscard]] std::vector<BuiltFace> BuiltFaces(const AGraph& plan, const tools::SimulateSummary& simulated, const BuiltHouse& house);

// Counts a scan for the parts of the built faces that it saw.
void CountSeen(const runtime::Scan& deskewed, const Eigen::Isometry3d& T_plan_lidar, std::vector<BuiltFace>& built);

[[nodiscard]] std::vector<MappedFace> MappedFaces(const runtime::SGraph& map, const Eigen::Isometry3d& T_plan_map);

struct WallScore {
  int walls = 0, found = 0, twice = 0, phantoms = 0;
  std::vector<double> offsets_m, turns_deg, tilts_deg;  // absolute
};

// Found: half of its seen length is in the map. Offset, turn and tilt are those of the surface of the map that has most of it, where it has
// it. Twice: two surfaces of the map within 10 cm of each other where the house has one, or where it has none at one of them: a sill before
// its wall is a surface of its own. Phantoms: surfaces of the map, furniture included, half of which or more lie where the house has no
// face so directed. `name`: on stderr all walls that are missed, twice, phantoms, or off by more than 1 cm or 0.2 degrees, with what the
// map has there.
[[nodiscard]] WallScore ScoreWalls(const std::vector<BuiltFace>& built, const std::vector<MappedFace>& mapped, const BuiltHouse& house,
                                   bool name);

}  // namespace plumb::benchmarks
