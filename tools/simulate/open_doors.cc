#include "tools/simulate/open_doors.h"

#include "runtime/matching/door_leaves.h"

namespace plumb::tools {

AGraph WithInnerDoorsOpen(const AGraph& plan) {
  const std::vector<DoorwayId> leaf_of = runtime::LeafTriangles(plan);
  AGraph open = plan;
  open.mesh.triangles.clear();
  for (size_t i = 0; i < leaf_of.size(); ++i) {
    const bool inner = leaf_of[i].valid() && plan.doorways[leaf_of[i].index()].room_a.valid() && plan.doorways[leaf_of[i].index()].room_b.valid();
    if (!inner) open.mesh.triangles.push_back(plan.mesh.triangles[i]);
  }
  return open;
}

}  // namespace plumb::tools
