#include "tools/simulate/free_space.h"

#include <algorithm>
#include <cmath>

#include "runtime/matching/ray_caster.h"
#include "runtime/numerics/distance_transform.h"

namespace plumb::tools {
namespace {

constexpr double kMargin_m = 0.5;
constexpr double kLevel_m = 0.05;      // rooms whose floors differ by more are on another level
constexpr double kFloorDepth_m = 0.1;  // the robot may roll down a step of this height
constexpr double kStep_m = kCell_m / 3;
constexpr double kMaxCells = 64e6;     // 400 m x 400 m

using Polygon3 = std::vector<Eigen::Vector3d>;

// The part of the polygon with sign * z >= sign * level (Sutherland and Hodgman).
Polygon3 ClipAtHeight(const Polygon3& in, double level, double sign) {
  Polygon3 out;
  for (size_t i = 0; i < in.size(); ++i) {
    const Eigen::Vector3d &a = in[i], &b = in[(i + 1) % in.size()];
    const double da = sign * (a.z() - level), db = sign * (b.z() - level);
    if (da >= 0) out.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

bool Inside(const Ring& ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

bool InRoom(const Room& room, const Eigen::Vector2d& p) {
  return Inside(room.polygon, p) && std::none_of(room.holes.begin(), room.holes.end(), [&p](const Ring& hole) { return Inside(hole, p); });
}

}  // namespace

FreeSpace::FreeSpace(const AGraph& house, StoreyId storey, const std::vector<Rectangle>& passages) {
  Eigen::AlignedBox2d box;
  std::vector<double> floors_m;
  for (const Room& room : house.rooms) {
    if (room.storey != storey) continue;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    floors_m.push_back(room.floor_z_m);
  }
  if (floors_m.empty()) return;
  std::nth_element(floors_m.begin(), floors_m.begin() + static_cast<ptrdiff_t>(floors_m.size() / 2), floors_m.end());
  floor_z_m_ = floors_m[floors_m.size() / 2];
  origin_ = box.min() - Eigen::Vector2d::Constant(kMargin_m);
  const Eigen::Vector2d cells = (box.sizes() + Eigen::Vector2d::Constant(2 * kMargin_m)) / kCell_m;
  if (cells.prod() > kMaxCells) return;
  width_ = static_cast<int>(std::ceil(cells.x()));
  height_ = static_cast<int>(std::ceil(cells.y()));
  LabelRooms(house, storey, passages);
  std::vector<uint8_t> blocked(room_.size());
  for (size_t i = 0; i < room_.size(); ++i) blocked[i] = room_[i] == kNoRoom ? 1 : 0;
  BlockTriangles(house, blocked);
  BlockMissingFloor(house, blocked);
  MeasureClearance(blocked);
}

Cell FreeSpace::CellAt(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d c = (p - origin_) / kCell_m;
  return {std::clamp(static_cast<int>(std::floor(c.x())), 0, width_ - 1), std::clamp(static_cast<int>(std::floor(c.y())), 0, height_ - 1)};
}

void FreeSpace::LabelRooms(const AGraph& house, StoreyId storey, const std::vector<Rectangle>& passages) {
  room_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), kNoRoom);
  for (size_t r = 0; r < house.rooms.size(); ++r) {
    const Room& room = house.rooms[r];
    if (room.storey != storey || std::abs(room.floor_z_m - floor_z_m_) > kLevel_m) continue;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    const Cell lo = CellAt(box.min()), hi = CellAt(box.max());
    for (int y = lo.y; y <= hi.y; ++y) {
      for (int x = lo.x; x <= hi.x; ++x) {
        if (InRoom(room, Center({x, y}))) room_[Index({x, y})] = static_cast<int16_t>(r);
      }
    }
  }
  for (size_t i = 0; i < room_.size(); ++i) {
    if (room_[i] != kNoRoom) continue;
    const auto contains = [p = Center(At(i))](const Rectangle& r) { return r.Contains(p); };
    if (std::any_of(passages.begin(), passages.end(), contains)) room_[i] = kPassage;
  }
}

void FreeSpace::BlockTriangles(const AGraph& house, std::vector<uint8_t>& blocked) const {
  const auto block = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d c = (p - origin_) / kCell_m;
    if (c.x() < 0 || c.y() < 0 || c.x() >= width_ || c.y() >= height_) return;
    blocked[Index(CellAt(p))] = 1;
  };
  for (const Triangle& t : house.mesh.triangles) {
    Polygon3 part;
    for (const uint32_t v : {t.a, t.b, t.c}) part.push_back(house.mesh.vertices[v].cast<double>() + house.origin);
    part = ClipAtHeight(ClipAtHeight(part, floor_z_m_ + kBodyBottom_m, 1), floor_z_m_ + kBodyTop_m, -1);
    // Fans of the clipped polygon, each sampled finer than a cell.
    for (size_t i = 1; i + 1 < part.size(); ++i) {
      const Eigen::Vector2d a = part[0].head<2>(), u = part[i].head<2>() - a, v = part[i + 1].head<2>() - a;
      Eigen::AlignedBox2d reach(a);
      reach.extend(a + u);
      reach.extend(a + v);
      if (!reach.intersects(Eigen::AlignedBox2d(origin_, origin_ + kCell_m * Eigen::Vector2d(width_, height_)))) continue;
      const int nu = static_cast<int>(std::ceil(u.norm() / kStep_m)) + 1, nv = static_cast<int>(std::ceil(v.norm() / kStep_m)) + 1;
      const int n = std::max(nu, nv);
      for (int k = 0; k <= n; ++k) {
        const double along = static_cast<double>(k) / n;
        const Eigen::Vector2d from = a + along * u, to = a + along * v;
        const int m = static_cast<int>(std::ceil((to - from).norm() / kStep_m)) + 1;
        for (int l = 0; l <= m; ++l) block(from + (to - from) * (static_cast<double>(l) / m));
      }
    }
  }
}

void FreeSpace::BlockMissingFloor(const AGraph& house, std::vector<uint8_t>& blocked) const {
  const runtime::RayCaster caster(house.mesh);
  std::vector<size_t> missing;
  size_t looked_at = 0;
  for (size_t i = 0; i < blocked.size(); ++i) {
    if (blocked[i] != 0) continue;
    ++looked_at;
    const Eigen::Vector2d p = Center(At(i));
    runtime::Ray ray;
    ray.origin = (Eigen::Vector3d(p.x(), p.y(), floor_z_m_ + kBodyBottom_m) - house.origin).cast<float>();
    ray.direction = -Eigen::Vector3f::UnitZ();
    ray.max_range_m = static_cast<float>(kBodyBottom_m + kFloorDepth_m);
    if (!caster.Cast(ray).hit()) missing.push_back(i);
  }
  if (2 * missing.size() > looked_at) return;  // the plan has walls but no floors
  for (const size_t i : missing) blocked[i] = 1;
}

void FreeSpace::MeasureClearance(const std::vector<uint8_t>& blocked) {
  clearance_m_ = runtime::SquaredCellDistances(blocked, static_cast<size_t>(width_));
  // To the near side of the obstacle's cell at worst, so half a cell less.
  for (float& squared : clearance_m_) squared = static_cast<float>(kCell_m * std::max(0.0, std::sqrt(static_cast<double>(squared)) - 0.5));
}

}  // namespace plumb::tools
