#include "runtime/matching/graph/match_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {
namespace {

constexpr double kSameLine_rad = 0.09, kSameLine_m = 0.06;  // pieces of one wall, beside a door or a pillar
constexpr double kMinLength_m = 0.4;                        // shorter ones are reveals
constexpr double kSide_rad = 0.35;  // of a side's normal off the square of the longest; built walls turn by up to 15 degrees
constexpr size_t kMinWalls = 3;

double Length(const GraphWall& w) { return (w.end - w.start).norm(); }

double AngleBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return std::abs(std::atan2(Cross(a, b), a.dot(b))); }

bool InOneLine(const GraphWall& a, const GraphWall& b) {
  return AngleBetween(a.normal, b.normal) < kSameLine_rad && std::abs(a.normal.dot(b.start + b.end) / 2 + a.d_m) < kSameLine_m;
}

// What pieces in one line have in common: the longest piece, and how long all are together.
struct Side {
  GraphWall wall;
  double length_m = 0;
};

std::vector<Side> Sides(std::vector<GraphWall> pieces) {
  std::stable_sort(pieces.begin(), pieces.end(), [](const GraphWall& a, const GraphWall& b) { return Length(a) > Length(b); });
  std::vector<Side> sides;
  for (const GraphWall& piece : pieces) {
    auto same = std::find_if(sides.begin(), sides.end(), [&](const Side& s) { return InOneLine(s.wall, piece); });
    if (same == sides.end()) same = sides.insert(sides.end(), {piece, 0});
    same->length_m += Length(piece);
  }
  std::erase_if(sides, [](const Side& s) { return s.length_m < kMinLength_m; });
  return sides;
}

// The longest of each of four directions, one after the other by 90 degrees, from the longest of all; empty if one has none.
std::vector<GraphWall> FourSides(const std::vector<Side>& sides) {
  std::vector<GraphWall> four;
  if (sides.empty()) return four;
  const Side& longest = *std::max_element(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.length_m < b.length_m; });
  Eigen::Vector2d direction = longest.wall.normal;
  for (int quarter = 0; quarter < 4; ++quarter, direction = Eigen::Vector2d(-direction.y(), direction.x())) {
    const Side* best = nullptr;
    for (const Side& side : sides) {
      if (AngleBetween(side.wall.normal, direction) < kSide_rad && (best == nullptr || side.length_m > best->length_m)) best = &side;
    }
    if (best == nullptr) return {};
    four.push_back(best->wall);
  }
  return four;
}

// Of the quadrilateral between four lines in order.
double AreaBetween(const std::vector<GraphWall>& four) {
  std::array<Eigen::Vector2d, 4> corners;
  for (size_t i = 0; i < 4; ++i) {
    const GraphWall &a = four[i], &b = four[(i + 1) % 4];
    Eigen::Matrix2d normals;
    normals << a.normal.transpose(), b.normal.transpose();
    corners[i] = -normals.inverse() * Eigen::Vector2d(a.d_m, b.d_m);
  }
  double twice = 0;
  for (size_t i = 0; i < 4; ++i) twice += Cross(corners[i] - corners[0], corners[(i + 1) % 4] - corners[0]);
  return twice / 2;
}

struct RoomPieces {
  uint32_t id = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double area_m2 = 0;
  std::vector<GraphWall> pieces;
};

class Builder {
 public:
  explicit Builder(GraphRooms rooms) : rooms_(rooms) {}

  void Add(const RoomPieces& room) {
    std::vector<GraphWall> walls;
    const std::vector<Side> sides = Sides(room.pieces);
    Eigen::Vector2d center = room.center;
    if (rooms_ == GraphRooms::kFourWalls) {
      walls = FourSides(sides);
      const std::optional<Eigen::Vector2d> middle = FourWallCenter(walls);
      if (!middle || std::abs(AreaBetween(walls) - room.area_m2) > kFourWallAreaRatio * room.area_m2) return;
      center = *middle;
    } else {
      for (const Side& side : sides) walls.push_back(side.wall);
      if (walls.size() < kMinWalls) return;
    }
    GraphRoom out{room.id, center, {}};
    for (const GraphWall& wall : walls) out.walls.push_back(IndexOf(wall));
    graph_.rooms.push_back(std::move(out));
  }

  // A wall that may belong to a room added before, or to none.
  void AddWall(const GraphWall& wall) {
    if (Length(wall) >= kMinLength_m) IndexOf(wall);
  }

  MatchGraph Take() { return std::move(graph_); }

