#include "compiler/frontends/mesh/mesh_marks.h"

#include <cmath>

namespace plumb::compiler {
namespace {

constexpr double kMaxWarp = 4;  // tolerances between the ends of a face that is not quite straight

}  // namespace

std::optional<size_t> DirectionOf(const std::vector<FaceDirection>& directions, const Eigen::Vector2d& v) {
  std::optional<size_t> best;
  double least = kSameDirection_rad * v.norm();
  for (size_t d = 0; d < directions.size(); ++d) {
    const double off = std::abs(directions[d].across.dot(v));
    if (off >= least) continue;
    best = d;
    least = off;
  }
  return best;
}

Mark MarkOf(const FaceDirection& direction, const FaceSegment& f, size_t height) {
  Mark m;
  m.c_m = 0.5 * (direction.C(f.a) + direction.C(f.b));
  const double sa = direction.S(f.a), sb = direction.S(f.b);
  m.s0_m = std::min(sa, sb);
  m.s1_m = std::max(sa, sb);
  m.sign = sb > sa ? -1 : 1;  // the solid is on the left: across, if it runs along the direction
  m.height = height;
  return m;
}

std::vector<double> NumberLines(std::vector<Mark>& marks, double tolerance_m) {
  std::vector<Mark*> sorted;
  for (Mark& m : marks) sorted.push_back(&m);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Mark* a, const Mark* b) { return a->c_m < b->c_m; });
  std::vector<double> offsets;
  for (size_t i = 0; i < sorted.size();) {
    size_t end = i;
    double length_m = 0, half_m = 0;
    for (; end < sorted.size() && (end == i || sorted[end]->c_m <= sorted[end - 1]->c_m + tolerance_m) &&
           sorted[end]->c_m <= sorted[i]->c_m + kMaxWarp * tolerance_m;
         ++end)
      length_m += sorted[end]->s1_m - sorted[end]->s0_m;
    size_t middle = i;
    for (; middle + 1 < end && (half_m += sorted[middle]->s1_m - sorted[middle]->s0_m) < 0.5 * length_m; ++middle) {
    }
    for (size_t k = i; k < end; ++k) sorted[k]->line = offsets.size();
    offsets.push_back(sorted[middle]->c_m);
    i = end;
  }
  return offsets;
}

}  // namespace plumb::compiler
