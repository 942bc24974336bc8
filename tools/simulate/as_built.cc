#include "tools/simulate/as_built.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/matching/ray_caster.h"
#include "tools/simulate/missing_floors.h"
#include "tools/simulate/open_doors.h"
#include "tools/simulate/random.h"

namespace plumb::tools {
namespace {

constexpr double kMinSurface_m = 1.5;
constexpr double kSameDirection_rad = 10 * std::numbers::pi / 180;
constexpr int kDrawsPerWall = 6;
constexpr double kOverlapShare = 0.8;     // of the thinner wall: how far one piece of a long wall may stand off the next
constexpr double kMoreLeaks = 0.002;      // share of rays
constexpr double kSillDepth_m = 0.45;     // doorways reach this far into the rooms

// A wall that may deviate.
struct Candidate {
  size_t wall = 0;
  SurfaceId reference;
};

Rectangle OpeningFootprint(const AGraph& plan, const Eigen::Vector3d& position, double passage_yaw_rad, double width_m, WallId wall) {
  const double thickness_m = wall.valid() ? plan.walls[wall.index()].thickness_m : 0.3;
  const Eigen::Vector2d through(std::cos(passage_yaw_rad), std::sin(passage_yaw_rad));
  return {position.head<2>(), {-through.y(), through.x()}, 0.5 * width_m, 0.5 * thickness_m};
}

std::vector<Rectangle> Passages(const AGraph& plan, const std::vector<Doorway>& doorways, StoreyId storey,
                                const std::vector<Eigen::Isometry2d>& motions) {
  std::vector<Rectangle> passages;
  for (const Doorway& d : doorways) {
    if (!d.room_a.valid() || !d.room_b.valid() || plan.rooms[d.room_a.index()].storey != storey) continue;
    const Rectangle floor = OpeningFootprint(plan, d.position, d.yaw_rad, d.width_m, d.wall).Grown(0, kSillDepth_m);
    passages.push_back(d.wall.valid() ? floor.Moved(motions[d.wall.index()]) : floor);
  }
  return passages;
}

// Share of rays from the middles of the rooms that leave the house.
double LeakShare(const AGraph& house, const FreeSpace& space, const Reach& reach) {
  constexpr int kRays = 4000;  // per room, evenly over the sphere (Fibonacci lattice)
  const runtime::RayCaster caster(house.mesh);
  double rays = 0, lost = 0;
  for (const RoomFloor& floor : reach.rooms) {
    if (!floor.reachable) continue;
    const Eigen::Vector2d p = space.Center(space.At(floor.middle));
    runtime::Ray ray;
    ray.origin = (Eigen::Vector3d(p.x(), p.y(), space.floor_z_m() + 1.0) - house.origin).cast<float>();
    for (int i = 0; i < kRays; ++i) {
      const double z = 1 - (2 * i + 1.0) / kRays, r = std::sqrt(1 - z * z), a = i * std::numbers::pi * (3 - std::sqrt(5.0));
      ray.direction = Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z).cast<float>();
      rays += 1;
      if (!caster.Cast(ray).hit()) lost += 1;
    }
  }
  return rays > 0 ? lost / rays : 0;
}

class Builder {
 public:
  Builder(const AGraph& plan, StoreyId storey, const SimulateOptions& options)
      : plan_(plan), storey_(storey), options_(options), bodies_(FindWallBodies(plan)),
        random_(options.seed, static_cast<uint64_t>(RandomStream::kDeviations)) {
    built_.motions.assign(plan.walls.size(), Eigen::Isometry2d::Identity());
    built_.doorways = plan.doorways;
    open_ = WithInnerDoorsOpen(plan);
  }

  Expected<AsBuilt> Run() {
    Expected<std::vector<DoorwayChange>> changes = ChangeDoorways(storey_, options_, bodies_, open_, built_.doorways);
    if (!changes) return tl::unexpected(changes.error());
    built_.doorway_changes = std::move(*changes);
    built_.passages = Passages(plan_, built_.doorways, storey_, built_.motions);
    open_ = WithFloorsAndCeilings(std::move(open_), storey_, built_.passages);
    built_.house = open_;
    if (options_.deviate == 0 && options_.deviate_ratio == 0) return std::move(built_);
    const FreeSpace space(open_, storey_, built_.passages);
    if (space.size() == 0) return Fail(ErrorCode::kPlanUnsuitable, "the storey has no rooms, or more than 400 m x 400 m of them");
    const Reach reach = FindReach(open_, storey_, space);
    planned_rooms_ = reach.reachable();
    planned_radius_m_ = reach.robot_radius_m;
    planned_leaks_ = LeakShare(open_, space, reach);
    std::vector<Candidate> candidates = Candidates();
    random_.Shuffle(candidates);
    const bool by_share = options_.deviate_ratio > 0;
    const auto wanted =
        static_cast<size_t>(by_share ? std::ceil(options_.deviate_ratio * static_cast<double>(candidates.size())) : options_.deviate);
    for (const Candidate& candidate : candidates) {
      if (built_.walls.size() == wanted) break;
      if (LeavesMajority(candidate.wall)) Try(candidate);
    }
    if (!by_share && built_.walls.size() < wanted) {
      return Fail(ErrorCode::kPlanUnsuitable,
                  fmt::format("only {} of {} walls can deviate: of {} long enough, the others would leave their direction without a "
                              "majority that stays, run into something, or close a way",
                              built_.walls.size(), options_.deviate, candidates.size()));
    }
    const auto by_wall = [](const WallDisplacement& a, const WallDisplacement& b) { return a.wall < b.wall; };
    std::sort(built_.walls.begin(), built_.walls.end(), by_wall);
    return std::move(built_);
  }

