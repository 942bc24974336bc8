// Which planned faces a patch of the map may be of, and how likely each. Internal to coupling/.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/coupling/sight_lines.h"
#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_openings.h"
#include "runtime/coupling/wall_patch.h"

namespace plumb::runtime {

inline constexpr double kMapSigma_m = 0.03;   // of a map surface before joint estimation
inline constexpr double kMinOverlap_m = 0.2;  // of a patch and a face, along the wall

// A planned surface that is a face of its wall. Points into plan, frames and openings.
struct PlannedFace {
  SurfaceId id;
  const Surface* surface;
  const WallFrame* frame;
  const std::vector<WallOpening>* openings;
  int side;    // SideOf(): patches of one side lie on one line
  bool glass;  // of a wall that is planned of glass: what is seen past it does not speak against it
};

struct FaceCandidate {
  SurfaceId surface;
  int side = 0;        // PlannedFace::side
  bool glass = false;  // PlannedFace::glass
  double offset_m = 0, yaw_rad = 0, cost_nats = 0;
};

// `frames` and `openings` by wall.
[[nodiscard]] std::vector<PlannedFace> PlannedFaces(const AGraph& plan, const std::vector<WallFrame>& frames,
                                                    const std::vector<std::vector<WallOpening>>& openings);

// Per patch its candidates, the chosen one first.
using AssignedFaces = std::vector<std::vector<FaceCandidate>>;

// In the faces' order. `known`: by wall, may be shorter. O(faces).
[[nodiscard]] std::vector<FaceCandidate> CandidatesOf(const Patch& patch, const std::vector<PlannedFace>& faces, const SightLines& sight,
                                                      const std::vector<WallDeviation>& known, double max_offset_m,
                                                      const CouplingOptions& options);

}  // namespace plumb::runtime
