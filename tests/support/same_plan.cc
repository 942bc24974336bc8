#include "tests/support/same_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace plumb::test {
namespace {

constexpr int kSteps = 24;         // places compared on each surface
constexpr double kEnds = 0.01;     // of its length, left out at both ends: corners belong to two walls
constexpr double kFacing = 0.999;  // cosine between normals

struct Place {
  Eigen::Vector2d at, normal;
};

std::vector<Place> PlacesOn(const Surface& s) {
  std::vector<Place> out;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = kEnds + (1 - 2 * kEnds) * i / kSteps;
    if (!s.arc) {
      out.push_back({s.start + u * (s.end - s.start), s.normal.head<2>()});
      continue;
    }
    const double a = s.arc->start_rad + u * s.arc->sweep_rad;
    const Eigen::Vector2d radial(std::cos(a), std::sin(a));
    const Eigen::Vector2d along = (s.arc->sweep_rad > 0 ? 1 : -1) * Eigen::Vector2d(-radial.y(), radial.x());
    out.push_back({s.arc->center + s.arc->radius_m * radial, {-along.y(), along.x()}});
  }
  return out;
}

bool LiesOn(const Place& p, const Surface& s, double tolerance_m) {
  if (!s.arc) {
    const Eigen::Vector2d u = (s.end - s.start).normalized(), q = p.at - s.start;
    const double along = u.dot(q), across = u.x() * q.y() - u.y() * q.x();
    return s.normal.head<2>().dot(p.normal) > kFacing && std::abs(across) < tolerance_m && along > -tolerance_m &&
           along < s.length_m() + tolerance_m;
  }
  const Eigen::Vector2d q = p.at - s.arc->center, radial = q.normalized();
  const double sign = s.arc->sweep_rad > 0 ? -1 : 1;  // normals are on the left of the way along the arc
  const double beyond = std::remainder(std::atan2(q.y(), q.x()) - s.arc->start_rad - 0.5 * s.arc->sweep_rad, 2 * std::numbers::pi);
  return std::abs(q.norm() - s.arc->radius_m) < tolerance_m && sign * radial.dot(p.normal) > kFacing &&
         std::abs(beyond) < 0.5 * std::abs(s.arc->sweep_rad) + tolerance_m / s.arc->radius_m;
}

Surface Moved(const Eigen::Isometry2d& T, Surface s) {
  s.start = T * s.start;
  s.end = T * s.end;
  s.normal.head<2>() = T.linear() * s.normal.head<2>();
  if (s.arc) {
    s.arc->center = T * s.arc->center;
    s.arc->start_rad += Eigen::Rotation2Dd(T.linear()).angle();
  }
  return s;
}

class Comparison {
 public:
  Comparison(const AGraph& reference, const AGraph& other, const SamePlanOptions& options) : a_(reference), b_(other), options_(options) {}

  std::vector<std::string> Run() {
    Count("storeys", a_.storeys.size(), b_.storeys.size());
    Count("rooms", a_.rooms.size(), b_.rooms.size());
    Count("doorways", a_.doorways.size(), b_.doorways.size());
    Count("windows", a_.windows.size(), b_.windows.size());
    MatchRooms();
    for (const Doorway& d : a_.doorways) CompareDoorway(d);
    for (const Window& w : a_.windows) {
      const bool found = std::any_of(b_.windows.begin(), b_.windows.end(), [&](const Window& o) {
        return o.storey == w.storey && Near(w.position, o.position) && std::abs(o.width_m - w.width_m) < options_.tolerance_m;
      });
      if (!found) Say("no window `{}` of {:.3f} m at ({:.3f}, {:.3f})", w.name, w.width_m, w.position.x(), w.position.y());
    }
    CompareSurfaces();
    return std::move(out_);
  }

 private:
  template <class... Args>
  void Say(fmt::format_string<Args...> text, Args&&... args) {
    out_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void Count(const char* what, size_t expected, size_t found) {
    if (expected != found) Say("{} {} instead of {}", found, what, expected);
  }

  bool Near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return (options_.T_reference_other * Eigen::Vector2d(b.head<2>()) - a.head<2>()).norm() < options_.tolerance_m;
  }

