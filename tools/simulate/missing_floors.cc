#include "tools/simulate/missing_floors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/matching/ray_caster.h"
#include "schema/polygon.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kStep_m = 0.5;         // between the places looked at
constexpr double kLookFrom_m = 0.3;     // above the floor
constexpr double kFloorDepth_m = 0.5;   // lower is another storey's
constexpr double kMaxHeight_m = 100.0;  // higher is the sky
constexpr double kMinHeadroom_m = 1.5;

struct Coverage {
  size_t room = 0;
  int places = 0, no_floor = 0, no_ceiling = 0;
};

Coverage LookAt(const AGraph& house, size_t room_index, const runtime::RayCaster& caster) {
  const Room& room = house.rooms[room_index];
  Coverage out{room_index};
  Vector2d lo = room.polygon.front(), hi = lo;
  for (const Vector2d& p : room.polygon) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
  const auto nothing = [&](const Vector2d& p, double direction, double range_m) {
    runtime::Ray ray;
    ray.origin = (Eigen::Vector3d(p.x(), p.y(), room.floor_z_m + kLookFrom_m) - house.origin).cast<float>();
    ray.direction = Eigen::Vector3d(0, 0, direction).cast<float>();
    ray.max_range_m = static_cast<float>(range_m);
    return !caster.Cast(ray).hit();
  };
  for (double y = lo.y() + 0.5 * kStep_m; y < hi.y(); y += kStep_m) {
    for (double x = lo.x() + 0.5 * kStep_m; x < hi.x(); x += kStep_m) {
      const Vector2d p(x, y);
      if (!Contains(room, p)) continue;
      ++out.places;
      out.no_floor += nothing(p, -1, kLookFrom_m + kFloorDepth_m) ? 1 : 0;
      out.no_ceiling += nothing(p, 1, kMaxHeight_m) ? 1 : 0;
    }
  }
  return out;
}

// Adds level pieces at one height, to be seen from above or below.
class LevelBuilder {
 public:
  LevelBuilder(AGraph& house, StoreyId storey, const char* name) : house_(house), element_(static_cast<uint32_t>(house.elements.size())) {
    Element element;
    element.name = name;
    element.kind = ElementKind::kSlab;
    element.storey = storey;
    house.elements.push_back(std::move(element));
  }

  // Corners counter-clockwise seen from above.
  void AddQuad(const std::array<Vector2d, 4>& corners, double z_m, bool from_above) {
    const auto first = static_cast<uint32_t>(house_.mesh.vertices.size());
    for (const Vector2d& p : corners) house_.mesh.vertices.push_back((Eigen::Vector3d(p.x(), p.y(), z_m) - house_.origin).cast<float>());
    for (const auto& [b, c] : {std::pair{1U, 2U}, std::pair{2U, 3U}}) {
      house_.mesh.triangles.push_back(from_above ? Triangle{first, first + b, first + c, element_}
                                                 : Triangle{first, first + c, first + b, element_});
    }
  }

  // The room's polygon as trapezoids between the heights of its corners: no edge ends within one.
  void AddRoom(const Room& room, double z_m, bool from_above) {
    std::vector<double> ys;
    const auto add_corners = [&](const Ring& ring) {
      for (const Vector2d& p : ring) ys.push_back(p.y());
    };
    add_corners(room.polygon);
    for (const Ring& hole : room.holes) add_corners(hole);
    std::sort(ys.begin(), ys.end());
    ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
    for (size_t i = 0; i + 1 < ys.size(); ++i) {
      const std::vector<Span> spans = SpansBetween(room, ys[i], ys[i + 1]);
      for (size_t k = 0; k + 1 < spans.size(); k += 2) {
        const Span &left = spans[k], &right = spans[k + 1];
        AddQuad({Vector2d(left.low_m, ys[i]), {right.low_m, ys[i]}, {right.high_m, ys[i + 1]}, {left.high_m, ys[i + 1]}}, z_m, from_above);
      }
    }
  }

 private:
  struct Span {
    double low_m = 0, high_m = 0;  // x of an edge at both heights
  };

  static std::vector<Span> SpansBetween(const Room& room, double low_y_m, double high_y_m) {
    std::vector<Span> spans;
    const auto add = [&](const Ring& ring) {
      for (size_t i = 0; i < ring.size(); ++i) {
        const Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if (std::min(a.y(), b.y()) > low_y_m || std::max(a.y(), b.y()) < high_y_m || a.y() == b.y()) continue;
        const auto x_at = [&](double y) { return a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()); };
        spans.push_back({x_at(low_y_m), x_at(high_y_m)});
      }
    };
    add(room.polygon);
    for (const Ring& hole : room.holes) add(hole);
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.low_m + a.high_m < b.low_m + b.high_m; });
    return spans;
  }

  AGraph& house_;
  uint32_t element_;
};

double MedianFloor(const AGraph& house, const std::vector<Coverage>& rooms) {
  std::vector<double> floors_m;
  for (const Coverage& c : rooms) floors_m.push_back(house.rooms[c.room].floor_z_m);
  std::nth_element(floors_m.begin(), floors_m.begin() + static_cast<ptrdiff_t>(floors_m.size() / 2), floors_m.end());
  return floors_m[floors_m.size() / 2];
}

}  // namespace

AGraph WithFloorsAndCeilings(AGraph house, StoreyId storey, const std::vector<Rectangle>& passages) {
  std::vector<Coverage> rooms;
  Coverage all;
  const runtime::RayCaster caster(house.mesh);
  for (size_t r = 0; r < house.rooms.size(); ++r) {
    if (house.rooms[r].storey != storey || house.rooms[r].polygon.empty()) continue;
    rooms.push_back(LookAt(house, r, caster));
    all.places += rooms.back().places;
    all.no_floor += rooms.back().no_floor;
    all.no_ceiling += rooms.back().no_ceiling;
  }
  if (2 * all.no_floor > all.places) {
    LevelBuilder floor(house, storey, "floor");
    for (const Coverage& c : rooms) {
      if (2 * c.no_floor > c.places) floor.AddRoom(house.rooms[c.room], house.rooms[c.room].floor_z_m, true);
    }
    const double passage_z_m = MedianFloor(house, rooms);
    for (const Rectangle& passage : passages) floor.AddQuad(passage.Corners(), passage_z_m, true);
  }
  if (2 * all.no_ceiling > all.places) {
    LevelBuilder ceiling(house, storey, "ceiling");
    for (const Coverage& c : rooms) {
      const Room& room = house.rooms[c.room];
      if (2 * c.no_ceiling > c.places && room.ceiling_z_m > room.floor_z_m + kMinHeadroom_m) ceiling.AddRoom(room, room.ceiling_z_m, false);
    }
  }
  return house;
}

}  // namespace plumb::tools
