#include "tests/support/plans.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "tests/support/house.h"
#include "tests/support/random.h"

namespace plumb::test {
namespace {

constexpr double kHalf_m = 0.1, kHalfDoor_m = 0.45;

std::vector<Gap> GapsOf(const std::vector<GridDoor>& doors, bool vertical, size_t line, const std::vector<double>& across) {
  std::vector<Gap> gaps;
  for (const GridDoor& d : doors) {
    if (d.vertical != vertical || d.line != line) continue;
    const double middle = across[d.cell] + d.ratio * (across[d.cell + 1] - across[d.cell]);
    gaps.push_back({middle - kHalfDoor_m, middle + kHalfDoor_m});
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.from < b.from; });
  return gaps;
}

}  // namespace

AGraph MakeGridPlan(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<GridDoor>& doors) {
  AGraph g;
  g.storeys.push_back({"storey-0", "Ground floor", 0.0, kHouseHeight_m});
  const double x0 = xs.front() - kHalf_m, x1 = xs.back() + kHalf_m, y0 = ys.front() - kHalf_m, y1 = ys.back() + kHalf_m;
  std::vector<WallId> vertical, horizontal;
  for (size_t i = 0; i < xs.size(); ++i) {
    vertical.push_back(
        AddWall(g, "x" + std::to_string(i), {xs[i] - kHalf_m, y0}, {xs[i] + kHalf_m, y1}, GapsOf(doors, true, i, ys)));
  }
  for (size_t j = 0; j < ys.size(); ++j) {
    horizontal.push_back(
        AddWall(g, "y" + std::to_string(j), {x0, ys[j] - kHalf_m}, {x1, ys[j] + kHalf_m}, GapsOf(doors, false, j, xs)));
  }
  for (size_t j = 0; j + 1 < ys.size(); ++j) {
    for (size_t i = 0; i + 1 < xs.size(); ++i) {
      AddRoom(g, std::to_string(i) + "-" + std::to_string(j), {xs[i] + kHalf_m, ys[j] + kHalf_m},
              {xs[i + 1] - kHalf_m, ys[j + 1] - kHalf_m}, {horizontal[j], vertical[i + 1], horizontal[j + 1], vertical[i]});
    }
  }
  AddSurface(g, horizontal.front(), RoomId(), {x1, y0}, {x0, y0});
  AddSurface(g, vertical.back(), RoomId(), {x1, y1}, {x1, y0});
  AddSurface(g, horizontal.back(), RoomId(), {x0, y1}, {x1, y1});
  AddSurface(g, vertical.front(), RoomId(), {x0, y0}, {x0, y1});
  const size_t columns = xs.size() - 1;
  for (const GridDoor& d : doors) {
    const std::vector<double>& across = d.vertical ? ys : xs;
    const double middle = across[d.cell] + d.ratio * (across[d.cell + 1] - across[d.cell]);
    const Eigen::Vector2d at = d.vertical ? Eigen::Vector2d(xs[d.line], middle) : Eigen::Vector2d(middle, ys[d.line]);
    const size_t low = d.vertical ? d.cell * columns + d.line - 1 : (d.line - 1) * columns + d.cell;
    AddDoorway(g, "door", d.vertical ? vertical[d.line] : horizontal[d.line], RoomId(low), RoomId(d.vertical ? low + 1 : low + columns), at,
               d.vertical ? 0 : std::numbers::pi / 2, false);
  }
  const uint32_t slab = AddElement(g, "slab", ElementKind::kSlab);
  AddBox(g, {x0, y0, -0.2}, {x1, y1, 0}, slab);
  AddBox(g, {x0, y0, kHouseHeight_m}, {x1, y1, kHouseHeight_m + 0.2}, slab);
  return g;
}

AGraph MakeRandomPlan(uint64_t seed, int columns, int rows) {
  Random random(seed);
  std::vector<double> xs{0}, ys{0};
  for (int i = 0; i < columns; ++i) xs.push_back(xs.back() + random.Uniform(2.5, 6));
  for (int j = 0; j < rows; ++j) ys.push_back(ys.back() + random.Uniform(2.5, 6));
  std::vector<GridDoor> doors;
  for (size_t i = 1; i + 1 < xs.size(); ++i) {
    for (size_t j = 0; j + 1 < ys.size(); ++j) {
      if (random.Uniform(0, 1) < 0.6) doors.push_back({true, i, j, random.Uniform(0.3, 0.7)});
    }
  }
  for (size_t j = 1; j + 1 < ys.size(); ++j) {
    for (size_t i = 0; i + 1 < xs.size(); ++i) {
      if (random.Uniform(0, 1) < 0.6) doors.push_back({false, j, i, random.Uniform(0.3, 0.7)});
    }
  }
  return MakeGridPlan(xs, ys, doors);
}

AGraph Mirrored(AGraph plan) {
  for (Eigen::Vector3f& v : plan.mesh.vertices) v.x() = -v.x();
  for (Triangle& t : plan.mesh.triangles) std::swap(t.b, t.c);
  for (Surface& s : plan.surfaces) {
    std::swap(s.start, s.end);
    s.start.x() = -s.start.x();
    s.end.x() = -s.end.x();
    s.normal.x() = -s.normal.x();
  }
  for (Room& r : plan.rooms) {
    for (Eigen::Vector2d& p : r.polygon) p.x() = -p.x();
    std::reverse(r.polygon.begin(), r.polygon.end());
    r.center.x() = -r.center.x();
  }
  for (Doorway& d : plan.doorways) {
    d.position.x() = -d.position.x();
    d.yaw_rad = std::numbers::pi - d.yaw_rad;
  }
  return plan;
}

AGraph Scaled(AGraph plan, double scale) {
  for (Eigen::Vector3f& v : plan.mesh.vertices) v *= static_cast<float>(scale);
  for (Wall& w : plan.walls) w.thickness_m *= scale;
  for (Surface& s : plan.surfaces) {
    s.start *= scale;
    s.end *= scale;
    s.d_m *= scale;
    s.z_max_m *= scale;
  }
  for (Room& r : plan.rooms) {
    for (Eigen::Vector2d& p : r.polygon) p *= scale;
    r.center *= scale;
    r.area_m2 *= scale * scale;
    r.ceiling_z_m *= scale;
  }
  for (Doorway& d : plan.doorways) {
    d.position *= scale;
    d.width_m *= scale;
    d.height_m *= scale;
  }
  return plan;
}

void DeviateWall(AGraph& graph, WallId wall, double offset_m, double yaw_rad) {
  const auto surface = std::find_if(graph.surfaces.begin(), graph.surfaces.end(), [&](const Surface& s) { return s.wall == wall; });
  const Eigen::Vector2d middle = surface->midpoint(), shift = offset_m * surface->normal.head<2>();
  const Eigen::Rotation2Dd turn(yaw_rad);
  std::set<uint32_t> vertices;
  for (const Triangle& t : graph.mesh.triangles) {
    if (graph.elements[t.element].wall == wall) vertices.insert({t.a, t.b, t.c});
  }
  for (uint32_t i : vertices) {
    const Eigen::Vector2d p = graph.mesh.vertices[i].head<2>().cast<double>() + graph.origin.head<2>();
    graph.mesh.vertices[i].head<2>() = (turn * (p - middle) + middle + shift - graph.origin.head<2>()).cast<float>();
  }
}

}  // namespace plumb::test
