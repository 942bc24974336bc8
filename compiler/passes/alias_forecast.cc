#include "compiler/passes/alias_forecast.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "compiler/geometry/for_each_job.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/twin_classes.h"

namespace plumb::compiler {
namespace {

constexpr double kSameMotion_m = 0.3;  // closer everywhere, and it is one motion
constexpr size_t kTriesPerAlias = 4;
constexpr size_t kMaxDifferences = 8;

struct Candidate {
  PlanarMotion motion;
  size_t points = 0;  // of section, in the rooms that it takes along
};

class Forecast {
 public:
  Forecast(AGraph& graph, const AliasOptions& options)
      : graph_(graph), options_(options), shapes_(graph, options.twins), sections_(graph, Wanted(), options.sections), box_(BoxOfRooms()) {}

  void Run() {
    classes_ = FindTwinClasses(shapes_, sections_, graph_.rooms.size(), options_.min_overlap_ratio);
    for (const TwinClass& c : classes_) {
      if (c.rooms.size() > 1) graph_.look_alikes.push_back({c.rooms});
      for (const RoomId room : c.rooms) members_.emplace_back(room, static_cast<size_t>(&c - classes_.data()));
    }
    for (const Candidate& c : Candidates()) {
      if (graph_.aliases.size() == options_.max_aliases || alias_rooms_ >= options_.max_alias_rooms) break;
      AddAlias(c.motion);
    }
    std::stable_sort(graph_.aliases.begin(), graph_.aliases.end(), [](const Alias& a, const Alias& b) {
      return a.closed != b.closed ? a.closed : a.section_length_m > b.section_length_m;
    });
  }

 private:
  // Only rooms that may have a twin, or that fall on themselves, need sections.
  std::vector<bool> Wanted() const {
    std::vector<bool> wanted(graph_.rooms.size(), false);
    for (const RoomId room : shapes_.WithLikelyTwins()) wanted[room.index()] = true;
    for (size_t r = 0; r < wanted.size(); ++r) {
      if (!wanted[r] && shapes_.MayBeTwins(RoomId(r), RoomId(r))) wanted[r] = shapes_.MotionsOnto(RoomId(r), RoomId(r)).size() > 1;
    }
    return wanted;
  }

  // The motions that several connected rooms vote for, or a room that leads nowhere else; most section first.
  std::vector<Candidate> Candidates() const {
    const std::vector<MotionVote> votes = VotesFor(classes_, box_.center(), options_.max_votes);
    std::vector<Candidate> out;
    for (size_t first = 0, last = 0; first < votes.size(); first = last) {
      std::vector<RoomPair> pairs;
      for (; last < votes.size() && votes[last].bin == votes[first].bin; ++last) pairs.push_back(votes[last].pair);
      size_t points = 0;
      for (const Part& part : PartsThatStay(std::move(pairs))) {
        for (const RoomPair& pair : part.pairs) points += sections_.NumPoints(pair.from);
      }
      if (points > 0) out.push_back({votes[first].motion, points});
    }
    std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.points > b.points; });
    out.resize(std::min(out.size(), kTriesPerAlias * options_.max_aliases));
    return out;
  }

  // Rooms that hang together through doorways, and what a motion takes them onto.
  struct Part {
    std::vector<RoomPair> pairs;
    bool closed = false;  // neither these rooms nor their twins lead to others
  };

