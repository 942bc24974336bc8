#include "tests/support/house.h"

#include <cmath>
#include <numbers>

namespace plumb::test {
namespace {

constexpr double kHeight_m = kHouseHeight_m, kDoorHeight_m = 2.1, kOuter_m = 0.30, kInner_m = 0.12, kDoorWidth_m = 0.9;

}  // namespace

uint32_t AddElement(AGraph& g, const std::string& guid, ElementKind kind, WallId wall, DoorwayId doorway) {
  Element e;
  e.guid = guid;
  e.name = guid;
  e.type = "Test";
  e.kind = kind;
  e.storey = StoreyId(0);
  e.wall = wall;
  e.doorway = doorway;
  g.elements.push_back(e);
  return static_cast<uint32_t>(g.elements.size() - 1);
}

WallId AddWall(AGraph& g, const std::string& guid, Eigen::Vector2d lo, Eigen::Vector2d hi, const std::vector<Gap>& gaps) {
  const int axis = (hi - lo).x() >= (hi - lo).y() ? 0 : 1;
  Wall w;
  w.guid = w.name = guid;
  w.type = "Test";
  w.storey = StoreyId(0);
  const Eigen::Vector2d middle = 0.5 * (lo + hi);
  w.axis_start = w.axis_end = middle;
  w.axis_start[axis] = lo[axis];
  w.axis_end[axis] = hi[axis];
  w.thickness_m = hi[1 - axis] - lo[1 - axis];
  w.z_max_m = kHeight_m;
  const WallId id(g.walls.size());
  g.walls.push_back(w);
  const uint32_t element = AddElement(g, guid, ElementKind::kWall, id);
  const auto box = [&](double from, double to, double z0, double z1) {
    Eigen::Vector3d a(lo.x(), lo.y(), z0), b(hi.x(), hi.y(), z1);
    a[axis] = from;
    b[axis] = to;
    AddBox(g, a, b, element);
  };
  double at = lo[axis];
  for (const Gap& gap : gaps) {
    box(at, gap.from, 0, kHeight_m);
    box(gap.from, gap.to, kDoorHeight_m, kHeight_m);
    at = gap.to;
  }
  box(at, hi[axis], 0, kHeight_m);
  return id;
}

SurfaceId AddSurface(AGraph& g, WallId wall, RoomId room, Eigen::Vector2d start, Eigen::Vector2d end) {
  Surface s;
  s.wall = wall;
  s.storey = StoreyId(0);
  s.room = room;
  const Eigen::Vector2d along = (end - start).normalized();
  s.normal = Eigen::Vector3d(-along.y(), along.x(), 0);
  s.d_m = -s.normal.head<2>().dot(start);
  s.start = start;
  s.end = end;
  s.z_max_m = kHeight_m;
  g.surfaces.push_back(s);
  return SurfaceId(g.surfaces.size() - 1);
}

void AddRoom(AGraph& g, const std::string& name, Eigen::Vector2d lo, Eigen::Vector2d hi, const std::vector<WallId>& walls) {
  Room r;
  r.name = name;
  r.guid = "space-" + name;
  r.storey = StoreyId(0);
  r.polygon = {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}};
  r.area_m2 = (hi - lo).prod();
  r.center << 0.5 * (lo + hi), 0;
  r.yaw_rad = (hi - lo).x() >= (hi - lo).y() ? 0 : std::numbers::pi / 2 - 1e-12;
  r.ceiling_z_m = kHeight_m;
  const RoomId id(g.rooms.size());
  for (size_t i = 0; i < 4; ++i) r.surfaces.push_back(AddSurface(g, walls[i], id, r.polygon[i], r.polygon[(i + 1) % 4]));
  g.rooms.push_back(r);
}

