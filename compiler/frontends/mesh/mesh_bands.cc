#include "compiler/frontends/mesh/mesh_bands.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "compiler/frontends/mesh/mesh_marks.h"

namespace plumb::compiler {
namespace {

constexpr double kCap_m = 0.01;  // from the end of a wall to the face that closes it
constexpr double kCovered = 0.9;
constexpr double kAskew = 0.3;  // tangent of the angle between a cap and a square one

void AddSpan(double s0_m, double s1_m, std::vector<Span>& spans) {
  if (!spans.empty() && s0_m <= spans.back().s1_m + kMarkWeld_m)
    spans.back().s1_m = std::max(spans.back().s1_m, s1_m);
  else
    spans.push_back({s0_m, s1_m});
}

// Faces of one direction and group at all heights.
class Bundle {
 public:
  Bundle(const FaceDirection& direction, const SectionStack& stack, Facing facing, const MeshOptions& options)
      : direction_(direction), stack_(stack), facing_(facing), options_(options) {}

  std::vector<Mark> marks;

  std::vector<Band> Run(size_t direction, uint32_t group) {
    offsets_ = NumberLines(marks, options_.line_tolerance_m);
    const size_t heights = stack_.heights_m.size();
    covers_.assign(offsets_.size(), std::vector<std::vector<Span>>(heights));
    std::vector<std::vector<const Mark*>> at(heights);
    for (const Mark& m : marks) at[m.height].push_back(&m);
    for (height_ = 0; height_ < heights; ++height_) {
      Sweep(at[height_], [&](double s0_m, double s1_m, const std::vector<Active>& lines) { Pair(s0_m, s1_m, lines); });
    }
    std::vector<Band> out;
    for (auto& [key, spans] : solids_) {
      Band band{direction, offsets_[key.low], offsets_[key.high], group, key.low == key.high, std::move(spans)};
      if (band.sheet)
        SetBack(key.side, band);
      else
        for (size_t k = 0; k < heights; ++k) Complete(key.low, key.high, k, band.spans[k]);
      out.push_back(std::move(band));
    }
    return out;
  }

 private:
  struct Key {
    size_t low, high;
    int side;  // of a sheet's free space
    auto operator<=>(const Key&) const = default;
  };

  void AddSolid(size_t low, size_t high, int side, double s0_m, double s1_m) {
    auto& spans = solids_[{low, high, side}];
    spans.resize(stack_.heights_m.size());
    AddSpan(s0_m, s1_m, spans[height_]);
  }

  void SetBack(int side, Band& band) const {
    if (side >= 0) band.c0_m -= side > 0 ? options_.sheet_thickness_m : 0.5 * options_.sheet_thickness_m;
    if (side <= 0) band.c1_m += side < 0 ? options_.sheet_thickness_m : 0.5 * options_.sheet_thickness_m;
  }

  bool IsWall(size_t low, size_t high) const {
    const double t_m = offsets_[high] - offsets_[low];
    return t_m >= options_.min_wall_thickness_m && t_m <= options_.max_wall_thickness_m;
  }

  void Pair(double s0_m, double s1_m, const std::vector<Active>& lines) {
    for (const Active& a : lines) AddSpan(s0_m, s1_m, covers_[a.line][height_]);
    if (facing_ == Facing::kUnknown)
      PairNearest(s0_m, s1_m, lines);
    else
      PairByFacing(s0_m, s1_m, lines);
  }

  void PairByFacing(double s0_m, double s1_m, const std::vector<Active>& lines) {
    int depth = 0;
    size_t start = 0;
    const auto give_up = [&](size_t line) {  // it has no other face
      if (offsets_[line] - offsets_[start] <= options_.max_wall_thickness_m) return;
      AddSolid(start, start, -1, s0_m, s1_m);
      depth = 0;
    };
    for (const Active& a : lines) {
      const int entering = facing_ == Facing::kInward ? a.leaving : a.entering,
                leaving = facing_ == Facing::kInward ? a.entering : a.leaving;
      if (depth > 0) give_up(a.line);
      const bool was_free = depth == 0;
      if (was_free && entering > 0) start = a.line;
      // Skins that lie on each other count once.
      depth += entering > 0 ? 1 : 0;
      if (leaving == 0) continue;
      if (depth == 0 || (was_free && entering > 0)) {
        AddSolid(a.line, a.line, entering > 0 ? 0 : 1, s0_m, s1_m);
        depth = 0;
      } else if (--depth == 0 && IsWall(start, a.line)) {
        AddSolid(start, a.line, 0, s0_m, s1_m);
      }
    }
    if (depth > 0) AddSolid(start, start, -1, s0_m, s1_m);
  }

  // Each face belongs to one wall: the closest pairs first.
  void PairNearest(double s0_m, double s1_m, const std::vector<Active>& lines) {
    std::vector<size_t> gaps;
    for (size_t i = 0; i + 1 < lines.size(); ++i) {
      if (IsWall(lines[i].line, lines[i + 1].line)) gaps.push_back(i);
    }
    const auto width = [&](size_t i) { return offsets_[lines[i + 1].line] - offsets_[lines[i].line]; };
    std::stable_sort(gaps.begin(), gaps.end(), [&](size_t a, size_t b) { return width(a) < width(b) - kMarkWeld_m; });
    std::vector<bool> used(lines.size(), false);
    for (const size_t i : gaps) {
      if (used[i] || used[i + 1]) continue;
      used[i] = used[i + 1] = true;
      AddSolid(lines[i].line, lines[i + 1].line, 0, s0_m, s1_m);
    }
    for (size_t i = 0; i < lines.size(); ++i) {
      if (!used[i]) AddSolid(lines[i].line, lines[i].line, 0, s0_m, s1_m);
    }
  }

