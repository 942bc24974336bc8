#include "runtime/deviations/wall_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kSameLine_m = 0.06, kSameDirection_cos = 0.995;  // pieces of one face
constexpr double kMaxGap_m = 0.5;
constexpr int kMinCells = 3;  // of one column of a surface that stands there
constexpr double kMaxTrimGap_m = 0.3;
constexpr double kUnseen = -std::numeric_limits<double>::infinity();

WallCandidate CandidateOf(const MapSurface& s, const Eigen::Isometry3d& T_plan_map) {
  WallCandidate c;
  const auto in_plan = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d((T_plan_map * Eigen::Vector3d(p.x(), p.y(), 0)).head<2>()); };
  const double up_m = T_plan_map.translation().z();
  const Eigen::Vector2d start = in_plan(s.start), end = in_plan(s.end);
  c.panel.along = (end - start).normalized();
  c.panel.normal = {-c.panel.along.y(), c.panel.along.x()};
  c.panel.start = start;
  c.panel.length_m = (end - start).norm();
  c.panel.z_min_m = s.z_min_m + up_m;
  c.panel.z_max_m = s.z_max_m + up_m;
  c.area_m2 = s.area_m2;
  c.top_m.assign(static_cast<size_t>(std::ceil(c.panel.length_m / kColumn_m)), kUnseen);
  std::vector<int> cells(c.top_m.size(), 0);
  for (const Eigen::Vector2f& cell : s.cells) {
    const auto column = static_cast<size_t>(std::max(0.0, std::floor(static_cast<double>(cell.x()) / kColumn_m)));
    if (column >= c.top_m.size()) continue;
    c.top_m[column] = std::max(c.top_m[column], static_cast<double>(cell.y()) + up_m);
    ++cells[column];
  }
  // What only touches the surface's plane, such as the floor beyond its end, is none of it.
  for (size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] < kMinCells) c.top_m[i] = kUnseen;
  }
  for (const Observation& o : s.observations) c.keyframes.insert(o.keyframe);
  return c;
}

// Do the two lie on one line, one going on where the other ends?
bool Continues(const WallCandidate& a, const WallCandidate& b) {
  if (a.panel.normal.dot(b.panel.normal) < kSameDirection_cos) return false;
  const Eigen::Vector2d b_end = b.panel.start + b.panel.length_m * b.panel.along;
  const double from = a.panel.U(b.panel.start), to = a.panel.U(b_end);
  const double gap_m = std::max({0.0, std::min(from, to) - a.panel.length_m, -std::max(from, to)});
  if (gap_m > kMaxGap_m) return false;
  return std::abs(a.panel.W(0.5 * (b.panel.start + b_end))) < kSameLine_m;
}

// Lengthens `a`, whose line stays.
void Append(const WallCandidate& b, WallCandidate* a) {
  const Eigen::Vector2d b_end = b.panel.start + b.panel.length_m * b.panel.along;
  const double from = std::min(0.0, a->panel.U(b.panel.start)), to = std::max(a->panel.length_m, a->panel.U(b_end));
  std::vector<double> top_m(static_cast<size_t>(std::ceil((to - from) / kColumn_m)), kUnseen);
  const auto put = [&](const std::vector<double>& tops, double at) {
    for (size_t i = 0; i < tops.size(); ++i) {
      const auto column =
          static_cast<size_t>(std::clamp((at - from) / kColumn_m + static_cast<double>(i), 0.0, static_cast<double>(top_m.size()) - 1));
      top_m[column] = std::max(top_m[column], tops[i]);
    }
  };
  put(a->top_m, 0);
  put(b.top_m, a->panel.U(b.panel.start));
  a->top_m = std::move(top_m);
  a->panel.start += from * a->panel.along;
  a->panel.length_m = to - from;
  a->panel.z_min_m = std::min(a->panel.z_min_m, b.panel.z_min_m);
  a->panel.z_max_m = std::max(a->panel.z_max_m, b.panel.z_max_m);
  a->area_m2 += b.area_m2;
  a->keyframes.insert(b.keyframes.begin(), b.keyframes.end());
}

}  // namespace

std::vector<WallCandidate> UnmatchedFaces(const SGraph& map, const std::vector<Match>& matches, const Eigen::Isometry3d& T_plan_map) {
  std::set<uint32_t> matched;
  for (const Match& m : matches) matched.insert(m.map_surface);
  std::vector<WallCandidate> faces;
  for (size_t i = 0; i < map.surfaces.size(); ++i) {
    const MapSurface& s = map.surfaces[i];
    if (s.kind == SurfaceKind::kWall && !s.observations.empty() && s.length_m() > kColumn_m &&
        !matched.contains(static_cast<uint32_t>(i))) {
      faces.push_back(CandidateOf(s, T_plan_map));
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const WallCandidate& a, const WallCandidate& b) { return a.area_m2 > b.area_m2; });
  std::vector<WallCandidate> out;
  for (const WallCandidate& face : faces) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const WallCandidate& c) { return Continues(c, face); });
    if (same == out.end()) {
      out.push_back(face);
    } else {
      Append(face, &*same);
    }
  }
  return out;
}

double LengthAbove(const WallCandidate& c, double top_m) {
  return kColumn_m * static_cast<double>(std::count_if(c.top_m.begin(), c.top_m.end(), [&](double top) { return top >= top_m; }));
}

void TrimTo(const Room& room, WallCandidate* c) {
  for (size_t i = 0; i < c->top_m.size(); ++i) {
    const Eigen::Vector2d p = c->panel.start + kColumn_m * (static_cast<double>(i) + 0.5) * c->panel.along;
    if (!Contains(room, p)) c->top_m[i] = kUnseen;
  }
  const auto max_gap = static_cast<size_t>(std::lround(kMaxTrimGap_m / kColumn_m));
  size_t best_from = 0, best_to = 0;
  for (size_t i = 0; i < c->top_m.size();) {
    size_t from = i, to = i, gap = 0;
    for (; i < c->top_m.size() && gap <= max_gap; ++i) {
      gap = std::isfinite(c->top_m[i]) ? 0 : gap + 1;
      if (gap == 0) to = i + 1;
    }
    while (from < to && !std::isfinite(c->top_m[from])) ++from;
    if (to - from > best_to - best_from) {
      best_from = from;
      best_to = to;
    }
  }
  const double length_m = std::min(c->panel.length_m, kColumn_m * static_cast<double>(best_to));
  c->panel.start += kColumn_m * static_cast<double>(best_from) * c->panel.along;
  c->panel.length_m = std::max(0.0, length_m - kColumn_m * static_cast<double>(best_from));
  c->top_m = {c->top_m.begin() + static_cast<std::ptrdiff_t>(best_from), c->top_m.begin() + static_cast<std::ptrdiff_t>(best_to)};
}

}  // namespace plumb::runtime
