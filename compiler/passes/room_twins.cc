#include "compiler/passes/room_twins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kStraight_m = 0.01;     // corners less off the line through their neighbours do not count
constexpr double kSameTurn_cos = 0.9999; // 0.8 degrees
constexpr size_t kMaxMotions = 16;       // a round room falls on itself under any turn
constexpr double kPerimeterTolerances = 8;  // that the perimeters of twins may differ by
constexpr size_t kMaxCorners = 400;      // more, and a room is compared with no other

double Perimeter(const Ring& ring) {
  double out = 0;
  for (size_t i = 0; i < ring.size(); ++i) out += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return out;
}

Ring Prepared(const Ring& ring, const Eigen::Vector2d& origin) {
  Ring out = Simplified(ring, kStraight_m);
  if (out.size() < 3) out = ring;
  for (Eigen::Vector2d& p : out) p -= origin;
  return out;
}

size_t CornersOf(const std::vector<Ring>& rings) {
  size_t out = 0;
  for (const Ring& ring : rings) out += ring.size();
  return out;
}

Eigen::Vector2d Edge(const Ring& ring, size_t i) { return ring[(i + 1) % ring.size()] - ring[i]; }

size_t LongestEdge(const Ring& ring) {
  size_t best = 0;
  for (size_t i = 1; i < ring.size(); ++i) {
    if (Edge(ring, i).norm() > Edge(ring, best).norm()) best = i;
  }
  return best;
}

}  // namespace

std::string TwinOptions::Check() const {
  if (!(tolerance_m > 0 && tolerance_m < 1)) return fmt::format("TwinOptions.tolerance_m = {}; must be in (0, 1)", tolerance_m);
  if (!(height_tolerance_m > 0)) return fmt::format("TwinOptions.height_tolerance_m = {}; must be positive", height_tolerance_m);
  if (!(doorway_tolerance_m > 0)) return fmt::format("TwinOptions.doorway_tolerance_m = {}; must be positive", doorway_tolerance_m);
  return {};
}

RoomShapes::RoomShapes(const AGraph& graph, const TwinOptions& options) : options_(options) {
  const Eigen::Vector2d origin = graph.origin.head<2>();
  for (const Room& room : graph.rooms) {
    Shape shape;
    shape.rings.push_back(Prepared(room.polygon, origin));
    for (const Ring& hole : room.holes) shape.rings.push_back(Prepared(hole, origin));
    for (const Ring& ring : shape.rings) shape.perimeter_m += Perimeter(ring);
    const Eigen::Vector2d middle = Centroid(shape.rings);
    shape.center = {middle.x(), middle.y(), room.floor_z_m - graph.origin.z()};
    shape.area_m2 = room.area_m2;
    shape.height_m = room.ceiling_z_m - room.floor_z_m;
    shapes_.push_back(std::move(shape));
  }
  for (const Doorway& d : graph.doorways) AddOpening(d.room_a, d.room_b, d.position.head<2>() - origin, d.width_m);
  for (const OpenBoundary& b : graph.open_boundaries)
    AddOpening(b.room_a, b.room_b, 0.5 * (b.start + b.end) - origin, (b.end - b.start).norm());
  for (Shape& s : shapes_) {
    std::sort(s.neighbours.begin(), s.neighbours.end());
    s.neighbours.erase(std::unique(s.neighbours.begin(), s.neighbours.end()), s.neighbours.end());
  }
}

void RoomShapes::AddOpening(RoomId a, RoomId b, const Eigen::Vector2d& at, double width_m) {
  for (const auto& [here, there] : {std::pair(a, b), std::pair(b, a)}) {
    if (!here.valid() || a == b) continue;
    shapes_[here.index()].openings.push_back({at, width_m});
    if (there.valid()) shapes_[here.index()].neighbours.push_back(there);
  }
}

