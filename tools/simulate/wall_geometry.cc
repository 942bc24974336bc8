#include "tools/simulate/wall_geometry.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace plumb::tools {
namespace {

constexpr double kTouch_m = 0.02;          // walls closer than this meet
constexpr double kStrip_m = 0.4;           // strips run on past the wall's ends, for corners where both walls have moved

Eigen::Vector2d PlanXy(const AGraph& plan, uint32_t vertex) {
  return plan.mesh.vertices[vertex].cast<double>().head<2>() + plan.origin.head<2>();
}

bool IsStill(const Eigen::Isometry2d& motion) { return motion.matrix().isIdentity(0); }

// How far a wall reaches along its axis into another one that it crosses, from where it first touches.
double CrossingDepth_m(const Rectangle& through, double sine) { return 2 * through.half_width_m / std::max(sine, kMinCrossingSine); }

// Distance of p from the wall's strip (its faces, lengthened by `reach_m`); 0 inside.
double DistanceFromStrip(const Rectangle& wall, const Eigen::Vector2d& p, double reach_m) {
  const double across = std::abs((p - wall.center).dot(wall.across())) - wall.half_width_m;
  const double along = std::abs((p - wall.center).dot(wall.along)) - wall.half_length_m - reach_m;
  return std::max({across, along, 0.0});
}

bool InEndZone(const Rectangle& wall, const Eigen::Vector2d& p, double depth_m) {
  return std::abs((p - wall.center).dot(wall.along)) >= wall.half_length_m - depth_m;
}

class WallMover {
 public:
  WallMover(const AGraph& plan, const std::vector<WallBody>& bodies, const std::vector<Eigen::Isometry2d>& motions)
      : plan_(plan), bodies_(bodies), motions_(motions) {}

  Mesh Run() {
    mesh_.triangles.reserve(plan_.mesh.triangles.size());
    for (const Triangle& t : plan_.mesh.triangles) {
      mesh_.triangles.push_back({VertexOf(t.a, t.element), VertexOf(t.b, t.element), VertexOf(t.c, t.element), t.element});
    }
    for (size_t w = 0; w < bodies_.size(); ++w) {
      if (!IsStill(motions_[w])) AddStrips(w);
    }
    return std::move(mesh_);
  }

