#include "compiler/frontends/ifc/ifc_openings.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "compiler/geometry/csg.h"

namespace plumb::compiler {
namespace {

constexpr double kMinRemoved_m3 = 1e-9, kMinPiece_m3 = 1e-4;

// A candidate with some air around it.
struct Grown {
  size_t number = 0;
  Eigen::AlignedBox3d box;
};

std::vector<Grown> SortedByX(const std::vector<FillCandidate>& candidates, double margin_m) {
  std::vector<Grown> out;
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].box.isEmpty()) continue;
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(margin_m);
    out.push_back({i, Eigen::AlignedBox3d(candidates[i].box.min() - margin, candidates[i].box.max() + margin)});
  }
  std::stable_sort(out.begin(), out.end(), [](const Grown& a, const Grown& b) { return a.box.min().x() < b.box.min().x(); });
  return out;
}

double LongestX(const std::vector<Grown>& boxes) {
  double longest_m = 0;
  for (const Grown& b : boxes) longest_m = std::max(longest_m, b.box.sizes().x());
  return longest_m;
}

}  // namespace

bool CutOpening(const IfcModel& model, CutPair pair, const IfcOptions& options, const Solid& tool, Solid& body) {
  if (body.empty() || !Bounds(body).intersects(Bounds(tool))) return false;
  const CsgOptions csg{.plane_epsilon_m = options.plane_epsilon_m};
  // Bodies cut before have T-junctions: closedness is a question for the enclosed volume, not for edges.
  const double volume_m3 = Volume(body), tool_m3 = Volume(tool);
  const bool is_solid = volume_m3 > kMinRemoved_m3;
  Expected<Solid> rest = is_solid ? Subtract(body, tool, csg) : ClipOutside(body, tool, csg);
  const auto leave_out = [&](const std::string& why) {
    model.Emit(DiagnosticKind::kBooleanFailed, pair.opening,
               fmt::format("the opening {} is not cut out of {}: {}", model.Label(pair.opening), model.Label(pair.host), why));
    return false;
  };
  if (!rest) return leave_out(rest.error().message);
  if (!is_solid) {
    const bool cuts = SurfaceArea(*rest) < SurfaceArea(body);
    body = std::move(*rest);
    return cuts;
  }
  const double removed_m3 = volume_m3 - Volume(*rest);
  const double tolerance_m3 = 1e-6 + 1e-6 * volume_m3;
  if (removed_m3 < -tolerance_m3 || removed_m3 > std::min(volume_m3, tool_m3) + tolerance_m3) {
    return leave_out(fmt::format("that would take away {:.6f} m3 of {:.6f} m3", removed_m3, volume_m3));
  }
  body = std::move(*rest);
  return removed_m3 > kMinRemoved_m3;
}

std::optional<std::vector<bool>> CutApart(std::span<const Solid* const> tools, const IfcOptions& options, Solid& body) {
  const double volume_m3 = Volume(body);
  if (body.empty() || volume_m3 <= kMinRemoved_m3) return std::nullopt;
  Expected<DifferenceOfMany> cut = SubtractAll(body, tools, {.plane_epsilon_m = options.plane_epsilon_m});
  if (!cut) return std::nullopt;
  double tools_m3 = 0;
  for (const Solid* tool : tools) tools_m3 += Volume(*tool);
  const double removed_m3 = volume_m3 - Volume(cut->rest), tolerance_m3 = 1e-6 + 1e-6 * volume_m3;
  if (removed_m3 < -tolerance_m3 || removed_m3 > std::min(volume_m3, tools_m3) + tolerance_m3) return std::nullopt;
  body = std::move(cut->rest);
  return std::move(cut->cuts);
}

