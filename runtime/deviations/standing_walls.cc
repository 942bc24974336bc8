#include "runtime/deviations/standing_walls.h"

#include <cmath>

#include "runtime/coupling/wall_frame.h"

namespace plumb::runtime {
namespace {

constexpr double kOn_m = 0.08;        // of a point: three sigmas, less what the estimate leaves
constexpr double kEdge_m = 0.10;      // built faces are longer or shorter than planned by that
constexpr double kThrough_m = 0.25;   // a line that goes through a wall starts and ends so far from it
constexpr double kDoorway_m = 0.30;   // about a doorway lines may pass the wall
constexpr double kReach_m = 0.5;      // of PanelGrid's cells, at least half of one

std::vector<Panel> BuiltFaces(const AGraph& plan, const JointResult& estimate, double min_observed_m2, std::vector<WallId>* walls) {
  const std::vector<WallFrame> frames = WallFrames(plan);
  std::vector<const WallEstimate*> by_wall(plan.walls.size(), nullptr);
  for (const WallEstimate& w : estimate.walls) {
    if (w.observed_m2 >= min_observed_m2) by_wall[w.wall.index()] = &w;
  }
  std::vector<Panel> panels;
  for (const Surface& s : plan.surfaces) {
    if (!s.wall.valid() || !by_wall[s.wall.index()] || !IsFace(frames[s.wall.index()], s)) continue;
    const WallEstimate& w = *by_wall[s.wall.index()];
    const Face face = MakeFace(frames[s.wall.index()], s);
    const double parameters[kNumWallParameters] = {w.deviation.offset_m, w.deviation.yaw_rad, 0, w.thickness_error_m};
    Plane built;
    BuiltPlane(face, parameters, &built.n, &built.d);
    Panel panel;
    panel.normal = built.n.head<2>().normalized();
    panel.along = {panel.normal.y(), -panel.normal.x()};
    if (panel.along.dot(s.end - s.start) < 0) panel.along = -panel.along;
    const Eigen::Vector2d middle = s.midpoint() - built.SignedDistance(face.point) / built.n.head<2>().norm() * panel.normal;
    panel.length_m = s.length_m();
    panel.start = middle - 0.5 * panel.length_m * panel.along;
    panel.z_min_m = s.z_min_m;
    panel.z_max_m = s.z_max_m;
    panels.push_back(panel);
    walls->push_back(s.wall);
  }
  return panels;
}

}  // namespace

StandingWalls::StandingWalls(const AGraph& plan, const JointResult& estimate, double min_observed_m2)
    : plan_(plan), doorways_(plan.walls.size()), panels_(BuiltFaces(plan, estimate, min_observed_m2, &walls_)), grid_(panels_, kReach_m) {
  for (const Doorway& d : plan.doorways) {
    if (d.wall.valid()) doorways_[d.wall.index()].push_back(&d);
  }
}

void StandingWalls::At(const Eigen::Vector3d& p, std::vector<WallId>& out) {
  out.clear();
  grid_.Near(p.head<2>(), p.head<2>(), near_);
  for (const uint32_t i : near_) {
    const Panel& panel = panels_[i];
    if (std::abs(panel.W(p.head<2>())) < kOn_m && panel.Covers(panel.U(p.head<2>()), p.z(), kEdge_m)) out.push_back(walls_[i]);
  }
}

bool StandingWalls::InTheWay(const Sight& sight) {
  grid_.Near(sight.from.head<2>(), sight.to.head<2>(), near_);
  for (const uint32_t i : near_) {
    const Panel& panel = panels_[i];
    Meeting m;
    if (!Meet(panel, sight, &m) || m.from_m < kThrough_m || m.to_m > -kThrough_m || !panel.Covers(m.u, m.z, -kEdge_m)) continue;
    bool in_doorway = false;
    for (const Doorway* d : doorways_[walls_[i].index()]) {
      in_doorway |= std::abs(m.u - panel.U(d->position.head<2>())) < 0.5 * d->width_m + kDoorway_m &&
                    m.z < d->position.z() + d->height_m + kDoorway_m;
    }
    if (!in_doorway) return true;
  }
  return false;
}

}  // namespace plumb::runtime