 private:
  size_t IndexOf(const GraphWall& wall) {
    const auto at = std::find_if(graph_.walls.begin(), graph_.walls.end(), [&](const GraphWall& w) { return w.id == wall.id; });
    if (at != graph_.walls.end()) return static_cast<size_t>(at - graph_.walls.begin());
    graph_.walls.push_back(wall);
    return graph_.walls.size() - 1;
  }

  GraphRooms rooms_;
  MatchGraph graph_;
};

GraphWall FromPlan(const AGraph& plan, SurfaceId id) {
  const Surface& s = plan.surfaces[id.index()];
  const Eigen::Vector2d origin = plan.origin.head<2>(), normal = s.normal.head<2>().normalized(), start = s.start - origin;
  return {static_cast<uint32_t>(id.index()), normal, -normal.dot(start), start, s.end - origin};
}

GraphWall FromMap(const MapSurface& s) {
  const Eigen::Vector2d normal = s.plane.n.head<2>().normalized();
  return {s.id, normal, -normal.dot(s.start + s.end) / 2, s.start, s.end};
}

bool IsWall(const MapSurface& s) { return s.kind == SurfaceKind::kWall && !s.observations.empty() && s.length_m() > 0; }

}  // namespace

std::vector<size_t> MatchGraph::Orphans() const {
  std::vector<bool> parented(walls.size(), false);
  for (const GraphRoom& room : rooms)
    for (size_t w : room.walls) parented[w] = true;
  std::vector<size_t> orphans;
  for (size_t w = 0; w < walls.size(); ++w)
    if (!parented[w]) orphans.push_back(w);
  return orphans;
}

std::optional<Eigen::Vector2d> FourWallCenter(const std::vector<GraphWall>& walls) {
  if (walls.size() != 4) return std::nullopt;
  // The wall that faces each best; two pairs of them.
  std::array<size_t, 4> facing{};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      if (walls[i].normal.dot(walls[j].normal) < walls[i].normal.dot(walls[facing[i]].normal)) facing[i] = j;
    }
  }
  Eigen::Matrix2d rows;
  Eigen::Vector2d d_m;
  int pairs = 0;
  for (size_t i = 0; i < 4; ++i) {
    const size_t j = facing[i];
    if (facing[j] != i || j <= i || walls[i].normal.dot(walls[j].normal) > -0.8) continue;
    if (pairs == 2) return std::nullopt;
    rows.row(pairs) = (walls[i].normal - walls[j].normal).transpose();
    d_m(pairs++) = walls[i].d_m - walls[j].d_m;
  }
  if (pairs != 2 || std::abs(rows.determinant()) < 0.8) return std::nullopt;
  return -rows.inverse() * d_m;
}

MatchGraph PlanGraph(const AGraph& plan, StoreyId storey, GraphRooms rooms) {
  Builder builder(rooms);
  const Eigen::Vector2d origin = plan.origin.head<2>();
  const auto usable = [&](SurfaceId id) { return !plan.surfaces[id.index()].arc && std::abs(plan.surfaces[id.index()].normal.z()) < 0.3; };
  for (size_t i = 0; i < plan.rooms.size(); ++i) {
    const Room& room = plan.rooms[i];
    if (room.storey != storey) continue;
    RoomPieces pieces{static_cast<uint32_t>(i), room.center.head<2>() - origin, room.area_m2, {}};
    for (SurfaceId id : room.surfaces)
      if (usable(id)) pieces.pieces.push_back(FromPlan(plan, id));
    builder.Add(pieces);
  }
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    if (plan.surfaces[i].storey == storey && usable(SurfaceId(i))) builder.AddWall(FromPlan(plan, SurfaceId(i)));
  }
  return builder.Take();
}

MatchGraph MapGraph(const SGraph& map, const UpperLayers& layers, uint32_t floor, GraphRooms rooms) {
  Builder builder(rooms);
  std::vector<bool> elsewhere(map.surfaces.size(), false);
  for (const MapRoom& room : layers.rooms) {
    RoomPieces pieces{room.id, room.center, room.area_m2, {}};
    for (uint32_t id : room.surfaces) {
      if (!IsWall(map.surfaces[id])) continue;
      elsewhere[id] = elsewhere[id] || room.floor != floor;
      pieces.pieces.push_back(FromMap(map.surfaces[id]));
    }
    if (room.floor == floor) builder.Add(pieces);
  }
  for (const MapSurface& s : map.surfaces)
    if (IsWall(s) && !elsewhere[s.id]) builder.AddWall(FromMap(s));
  return builder.Take();
}

}  // namespace plumb::runtime
