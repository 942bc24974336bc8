#include "compiler/frontends/mesh/mesh_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUpright = 0.1;              // of the normal's z: six degrees off the vertical
constexpr double kBin_rad = 0.001;            // of the histogram of directions
constexpr double kSameDirection_rad = 0.005;  // faces within it are parallel
constexpr double kWeld_m = 0.003;             // ends of faces closer than this meet
constexpr double kCap_m = 0.01;               // from the end of a wall to the face that closes it
constexpr double kCovered = 0.9;
constexpr double kMaxWarp = 4;  // tolerances between the ends of a face that is not quite straight

struct Mark {
  double c_m = 0, s0_m = 0, s1_m = 0;
  int sign = 0;  // +1: the free space is on the side of greater c
  size_t height = 0, line = 0;
};

struct Active {
  size_t line = 0;
  int entering = 0, leaving = 0;
};

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
    for (; i < events.size() && events[i].s_m <= s_m + kWeld_m; ++i) {
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

// Numbers the lines by offset; returns their offsets: medians by length. Faces of a long wall that is not quite straight chain up.
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

void AddSpan(double s0_m, double s1_m, std::vector<Span>& spans) {
  if (!spans.empty() && s0_m <= spans.back().s1_m + kWeld_m)
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
    std::stable_sort(gaps.begin(), gaps.end(), [&](size_t a, size_t b) { return width(a) < width(b) - kWeld_m; });
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
      if (s.s0_m > s_m + kWeld_m || s.s1_m < s_m - kWeld_m) continue;
      const double rest_m = step > 0 ? s.s1_m - s_m : s_m - s.s0_m;
      return rest_m > kWeld_m && rest_m <= options_.max_wall_thickness_m ? rest_m : 0;
    }
    return 0;
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
      if (!IsCapped(low, high, height, s.s0_m)) s.s0_m -= std::max(Overhang(low, height, s.s0_m, -1), Overhang(high, height, s.s0_m, -1));
      if (!IsCapped(low, high, height, s.s1_m)) s.s1_m += std::max(Overhang(low, height, s.s1_m, 1), Overhang(high, height, s.s1_m, 1));
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

double AngleOf(const Vector2d& v) {
  const double a = std::atan2(v.y(), v.x());
  return a < 0 ? a + std::numbers::pi : a >= std::numbers::pi ? a - std::numbers::pi : a;
}

double AngleBetween(double a_rad, double b_rad) {
  const double d = std::abs(a_rad - b_rad);
  return std::min(d, std::numbers::pi - d);
}

std::optional<size_t> DirectionOf(const std::vector<FaceDirection>& directions, const Vector2d& v) {
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

}  // namespace

std::vector<FaceSegment> CutScene(const std::vector<MeshObject>& objects, double z_m) {
  std::vector<FaceSegment> out;
  for (uint32_t o = 0; o < objects.size(); ++o) {
    const Solid& solid = objects[o].solid;
    for (const Eigen::Vector3i& t : solid.triangles) {
      FaceSegment f{{}, {}, o};
      int crossings = 0;
      for (int k = 0; k < 3; ++k) {
        const Vector3d &p = solid.vertices[static_cast<size_t>(t[k])], &q = solid.vertices[static_cast<size_t>(t[(k + 1) % 3])];
        const bool p_above = p.z() >= z_m, q_above = q.z() >= z_m;
        if (p_above == q_above) continue;
        const Vector3d &low = p_above ? q : p, &high = p_above ? p : q;
        const double ratio = (z_m - low.z()) / (high.z() - low.z());
        (p_above ? f.a : f.b) = (low + ratio * (high - low)).head<2>();
        ++crossings;
      }
      if (crossings == 2 && f.a != f.b) out.push_back(f);
    }
  }
  return out;
}

std::vector<FaceDirection> FindDirections(const std::vector<MeshObject>& objects) {
  struct Face {
    double angle_rad, area_m2;
  };
  std::vector<Face> faces;
  std::map<int, double> bins;
  for (const MeshObject& o : objects) {
    for (const Eigen::Vector3i& t : o.solid.triangles) {
      const Vector3d& p = o.solid.vertices[static_cast<size_t>(t[0])];
      const Vector3d n = (o.solid.vertices[static_cast<size_t>(t[1])] - p).cross(o.solid.vertices[static_cast<size_t>(t[2])] - p);
      const double twice_area = n.norm();
      if (!(twice_area > 0) || std::abs(n.z()) > kUpright * twice_area) continue;
      faces.push_back({AngleOf({-n.y(), n.x()}), 0.5 * twice_area});
      bins[static_cast<int>(faces.back().angle_rad / kBin_rad)] += faces.back().area_m2;
    }
  }
  std::vector<std::pair<double, int>> order;
  for (const auto& [bin, area_m2] : bins) order.emplace_back(-area_m2, bin);
  std::sort(order.begin(), order.end());
  std::vector<FaceDirection> out;
  std::vector<double> angles;
  for (const auto& [minus_area, bin] : order) {
    const double middle = (bin + 0.5) * kBin_rad;
    if (std::any_of(angles.begin(), angles.end(), [&](double a) { return AngleBetween(a, middle) < kSameDirection_rad; })) continue;
    double sum = 0, weight = 0;
    for (const Face& f : faces) {
      if (AngleBetween(f.angle_rad, middle) > kBin_rad) continue;
      double off = f.angle_rad - middle;
      if (off > 1) off -= std::numbers::pi;
      if (off < -1) off += std::numbers::pi;
      sum += off * f.area_m2;
      weight += f.area_m2;
    }
    const double angle = middle + (weight > 0 ? sum / weight : 0);
    angles.push_back(middle);
    FaceDirection d;
    d.along = {std::cos(angle), std::sin(angle)};
    d.across = {-d.along.y(), d.along.x()};
    out.push_back(d);
  }
  return out;
}

Facing FindFacing(const std::vector<FaceDirection>& directions, const SectionStack& stack, const MeshOptions& options) {
  double apart_m = 0, towards_m = 0, same_m = 0;
  for (size_t k = 0; k < stack.heights_m.size(); ++k) {
    std::vector<std::vector<Mark>> by_direction(directions.size());
    for (const FaceSegment& f : stack.segments[k]) {
      if (const auto d = DirectionOf(directions, f.b - f.a)) by_direction[*d].push_back(MarkOf(directions[*d], f, k));
    }
    for (std::vector<Mark>& marks : by_direction) {
      const std::vector<double> offsets = NumberLines(marks, options.line_tolerance_m);
      std::vector<const Mark*> pointers;
      for (const Mark& m : marks) pointers.push_back(&m);
      Sweep(pointers, [&](double s0_m, double s1_m, const std::vector<Active>& lines) {
        for (size_t i = 0; i + 1 < lines.size(); ++i) {
          const Active &a = lines[i], &b = lines[i + 1];
          const double t_m = offsets[b.line] - offsets[a.line];
          if (t_m < options.min_wall_thickness_m || t_m > options.max_wall_thickness_m) continue;
          const int sign_a = a.leaving - a.entering, sign_b = b.leaving - b.entering;
          if (sign_a < 0 && sign_b > 0) apart_m += s1_m - s0_m;
          if (sign_a > 0 && sign_b < 0) towards_m += s1_m - s0_m;
          if (sign_a * sign_b > 0) same_m += s1_m - s0_m;
        }
      });
    }
  }
  if (apart_m >= 2 * towards_m && apart_m >= 2 * same_m) return Facing::kOutward;
  if (towards_m >= 2 * apart_m && towards_m >= 2 * same_m) return Facing::kInward;
  return Facing::kUnknown;
}

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
