// The house built otherwise than planned, driven through, and put into its plan: what missing and unplanned walls are judged by.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/mapper.h"
#include "runtime/optimization/joint_optimizer.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::test {

inline size_t WallOf(const AGraph& house, const std::string& guid) {
  for (size_t w = 0; w < house.walls.size(); ++w) {
    if (house.walls[w].guid == guid) return w;
  }
  return house.walls.size();
}

// Without the wall's triangles whose middle `leaves_out` accepts (plan frame).
template <class F>
void TakeOut(AGraph& house, const std::string& guid, F&& leaves_out) {
  const WallId wall(WallOf(house, guid));
  std::erase_if(house.mesh.triangles, [&](const Triangle& t) {
    const Eigen::Vector3f middle = (house.mesh.vertices[t.a] + house.mesh.vertices[t.b] + house.mesh.vertices[t.c]) / 3;
    return house.elements[t.element].wall == wall && leaves_out(middle.cast<double>() + house.origin);
  });
}

inline void TakeOut(AGraph& house, const std::string& guid) {
  TakeOut(house, guid, [](const Eigen::Vector3d&) { return true; });
}

// Moves the wall's body.
inline void Displace(AGraph& house, const std::string& guid, const Eigen::Isometry2d& motion) {
  const WallId wall(WallOf(house, guid));
  Mesh& mesh = house.mesh;
  for (Triangle& t : mesh.triangles) {
    if (house.elements[t.element].wall != wall) continue;
    for (uint32_t* v : {&t.a, &t.b, &t.c}) {
      Eigen::Vector3f p = mesh.vertices[*v];
      p.head<2>() = (motion * Eigen::Vector2d(p.head<2>().cast<double>())).cast<float>();
      *v = static_cast<uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(p);
    }
  }
}

inline void AddThing(AGraph& house, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  AddBox(house, lo, hi, AddElement(house, "thing", ElementKind::kFurniture));
}

struct Survey {
  runtime::SGraph map;
  std::vector<runtime::Match> matches;
  runtime::JointResult estimate;
};

// Through all rooms of the house, with true poses: what is tested is what becomes of the map.
inline Survey DriveThrough(const AGraph& plan, const AGraph& as_built) {
  constexpr double kPeriod_s = 0.6, kHeight_m = 0.8;
  SyntheticLidarOptions options;
  options.azimuths = 720;
  const SyntheticLidar lidar(as_built, options);
  const Drive drive({{1.0, 1.0},
                     {4.2, 1.0},
                     {4.2, 2.75},
                     {6.2, 2.75},
                     {6.2, 1.2},
                     {8.0, 1.2},
                     {8.0, 5.2},
                     {6.0, 5.2},
                     {8.0, 5.2},
                     {8.0, 2.75},
                     {2.45, 2.75},
                     {2.45, 4.75},
                     {4.0, 4.75},
                     {1.0, 4.75}},
                    kHeight_m);
  const Eigen::Isometry3d T_plan_map = drive.At(0);
  runtime::Mapper mapper;
  for (double t = 0; t < drive.duration_s(); t += kPeriod_s) {
    const Eigen::Isometry3d T = drive.At(t);
    runtime::Scan scan = lidar.Sweep([&](double) { return T; }, t);
    scan.time_s.clear();  // it stood still meanwhile
    mapper.AddScan(scan, T_plan_map.inverse() * T);
  }
  mapper.Flush();
  Survey out;
  out.map = mapper.graph();
  out.matches = runtime::MatchSurfaces(out.map, plan, T_plan_map, std::vector<runtime::WallDeviation>(plan.walls.size()));
  out.estimate = runtime::OptimizeJointly(out.map, plan, out.matches, T_plan_map);
  for (size_t i = 0; i < out.estimate.T_map_kf.size(); ++i) out.map.keyframes[i].T_map_kf = out.estimate.T_map_kf[i];
  return out;
}

}  // namespace plumb::test