void AddDoorway(AGraph& g, const std::string& name, WallId wall, RoomId a, RoomId b, Eigen::Vector2d at, double yaw_rad, bool leaf) {
  Doorway d;
  d.guid = d.name = name;
  d.storey = StoreyId(0);
  d.wall = wall;
  d.room_a = a;
  d.room_b = b;
  d.position << at, 0;
  d.yaw_rad = yaw_rad;
  d.width_m = kDoorWidth_m;
  d.height_m = kDoorHeight_m;
  d.has_leaf = leaf;
  g.doorways.push_back(d);
}

void AddBox(AGraph& g, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi, uint32_t element) {
  const auto base = static_cast<uint32_t>(g.mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p((i & 1) ? hi.x() : lo.x(), (i & 2) ? hi.y() : lo.y(), (i & 4) ? hi.z() : lo.z());
    g.mesh.vertices.push_back((p - g.origin).cast<float>());
  }
  constexpr uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    g.mesh.triangles.push_back({base + f[0], base + f[1], base + f[2], element});
    g.mesh.triangles.push_back({base + f[0], base + f[2], base + f[3], element});
  }
}

AGraph MakeHouse() {
  AGraph g;
  g.tool_version = "test";
  g.source_format = "test";
  g.storeys.push_back({"storey-0", "Ground floor", 0.0, kHeight_m});
  const double o = kOuter_m, h = kInner_m / 2;
  // Rooms: A [0,5-h] x [0,3.5-h], B [0,5-h] x [3.5+h,6], C [5+h,9] x [0,6].
  const WallId south = AddWall(g, "wall-south", {-o, -o}, {9 + o, 0});
  const WallId east = AddWall(g, "wall-east", {9, 0}, {9 + o, 6});
  const WallId north = AddWall(g, "wall-north", {-o, 6}, {9 + o, 6 + o});
  const WallId west = AddWall(g, "wall-west", {-o, 0}, {0, 6}, {{1.2, 2.1}});
  const WallId middle = AddWall(g, "wall-middle", {5 - h, 0}, {5 + h, 6}, {{2.3, 3.2}});
  const WallId across = AddWall(g, "wall-across", {0, 3.5 - h}, {5 - h, 3.5 + h}, {{2.0, 2.9}});
  AddRoom(g, "A", {0, 0}, {5 - h, 3.5 - h}, {south, middle, across, west});
  AddRoom(g, "B", {0, 3.5 + h}, {5 - h, 6}, {across, middle, north, west});
  AddRoom(g, "C", {5 + h, 0}, {9, 6}, {south, east, north, middle});
  AddSurface(g, south, RoomId(), {9 + o, -o}, {-o, -o});
  AddSurface(g, east, RoomId(), {9 + o, 6 + o}, {9 + o, -o});
  AddSurface(g, north, RoomId(), {-o, 6 + o}, {9 + o, 6 + o});
  AddSurface(g, west, RoomId(), {-o, -o}, {-o, 6 + o});
  for (WallId id : {south, east, north, west}) g.walls[id.index()].external = true;
  AddDoorway(g, "D1", across, RoomId(0), RoomId(1), {2.45, 3.5}, std::numbers::pi / 2, false);
  AddDoorway(g, "D2", middle, RoomId(0), RoomId(2), {5.0, 2.75}, 0, false);
  AddDoorway(g, "D3", west, RoomId(0), RoomId(), {-0.15, 1.65}, std::numbers::pi, true);
  AddBox(g, {-0.1, 1.2, 0}, {-0.05, 2.1, kDoorHeight_m}, AddElement(g, "leaf-D3", ElementKind::kDoor, west, DoorwayId(2)));
  const uint32_t slab = AddElement(g, "slab", ElementKind::kSlab);
  AddBox(g, {-o, -o, -0.2}, {9 + o, 6 + o, 0}, slab);
  AddBox(g, {-o, -o, kHeight_m}, {9 + o, 6 + o, kHeight_m + 0.2}, AddElement(g, "ceiling", ElementKind::kSlab));
  // Chimney breast in C: makes the house unlike itself under a half turn.
  AddBox(g, {8.4, 0, 0}, {9, 0.5, kHeight_m}, AddElement(g, "chimney", ElementKind::kColumn));
  return g;
}

}  // namespace plumb::test
