#include "compiler/passes/twin_classes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

constexpr int kYawBins = 180;
constexpr double kPlaceBin_m = 0.5, kHeightBin_m = 0.5;

std::array<int32_t, 4> BinOf(const PlanarMotion& motion, const Eigen::Vector3d& middle) {
  const Eigen::Vector3d to = motion.Apply(middle);
  const auto bin = [](double value, double width) { return static_cast<int32_t>(std::lround(value / width)); };
  const int32_t yaw = (bin(motion.yaw_rad(), 2 * std::numbers::pi / kYawBins) + kYawBins) % kYawBins;
  return {yaw, bin(to.x(), kPlaceBin_m), bin(to.y(), kPlaceBin_m), bin(to.z(), kHeightBin_m)};
}

size_t CountVotes(const TwinClass& c) { return c.rooms.size() * (c.rooms.size() + 1) / 2 * c.symmetries(); }

void AddVotes(const TwinClass& c, const Eigen::Vector3d& middle, size_t limit, std::vector<MotionVote>& votes) {
  for (size_t a = 0; a < c.rooms.size() && votes.size() < limit; ++a) {
    for (size_t b = a; b < c.rooms.size() && votes.size() < limit; ++b) {
      for (size_t s = a == b ? 1 : 0; s < c.symmetries(); ++s) {
        const PlanarMotion motion = c.Between(a, b, s);
        votes.push_back({BinOf(motion, middle), {c.rooms[a], c.rooms[b]}, motion});
      }
    }
  }
}

}  // namespace

std::vector<TwinClass> FindTwinClasses(const RoomShapes& shapes, const RoomSections& sections, size_t num_rooms, double min_overlap_ratio) {
  const auto verified = [&](RoomId a, RoomId b) {
    std::vector<PlanarMotion> motions = shapes.MotionsOnto(a, b);
    std::erase_if(motions, [&](const PlanarMotion& m) { return sections.Compare(a, m, b).overlap_ratio() < min_overlap_ratio; });
    return motions;
  };
  std::vector<TwinClass> classes;
  for (size_t r = 0; r < num_rooms; ++r) {
    const RoomId room(r);
    if (sections.NumPoints(room) == 0) continue;
    const auto joins = [&](TwinClass& c) {
      if (!shapes.MayBeTwins(c.rooms.front(), room)) return false;
      std::vector<PlanarMotion> motions = verified(c.rooms.front(), room);
      // A room near the limit may have fewer motions than its class has symmetries; it then stands alone.
      if (motions.empty() || motions.size() < c.symmetries()) return false;
      c.rooms.push_back(room);
      c.motions.push_back(std::move(motions));
      return true;
    };
    if (std::none_of(classes.begin(), classes.end(), joins)) classes.push_back({{room}, {verified(room, room)}, {}});
  }
  for (TwinClass& c : classes) {
    c.by_x = c.rooms;
    std::stable_sort(c.by_x.begin(), c.by_x.end(), [&](RoomId a, RoomId b) { return shapes.Center(a).x() < shapes.Center(b).x(); });
  }
  return classes;
}

std::vector<MotionVote> VotesFor(const std::vector<TwinClass>& classes, const Eigen::Vector3d& middle, size_t max_votes) {
  std::vector<const TwinClass*> rarest;
  for (const TwinClass& c : classes) rarest.push_back(&c);
  std::stable_sort(rarest.begin(), rarest.end(), [](const TwinClass* a, const TwinClass* b) { return CountVotes(*a) < CountVotes(*b); });
  std::vector<MotionVote> votes;
  for (size_t i = 0; i < rarest.size(); ++i) {
    const size_t left = max_votes - std::min(votes.size(), max_votes);
    AddVotes(*rarest[i], middle, votes.size() + left / (rarest.size() - i), votes);
  }
  std::stable_sort(votes.begin(), votes.end(), [](const MotionVote& a, const MotionVote& b) { return a.bin < b.bin; });
  return votes;
}

}  // namespace plumb::compiler