std::vector<std::vector<size_t>> GroupsApart(std::span<const Eigen::AlignedBox3d> boxes, double margin_m) {
  constexpr size_t kMaxGroup = 512;  // bounds the search
  std::vector<std::vector<size_t>> groups;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(margin_m);
    const Eigen::AlignedBox3d grown(boxes[i].min() - margin, boxes[i].max() + margin);
    const auto takes = [&](const std::vector<size_t>& group) {
      return group.size() < kMaxGroup && std::none_of(group.begin(), group.end(), [&](size_t k) { return boxes[k].intersects(grown); });
    };
    const auto group = std::find_if(groups.begin(), groups.end(), takes);
    (group == groups.end() ? groups.emplace_back() : *group).push_back(i);
  }
  return groups;
}

Solid PieceCutBefore(const Solid& opening, const Eigen::Isometry3d& T_plan_wall, const Solid& wall, const IfcOptions& options) {
  constexpr double kMaxThickness_m = 1, kMinLengthRatio = 2;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : wall.vertices) box.extend(T_plan_wall.inverse() * v);
  if (box.isEmpty()) return {};
  const double x_m = box.sizes().x(), y_m = box.sizes().y();
  if (std::min(x_m, y_m) > kMaxThickness_m || std::max(x_m, y_m) < kMinLengthRatio * std::min(x_m, y_m)) return {};
  const Solid whole = MakeBox(box.min(), box.max(), Eigen::Affine3d(T_plan_wall.matrix()));
  const CsgOptions csg{.plane_epsilon_m = options.plane_epsilon_m};
  const Expected<Solid> outside = Subtract(whole, opening, csg);
  if (!outside || Volume(whole) - Volume(*outside) < kMinPiece_m3) return {};
  return Subtract(whole, *outside, csg).value_or(Solid());
}

std::vector<std::pair<uint32_t, uint32_t>> MatchFillings(const std::vector<FillCandidate>& fillings,
                                                         const std::vector<FillCandidate>& openings, double min_overlap) {
  constexpr double kMargin_m = 0.05;        // thin leaves get a body, frames may stand out a little
  constexpr size_t kMaxPairs = 10000000;  // only doors heaped on one another come near it
  struct Pair {
    double score;
    size_t filling, opening;
  };
  std::vector<Pair> pairs;
  const std::vector<Grown> holes = SortedByX(openings, kMargin_m);
  const double longest_m = LongestX(holes);
  for (const Grown& filling : SortedByX(fillings, kMargin_m)) {
    // No hole is longer than the longest: those that begin before its length back end before the filling.
    const double first_x = filling.box.min().x() - longest_m;
    auto hole = std::lower_bound(holes.begin(), holes.end(), first_x, [](const Grown& h, double x) { return h.box.min().x() < x; });
    for (; hole != holes.end() && hole->box.min().x() <= filling.box.max().x(); ++hole) {
      const Eigen::AlignedBox3d common = filling.box.intersection(hole->box);
      if (common.isEmpty()) continue;
      const double overlap = common.volume() / filling.box.volume();
      const double height_ratio = common.sizes().z() / filling.box.merged(hole->box).sizes().z();
      if (overlap >= min_overlap && height_ratio >= min_overlap) pairs.push_back({overlap * height_ratio, filling.number, hole->number});
    }
    if (pairs.size() > kMaxPairs) break;
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return std::tie(b.score, a.filling, a.opening) < std::tie(a.score, b.filling, b.opening); });
  std::vector<char> used_filling(fillings.size(), 0), used_opening(openings.size(), 0);
  std::vector<std::pair<size_t, size_t>> chosen;
  for (const Pair& pair : pairs) {
    if (used_filling[pair.filling] != 0 || used_opening[pair.opening] != 0) continue;
    used_filling[pair.filling] = used_opening[pair.opening] = 1;
    chosen.emplace_back(pair.filling, pair.opening);
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<std::pair<uint32_t, uint32_t>> out;
  for (const auto& [f, o] : chosen) out.emplace_back(fillings[f].index, openings[o].index);
  return out;
}

}  // namespace plumb::compiler
