#include "tests/compile/corpus/raster.h"

#include <algorithm>
#include <cmath>

namespace plumb::corpus {
namespace {

constexpr int32_t kFree = -2;
constexpr int kMargin = 8;  // cells around the plan: the outside is connected

Eigen::AlignedBox2d BoxOf(const Rings& rings) {
  Eigen::AlignedBox2d box;
  for (const Ring& ring : rings) {
    for (const auto& p : ring) box.extend(p);
  }
  return box;
}

double Length(const std::vector<std::pair<double, double>>& spans) {
  double out = 0;
  for (const auto& [lo, hi] : spans) out += hi - lo;
  return out;
}

double CommonLength(const std::vector<std::pair<double, double>>& a, const std::vector<std::pair<double, double>>& b) {
  double out = 0;
  for (const auto& [lo, hi] : a) {
    for (const auto& [from, to] : b) out += std::max(0.0, std::min(hi, to) - std::max(lo, from));
  }
  return out;
}

}  // namespace

std::vector<std::pair<double, double>> SpansAt(const Rings& rings, double y_m) {
  std::vector<std::pair<double, int>> crossings;
  for (const Ring& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() <= y_m) == (b.y() <= y_m)) continue;
      crossings.emplace_back(a.x() + (b.x() - a.x()) * (y_m - a.y()) / (b.y() - a.y()), a.y() <= y_m ? 1 : -1);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<std::pair<double, double>> out;
  int winding = 0;
  for (const auto& [x, step] : crossings) {
    if (winding == 0) out.emplace_back(x, x);
    winding += step;
    out.back().second = x;
  }
  return out;
}

bool Inside(const Rings& rings, const Eigen::Vector2d& p) {
  const auto spans = SpansAt(rings, p.y());
  return std::any_of(spans.begin(), spans.end(), [&](const auto& s) { return s.first <= p.x() && p.x() <= s.second; });
}

double Iou(const Rings& a, const Rings& b) {
  constexpr double kRow_m = 0.01;
  const Eigen::AlignedBox2d box_a = BoxOf(a), box_b = BoxOf(b);
  if (box_a.isEmpty() || box_b.isEmpty() || !box_a.intersects(box_b)) return 0;
  const double low = std::min(box_a.min().y(), box_b.min().y()), high = std::max(box_a.max().y(), box_b.max().y());
  const int rows = std::max(1, static_cast<int>(std::ceil((high - low) / kRow_m)));
  double common = 0, sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double y = low + (i + 0.5) * (high - low) / rows;
    const auto in_a = SpansAt(a, y), in_b = SpansAt(b, y);
    common += CommonLength(in_a, in_b);
    sum += Length(in_a) + Length(in_b);
  }
  return sum > 0 ? common / (sum - common) : 0;
}

Raster::Raster(const std::vector<Rings>& regions) {
  Eigen::AlignedBox2d box;
  for (const Rings& r : regions) box.extend(BoxOf(r));
  if (box.isEmpty()) box.extend(Eigen::Vector2d(0, 0));
  low_ = box.min() - Eigen::Vector2d::Constant(kMargin * kCell_m);
  width_ = static_cast<int>(std::ceil(box.sizes().x() / kCell_m)) + 2 * kMargin;
  height_ = static_cast<int>(std::ceil(box.sizes().y() / kCell_m)) + 2 * kMargin;
  cells_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), kFree);
  for (const Rings& r : regions) Fill(r);
  Grow();
  NumberComponents();
}

void Raster::Fill(const Rings& rings) {
  const Eigen::AlignedBox2d box = BoxOf(rings);
  if (box.isEmpty()) return;
  const int first = static_cast<int>((box.min().y() - low_.y()) / kCell_m), last = static_cast<int>((box.max().y() - low_.y()) / kCell_m);
  for (int row = first; row <= last; ++row) {
    for (const auto& [lo, hi] : SpansAt(rings, low_.y() + (row + 0.5) * kCell_m)) {
      const int from = static_cast<int>(std::ceil((lo - low_.x()) / kCell_m - 0.5));
      for (int column = from; low_.x() + (column + 0.5) * kCell_m <= hi; ++column) {
        cells_[static_cast<size_t>(row) * static_cast<size_t>(width_) + static_cast<size_t>(column)] = kSolid;
      }
    }
  }
}

void Raster::Grow() {
  const std::vector<int32_t> before = cells_;
  const auto w = static_cast<size_t>(width_);
  for (size_t i = 0; i < before.size(); ++i) {
    if (before[i] != kSolid) continue;
    for (const size_t neighbour : {i - 1, i + 1, i - w, i + w}) cells_[neighbour] = kSolid;
  }
}

void Raster::NumberComponents() {
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i] == kFree) Flood(i, static_cast<int32_t>(areas_m2_.size()));
  }
}

void Raster::Flood(size_t start, int32_t component) {
  const auto w = static_cast<size_t>(width_);
  size_t count = 0;
  std::vector<size_t> open = {start};
  cells_[start] = component;
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    ++count;
    const size_t column = i % w, row = i / w;
    const auto visit = [&](bool exists, size_t neighbour) {
      if (!exists || cells_[neighbour] != kFree) return;
      cells_[neighbour] = component;
      open.push_back(neighbour);
    };
    visit(column > 0, i - 1);
    visit(column + 1 < w, i + 1);
    visit(row > 0, i - w);
    visit(row + 1 < static_cast<size_t>(height_), i + w);
  }
  areas_m2_.push_back(static_cast<double>(count) * kCell_m * kCell_m);
}

int32_t Raster::At(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d q = (p - low_) / kCell_m;
  if (q.x() < 0 || q.y() < 0 || q.x() >= width_ || q.y() >= height_) return kOutside;
  return cells_[static_cast<size_t>(q.y()) * static_cast<size_t>(width_) + static_cast<size_t>(q.x())];
}

bool Raster::SolidWithin(const Eigen::Vector2d& p, double radius_m) const {
  for (double dy = -radius_m; dy <= radius_m; dy += kCell_m) {
    const double reach = std::sqrt(radius_m * radius_m - dy * dy);
    for (double dx = -reach; dx <= reach; dx += kCell_m) {
      if (At(p + Eigen::Vector2d(dx, dy)) == kSolid) return true;
    }
  }
  return false;
}

}  // namespace plumb::corpus
