// A map with walls put in by hand, for the tests of coupling.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {

// A map in plan coordinates: one keyframe, patches added by hand.
struct Scene {
  SGraph map;
  Scene() { map.keyframes.emplace_back(); }
  uint32_t Add(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double z_min_m = 0.2, double z_max_m = 2.0) {
    MapSurface s;
    s.id = static_cast<uint32_t>(map.surfaces.size());
    const Eigen::Vector2d along = (end - start).normalized();
    s.plane.n = {-along.y(), along.x(), 0};
    s.plane.d = -s.plane.n.head<2>().dot(start);
    s.start = start;
    s.end = end;
    s.z_min_m = z_min_m;
    s.z_max_m = z_max_m;
    s.area_m2 = (end - start).norm() * (z_max_m - z_min_m);
    test::FillCells(s);
    Observation o;  // centred on the patch
    for (double z_m : {z_min_m, z_max_m}) {
      for (const Eigen::Vector2d& at : {start, end}) o.stats.Add({at.x(), at.y(), z_m});
    }
    s.observations.push_back(o);
    map.surfaces.push_back(s);
    return s.id;
  }
  // Sees points on the vertical rectangle over [start, end] from a keyframe at `from`, plan frame.
  void See(const Eigen::Vector3d& from, const Eigen::Vector2d& start, const Eigen::Vector2d& end, double z_min_m, double z_max_m) {
    Keyframe keyframe;
    keyframe.id = static_cast<uint32_t>(map.keyframes.size());
    keyframe.T_map_kf.translation() = from;
    for (double u = 0.02; u < 1; u += 0.05) {
      for (double z_m = z_min_m + 0.03; z_m < z_max_m; z_m += 0.1) {
        const Eigen::Vector2d at = start + u * (end - start);
        keyframe.points.push_back((Eigen::Vector3d(at.x(), at.y(), z_m) - from).cast<float>());
      }
    }
    map.keyframes.push_back(keyframe);
  }
  // The plan surface that a map surface went to; none if unmatched.
  SurfaceId Of(const AGraph& plan, uint32_t map_surface, const std::vector<WallDeviation>& known = {}) const {
    for (const Match& m : MatchSurfaces(map, plan, Eigen::Isometry3d::Identity(), known)) {
      if (m.map_surface == map_surface) return m.plan_surface;
    }
    return {};
  }
};

}  // namespace plumb::runtime
