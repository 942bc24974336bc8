#include "runtime/coupling/wall_openings.h"

namespace plumb::runtime {

std::vector<std::vector<WallOpening>> OpeningsOfWalls(const AGraph& plan) {
  std::vector<std::vector<WallOpening>> openings(plan.walls.size());
  const auto add = [&](WallId wall, const Eigen::Vector3d& at, double width_m, double height_m) {
    if (wall.valid()) openings[wall.index()].push_back({at.head<2>(), width_m, at.z(), at.z() + height_m});
  };
  for (const Doorway& d : plan.doorways) add(d.wall, d.position, d.width_m, d.height_m);
  for (const Window& w : plan.windows) add(w.wall, w.position, w.width_m, w.height_m);
  return openings;
}

}  // namespace plumb::runtime
