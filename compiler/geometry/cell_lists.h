// Points by the cell of a grid that they lie in, for looking up what is near a place.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::compiler {

// Of points in the plane, told by their numbers 0, 1, 2, ... Cells are much larger than the distance that counts as near, so that only
// points near a border are looked up in more than one; far apart cells may share a list, which costs time only. O(1) a point.
class CellLists {
 public:
  explicit CellLists(double near_m) : near_m_(near_m), cell_m_(kCellsize * near_m), slots_(32) {}

  // Calls visit(i) for all points in reach of `p`, and for some beside them: first those of the lower cells, in each the latest first.
  template <class Visit>
  void ForEachNear(const Eigen::Vector2d& p, const Visit& visit) const {
    const int64_t x1 = CellOf(p.x() + near_m_), y0 = CellOf(p.y() - near_m_), y1 = CellOf(p.y() + near_m_);
    for (int64_t x = CellOf(p.x() - near_m_); x <= x1; ++x) {
      for (int64_t y = y0; y <= y1; ++y) {
        for (uint32_t i = slots_[SlotOf(Key(x, y))].head; i != kEnd; i = next_[i]) visit(i);
      }
    }
  }

  // The next number.
  void Add(const Eigen::Vector2d& p) {
    if (2 * used_ >= slots_.size()) Grow();
    const uint64_t key = Key(CellOf(p.x()), CellOf(p.y()));
    Slot& slot = slots_[SlotOf(key)];
    if (slot.head == kEnd) ++used_;
    const auto index = static_cast<uint32_t>(next_.size());
    next_.push_back(slot.head);
    slot = {key, index};
  }

 private:
  static constexpr double kCellsize = 8;  // in units of what is near
  static constexpr double kFar = 1e15;    // cells
  static constexpr uint32_t kEnd = 0xffffffffu;
  struct Slot {
    uint64_t key = 0;
    uint32_t head = kEnd;  // its last point; none: the slot is empty
  };

  [[nodiscard]] int64_t CellOf(double v) const { return static_cast<int64_t>(std::floor(std::clamp(v / cell_m_, -kFar, kFar))); }
  static uint64_t Key(int64_t x, int64_t y) {
    const uint64_t mixed = (static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(y)) * 0xbf58476d1ce4e5b9u;
    return mixed ^ (mixed >> 29);
  }
  [[nodiscard]] size_t SlotOf(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    size_t at = key & mask;
    while (slots_[at].head != kEnd && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }
  void Grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.head != kEnd) slots_[SlotOf(slot.key)] = slot;
    }
  }

  double near_m_, cell_m_;
  std::vector<uint32_t> next_;  // in the same cell
  std::vector<Slot> slots_;     // a hash table with open addresses; their number is a power of two
  size_t used_ = 0;
};

}  // namespace plumb::compiler
