#include "runtime/deviations/panel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kCell_m = 1.0;
constexpr double kMaxCells = 512;  // along one axis; cells of larger plans are larger

}  // namespace

bool Meet(const Panel& panel, const Sight& sight, Meeting* meeting) {
  const double from = panel.W(sight.from.head<2>()), to = panel.W(sight.to.head<2>());
  const double side = from >= 0 ? 1.0 : -1.0, closer = side * (from - to);
  if (closer <= 0) return false;
  const Eigen::Vector3d step = sight.to - sight.from;
  const double t = side * from / closer;
  const Eigen::Vector3d at = sight.from + t * step;
  *meeting = {side * from,     side * to,           panel.U(at.head<2>()), at.z(), panel.along.dot(step.head<2>()) / closer,
              t * step.norm(), closer / step.norm()};
  return true;
}

PanelGrid::PanelGrid(const std::vector<Panel>& panels, double reach_m) : seen_(panels.size(), 0) {
  Eigen::AlignedBox2d all;
  const auto box = [&](const Panel& p) {
    Eigen::AlignedBox2d out(p.start);
    out.extend(p.start + p.length_m * p.along);
    return Eigen::AlignedBox2d(out.min().array() - reach_m, out.max().array() + reach_m);
  };
  for (const Panel& p : panels) all.extend(box(p));
  if (all.isEmpty()) return;
  low_ = all.min();
  cell_m_ = std::max(kCell_m, all.sizes().maxCoeff() / kMaxCells);
  size_ = (all.sizes() / cell_m_).array().floor().cast<int>() + 1;
  cells_.resize(static_cast<size_t>(size_.x()) * static_cast<size_t>(size_.y()));
  for (uint32_t i = 0; i < panels.size(); ++i) {
    const Eigen::AlignedBox2d b = box(panels[i]);
    const Eigen::Vector2i lo = CellOf(b.min()), hi = CellOf(b.max());
    const double diagonal = cell_m_ * std::sqrt(0.5) + reach_m;
    for (int y = lo.y(); y <= hi.y(); ++y) {
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const Eigen::Vector2d middle = low_ + cell_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
        if (std::abs(panels[i].W(middle)) > diagonal) continue;
        cells_[static_cast<size_t>(y) * static_cast<size_t>(size_.x()) + static_cast<size_t>(x)].push_back(i);
      }
    }
  }
}

Eigen::Vector2i PanelGrid::CellOf(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d c = (p - low_) / cell_m_;
  const auto clamped = [](double v, int size) { return static_cast<int>(std::clamp(std::floor(v), 0.0, size - 1.0)); };
  return {clamped(c.x(), size_.x()), clamped(c.y(), size_.y())};
}

void PanelGrid::Near(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::vector<uint32_t>& out) {
  out.clear();
  if (cells_.empty()) return;
  ++query_;
  // Half a cell at a time: a corner of a cell that is stepped over is within the panels' reach of the next.
  const int steps = static_cast<int>(std::ceil((b - a).norm() / (0.5 * cell_m_)));
  Eigen::Vector2i last(-1, -1);
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector2d p = steps == 0 ? a : Eigen::Vector2d(a + static_cast<double>(k) / steps * (b - a));
    const Eigen::Vector2i cell = CellOf(p);
    if (cell == last) continue;
    last = cell;
    for (const uint32_t i : cells_[static_cast<size_t>(cell.y()) * static_cast<size_t>(size_.x()) + static_cast<size_t>(cell.x())]) {
      if (seen_[i] == query_) continue;
      seen_[i] = query_;
      out.push_back(i);
    }
  }
}

}  // namespace plumb::runtime
