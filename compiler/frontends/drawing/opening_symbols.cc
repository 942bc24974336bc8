#include "compiler/frontends/drawing/opening_symbols.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Interval = std::pair<double, double>;

constexpr double kBesides_m = 0.01;  // between panels that slide past each other
constexpr double kAlong = 0.1;       // a line along the gap rises less than this of its length

// The leaf of a door is about as long as the door is wide, or half as long where there are two.
bool IsLeafOf(double share) { return (share > 0.8 && share < 1.2) || (share > 0.42 && share < 0.58); }

double LengthOfUnion(std::vector<Interval> parts) {
  std::sort(parts.begin(), parts.end());
  double sum = 0, end = -std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : parts) {
    if (to > end) sum += to - std::max(from, end), end = to;
  }
  return sum;
}

bool MeetsBox(const Vector2d& a, const Vector2d& b, const Vector2d& half) {
  double t0 = 0, t1 = 1;
  const Vector2d d = b - a;
  for (int k = 0; k < 2; ++k) {
    if (std::abs(d[k]) < 1e-12) {
      if (std::abs(a[k]) > half[k]) return false;
      continue;
    }
    double lo = (-half[k] - a[k]) / d[k], hi = (half[k] - a[k]) / d[k];
    if (lo > hi) std::swap(lo, hi);
    t0 = std::max(t0, lo);
    t1 = std::min(t1, hi);
  }
  return t0 <= t1;
}

// The lines in one gap, one after the other.
class EvidenceOfGap {
 public:
  EvidenceOfGap(const DrawnOpening& gap, const OpeningOptions& options)
      : options_(options), gap_(gap), width_m_(gap.width_m()) {
    half_ = {0.5 * width_m_ + options.symbol_slack_m, 0.5 * gap.depth_m + options.symbol_slack_m};
  }

  [[nodiscard]] double reach_m() const { return half_.norm(); }

  void Add(const Vector2d& from, const Vector2d& to, const DrawnPath& path, uint32_t p) {
    const Vector2d a = gap_.Local(from), b = gap_.Local(to);
    if (!MeetsBox(a, b, half_)) return;
    const double half_m = 0.5 * width_m_;
    const bool along = std::abs(a.y() - b.y()) < kAlong * std::abs(a.x() - b.x());
    Interval part{std::max(-half_m, std::min(a.x(), b.x())), std::min(half_m, std::max(a.x(), b.x()))};
    if (!along || part.second < part.first) part = {0, 0};
    const double span = (part.second - part.first) / width_m_;
    if (span > 0.4 && span < 0.7) panels_.push_back(0.5 * (a.y() + b.y()));
    AddLeaf(a, b, along, path, p);
    if (path.role == LineRole::kDoor) AddLine(part, p, out_.door, door_);
    if (path.role == LineRole::kWindow) AddLine(part, p, out_.window, window_);
    if (path.role == LineRole::kOpening || path.role == LineRole::kAny) {
      AddLine(part, p, out_.mixed, mixed_);
      out_.mixed_line = std::max(out_.mixed_line, span);
    }
  }

  SymbolEvidence Sum() {
    out_.door_span = LengthOfUnion(std::move(door_)) / width_m_;
    out_.window_span = LengthOfUnion(std::move(window_)) / width_m_;
    out_.mixed_span = LengthOfUnion(std::move(mixed_)) / width_m_;
    const auto [low, high] = std::minmax_element(panels_.begin(), panels_.end());
    out_.sliding = !panels_.empty() && *high - *low > kBesides_m;
    return out_;
  }

 private:
  static void AddLine(const Interval& part, uint32_t p, uint32_t& first, std::vector<Interval>& parts) {
    first = std::min(first, p);
    parts.push_back(part);
  }

