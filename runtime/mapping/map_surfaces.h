// The surfaces of the S-Graph: which segment belongs to which surface, and what a surface is given its observations.
#pragma once

#include <vector>

#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/mapping/surface_patch.h"

namespace plumb::runtime {

// What only the mapper needs of a surface.
struct SurfaceTrack {
  SurfacePatch patch;
  PlaneStats sum;  // of all observations, map frame
};

struct TrackedSurface {
  MapSurface surface;
  SurfaceTrack track;
};

// A surface of its own, made of one segment seen from `keyframe`.
[[nodiscard]] TrackedSurface SurfaceOf(const Segment& segment, const Keyframe& keyframe);

// How far apart two surfaces are, at the ends of their overlap; infinity if they are not the same: other kind or facing, other direction,
// offset too large, or a gap between them. Offsets are taken on the surfaces, never at the frame's origin, where an error in direction
// would pass for one in offset. `directed`: both directions are known well; else only merge_angle_rad bounds the angle between them.
[[nodiscard]] double SurfaceDistance(const SurfacePatch& a, const SurfacePatch& b, const MapperOptions& options, bool directed = true);

// False only of surfaces whose distance is infinity because they are far apart: a test of few steps, to be made first.
[[nodiscard]] bool MayTouch(const Ball& a, const Ball& b, const MapperOptions& options);

// Whether one plane fits the points of both about as well as each one's own does: nowhere near a step, however gently a plane could lean
// across it.
[[nodiscard]] bool FitOnePlane(const SurfaceTrack& a, const SurfaceTrack& b, const MapperOptions& options);
// The same of points alone; `towards`: roughly the normal.
[[nodiscard]] bool FitOnePlane(const PlaneStats& a, const PlaneStats& b, const Eigen::Vector3d& towards, const MapperOptions& options);

// Share of b's cells of which any of the others has been seen half as often as b or more, on or next to them and no further than that in
// front or behind.
[[nodiscard]] double CoveredShare(const SurfacePatch& b, const std::vector<const SurfacePatch*>& by, double distance_m);

// Whether b is none: most of its cells lie close in front of or behind where surfaces that face the same way and have many times as many
// points, one or several of them, have been seen half as often as b or more. Of two opaque surfaces one hides the other, so nothing real
// can be there; such planes lean from a wall to a door's casing or a window's frame. O(cells of b) for each surface near by, and a few
// steps for each of `surfaces`, which have `tracks` and `balls` (theirs) in the same order and may contain b.
[[nodiscard]] bool IsEcho(const MapSurface& b, const SurfacePatch& b_patch, const std::vector<MapSurface>& surfaces,
                          const std::vector<SurfaceTrack>& tracks, const std::vector<Ball>& balls);

// Which of b's cells are echoes though b as a whole is none: those right in front of or behind a cell that has been seen from many times as
// many keyframes. In the order of its patch's cells; arguments as above.
[[nodiscard]] std::vector<bool> EchoCells(const MapSurface& b, const SurfacePatch& b_patch, const std::vector<MapSurface>& surfaces,
                                          const std::vector<SurfaceTrack>& tracks, const std::vector<Ball>& balls);

// Whether what was seen of a surface is as much as a segment must have.
[[nodiscard]] bool IsLargeEnough(const SurfacePatch& patch, const MapperOptions& options);

// Takes cells from a surface; its points and plane stay as they were. False if what is left is too small for one.
[[nodiscard]] bool TakeCells(const std::vector<bool>& gone, const MapperOptions& options, MapSurface* surface, SurfaceTrack* track);

// Adds observations to others, in the keyframes' order, those of one keyframe as one.
void AddObservations(const std::vector<Observation>& more, std::vector<Observation>* observations);

// Adds b's observations and cells to a.
void Absorb(const TrackedSurface& b, const std::vector<Keyframe>& keyframes, MapSurface* a, SurfaceTrack* a_track);

// Plane and extent anew from the observations and the keyframes' present poses.
void Recompute(const std::vector<Keyframe>& keyframes, MapSurface* surface, SurfaceTrack* track);

}  // namespace plumb::runtime
