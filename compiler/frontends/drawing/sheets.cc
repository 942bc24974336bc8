#include "compiler/frontends/drawing/sheets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

constexpr double kLongerThanDoors_m = 2.6;
constexpr double kMinWall_m = 0.05, kMaxWall_m = 0.6;
constexpr double kSameRow = 0.5;  // of a plan's height, between plans of one row

bool IsWallLike(const DrawnPath& path) { return path.role == LineRole::kWall || path.role == LineRole::kAny || path.role == LineRole::kColumn; }

std::vector<std::vector<uint32_t>> GroupsOf(const Drawing& drawing, double gap_m) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const DrawnPath& path : drawing.paths) {
    Eigen::AlignedBox2d box = BoxOf(path.points);
    box.min().array() -= 0.5 * gap_m;
    box.max().array() += 0.5 * gap_m;
    boxes.push_back(box);
  }
  const BoxTree<2> tree(boxes);
  std::vector<uint32_t> group(boxes.size(), kNone);
  std::vector<std::vector<uint32_t>> out;
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    if (group[i] != kNone) continue;
    std::vector<uint32_t> members = {i};
    group[i] = static_cast<uint32_t>(out.size());
    for (size_t k = 0; k < members.size(); ++k) {
      tree.ForEachIn(boxes[members[k]], [&](uint32_t j) {
        if (group[j] == kNone) group[j] = group[i], members.push_back(j);
      });
    }
    std::sort(members.begin(), members.end());
    out.push_back(std::move(members));
  }
  return out;
}

struct Sheet {
  Eigen::AlignedBox2d box;  // of lines that may be walls
  size_t group;
};

}  // namespace

std::vector<Drawing> SplitSheets(Drawing drawing, const SheetOptions& options) {
  const auto groups = GroupsOf(drawing, options.min_gap_m);
  std::vector<Sheet> sheets;
  for (size_t g = 0; g < groups.size(); ++g) {
    Eigen::AlignedBox2d box;
    for (const uint32_t p : groups[g]) {
      if (IsWallLike(drawing.paths[p])) box.extend(BoxOf(drawing.paths[p].points));
    }
    if (!box.isEmpty() && box.sizes().minCoeff() >= options.min_side_m) sheets.push_back({box, g});
  }
  const auto one = [&] {
    std::vector<Drawing> out;
    out.push_back(std::move(drawing));
    return out;
  };
  if (sheets.size() < 2) return one();
  Eigen::Vector2d least = sheets[0].box.sizes(), most = least;
  for (const Sheet& s : sheets) least = least.cwiseMin(s.box.sizes()), most = most.cwiseMax(s.box.sizes());
  if (((most - least).array() > options.max_size_difference * most.array()).any()) return one();
  std::stable_sort(sheets.begin(), sheets.end(), [&](const Sheet& a, const Sheet& b) {
    const double row_a = std::round(a.box.min().y() / (kSameRow * most.y())), row_b = std::round(b.box.min().y() / (kSameRow * most.y()));
    return row_a != row_b ? row_a < row_b : a.box.min().x() < b.box.min().x();
  });
  std::vector<Drawing> out(sheets.size());
  for (size_t i = 0; i < sheets.size(); ++i) {
    const Eigen::Vector2d shift = sheets[0].box.min() - sheets[i].box.min();
    for (const uint32_t p : groups[sheets[i].group]) {
      out[i].paths.push_back(std::move(drawing.paths[p]));
      for (auto& q : out[i].paths.back().points) q += shift;
      for (Arc& arc : out[i].paths.back().arcs) arc.center += shift;
    }
    for (const DrawnText& text : drawing.texts) {
      if (!sheets[i].box.contains(text.at)) continue;
      out[i].texts.push_back(text);
      out[i].texts.back().at += shift;
    }
    for (const DrawnSpace& space : drawing.spaces) {
      if (!sheets[i].box.contains(BoxOf(space.outline).center())) continue;
      out[i].spaces.push_back(space);
      for (auto& q : out[i].spaces.back().outline) q += shift;
    }
  }
  return out;
}

void MendRoles(Drawing& drawing) {
  std::map<uint32_t, std::vector<MapLine>> long_lines;  // by layer
  for (uint32_t p = 0; p < drawing.paths.size(); ++p) {
    const DrawnPath& path = drawing.paths[p];
    if (path.role != LineRole::kDoor || path.curved) continue;
    const size_t sides = path.points.size() - (path.closed ? 0 : 1);
    for (size_t i = 0; i < sides; ++i) {
      const MapLine line{path.points[i], path.points[(i + 1) % path.points.size()], p};
      if ((line.b - line.a).norm() > kLongerThanDoors_m) long_lines[path.layer].push_back(line);
    }
  }
  std::set<uint32_t> mixed;
  for (const auto& entry : long_lines) {
    const uint32_t layer = entry.first;
    const auto& lines = entry.second;
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const MapLine& l : lines) {
      Eigen::AlignedBox2d box(l.a);
      box.extend(l.b);
      boxes.emplace_back(box.min().array() - kMaxWall_m, box.max().array() + kMaxWall_m);
    }
    const BoxTree<2> tree(boxes);
    for (size_t i = 0; i < lines.size() && !mixed.contains(layer); ++i) {
      const Eigen::Vector2d u = (lines[i].b - lines[i].a).normalized();
      tree.ForEachIn(boxes[i], [&](uint32_t j) {
        const Eigen::Vector2d v = (lines[j].b - lines[j].a).normalized();
        const double distance = std::abs(Cross(u, lines[j].a - lines[i].a));
        if (std::abs(Cross(u, v)) < 0.01 && distance > kMinWall_m && distance < kMaxWall_m) mixed.insert(layer);
      });
    }
  }
  for (DrawnPath& path : drawing.paths) {
    if (path.role == LineRole::kDoor && mixed.contains(path.layer) && path.symbol == kNone) path.role = LineRole::kAny;
  }
}

}  // namespace plumb::compiler