 private:
  // The longest surface of each wall towards a room of the storey, if it is long enough.
  [[nodiscard]] std::vector<Candidate> Candidates() const {
    std::vector<SurfaceId> longest(plan_.walls.size());
    for (size_t i = 0; i < plan_.surfaces.size(); ++i) {
      const Surface& s = plan_.surfaces[i];
      if (!s.wall.valid() || !s.room.valid() || plan_.rooms[s.room.index()].storey != storey_) continue;
      SurfaceId& best = longest[s.wall.index()];
      if (!best.valid() || s.length_m() > plan_.surfaces[best.index()].length_m()) best = SurfaceId(i);
    }
    std::vector<Candidate> candidates;
    for (size_t w = 0; w < longest.size(); ++w) {
      const bool fits = longest[w].valid() && !bodies_[w].curved && plan_.surfaces[longest[w].index()].length_m() >= kMinSurface_m;
      if (fits) candidates.push_back({w, longest[w]});
    }
    return candidates;
  }

  // Would more than half of the walls with this direction, and at least two, stay put if `wall` moved too?
  [[nodiscard]] bool LeavesMajority(size_t wall) const {
    size_t walls = 0, moved = 1;
    for (const Candidate& c : Candidates()) {
      if (CrossingSine(bodies_[wall], bodies_[c.wall]) > std::sin(kSameDirection_rad)) continue;
      ++walls;
      if (!built_.motions[c.wall].matrix().isIdentity(0)) ++moved;
    }
    return walls >= moved + 2 && walls > 2 * moved;
  }

  void Try(const Candidate& candidate) {
    const Surface& surface = plan_.surfaces[candidate.reference.index()];
    for (int i = 0; i < kDrawsPerWall; ++i) {
      const double shift_m = random_.Sign() * random_.Uniform(options_.min_translation_m, options_.max_translation_m);
      const double yaw_rad = random_.Sign() * random_.Uniform(options_.min_rotation_rad, options_.max_rotation_rad);
      const Eigen::Vector2d pivot = surface.midpoint();
      const Eigen::Isometry2d motion = Eigen::Translation2d(pivot + shift_m * surface.normal.head<2>().normalized()) *
                                       Eigen::Rotation2Dd(yaw_rad) * Eigen::Translation2d(-pivot);
      std::vector<Eigen::Isometry2d> motions = built_.motions;
      motions[candidate.wall] = motion;
      if (RunsIntoSomething(candidate.wall, motions) || OpensAJoint(candidate.wall, motions)) continue;
      AsBuilt attempt = built_;
      attempt.motions = std::move(motions);
      attempt.passages = Passages(plan_, built_.doorways, storey_, attempt.motions);
      attempt.house.mesh = MoveWalls(open_, bodies_, attempt.motions);
      if (!IsLivable(attempt)) continue;
      WallDisplacement wall{WallId(candidate.wall), candidate.reference, shift_m, yaw_rad, {}};
      for (size_t s = 0; s < plan_.surfaces.size(); ++s) {
        if (plan_.surfaces[s].wall == wall.wall) wall.surfaces.push_back(DisplacementOf(plan_, SurfaceId(s), motion));
      }
      attempt.walls.push_back(std::move(wall));
      built_ = std::move(attempt);
      return;
    }
  }

  [[nodiscard]] bool SameHeight(size_t a, size_t b) const {
    return bodies_[a].z_min_m < bodies_[b].z_max_m && bodies_[b].z_min_m < bodies_[a].z_max_m;
  }

  // Into a wall that it does not join, or over an opening of another wall.
  [[nodiscard]] bool RunsIntoSomething(size_t wall, const std::vector<Eigen::Isometry2d>& motions) const {
    const Rectangle moved = bodies_[wall].footprint.Moved(motions[wall]);
    for (size_t w = 0; w < bodies_.size(); ++w) {
      if (w == wall || !SameHeight(w, wall) || Meet(bodies_[w], bodies_[wall])) continue;
      if (Overlap(moved, bodies_[w].footprint.Moved(motions[w]))) return true;
    }
    const auto covers = [&](const Eigen::Vector3d& position, double yaw_rad, double width_m, WallId host) {
      const bool elsewhere = position.z() > bodies_[wall].z_max_m || position.z() < bodies_[wall].z_min_m - 0.5;
      if (elsewhere || !host.valid() || host.index() == wall) return false;
      return Overlap(moved, OpeningFootprint(plan_, position, yaw_rad, width_m, host).Moved(motions[host.index()]));
    };
    for (const Doorway& d : built_.doorways) {
      if (covers(d.position, d.yaw_rad, d.width_m, d.wall)) return true;
    }
    return std::any_of(plan_.windows.begin(), plan_.windows.end(),
                       [&](const Window& w) { return covers(w.position, w.yaw_rad, w.width_m, w.wall); });
  }