  bool Covers(size_t line, size_t height, double s0_m, double s1_m) const {
    double covered_m = 0;
    for (const Span& s : covers_[line][height]) covered_m += std::max(0.0, std::min(s.s1_m, s1_m) - std::max(s.s0_m, s0_m));
    return covered_m >= kCovered * (s1_m - s0_m);
  }

  bool IsCapped(size_t low, size_t high, size_t height, double s_m) const {
    const double c_m = 0.5 * (offsets_[low] + offsets_[high]);
    return std::any_of(stack_.segments[height].begin(), stack_.segments[height].end(), [&](const FaceSegment& f) {
      const double sa = direction_.S(f.a) - s_m, sb = direction_.S(f.b) - s_m;
      if (std::abs(sa) > kCap_m || std::abs(sb) > kCap_m) return false;
      return (direction_.C(f.a) < c_m) != (direction_.C(f.b) < c_m);
    });
  }

  // How far a face goes on from s in the direction of `step`, if not farther than a wall is thick.
  double Overhang(size_t line, size_t height, double s_m, int step) const {
    for (const Span& s : covers_[line][height]) {
      if (s.s0_m > s_m + kMarkWeld_m || s.s1_m < s_m - kMarkWeld_m) continue;
      const double rest_m = step > 0 ? s.s1_m - s_m : s_m - s.s0_m;
      return rest_m > kMarkWeld_m && rest_m <= options_.max_wall_thickness_m ? rest_m : 0;
    }
    return 0;
  }

  // Where the wall ends that both faces reach s of: at its cap, which jambs in curves have a little askew, else where its longer face ends.
  double EndOf(size_t low, size_t high, size_t height, double s_m, int step) const {
    if (IsCapped(low, high, height, s_m)) return s_m;
    const double beyond_m = std::max(Overhang(low, height, s_m, step), Overhang(high, height, s_m, step));
    const double c_m = 0.5 * (offsets_[low] + offsets_[high]);
    double cap_m = beyond_m;
    for (const FaceSegment& f : stack_.segments[height]) {
      const double ca = direction_.C(f.a), cb = direction_.C(f.b);
      if (beyond_m == 0 || (ca < c_m) == (cb < c_m)) continue;
      const double sa = step * (direction_.S(f.a) - s_m), sb = step * (direction_.S(f.b) - s_m);
      const double at_m = sa + (sb - sa) * (c_m - ca) / (cb - ca);
      if (std::abs(sa - sb) <= kAskew * std::abs(ca - cb) && at_m > -kCap_m && at_m < cap_m) cap_m = std::max(0.0, at_m);
    }
    return s_m + step * cap_m;
  }

  // Where walls meet, the faces of one end at the other: the solid goes on through gaps that nothing caps, and into corners along the
  // outer face.
  void Complete(size_t low, size_t high, size_t height, std::vector<Span>& spans) const {
    std::vector<Span> out;
    for (const Span& s : spans) {
      const double gap_m = out.empty() ? 0 : s.s0_m - out.back().s1_m;
      const bool joined = !out.empty() && gap_m <= options_.max_wall_thickness_m &&
                          ((Covers(low, height, out.back().s1_m, s.s0_m) || Covers(high, height, out.back().s1_m, s.s0_m)) ||
                           (!IsCapped(low, high, height, out.back().s1_m) && !IsCapped(low, high, height, s.s0_m)));
      if (joined)
        out.back().s1_m = s.s1_m;
      else
        out.push_back(s);
    }
    for (Span& s : out) {
      s.s0_m = EndOf(low, high, height, s.s0_m, -1);
      s.s1_m = EndOf(low, high, height, s.s1_m, 1);
    }
    spans = std::move(out);
  }

  const FaceDirection& direction_;
  const SectionStack& stack_;
  const Facing facing_;
  const MeshOptions& options_;
  std::vector<double> offsets_;
  std::vector<std::vector<std::vector<Span>>> covers_;  // by line and height
  std::map<Key, std::vector<std::vector<Span>>> solids_;
  size_t height_ = 0;
};

}  // namespace

std::vector<Band> FindBands(const std::vector<FaceDirection>& directions, const SectionStack& stack, const std::vector<uint32_t>& group_of,
                            Facing facing, const MeshOptions& options) {
  std::map<std::pair<size_t, uint32_t>, Bundle> bundles;
  for (size_t k = 0; k < stack.heights_m.size(); ++k) {
    for (const FaceSegment& f : stack.segments[k]) {
      const std::optional<size_t> d = DirectionOf(directions, f.b - f.a);
      if (!d) continue;
      auto& bundle = bundles.try_emplace({*d, group_of[f.object]}, directions[*d], stack, facing, options).first->second;
      bundle.marks.push_back(MarkOf(directions[*d], f, k));
    }
  }
  std::vector<Band> out;
  for (auto& [key, bundle] : bundles) {
    for (Band& band : bundle.Run(key.first, key.second)) out.push_back(std::move(band));
  }
  return out;
}

}  // namespace plumb::compiler