  std::vector<Part> PartsThatStay(std::vector<RoomPair> pairs) const {
    std::sort(pairs.begin(), pairs.end(),
              [](const RoomPair& a, const RoomPair& b) { return std::tie(a.from, a.to) < std::tie(b.from, b.to); });
    std::vector<bool> seen(pairs.size(), false);
    std::vector<Part> parts;
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (seen[i]) continue;
      Part part;
      part.pairs.push_back(pairs[i]);
      seen[i] = true;
      for (size_t k = 0; k < part.pairs.size(); ++k) {
        for (RoomId next : shapes_.Neighbours(part.pairs[k].from)) {
          auto it = std::lower_bound(pairs.begin(), pairs.end(), next, [](const RoomPair& p, RoomId room) { return p.from < room; });
          for (; it != pairs.end() && it->from == next; ++it) {
            const size_t j = static_cast<size_t>(it - pairs.begin());
            if (!seen[j]) part.pairs.push_back(*it);
            seen[j] = true;
          }
        }
      }
      part.closed = LeadsNowhereElse(part.pairs, &RoomPair::from) && LeadsNowhereElse(part.pairs, &RoomPair::to);
      const bool is_shaft = part.pairs.size() == 1 && IsShaft(part.pairs.front().from);
      if (!is_shaft && (part.closed || part.pairs.size() > 1)) parts.push_back(std::move(part));
    }
    return parts;
  }

  // No way leads in, although its storey has doorways: no robot gets there. (An attic that a stair leads to is none.)
  bool IsShaft(RoomId room) const {
    const StoreyId storey = graph_.rooms[room.index()].storey;
    return shapes_.Ways(room) == 0 &&
           std::any_of(graph_.doorways.begin(), graph_.doorways.end(), [&](const Doorway& d) { return d.storey == storey; });
  }

  bool LeadsNowhereElse(const std::vector<RoomPair>& pairs, RoomId RoomPair::*side) const {
    std::vector<RoomId> rooms;
    for (const RoomPair& p : pairs) rooms.push_back(p.*side);
    std::sort(rooms.begin(), rooms.end());
    return std::all_of(rooms.begin(), rooms.end(), [&](RoomId room) {
      const std::vector<RoomId>& next = shapes_.Neighbours(room);
      return std::all_of(next.begin(), next.end(), [&](RoomId n) { return std::binary_search(rooms.begin(), rooms.end(), n); });
    });
  }

  // All rooms that `motion` takes onto another of their class.
  std::vector<RoomPair> RoomsTaken(const PlanarMotion& motion) const {
    const double reach_m = 2 * options_.twins.tolerance_m;
    std::vector<std::vector<RoomPair>> taken(members_.size());
    ForEachJob(members_.size(), options_.sections.min_parallel, [&](size_t m) {
      const auto& [room, in_class] = members_[m];
      const std::vector<RoomId>& by_x = classes_[in_class].by_x;
      const double x_m = motion.Apply(shapes_.Center(room)).x();
      auto it = std::lower_bound(by_x.begin(), by_x.end(), x_m - reach_m, [&](RoomId r, double x) { return shapes_.Center(r).x() < x; });
      for (; it != by_x.end() && shapes_.Center(*it).x() <= x_m + reach_m; ++it) {
        if (shapes_.TakesOnto(room, motion, *it)) taken[m].push_back({room, *it});
      }
    });
    std::vector<RoomPair> pairs;
    for (const auto& of_room : taken) pairs.insert(pairs.end(), of_room.begin(), of_room.end());
    return pairs;
  }

  // Least squares over the centres of the rooms; the motion of one vote leans on one room's longest wall.
  PlanarMotion Fitted(const PlanarMotion& motion, const std::vector<RoomPair>& pairs) const {
    if (pairs.size() < 2) return motion;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
    for (const RoomPair& p : pairs) {
      from += shapes_.Center(p.from) / static_cast<double>(pairs.size());
      to += shapes_.Center(p.to) / static_cast<double>(pairs.size());
    }
    double dot = 0, cross = 0;
    for (const RoomPair& p : pairs) {
      const Eigen::Vector2d u = (shapes_.Center(p.from) - from).head<2>(), v = (shapes_.Center(p.to) - to).head<2>();
      dot += u.dot(v);
      cross += Cross(u, v);
    }
    // Rooms one above the other tell nothing of the turn.
    const double yaw_rad = std::hypot(dot, cross) > 1 ? std::atan2(cross, dot) : motion.yaw_rad();
    return PlanarMotion::TurnOnto(yaw_rad, from, to);
  }

  bool IsKnown(const PlanarMotion& motion) const {
    return std::any_of(known_.begin(), known_.end(), [&](const PlanarMotion& known) {
      for (const auto corner :
           {Eigen::AlignedBox3d::BottomLeftFloor, Eigen::AlignedBox3d::BottomRightFloor, Eigen::AlignedBox3d::TopLeftFloor}) {
        const Eigen::Vector3d p = box_.corner(corner);
        if ((known.Apply(p) - motion.Apply(p)).norm() > kSameMotion_m) return false;
      }
      return true;
    });
  }

  using Comparisons = std::map<RoomId, SectionComparison>;  // of a room with its twin

  void AddAlias(const PlanarMotion& voted) {
    const PlanarMotion motion = Fitted(voted, RoomsTaken(voted));
    if (IsKnown(motion)) return;
    known_.push_back(motion);
    known_.push_back(motion.Inverse());
    const std::vector<RoomPair> pairs = RoomsTaken(motion);
    std::vector<SectionComparison> found(pairs.size());
    ForEachJob(pairs.size(), options_.sections.min_parallel,
               [&](size_t i) { found[i] = sections_.Compare(pairs[i].from, motion, pairs[i].to); });
    Comparisons compared;
    std::vector<RoomPair> coinciding;
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (found[i].overlap_ratio() < options_.min_overlap_ratio) continue;
      coinciding.push_back(pairs[i]);
      compared[pairs[i].from] = std::move(found[i]);
    }
    const std::vector<Part> parts = PartsThatStay(std::move(coinciding));
    if (parts.empty()) return;
    graph_.aliases.push_back(AliasOf(motion, parts, compared));
    alias_rooms_ += graph_.aliases.back().rooms.size();
  }

  Alias AliasOf(const PlanarMotion& motion, const std::vector<Part>& parts, const Comparisons& compared) const {
    Alias alias;
    alias.yaw_rad = motion.yaw_rad();
    const Eigen::Vector2d origin = graph_.origin.head<2>();
    alias.translation = motion.translation;
    alias.translation.head<2>() += origin - motion.Rotate(origin);
    alias.tolerance_m = options_.sections.tolerance_m;
    alias.closed = std::all_of(parts.begin(), parts.end(), [](const Part& p) { return p.closed; });
    std::vector<RoomPair> pairs;
    for (const Part& part : parts) pairs.insert(pairs.end(), part.pairs.begin(), part.pairs.end());
    std::sort(pairs.begin(), pairs.end(), [](const RoomPair& a, const RoomPair& b) { return a.from < b.from; });
    for (const RoomPair& p : pairs) {
      alias.rooms.push_back(p.from);
      alias.twins.push_back(p.to);
    }
    alias.from_storey = StoreyOf(alias.rooms);
    alias.to_storey = StoreyOf(alias.twins);
    AddOverlap(compared, alias);
    return alias;
  }

  // None if the rooms are on several.
  StoreyId StoreyOf(const std::vector<RoomId>& rooms) const {
    const StoreyId storey = graph_.rooms[rooms.front().index()].storey;
    const bool one = std::all_of(rooms.begin(), rooms.end(), [&](RoomId r) { return graph_.rooms[r.index()].storey == storey; });
    return one ? storey : StoreyId();
  }

  void AddOverlap(const Comparisons& compared, Alias& alias) const {
    const double heights = static_cast<double>(options_.sections.heights_m.size());
    size_t points = 0, unmatched = 0;
    std::map<uint32_t, size_t> by_element;
    for (RoomId room : alias.rooms) {
      const SectionComparison& c = compared.at(room);
      points += c.points;
      unmatched += c.unmatched_elements.size();
      alias.section_length_m += static_cast<double>(sections_.NumPoints(room)) * sections_.step_m() / heights;
      for (uint32_t e : c.unmatched_elements) ++by_element[e];
    }
    alias.overlap_ratio = 1 - static_cast<double>(unmatched) / static_cast<double>(points);
    std::vector<std::pair<uint32_t, size_t>> differences;
    for (const auto& [element, count] : by_element) {
      if (static_cast<double>(count) * sections_.step_m() >= options_.min_difference_m) differences.emplace_back(element, count);
    }
    std::stable_sort(differences.begin(), differences.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    differences.resize(std::min(differences.size(), kMaxDifferences));
    for (const auto& [element, count] : differences) alias.differences.emplace_back(element);
  }

  // In the mesh frame.
  Eigen::AlignedBox3d BoxOfRooms() const {
    Eigen::AlignedBox3d box;
    for (const Room& r : graph_.rooms) {
      for (const Eigen::Vector2d& p : r.polygon) box.extend(Eigen::Vector3d(p.x(), p.y(), r.floor_z_m) - graph_.origin);
    }
    return box;
  }

  AGraph& graph_;
  const AliasOptions& options_;
  RoomShapes shapes_;
  RoomSections sections_;
  Eigen::AlignedBox3d box_;
  std::vector<TwinClass> classes_;
  std::vector<std::pair<RoomId, size_t>> members_;  // of the classes, each with its class
  size_t alias_rooms_ = 0;
  std::vector<PlanarMotion> known_ = {PlanarMotion()};
};

}  // namespace

std::string AliasOptions::Check() const {
  for (const std::string& fault : {sections.Check(), twins.Check()}) {
    if (!fault.empty()) return fault;
  }
  if (!(min_overlap_ratio > 0 && min_overlap_ratio <= 1))
    return fmt::format("AliasOptions.min_overlap_ratio = {}; must be in (0, 1]", min_overlap_ratio);
  if (!(min_difference_m >= 0)) return fmt::format("AliasOptions.min_difference_m = {}; must not be negative", min_difference_m);
  if (max_aliases > 1000) return fmt::format("AliasOptions.max_aliases = {}; must be at most 1000", max_aliases);
  return {};
}

void ForecastAliases(const AliasOptions& options, AGraph& graph) {
  graph.aliases.clear();
  graph.look_alikes.clear();
  if (!graph.rooms.empty()) Forecast(graph, options).Run();
}

}  // namespace plumb::compiler
