#include "runtime/deviations/displaced_wall.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kOn_m = 0.10;  // of a point from the faces of the wall that it is on, besides what the steps leave
constexpr double kOffsetStep_m = 0.1, kYawStep_rad = 0.1309;
constexpr double kMinClosed_m2 = 0.25;  // of what must be seen of a wall that may stand there
constexpr double kMinOpenRatio = 0.5;   // of the cells seen: a wall that stands there stops lines nearly everywhere, furniture in part

Panel Moved(Panel panel, const Eigen::Vector2d& pivot, const Eigen::Vector2d& normal, double offset_m, double yaw_rad) {
  const Eigen::Rotation2Dd turn(yaw_rad);
  panel.start = pivot + turn * (panel.start - pivot) + offset_m * normal;
  panel.along = turn * panel.along;
  panel.normal = turn * panel.normal;
  return panel;
}

}  // namespace

DisplacedWall::DisplacedWall(const WallFrame& frame, std::vector<FaceGrid> faces, const PresenceOptions& options)
    : options_(options), pivot_(frame.pivot.head<2>()) {
  const Eigen::Vector2d normal = frame.normal.head<2>().normalized();
  const int offsets = static_cast<int>(std::lround(options.max_offset_m / kOffsetStep_m));
  const int turns = static_cast<int>(std::lround(options.max_yaw_rad / kYawStep_rad));
  double arm_m = 0;
  for (const FaceGrid& g : faces) {
    planned_.push_back(g.panel);
    arm_m = std::max({arm_m, (g.panel.start - pivot_).norm(), (g.panel.start + g.panel.length_m * g.panel.along - pivot_).norm()});
  }
  reach_m_ = options.max_offset_m + arm_m * std::sin(options.max_yaw_rad);
  radius_m_ = options.max_offset_m + arm_m;
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int offset = -offsets; offset <= offsets; ++offset) {
      places_.push_back(faces);
      for (FaceGrid& g : places_.back()) g.panel = Moved(g.panel, pivot_, normal, offset * kOffsetStep_m, turn * kYawStep_rad);
    }
  }
}

void DisplacedWall::Count(const Sight& sight, bool stops) {
  const Eigen::Vector2d from = sight.from.head<2>(), way = sight.to.head<2>() - from;
  const double nearest = std::clamp(way.dot(pivot_ - from) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
  if ((from + nearest * way - pivot_).norm() > radius_m_) return;
  for (size_t face = 0; face < planned_.size(); ++face) {
    const double from_m = planned_[face].W(sight.from.head<2>()), to_m = planned_[face].W(sight.to.head<2>());
    if (std::min(from_m, to_m) > reach_m_ || std::max(from_m, to_m) < -reach_m_) continue;
    for (std::vector<FaceGrid>& place : places_) {
      FaceGrid& g = place[face];
      Meeting m;
      if (!Meet(g.panel, sight, &m) || m.incidence < options_.min_incidence || m.sight_m > options_.max_sight_m) continue;
      FaceCell* cell = g.At(m.u, m.z);
      if (!cell) continue;
      const double arm_m = std::abs(g.panel.along.dot(pivot_ - g.panel.start) - m.u);
      const double on_m = g.half_m + kOn_m + 0.5 * kOffsetStep_m + 0.5 * kYawStep_rad * arm_m;
      if (std::abs(m.to_m) <= on_m) {
        cell->ended += stops ? 1 : 0;
      } else if (m.from_m > on_m && m.to_m < -on_m) {
        cell->CountPassed(sight.keyframe);
      }
    }
  }
}

bool DisplacedWall::MayStand() const {
  return std::any_of(places_.begin(), places_.end(), [&](const std::vector<FaceGrid>& place) {
    double open_m2 = 0, closed_m2 = 0;
    for (const FaceGrid& g : place) {
      const double cell_m2 = g.cell_m * g.cell_m;
      for (const FaceCell& cell : g.cells) {
        const bool open = IsOpen(cell, options_);
        if (open) open_m2 += cell_m2;
        if (!open && cell.ended >= static_cast<uint32_t>(options_.min_lines)) closed_m2 += cell_m2;
      }
    }
    return closed_m2 >= kMinClosed_m2 && open_m2 < kMinOpenRatio * (open_m2 + closed_m2);
  });
}

}  // namespace plumb::runtime