  void MatchRooms() {
    room_of_a_.resize(a_.rooms.size());
    for (size_t i = 0; i < a_.rooms.size(); ++i) {
      const Room& r = a_.rooms[i];
      for (size_t j = 0; j < b_.rooms.size(); ++j) {
        const Room& o = b_.rooms[j];
        // An outline moved by the tolerance all round.
        double around_m = 0;
        for (size_t k = 0; k < r.polygon.size(); ++k) around_m += (r.polygon[(k + 1) % r.polygon.size()] - r.polygon[k]).norm();
        if (o.storey == r.storey && Near(r.center, o.center) && std::abs(o.area_m2 - r.area_m2) < 0.5 * options_.tolerance_m * around_m)
          room_of_a_[i] = RoomId(j);
      }
      if (!room_of_a_[i].valid()) {
        Say("no room `{}` of {:.3f} m2 at ({:.3f}, {:.3f})", r.name, r.area_m2, r.center.x(), r.center.y());
        continue;
      }
      const Room& same = b_.rooms[room_of_a_[i].index()];
      if (options_.heights && std::abs(same.floor_z_m - r.floor_z_m) + std::abs(same.ceiling_z_m - r.ceiling_z_m) > options_.tolerance_m)
        Say("room `{}` from {:.3f} m to {:.3f} m is from {:.3f} m to {:.3f} m", r.name, r.floor_z_m, r.ceiling_z_m, same.floor_z_m,
            same.ceiling_z_m);
      if (options_.names && b_.rooms[room_of_a_[i].index()].name != r.name) {
        Say("room `{}` is `{}`", r.name, b_.rooms[room_of_a_[i].index()].name);
      }
    }
  }

  RoomId InOther(RoomId id) const { return id.valid() ? room_of_a_[id.index()] : id; }

  // As seen by who comes from the given room; without their widths, as some sources count frames in.
  static std::vector<DoorLeaf> LeavesFrom(const Doorway& d, RoomId from) {
    std::vector<DoorLeaf> out = d.leaves;
    for (DoorLeaf& l : out) {
      l.width_m = 0;
      if (d.room_a == from) continue;
      if (l.jamb != Jamb::kUnknown) l.jamb = l.jamb == Jamb::kLeft ? Jamb::kRight : Jamb::kLeft;
      if (l.opens_to != DoorwaySide::kUnknown) l.opens_to = l.opens_to == DoorwaySide::kRoomA ? DoorwaySide::kRoomB : DoorwaySide::kRoomA;
    }
    std::stable_sort(out.begin(), out.end(), [](const DoorLeaf& a, const DoorLeaf& b) { return a.jamb < b.jamb; });
    return out;
  }

  void CompareDoorway(const Doorway& d) {
    const auto same = std::find_if(b_.doorways.begin(), b_.doorways.end(), [&](const Doorway& o) {
      return o.storey == d.storey && Near(d.position, o.position) && std::abs(o.width_m - d.width_m) < options_.tolerance_m;
    });
    if (same == b_.doorways.end())
      return Say("no doorway `{}` of {:.3f} m at ({:.3f}, {:.3f})", d.name, d.width_m, d.position.x(), d.position.y());
    const auto rooms = [](RoomId a, RoomId b) { return std::multiset<uint32_t>{a.value, b.value}; };
    if (rooms(same->room_a, same->room_b) != rooms(InOther(d.room_a), InOther(d.room_b))) Say("doorway `{}` joins other rooms", d.name);
    if (options_.swings && LeavesFrom(*same, InOther(d.room_a)) != LeavesFrom(d, d.room_a)) Say("doorway `{}` opens another way", d.name);
    if (options_.leaves && same->has_leaf != d.has_leaf) Say("doorway `{}` {} a leaf", d.name, d.has_leaf ? "is without" : "has");
  }

  void CompareSurfaces() {
    std::vector<Surface> moved;
    for (const Surface& s : b_.surfaces) moved.push_back(Moved(options_.T_reference_other, s));
    const auto compare = [&](const std::vector<Surface>& of, const std::vector<Surface>& with, bool reference, const char* whose) {
      for (const Surface& s : of) {
        for (const Place& p : PlacesOn(s)) {
          const bool found = std::any_of(with.begin(), with.end(), [&](const Surface& o) {
            const RoomId expected = reference ? InOther(s.room) : s.room, room = reference ? o.room : InOther(o.room);
            return o.storey == s.storey && room == expected && LiesOn(p, o, options_.tolerance_m);
          });
          if (found) continue;
          Say("a surface {} at ({:.3f}, {:.3f}), of {:.3f} m from ({:.3f}, {:.3f}), has none beside it", whose, p.at.x(), p.at.y(),
              s.length_m(), s.start.x(), s.start.y());
          break;
        }
      }
    };
    compare(a_.surfaces, moved, true, "of the reference");
    compare(moved, a_.surfaces, false, "of the other");
  }

  const AGraph &a_, &b_;
  const SamePlanOptions& options_;
  std::vector<RoomId> room_of_a_;  // in b_, by room of a_
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> PlanDifferences(const AGraph& reference, const AGraph& other, const SamePlanOptions& options) {
  return Comparison(reference, other, options).Run();
}

}  // namespace plumb::test