 private:
  // Elements may share vertices in the plan; here each has its own, as one may move without the other.
  uint32_t VertexOf(uint32_t vertex, uint32_t element) {
    const uint64_t key = uint64_t{element} << 32 | vertex;
    const auto [it, added] = vertex_of_.try_emplace(key, static_cast<uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.push_back(Moved(vertex, plan_.elements[element]));
    return it->second;
  }

  Eigen::Vector3f Moved(uint32_t vertex, const Element& element) const {
    const Eigen::Vector3f planned = plan_.mesh.vertices[vertex];
    if (!element.wall.valid()) return planned;
    const size_t wall = element.wall.index();
    const Eigen::Vector2d xy = PlanXy(plan_, vertex);
    const double z = static_cast<double>(planned.z()) + plan_.origin.z();
    const Eigen::Vector2d moved = IsWallBody(element) ? MovedBodyPoint(wall, xy, z) : motions_[wall] * xy;
    if (moved == xy) return planned;
    Eigen::Vector3f out = planned;
    out.head<2>() = (moved - plan_.origin.head<2>()).cast<float>();
    return out;
  }

  Eigen::Vector2d MovedBodyPoint(size_t wall, const Eigen::Vector2d& p, double z) const {
    const size_t other = WallAtJoint(wall, p, z);
    if (other == bodies_.size() || (IsStill(motions_[wall]) && IsStill(motions_[other]))) return motions_[wall] * p;
    // Across each of the two walls the point stays where it is; that leaves one place for it.
    Eigen::Matrix2d normals;
    Eigen::Vector2d offsets;
    int row = 0;
    for (const size_t w : {wall, other}) {
      const Eigen::Vector2d planned = bodies_[w].footprint.across(), built = motions_[w].linear() * planned;
      normals.row(row) = built.transpose();
      offsets[row++] = planned.dot(p - bodies_[w].footprint.center) + built.dot(motions_[w] * bodies_[w].footprint.center);
    }
    return normals.inverse() * offsets;
  }

  // The wall that `wall` touches with its end at p; bodies_.size() if none.
  size_t WallAtJoint(size_t wall, const Eigen::Vector2d& p, double z) const {
    const WallBody& body = bodies_[wall];
    size_t best = bodies_.size();
    double best_distance = kTouch_m;
    for (size_t w = 0; w < bodies_.size(); ++w) {
      const WallBody& other = bodies_[w];
      const double sine = CrossingSine(body, other);
      if (w == wall || body.curved || other.curved || sine < kMinCrossingSine) continue;
      if (z < other.z_min_m - kTouch_m || z > other.z_max_m + kTouch_m) continue;
      if (!InEndZone(body.footprint, p, CrossingDepth_m(other.footprint, sine) + kTouch_m)) continue;
      const double distance = DistanceFromStrip(other.footprint, p, CrossingDepth_m(body.footprint, sine));
      // Of two at the same place (a long wall in two pieces) the one that moved decides.
      const bool better = distance < best_distance - 1e-6 || (best != bodies_.size() && distance < best_distance + 1e-6 &&
                                                              IsStill(motions_[best]) && !IsStill(motions_[w]));
      if (distance <= kTouch_m && (better || best == bodies_.size())) {
        best = w;
        best_distance = distance;
      }
    }
    return best;
  }

  void AddStrips(size_t wall) {
    std::set<double> heights;
    bool outer = false;
    for (const Surface& s : plan_.surfaces) {
      if (s.wall != WallId(wall)) continue;
      outer = outer || !s.room.valid();
      if (s.room.valid()) heights.insert({plan_.rooms[s.room.index()].floor_z_m, plan_.rooms[s.room.index()].ceiling_z_m});
    }
    if (!outer) return;
    uint32_t element = 0;
    while (element < plan_.elements.size() && plan_.elements[element].kind != ElementKind::kSlab) ++element;
    if (element == plan_.elements.size()) return;  // no slabs, no edge to close
    const auto planned = bodies_[wall].footprint.Grown(kStrip_m, 0).Corners();
    const auto built = bodies_[wall].footprint.Grown(kStrip_m, 0).Moved(motions_[wall]).Corners();
    for (const double z : heights) {
      AddQuad({planned[0], planned[1], built[1], built[0]}, z, element);  // between the right faces,
      AddQuad({planned[3], planned[2], built[2], built[3]}, z, element);  // the left faces,
      AddQuad(built, z, element);                                         // and under the wall
    }
  }

  void AddQuad(const std::array<Eigen::Vector2d, 4>& corners, double z, uint32_t element) {
    const auto base = static_cast<uint32_t>(mesh_.vertices.size());
    for (const Eigen::Vector2d& c : corners) {
      mesh_.vertices.push_back((Eigen::Vector3d(c.x(), c.y(), z) - plan_.origin).cast<float>());
    }
    mesh_.triangles.push_back({base, base + 1, base + 2, element});
    mesh_.triangles.push_back({base, base + 2, base + 3, element});
  }

  const AGraph& plan_;
  const std::vector<WallBody>& bodies_;
  const std::vector<Eigen::Isometry2d>& motions_;
  Mesh mesh_;
  std::unordered_map<uint64_t, uint32_t> vertex_of_;  // looked up only, never walked
};

}  // namespace

bool IsWallBody(const Element& element) {
  return element.wall.valid() && element.kind != ElementKind::kDoor && element.kind != ElementKind::kWindow;
}

std::vector<WallBody> FindWallBodies(const AGraph& plan) {
  struct Extent {
    Eigen::AlignedBox2d box;  // along and across the axis, from its start
    Eigen::AlignedBox1d z;
  };
  std::vector<WallBody> bodies(plan.walls.size());
  std::vector<Extent> extents(plan.walls.size());
  const auto frame = [&plan](size_t w) {
    const Wall& wall = plan.walls[w];
    const Eigen::Vector2d axis = wall.axis_end - wall.axis_start;
    const Eigen::Vector2d u = axis.norm() > 1e-6 ? Eigen::Vector2d(axis.normalized()) : Eigen::Vector2d::UnitX();
    Eigen::Matrix2d R;
    R << u.x(), -u.y(), u.y(), u.x();
    return R;
  };
  for (const Triangle& t : plan.mesh.triangles) {
    const Element& element = plan.elements[t.element];
    if (!IsWallBody(element)) continue;
    const size_t w = element.wall.index();
    for (const uint32_t v : {t.a, t.b, t.c}) {
      extents[w].box.extend(frame(w).transpose() * (PlanXy(plan, v) - plan.walls[w].axis_start));
      extents[w].z.extend(Eigen::Matrix<double, 1, 1>(static_cast<double>(plan.mesh.vertices[v].z()) + plan.origin.z()));
    }
  }
  for (size_t w = 0; w < plan.walls.size(); ++w) {
    const Wall& wall = plan.walls[w];
    const Eigen::Matrix2d R = frame(w);
    const bool solid = !extents[w].box.isEmpty();
    const double length = (wall.axis_end - wall.axis_start).norm();
    const Eigen::Vector2d half(0, wall.thickness_m / 2);
    const Eigen::AlignedBox2d box = solid ? extents[w].box : Eigen::AlignedBox2d(-half, Eigen::Vector2d(length, 0) + half);
    bodies[w].footprint = {wall.axis_start + R * box.center(), R.col(0), box.sizes().x() / 2, box.sizes().y() / 2};
    bodies[w].z_min_m = solid ? extents[w].z.min()(0) : wall.z_min_m;
    bodies[w].z_max_m = solid ? extents[w].z.max()(0) : wall.z_max_m;
  }
  for (const Surface& s : plan.surfaces) {
    if (s.arc && s.wall.valid()) bodies[s.wall.index()].curved = true;
  }
  return bodies;
}

double CrossingSine(const WallBody& a, const WallBody& b) { return std::abs(a.footprint.along.dot(b.footprint.across())); }

bool Meet(const WallBody& a, const WallBody& b) {
  if (a.z_max_m < b.z_min_m || b.z_max_m < a.z_min_m) return false;
  return Overlap(a.footprint.Grown(kTouch_m, kTouch_m), b.footprint);
}

Mesh MoveWalls(const AGraph& plan, const std::vector<WallBody>& bodies, const std::vector<Eigen::Isometry2d>& motions) {
  return WallMover(plan, bodies, motions).Run();
}

}  // namespace plumb::tools
