// Walls of the map that are two: pieces a few centimetres apart, or at a slight angle, that single views were too noisy to tell apart. All
// views together are not.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "runtime/mapping/map_surfaces.h"
#include "runtime/mapping/mapper_options.h"

namespace plumb::runtime {

// How far in front of a wall's plane its points lie, in a column of kColumn_m along it.
struct WallColumn {
  double along_m = 0;  // its middle, in the patch's coordinates
  double offset_m = 0;
  double variance_m2 = 0;  // of that, flatness of walls included
};
inline constexpr double kColumn_m = 0.2;

// Of a wall surface, from the kept points of the keyframes that observed it, in the order of along_m; where it has few points there are
// none. O(points of these keyframes).
[[nodiscard]] std::vector<WallColumn> ColumnsOf(const MapSurface& surface, const SurfaceTrack& track,
                                                const std::vector<Keyframe>& keyframes, const MapperOptions& options);

// Where two lines fit the columns better than one does, beyond doubt, and come to differ by 1.5 cm or more at the cut or at the shorter
// piece's end: a step or a bend. Each piece has 0.6 m of columns or more. O(columns^2).
[[nodiscard]] std::optional<double> FindCut(std::span<const WallColumn> columns);

// Cuts a wall surface at along_m and returns the piece beyond; its id is for the caller to give. What one keyframe saw of both pieces is
// told apart by its kept points. None, and nothing changed, if a piece would be too small or is not seen.
[[nodiscard]] std::optional<TrackedSurface> CutWall(double along_m, const std::vector<Keyframe>& keyframes, const MapperOptions& options,
                                                    MapSurface* surface, SurfaceTrack* track);

}  // namespace plumb::runtime
