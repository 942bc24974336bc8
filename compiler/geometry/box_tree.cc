#include "compiler/geometry/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <span>

namespace plumb::compiler {
namespace {

constexpr size_t kShared = 1 << 15;  // boxes that are worth a second thread

struct Place {
  double at;
  uint32_t index;
};

template <int kDimension>
class Builder {
 public:
  using Box = Eigen::AlignedBox<double, kDimension>;
  Builder(const std::vector<Box>& boxes, std::vector<uint32_t>& order, std::vector<Box>& nodes)
      : boxes_(boxes), order_(order), nodes_(nodes) {}

  // Of order[first, first + places.size()), below `node`.
  void Build(size_t node, size_t first, std::span<Place> places) {
    Box& bounds = nodes_[node];
    for (const Place& p : places) bounds.extend(boxes_[p.index]);
    if (2 * node >= nodes_.size()) {
      for (size_t i = 0; i < places.size(); ++i) order_[first + i] = places[i].index;
      return;
    }
    Eigen::Index axis = 0;
    if (!bounds.isEmpty()) bounds.sizes().maxCoeff(&axis);
    for (Place& p : places) p.at = boxes_[p.index].min()[axis] + boxes_[p.index].max()[axis];
    const size_t half = places.size() / 2;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end(),
                     [](const Place& a, const Place& b) { return a.at != b.at ? a.at < b.at : a.index < b.index; });
    const auto lower = [&] { Build(2 * node, first, places.first(half)); };
    const auto upper = [&] { Build(2 * node + 1, first + half, places.subspan(half)); };
    if (places.size() >= kShared) {
      tbb::parallel_invoke(lower, upper);
    } else {
      lower();
      upper();
    }
  }

 private:
  const std::vector<Box>& boxes_;
  std::vector<uint32_t>& order_;
  std::vector<Box>& nodes_;
};

}  // namespace

template <int kDimension>
void BoxTree<kDimension>::Build() {
  order_.resize(boxes_.size());
  size_t leaves = 1;
  while (leaves * kLeaf < order_.size()) leaves *= 2;
  nodes_.resize(2 * leaves);
  std::vector<Place> places(order_.size());
  for (uint32_t i = 0; i < places.size(); ++i) places[i].index = i;
  if (!order_.empty()) Builder<kDimension>(boxes_, order_, nodes_).Build(1, 0, places);
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace plumb::compiler
