// A static tree of axis-aligned boxes: finds those that meet something without looking at all. Points are boxes without extent.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::compiler {

// Built by splitting at the median of the longest extent: O(n log n). Deterministic; large ones are built on several threads.
template <int kDimension>
class BoxTree {
 public:
  using Box = Eigen::AlignedBox<double, kDimension>;

  BoxTree() = default;
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)) { Build(); }

  [[nodiscard]] size_t size() const { return boxes_.size(); }

  // Calls visit(i) for each box i with meets(box), and for a few others beside them, given that meets(a) implies meets(b) where b contains
  // a. The order is fixed, but no particular one.
  template <class Meets, class Visit>
  void ForEach(const Meets& meets, const Visit& visit) const {
    if (!order_.empty()) Descend(1, 0, order_.size(), meets, visit);
  }

  // Only those that have a point in common with `query`, on its border too.
  template <class Visit>
  void ForEachIn(const Box& query, const Visit& visit) const {
    ForEach([&query](const Box& box) { return box.intersects(query); }, [&](uint32_t i) {
      if (boxes_[i].intersects(query)) visit(i);
    });
  }

 private:
  static constexpr size_t kLeaf = 8;

  void Build();

  [[nodiscard]] bool IsLeaf(size_t node) const { return 2 * node >= nodes_.size(); }

  template <class Meets, class Visit>
  void Descend(size_t node, size_t first, size_t last, const Meets& meets, const Visit& visit) const {
    if (!meets(nodes_[node])) return;
    if (IsLeaf(node)) {
      for (size_t i = first; i < last; ++i) visit(order_[i]);
      return;
    }
    const size_t middle = (first + last) / 2;
    Descend(2 * node, first, middle, meets, visit);
    Descend(2 * node + 1, middle, last, meets, visit);
  }

  std::vector<Box> boxes_;
  std::vector<uint32_t> order_;
  std::vector<Box> nodes_;  // from 1 on; node n holds a part of order_, its halves are nodes 2n and 2n + 1
};

extern template class BoxTree<2>;
extern template class BoxTree<3>;

}  // namespace plumb::compiler
