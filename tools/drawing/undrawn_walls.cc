#include "tools/drawing/undrawn_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "schema/polygon.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kStep_m = 0.05;                           // between points of an axis that are looked for
constexpr double kLeastPiece_m = 0.1;                      // to draw
constexpr std::array<double, 3> kAcross = {-0.3, 0, 0.3};  // of the thickness: one skin of two may close
constexpr double kReach_m = 0.02;                          // beyond an opening's jamb

// The rings of one element, even-odd.
struct Filled {
  Eigen::AlignedBox2d box;
  const std::vector<Ring>* rings;
  [[nodiscard]] bool Holds(const Vector2d& p) const {
    if (!box.contains(p)) return false;
    return std::count_if(rings->begin(), rings->end(), [&p](const Ring& ring) { return Contains(ring, p); }) % 2 == 1;
  }
};

class Walls {
 public:
  Walls(const AGraph& graph, double z_m, const std::vector<ElementSection>& sections) : graph_(graph), z_m_(z_m) {
    for (const ElementSection& section : sections) {
      Filled filled{{}, &section.rings};
      for (const Ring& ring : section.rings) {
        for (const Vector2d& p : ring) filled.box.extend(p);
      }
      filled_.push_back(filled);
    }
  }

  void AddPieces(WallId id, std::vector<Ring>& out) const {
    const Wall& wall = graph_.walls[id.index()];
    const double length_m = (wall.axis_end - wall.axis_start).norm();
    const auto openings = OpeningsOf(id);
    const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kStep_m)));
    const double step_m = length_m / steps;
    int first = 0;
    for (int i = 0; i <= steps; ++i) {
      const double at_m = (i + 0.5) * step_m;
      if (i < steps && IsUndrawn(wall, openings, at_m)) continue;
      if ((i - first) * step_m >= kLeastPiece_m) out.push_back(Piece(wall, first * step_m, i * step_m));
      first = i + 1;
    }
  }

 private:
  // From and to along the axis, of those at the height of the cut.
  [[nodiscard]] std::vector<std::pair<double, double>> OpeningsOf(WallId id) const {
    const Wall& wall = graph_.walls[id.index()];
    const Vector2d along = (wall.axis_end - wall.axis_start).normalized();
    std::vector<std::pair<double, double>> out;
    const auto add = [&](const auto& openings) {
      for (const auto& o : openings) {
        if (o.wall != id || z_m_ < o.position.z() || z_m_ > o.position.z() + o.height_m) continue;
        const double middle_m = along.dot(o.position.template head<2>() - wall.axis_start), half_m = 0.5 * o.width_m + kReach_m;
        out.emplace_back(middle_m - half_m, middle_m + half_m);
      }
    };
    add(graph_.doorways);
    add(graph_.windows);
    return out;
  }

  [[nodiscard]] bool IsUndrawn(const Wall& wall, const std::vector<std::pair<double, double>>& openings, double at_m) const {
    const auto is_open = [at_m](const auto& o) { return o.first < at_m && at_m < o.second; };
    if (std::any_of(openings.begin(), openings.end(), is_open)) return false;
    const Vector2d along = (wall.axis_end - wall.axis_start).normalized(), p = wall.axis_start + at_m * along;
    return std::any_of(kAcross.begin(), kAcross.end(), [&](double share) {
      const Vector2d q = p + share * wall.thickness_m * Vector2d(-along.y(), along.x());
      return std::none_of(filled_.begin(), filled_.end(), [&q](const Filled& f) { return f.Holds(q); });
    });
  }

  static Ring Piece(const Wall& wall, double from_m, double to_m) {
    const Vector2d along = (wall.axis_end - wall.axis_start).normalized();
    return RectangleAlong(wall.axis_start + 0.5 * (from_m + to_m) * along, along, to_m - from_m, wall.thickness_m);
  }

  const AGraph& graph_;
  double z_m_;
  std::vector<Filled> filled_;
};

}  // namespace

std::vector<Ring> UndrawnWalls(const AGraph& graph, StoreyId storey, double z_m, const std::vector<SectionSegment>& segments,
                               const std::vector<ElementSection>& sections) {
  // Segments less corners of closed rings, by wall; none where nothing was cut.
  std::vector<std::optional<ptrdiff_t>> left_over(graph.walls.size());
  const auto count = [&](uint32_t element, ptrdiff_t n) {
    if (const WallId wall = graph.elements[element].wall; wall.valid()) left_over[wall.index()] = left_over[wall.index()].value_or(0) + n;
  };
  for (const SectionSegment& s : segments) count(s.element, 1);
  for (const ElementSection& section : sections) {
    for (const Ring& ring : section.rings) count(section.element, -static_cast<ptrdiff_t>(ring.size()));
  }
  for (const Surface& s : graph.surfaces) {
    if (s.arc && s.wall.valid()) left_over[s.wall.index()] = 0;
  }
  const Walls walls(graph, z_m, sections);
  std::vector<Ring> out;
  for (size_t i = 0; i < graph.walls.size(); ++i) {
    const Wall& w = graph.walls[i];
    if (w.storey != storey || w.z_min_m > z_m || w.z_max_m < z_m || w.axis_start == w.axis_end || left_over[i] == 0) continue;
    walls.AddPieces(WallId(i), out);
  }
  return out;
}

}  // namespace plumb::tools
