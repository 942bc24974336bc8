// Faces of a section by direction and offset: what sections and bands both sweep along. Private to them.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "compiler/frontends/mesh/mesh_sections.h"

namespace plumb::compiler {

inline constexpr double kMarkWeld_m = 0.003;  // ends of faces closer than this meet

// A face of a section along one direction.
struct Mark {
  double c_m = 0, s0_m = 0, s1_m = 0;
  int sign = 0;  // +1: the free space is on the side of greater c
  size_t height = 0, line = 0;
};

// A line with the faces that cover it at one place.
struct Active {
  size_t line = 0;
  int entering = 0, leaving = 0;
};

[[nodiscard]] std::optional<size_t> DirectionOf(const std::vector<FaceDirection>& directions, const Eigen::Vector2d& v);

[[nodiscard]] Mark MarkOf(const FaceDirection& direction, const FaceSegment& f, size_t height);

// Numbers the lines by offset; returns their offsets: medians by length. Faces of a long wall that is not quite straight chain up.
[[nodiscard]] std::vector<double> NumberLines(std::vector<Mark>& marks, double tolerance_m);

// Calls visit(s0, s1, lines) for every stretch along the direction with the faces that cover it, in the order of their offsets.
template <class Visit>
void Sweep(const std::vector<const Mark*>& marks, const Visit& visit) {
  struct Event {
    double s_m;
    const Mark* mark;
    int step;
  };
  std::vector<Event> events;
  for (const Mark* m : marks) {
    events.push_back({m->s0_m, m, 1});
    events.push_back({m->s1_m, m, -1});
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.s_m < b.s_m; });
  std::map<size_t, Active> active;
  std::vector<Active> lines;
  for (size_t i = 0; i < events.size();) {
    const double s_m = events[i].s_m;
    for (; i < events.size() && events[i].s_m <= s_m + kMarkWeld_m; ++i) {
      Active& a = active[events[i].mark->line];
      a.line = events[i].mark->line;
      (events[i].mark->sign < 0 ? a.entering : a.leaving) += events[i].step;
      if (a.entering == 0 && a.leaving == 0) active.erase(a.line);
    }
    if (i == events.size() || active.empty()) continue;
    lines.clear();
    for (const auto& [line, a] : active) lines.push_back(a);
    visit(s_m, events[i].s_m, lines);
  }
}

}  // namespace plumb::compiler
