#include "compiler/frontends/drawing/hatching.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kParallel_rad = 0.01;
constexpr double kLeast = 1e-4;   // of the extent, between two lines
constexpr size_t kMaxLook = 2000;  // lines at most that are tried as a line's neighbour

struct Line {
  double angle_rad, offset, from, to;
  uint32_t path, layer;
};

// Straight lines that stand for themselves.
std::vector<Line> LinesOf(const Drawing& drawing) {
  std::vector<Line> out;
  for (uint32_t p = 0; p < drawing.paths.size(); ++p) {
    const DrawnPath& path = drawing.paths[p];
    if (path.points.size() != 2) continue;
    const Eigen::Vector2d d = path.points[1] - path.points[0];
    if (d.norm() <= 0) continue;
    double angle = std::atan2(d.y(), d.x());
    if (angle < 0) angle += std::numbers::pi;
    if (angle >= std::numbers::pi - kParallel_rad) angle -= std::numbers::pi;
    out.push_back({angle, 0, 0, 0, p, path.layer});
  }
  std::stable_sort(out.begin(), out.end(), [](const Line& a, const Line& b) { return a.layer != b.layer ? a.layer < b.layer : a.angle_rad < b.angle_rad; });
  return out;
}

class HatchingFinder {
 public:
  HatchingFinder(const Drawing& drawing, const HatchingOptions& options) : drawing_(drawing), options_(options), hatch_(drawing.paths.size(), false) {
    Eigen::AlignedBox2d box;
    for (const DrawnPath& path : drawing.paths) box.extend(BoxOf(path.points));
    extent_ = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  }

  std::vector<bool> Run() {
    std::vector<Line> lines = LinesOf(drawing_);
    for (size_t first = 0; first < lines.size();) {
      size_t last = first + 1;
      while (last < lines.size() && lines[last].layer == lines[first].layer && lines[last].angle_rad - lines[last - 1].angle_rad < kParallel_rad &&
             lines[last].angle_rad - lines[first].angle_rad < 4 * kParallel_rad)
        ++last;
      if (last - first >= options_.min_lines) MarkIn({lines.begin() + static_cast<std::ptrdiff_t>(first), lines.begin() + static_cast<std::ptrdiff_t>(last)});
      first = last;
    }
    return std::move(hatch_);
  }

 private:
  // All of about one direction.
  void MarkIn(std::vector<Line> lines) {
    const double angle = lines[lines.size() / 2].angle_rad;
    const Eigen::Vector2d u(std::cos(angle), std::sin(angle));
    for (Line& line : lines) {
      const auto& p = drawing_.paths[line.path].points;
      line.offset = 0.5 * Cross(u, p[0] + p[1]);
      std::tie(line.from, line.to) = std::minmax(u.dot(p[0]), u.dot(p[1]));
    }
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.offset < b.offset; });
    std::vector<uint32_t> next(lines.size(), kNone), run(lines.size(), 1), before(lines.size(), kNone);
    for (size_t i = 0; i < lines.size(); ++i) next[i] = NextOf(lines, i);
    // The longest row that ends in each line, with steps all alike.
    for (uint32_t i = 0; i < lines.size(); ++i) {
      const uint32_t j = next[i];
      if (j == kNone) continue;
      const double step = lines[j].offset - lines[i].offset;
      const double last = before[i] == kNone ? step : lines[i].offset - lines[before[i]].offset;
      const uint32_t length = std::abs(step - last) <= options_.max_difference * step ? run[i] + 1 : 2;
      if (length > run[j]) run[j] = length, before[j] = i;
    }
    for (uint32_t i = 0; i < lines.size(); ++i) {
      if (run[i] < options_.min_lines) continue;
      uint32_t at = i;
      for (uint32_t k = run[i]; k > 0 && at != kNone; --k, at = before[at]) hatch_[lines[at].path] = true;
    }
    // Corners of hatched areas have rows of few lines.
    const auto found = std::count_if(lines.begin(), lines.end(), [&](const Line& line) { return hatch_[line.path]; });
    if (2 * static_cast<size_t>(found) < lines.size()) return;
    for (const Line& line : lines) hatch_[line.path] = true;
  }

  uint32_t NextOf(const std::vector<Line>& lines, size_t i) const {
    const Line& a = lines[i];
    for (size_t j = i + 1; j < std::min(lines.size(), i + kMaxLook); ++j) {
      const Line& b = lines[j];
      const double step = b.offset - a.offset;
      if (step > options_.max_spacing_share * extent_) break;
      const double overlap = std::min(a.to, b.to) - std::max(a.from, b.from);
      if (step > kLeast * extent_ && overlap > options_.min_overlap * std::min(a.to - a.from, b.to - b.from)) return static_cast<uint32_t>(j);
    }
    return kNone;
  }

  const Drawing& drawing_;
  const HatchingOptions& options_;
  std::vector<bool> hatch_;  // by path
  double extent_ = 0;
};

}  // namespace

size_t DropHatching(Drawing& drawing, const HatchingOptions& options) {
  const std::vector<bool> hatch = HatchingFinder(drawing, options).Run();
  std::vector<DrawnPath> kept;
  for (size_t p = 0; p < hatch.size(); ++p) {
    if (!hatch[p]) kept.push_back(std::move(drawing.paths[p]));
  }
  const size_t dropped = hatch.size() - kept.size();
  drawing.paths = std::move(kept);
  return dropped;
}

}  // namespace plumb::compiler
