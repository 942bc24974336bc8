#include "tools/simulate/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/matching/ray_caster.h"
#include "runtime/numerics/distance_transform.h"

namespace plumb::tools {
namespace {

constexpr double kMargin_m = 0.5;
constexpr double kLevel_m = 0.25;  // rooms whose floors are said to differ by more are on another level; the floor itself decides within
constexpr double kFloorDepth_m = 0.1;  // the robot may roll down a step of this height
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

// Where the row of cell centres at y enters and leaves the room, in turn.
std::vector<double> Crossings(const Room& room, double y) {
  std::vector<double> xs;
  const auto add = [&](const Ring& ring) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Eigen::Vector2d &a = ring[i], &b = ring[j];
      if ((a.y() > y) != (b.y() > y)) xs.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
  };
  add(room.polygon);
  for (const Ring& hole : room.holes) add(hole);
  std::sort(xs.begin(), xs.end());
  return xs;
}

// To the near side of the obstacle's cell at worst, so half a cell less.
float ClearanceOf(float squared_cells) {
  return static_cast<float>(kCell_m * std::max(0.0, std::sqrt(static_cast<double>(squared_cells)) - 0.5));
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

template <class Visit>
void FreeSpace::VisitCells(const std::vector<Eigen::Vector2d>& polygon, const Visit& visit) const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon) box.extend(p);
  if (!box.intersects(Eigen::AlignedBox2d(origin_, origin_ + kCell_m * Eigen::Vector2d(width_, height_)))) return;
  const int first = CellAt(box.min()).y, last = CellAt(box.max()).y;
  for (int y = first; y <= last; ++y) {
    // The polygon's extent in the row of cells: its corners there, and where its edges cross the row's borders.
    const double bottom = origin_.y() + y * kCell_m, top = bottom + kCell_m;
    double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();
    const auto extend = [&](double x) {
      least = std::min(least, x);
      most = std::max(most, x);
    };
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if (a.y() >= bottom && a.y() <= top) extend(a.x());
      for (const double border : {bottom, top}) {
        if ((a.y() < border) != (b.y() < border)) extend(a.x() + (b.x() - a.x()) * (border - a.y()) / (b.y() - a.y()));
      }
    }
    if (most < origin_.x() || least > origin_.x() + width_ * kCell_m) continue;
    const int to = CellAt({most, bottom}).x;
    for (int x = CellAt({least, bottom}).x; x <= to; ++x) visit(Cell{x, y});
  }
}

void FreeSpace::LabelRooms(const AGraph& house, StoreyId storey, const std::vector<Rectangle>& passages) {
  room_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), kNoRoom);
  for (size_t r = 0; r < house.rooms.size(); ++r) {
    const Room& room = house.rooms[r];
    if (room.storey != storey || std::abs(room.floor_z_m - floor_z_m_) > kLevel_m) continue;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    const int last = CellAt(box.max()).y;
    for (int y = CellAt(box.min()).y; y <= last; ++y) {
      const std::vector<double> xs = Crossings(room, Center({0, y}).y());
      for (size_t k = 0; k + 1 < xs.size(); k += 2) {
        const auto column = [&](double x) { return std::clamp(static_cast<int>(std::ceil((x - origin_.x()) / kCell_m - 0.5)), 0, width_); };
        for (int x = column(xs[k]); x < column(xs[k + 1]); ++x) room_[Index({x, y})] = static_cast<int16_t>(r);
      }
    }
  }
  for (const Rectangle& passage : passages) {
    const auto corners = passage.Corners();
    VisitCells({corners.begin(), corners.end()}, [&](Cell c) {
      if (room_[Index(c)] == kNoRoom && passage.Contains(Center(c))) room_[Index(c)] = kPassage;
    });
  }
}

void FreeSpace::BlockTriangles(const AGraph& house, std::vector<uint8_t>& blocked) const {
  std::vector<Eigen::Vector2d> outline;
  for (const Triangle& t : house.mesh.triangles) {
    Polygon3 part;
    for (const uint32_t v : {t.a, t.b, t.c}) part.push_back(house.mesh.vertices[v].cast<double>() + house.origin);
    part = ClipAtHeight(ClipAtHeight(part, floor_z_m_ + kBodyBottom_m, 1), floor_z_m_ + kBodyTop_m, -1);
    outline.clear();
    for (const Eigen::Vector3d& p : part) outline.push_back(p.head<2>());
    VisitCells(outline, [&](Cell c) { blocked[Index(c)] = 1; });
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
  for (float& squared : clearance_m_) squared = ClearanceOf(squared);
}

void FreeSpace::Block(const Rectangle& footprint) {
  const auto corners = footprint.Corners();
  const std::vector<Eigen::Vector2d> outline(corners.begin(), corners.end());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : outline) box.extend(p);
  // Cells farther off than any within is from what blocks it already cannot come nearer: the window grows until that holds.
  double reach_m = 0;
  for (double wanted_m = kCell_m; reach_m < wanted_m;) {
    reach_m = wanted_m;
    const Cell lo = CellAt(box.min() - Eigen::Vector2d::Constant(reach_m)), hi = CellAt(box.max() + Eigen::Vector2d::Constant(reach_m));
    for (int y = lo.y; y <= hi.y; ++y) {
      for (int x = lo.x; x <= hi.x; ++x) wanted_m = std::max(wanted_m, clearance_m(Index({x, y})) + kCell_m);
    }
  }
  const Cell lo = CellAt(box.min() - Eigen::Vector2d::Constant(reach_m)), hi = CellAt(box.max() + Eigen::Vector2d::Constant(reach_m));
  const auto width = static_cast<size_t>(hi.x - lo.x + 1);
  std::vector<uint8_t> blocked(width * static_cast<size_t>(hi.y - lo.y + 1), 0);
  const auto index = [&](Cell c) { return static_cast<size_t>(c.y - lo.y) * width + static_cast<size_t>(c.x - lo.x); };
  VisitCells(outline, [&](Cell c) { blocked[index(c)] = 1; });
  const std::vector<float> squared = runtime::SquaredCellDistances(blocked, width);
  for (int y = lo.y; y <= hi.y; ++y) {
    for (int x = lo.x; x <= hi.x; ++x) {
      float& clearance_m = clearance_m_[Index({x, y})];
      clearance_m = std::min(clearance_m, ClearanceOf(squared[index({x, y})]));
    }
  }
}

}  // namespace plumb::tools