  // Walls that continue each other, or curved ones, cannot be lengthened to close a joint: there the offset must stay within the thickness.
  [[nodiscard]] bool OpensAJoint(size_t wall, const std::vector<Eigen::Isometry2d>& motions) const {
    const Rectangle& body = bodies_[wall].footprint;
    for (size_t w = 0; w < bodies_.size(); ++w) {
      if (w == wall || !Meet(bodies_[w], bodies_[wall])) continue;
      if (bodies_[w].curved) return true;
      if (CrossingSine(bodies_[w], bodies_[wall]) >= kMinCrossingSine) continue;
      const double end = std::copysign(body.half_length_m, (bodies_[w].footprint.center - body.center).dot(body.along));
      const Eigen::Vector2d joint = body.center + end * body.along;
      const double offset_m = std::abs((motions[wall] * joint - motions[w] * joint).dot(body.across()));
      if (offset_m > kOverlapShare * 2 * std::min(body.half_width_m, bodies_[w].footprint.half_width_m)) return true;
    }
    return false;
  }

  [[nodiscard]] bool IsLivable(const AsBuilt& attempt) const {
    const FreeSpace space(attempt.house, storey_, attempt.passages);
    const Reach reach = FindReach(attempt.house, storey_, space);
    if (reach.reachable() < planned_rooms_ || reach.robot_radius_m < planned_radius_m_) return false;
    return LeakShare(attempt.house, space, reach) <= planned_leaks_ + kMoreLeaks;
  }

  const AGraph& plan_;
  AGraph open_;
  const StoreyId storey_;
  const SimulateOptions& options_;
  const std::vector<WallBody> bodies_;
  Random random_;
  AsBuilt built_;
  size_t planned_rooms_ = 0;
  double planned_radius_m_ = 0, planned_leaks_ = 0;
};

}  // namespace

Expected<AsBuilt> BuildWithDeviations(const AGraph& plan, StoreyId storey, const SimulateOptions& options) {
  return Builder(plan, storey, options).Run();
}

namespace {

// The middle of the wall's longest straight surface; of equals that with the lowest id.
Eigen::Vector2d MiddleOf(const AGraph& plan, WallId wall) {
  const Surface* longest = nullptr;
  for (const Surface& s : plan.surfaces) {
    if (s.wall == wall && !s.arc && (!longest || s.length_m() > longest->length_m() + 1e-3)) longest = &s;
  }
  const Wall& w = plan.walls[wall.index()];
  return longest ? longest->midpoint() : Eigen::Vector2d(0.5 * (w.axis_start + w.axis_end));
}

}  // namespace

std::vector<BuiltDoorway> DoorwaysOf(const AGraph& plan, StoreyId storey, const AsBuilt& built) {
  const std::vector<WallBody> bodies = FindWallBodies(plan);
  std::vector<BuiltDoorway> out;
  for (size_t i = 0; i < plan.doorways.size(); ++i) {
    const Doorway& d = plan.doorways[i];
    if (d.storey != storey || !d.wall.valid() || bodies[d.wall.index()].curved) continue;
    if (std::find(built.missing.begin(), built.missing.end(), d.wall) != built.missing.end()) continue;
    const Eigen::Isometry2d& motion = built.motions[d.wall.index()];
    const Eigen::Vector2d along(-std::sin(d.yaw_rad), std::cos(d.yaw_rad)), across(std::cos(d.yaw_rad), std::sin(d.yaw_rad));
    const Eigen::Vector2d c = d.position.head<2>(), pivot = c + along.dot(MiddleOf(plan, d.wall) - c) * along;
    const Eigen::Vector2d moved = motion * pivot - pivot, built_across = motion.linear() * across;
    const double offset_m = built_across.dot(moved) / built_across.dot(across);
    BuiltDoorway truth{DoorwayId(i), (motion.linear() * along).dot(moved - offset_m * across), 0, 0};
    for (const DoorwayChange& change : built.doorway_changes) {
      if (change.doorway != truth.doorway) continue;
      truth.shift_m += change.shift_m;
      truth.width_deviation_m += change.width_deviation_m;
    }
    out.push_back(truth);
  }
  return out;
}

SurfaceDisplacement DisplacementOf(const AGraph& plan, SurfaceId surface, const Eigen::Isometry2d& motion) {
  const Surface& s = plan.surfaces[surface.index()];
  const Eigen::Vector2d middle = s.midpoint(), planned = s.normal.head<2>().normalized(), built = motion.linear() * planned;
  SurfaceDisplacement out;
  out.surface = surface;
  out.rotation_rad = std::atan2(motion.linear()(1, 0), motion.linear()(0, 0));
  // Where the built plane crosses the planned normal through the planned midpoint.
  out.translation_m = built.dot(motion * middle - middle) / built.dot(planned);
  return out;
}

}  // namespace plumb::tools