  // Swings, and straight leaves that stand open.
  void AddLeaf(const Vector2d& a, const Vector2d& b, bool along, const DrawnPath& path, uint32_t p) {
    if (path.role == LineRole::kWindow) return;
    const double half_m = 0.5 * width_m_;
    const double from_jamb_m = std::min(std::abs(std::abs(a.x()) - half_m), std::abs(std::abs(b.x()) - half_m));
    if (!path.curved && !along && IsLeafOf((b - a).norm() / width_m_) && from_jamb_m < options_.symbol_slack_m)
      out_.leaf = std::min(out_.leaf, p);
    // The greater leaf of two that are not alike has its hinge at the jamb, too.
    const bool swing = std::any_of(path.arcs.begin(), path.arcs.end(), [&](const Arc& arc) {
      const Vector2d hinge = gap_.Local(arc.center);
      const double share = arc.radius_m / width_m_;
      const bool at_jamb = std::abs(std::abs(hinge.x()) - half_m) < options_.symbol_slack_m && std::abs(hinge.y()) < half_.y();
      return IsSwing(arc, options_) && (IsLeafOf(share) || (at_jamb && share > 0.5 && share < 1));
    });
    if (swing) out_.swing = std::min(out_.swing, p);
  }

  const OpeningOptions& options_;
  const DrawnOpening& gap_;
  const double width_m_;
  Vector2d half_;
  SymbolEvidence out_;
  std::vector<Interval> door_, window_, mixed_;
  std::vector<double> panels_;  // where they stand across the gap
};

}  // namespace

OpeningSymbols::OpeningSymbols(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options)
    : drawing_(drawing), options_(options), group_of_(drawing.paths.size(), kNone) {
  std::vector<Eigen::AlignedBox2d> boxes;
  std::map<uint32_t, uint32_t> group_of_symbol;
  for (const uint32_t p : symbols) {
    const DrawnPath& path = drawing.paths[p];
    const auto fresh = static_cast<uint32_t>(paths_of_.size());
    group_of_[p] = path.symbol == kNone ? fresh : group_of_symbol.try_emplace(path.symbol, fresh).first->second;
    if (group_of_[p] == fresh) paths_of_.emplace_back();
    paths_of_[group_of_[p]].push_back(p);
    const size_t sides = path.points.size() < 2 ? 0 : path.points.size() - (path.closed ? 0 : 1);
    for (size_t i = 0; i < sides; ++i) {
      strokes_.push_back({path.points[i], path.points[(i + 1) % path.points.size()], p});
      Eigen::AlignedBox2d box(strokes_.back().a);
      boxes.push_back(box.extend(strokes_.back().b));
    }
  }
  used_.assign(paths_of_.size(), false);
  tree_ = BoxTree<2>(std::move(boxes));
}

std::vector<uint32_t> OpeningSymbols::StrokesNear(const DrawnOpening& gap) const {
  const Vector2d reach = Vector2d::Constant(EvidenceOfGap(gap, options_).reach_m());
  std::vector<uint32_t> out;
  tree_.ForEachIn({gap.middle() - reach, gap.middle() + reach}, [&](uint32_t i) { out.push_back(i); });
  std::sort(out.begin(), out.end());
  return out;
}

SymbolEvidence OpeningSymbols::Look(const DrawnOpening& gap) const {
  EvidenceOfGap evidence(gap, options_);
  for (const uint32_t i : StrokesNear(gap)) evidence.Add(strokes_[i].a, strokes_[i].b, drawing_.paths[strokes_[i].path], strokes_[i].path);
  return evidence.Sum();
}

void OpeningSymbols::UseAllIn(const DrawnOpening& gap) {
  const double reach_m = 0.5 * gap.width_m() + options_.symbol_slack_m;
  for (const uint32_t i : StrokesNear(gap)) {
    if (DistanceToLine(gap.middle(), strokes_[i].a, strokes_[i].b) <= reach_m) Use(strokes_[i].path);
  }
}

void OpeningSymbols::Use(uint32_t path) { used_[GroupOf(path)] = true; }

bool OpeningSymbols::IsUsed(uint32_t path) const { return used_[GroupOf(path)]; }

}  // namespace plumb::compiler
