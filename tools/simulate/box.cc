#include "tools/simulate/box.h"

namespace plumb::tools {

void AddBox(AGraph& house, const Box& box, uint32_t element) {
  const auto base = static_cast<uint32_t>(house.mesh.vertices.size());
  for (const double z : {box.z_min_m, box.z_max_m}) {
    for (const Eigen::Vector2d& c : box.footprint.Corners()) {
      house.mesh.vertices.push_back((Eigen::Vector3d(c.x(), c.y(), z) - house.origin).cast<float>());
    }
  }
  const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    house.mesh.triangles.push_back({base + a, base + b, base + c, element});
    house.mesh.triangles.push_back({base + a, base + c, base + d, element});
  };
  quad(3, 2, 1, 0);
  quad(4, 5, 6, 7);
  for (uint32_t i = 0; i < 4; ++i) quad(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4);
}

}  // namespace plumb::tools
