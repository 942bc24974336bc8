// Rooms that a LiDAR cannot tell apart from inside, and the motions that they vote for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/passes/room_sections.h"
#include "compiler/passes/room_twins.h"

namespace plumb::compiler {

// Rooms of one shape whose sections coincide.
struct TwinClass {
  std::vector<RoomId> rooms;                       // ascending
  std::vector<std::vector<PlanarMotion>> motions;  // that take the first onto each: as many for each as the room has symmetries
  std::vector<RoomId> by_x;                        // of the centre

  [[nodiscard]] size_t symmetries() const { return motions.front().size(); }
  // Takes one room onto another, by position in `rooms`.
  [[nodiscard]] PlanarMotion Between(size_t from, size_t to, size_t symmetry) const {
    return motions[to][symmetry].After(motions[from].front().Inverse());
  }
};

// A room and the one that a motion takes it onto.
struct RoomPair {
  RoomId from, to;
};

// A vote of two rooms of one class for a motion. Votes with the same bin are for about the same motion.
struct MotionVote {
  std::array<int32_t, 4> bin{};  // yaw, and where the middle of the plan goes
  RoomPair pair;
  PlanarMotion motion;
};

// Every room that has sections is in one class, many of them alone. O(rooms * classes).
[[nodiscard]] std::vector<TwinClass> FindTwinClasses(const RoomShapes& shapes, const RoomSections& sections, size_t num_rooms,
                                                     double min_overlap_ratio);

// For each two rooms of a class, and each way to take one onto the other; sorted by bin. Classes share about `max_votes`: small ones come
// first and leave the others what they do not need.
[[nodiscard]] std::vector<MotionVote> VotesFor(const std::vector<TwinClass>& classes, const Eigen::Vector3d& middle, size_t max_votes);

}  // namespace plumb::compiler
