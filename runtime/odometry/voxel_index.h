// A flat hash table from voxel keys to dense indices, numbered in order of insertion: iteration over the indices is deterministic.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumb::runtime {

// Voxel coordinates as one key, 21 bits each: unique within +-1,048,576 voxels of the origin.
[[nodiscard]] inline uint64_t PackVoxel(int64_t x, int64_t y, int64_t z) {
  constexpr uint64_t kMask = (uint64_t{1} << 21) - 1;
  return (static_cast<uint64_t>(x) & kMask) | (static_cast<uint64_t>(y) & kMask) << 21 | (static_cast<uint64_t>(z) & kMask) << 42;
}

// Of the voxel that holds p, given in units of voxels.
[[nodiscard]] inline uint64_t VoxelKey(const Eigen::Vector3d& p) {
  return PackVoxel(static_cast<int64_t>(std::floor(p.x())), static_cast<int64_t>(std::floor(p.y())),
                   static_cast<int64_t>(std::floor(p.z())));
}

// The k-th, of 27, of the steps to a voxel and its neighbours; 13 is the voxel itself.
[[nodiscard]] inline Eigen::Vector3d NeighbourOffset(int k) { return Eigen::Vector3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1); }

// Open addressing, linear probing, at most half full. Expected O(1) per call.
class VoxelIndex {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  explicit VoxelIndex(size_t expected = 64) { Rehash(expected); }

  [[nodiscard]] size_t size() const { return size_; }

  [[nodiscard]] uint32_t Find(uint64_t key) const { return slots_[Probe(key)].index; }

  // The key's index, and whether it is new.
  std::pair<uint32_t, bool> Insert(uint64_t key) {
    if (2 * (size_ + 1) > slots_.size()) Rehash(2 * size_ + 2);
    Slot& slot = slots_[Probe(key)];
    if (slot.index != kNone) return {slot.index, false};
    slot = {key, static_cast<uint32_t>(size_++)};
    return {slot.index, true};
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t index = kNone;
  };

  [[nodiscard]] size_t Probe(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    uint64_t h = key * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
    size_t at = h & mask;
    while (slots_[at].index != kNone && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }

  void Rehash(size_t expected) {
    size_t capacity = 128;
    while (capacity < 2 * expected) capacity *= 2;
    std::vector<Slot> old(capacity);
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.index != kNone) slots_[Probe(slot.key)] = slot;
    }
  }

  std::vector<Slot> slots_;
  size_t size_ = 0;
};

}  // namespace plumb::runtime