bool RoomShapes::MayBeTwins(RoomId a, RoomId b) const {
  const Shape &s = shapes_[a.index()], &t = shapes_[b.index()];
  const double tolerance = options_.tolerance_m;
  return s.openings.size() == t.openings.size() && std::abs(s.area_m2 - t.area_m2) <= tolerance * std::min(s.perimeter_m, t.perimeter_m) &&
         std::abs(s.perimeter_m - t.perimeter_m) <= kPerimeterTolerances * tolerance && std::abs(s.height_m - t.height_m) <= options_.height_tolerance_m &&
         std::max(CornersOf(s.rings), CornersOf(t.rings)) <= kMaxCorners;
}

std::vector<RoomId> RoomShapes::WithLikelyTwins() const {
  std::vector<RoomId> order;
  for (size_t r = 0; r < shapes_.size(); ++r) order.emplace_back(r);
  const auto key = [this](RoomId r) { return std::pair(shapes_[r.index()].openings.size(), shapes_[r.index()].perimeter_m); };
  std::stable_sort(order.begin(), order.end(), [&](RoomId a, RoomId b) { return key(a) < key(b); });
  std::vector<RoomId> out;
  for (size_t i = 0; i < order.size(); ++i) {
    const auto is_near = [&](size_t k) {
      const auto [ways, perimeter_m] = key(order[i]);
      const auto [other_ways, other_m] = key(order[k]);
      return ways == other_ways && std::abs(perimeter_m - other_m) <= kPerimeterTolerances * options_.tolerance_m;
    };
    bool found = false;
    for (size_t k = i; !found && k-- > 0 && is_near(k);) found = MayBeTwins(order[i], order[k]);
    for (size_t k = i + 1; !found && k < order.size() && is_near(k); ++k) found = MayBeTwins(order[i], order[k]);
    if (found) out.push_back(order[i]);
  }
  return out;
}

bool RoomShapes::BoundaryOnto(const Shape& a, const PlanarMotion& motion, const Shape& b) const {
  for (const Ring& ring : a.rings) {
    for (const Eigen::Vector2d& p : ring) {
      if (DistanceToRings(motion.Apply(p), b.rings) > options_.tolerance_m) return false;
    }
  }
  return true;
}

bool RoomShapes::OpeningsOnto(const Shape& a, const PlanarMotion& motion, const Shape& b) const {
  return std::all_of(a.openings.begin(), a.openings.end(), [&](const Opening& o) {
    const Eigen::Vector2d at = motion.Apply(o.at);
    return std::any_of(b.openings.begin(), b.openings.end(), [&](const Opening& p) {
      return (p.at - at).norm() <= options_.doorway_tolerance_m && std::abs(p.width_m - o.width_m) <= options_.doorway_tolerance_m;
    });
  });
}

bool RoomShapes::TakesOnto(RoomId a, const PlanarMotion& motion, RoomId b) const {
  const Shape &s = shapes_[a.index()], &t = shapes_[b.index()];
  if ((motion.Apply(s.center) - t.center).norm() > 2 * options_.tolerance_m) return false;
  const PlanarMotion back = motion.Inverse();
  return BoundaryOnto(s, motion, t) && BoundaryOnto(t, back, s) && OpeningsOnto(s, motion, t) && OpeningsOnto(t, back, s);
}

std::vector<PlanarMotion> RoomShapes::MotionsOnto(RoomId a, RoomId b) const {
  const Shape &s = shapes_[a.index()], &t = shapes_[b.index()];
  const Eigen::Vector2d edge = Edge(s.rings.front(), LongestEdge(s.rings.front()));
  std::vector<PlanarMotion> motions;
  if (a == b) motions.emplace_back();
  for (size_t i = 0; i < t.rings.front().size() && motions.size() < kMaxMotions; ++i) {
    const Eigen::Vector2d other = Edge(t.rings.front(), i);
    if (std::abs(other.norm() - edge.norm()) > 2 * options_.tolerance_m) continue;
    const PlanarMotion motion = PlanarMotion::TurnOnto(std::atan2(Cross(edge, other), edge.dot(other)), s.center, t.center);
    const bool known = std::any_of(motions.begin(), motions.end(), [&](const PlanarMotion& m) {
      return m.cos * motion.cos + m.sin * motion.sin > kSameTurn_cos;
    });
    if (!known && TakesOnto(a, motion, b)) motions.push_back(motion);
  }
  return motions;
}

}  // namespace plumb::compiler
