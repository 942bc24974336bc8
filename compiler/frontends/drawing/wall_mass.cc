#include "compiler/frontends/drawing/wall_mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "compiler/frontends/drawing/curve_edges.h"
#include "compiler/frontends/drawing/loose_ends.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/single_lines.h"
#include "compiler/geometry/box_tree.h"
#include "compiler/geometry/cell_lists.h"
#include "compiler/geometry/for_each_job.h"
#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

constexpr uint32_t kClosing = 0xfffffffeu;  // source of a line that the drawing does not have
constexpr double kBeside_m = 0.02;   // from a room's outline into the room
constexpr double kAround_m = 0.1;    // ... to the walls around it
constexpr double kSampled_m = 0.4;  // between points where a face is measured
constexpr double kFreeShare = 0.75;  // of a wall's boundary: all but a short side and half of a long one
constexpr int kMaxSamples = 40;     // on one side of it
constexpr double kOff_m = 1e-4;  // from a line into the face beside it
constexpr int kHealRounds = 3;   // a line whose end was led elsewhere leaves others beside it
constexpr size_t kMinParallel = 1 << 15;  // half-edges to measure

struct WeightedLength {
  double value_m, weight_m;
};

// The value that half of the weight lies below.
double WeightedMedian(std::vector<WeightedLength> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value_m < b.value_m; });
  double total = 0, sum = 0;
  for (const auto& v : values) total += v.weight_m;
  for (const auto& v : values) {
    sum += v.weight_m;
    if (2 * sum >= total) return v.value_m;
  }
  return values.back().value_m;
}

class MassFinder {
 public:
  MassFinder(const Drawing& drawing, const std::vector<uint32_t>& paths, const MassOptions& options)
      : drawing_(drawing), paths_(paths), options_(options) {}

  std::optional<WallMass> Run() {
    CollectLines();
    if (!Build() || !Close()) return std::nullopt;
    Classify();
    if (out_.single_lines) {
      const double single_m = out_.single_m;
      AddSingleLines();
      if (!Build()) return std::nullopt;
      Classify();
      out_.single_lines = true;
      out_.single_m = single_m;
    }
    std::vector<SourcedArc> arcs = ArcsOf(drawing_, paths_);
    arcs.insert(arcs.end(), sides_.begin(), sides_.end());
    FindCurves(drawing_, arcs, out_);
    return std::move(out_);
  }

 private:
  const LineMap& Map() const { return out_.map; }

  void CollectLines() {
    for (const uint32_t p : paths_) {
      const DrawnPath& path = drawing_.paths[p];
      for (size_t i = 0; i + 1 < path.points.size(); ++i) lines_.push_back({path.points[i], path.points[i + 1], p});
      if (path.closed && path.points.size() > 2) lines_.push_back({path.points.back(), path.points.front(), p});
      if (path.filled && path.closed && path.points.size() > 2 && path.role != LineRole::kAny) fills_.push_back(path.points);
    }
  }

  bool Build() {
    std::optional<LineMap> map = LineMap::Build(lines_, options_.join_m, options_.max_vertices);
    if (map) out_.map = std::move(*map);
    return map.has_value();
  }

  bool IsOfCurve(uint32_t source) const {
    return source < drawing_.paths.size() && (drawing_.paths[source].curved || !drawing_.paths[source].arcs.empty());
  }

  // Moves the ends rather than adding lines: a stub of millimetres beside a corner would be a side of the wall. A curve keeps its shape.
  void LeadEnds(const std::vector<Heal>& heals) {
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> moves;
    for (const Heal& heal : heals) {
      moves.emplace_back(heal.from, heal.to);
      if (heal.mate) moves.emplace_back(*heal.mate, heal.to);
    }
    CellLists froms(options_.join_m);
    for (const auto& [from, to] : moves) froms.Add(from);
    std::vector<MapLine> stubs;
    for (MapLine& line : lines_) {
      for (Eigen::Vector2d* end : {&line.a, &line.b}) {
        auto found = static_cast<uint32_t>(moves.size());
        froms.ForEachNear(*end, [&](uint32_t i) {
          if (i < found && (moves[i].first - *end).norm() <= options_.join_m) found = i;
        });
        if (found == moves.size()) continue;
        if (IsOfCurve(line.source)) stubs.push_back({*end, moves[found].second, kClosing});
        else *end = moves[found].second;
      }
    }
    lines_.insert(lines_.end(), stubs.begin(), stubs.end());
  }

  // False: too many crossings.
  bool Close() {
    for (int round = 0; round < kHealRounds; ++round) {
      const std::vector<Heal> heals = FindHeals(Map(), options_);
      if (heals.empty()) break;
      LeadEnds(heals);
      if (!Build()) return false;
      out_.heals.insert(out_.heals.end(), heals.begin(), heals.end());
    }
    const Closings closings = FindClosings(Map(), options_);
    for (const auto& [from, to] : closings.lines) lines_.push_back({from, to, kClosing});
    out_.heals.insert(out_.heals.end(), closings.joined.begin(), closings.joined.end());
    return closings.lines.empty() || Build();
  }

  // How far the other side of the half-edge's face is across from points of it.
  std::vector<WeightedLength> Widths(uint32_t h) const {
    const uint32_t face = Map().FaceOf(h);
    if (face == 0 || Map().FaceOf(h ^ 1u) == face) return {};
    const double far_m = 2 * options_.max_thickness_m;
    const Eigen::Vector2d a = Map().FromPoint(h), d = Map().ToPoint(h) - a, n = Perp(d).normalized();
    const auto other = [&](uint32_t e) { return e != h / 2; };
    // Long sides more often: a wall with pillars along one side is as thick as it is between them.
    std::vector<WeightedLength> out(static_cast<size_t>(std::clamp(static_cast<int>(d.norm() / kSampled_m), 3, kMaxSamples)));
    const auto samples = static_cast<double>(out.size());
    for (size_t i = 0; i < out.size(); ++i) {
      const std::optional<RayHit> hit = Map().Cast(a + (static_cast<double>(i) + 0.5) / samples * d + kOff_m * n, n, far_m, other);
      out[i] = {hit ? hit->t_m : far_m, d.norm() / samples};
    }
    return out;
  }

  std::vector<std::vector<WeightedLength>> MeasureFaces() const {
    std::vector<std::vector<WeightedLength>> widths(Map().num_half_edges()), out(Map().num_faces());
    ForEachJob(widths.size(), kMinParallel, [&](size_t h) { widths[h] = Widths(static_cast<uint32_t>(h)); });
    for (uint32_t h = 0; h < widths.size(); ++h) {
      auto& of_face = out[Map().FaceOf(h)];
      of_face.insert(of_face.end(), widths[h].begin(), widths[h].end());
    }
    return out;
  }

  // The median of what is measured across, or the mean where that is more than a wall's: free space that a line runs round close by
  // is narrow along most of its boundary, too.
  double ThicknessOf(uint32_t face, const std::vector<WeightedLength>& widths) const {
    double length_m = 0;
    for (const auto& w : widths) length_m += w.weight_m;
    const double mean_m = length_m > 0 ? 2 * Map().AreaOf(face) / length_m : 0;
    return mean_m > options_.max_thickness_m ? mean_m : WeightedMedian(widths);
  }

  void Classify() {
    const auto widths = MeasureFaces();
    std::vector<double> thickness_m(Map().num_faces(), 0);
    std::vector<WeightedLength> typical;
    for (uint32_t f = 1; f < Map().num_faces(); ++f) {
      thickness_m[f] = ThicknessOf(f, widths[f]);
      if (thickness_m[f] < options_.min_thickness_m || thickness_m[f] > options_.max_thickness_m) continue;
      for (const auto& w : widths[f]) typical.push_back({thickness_m[f], w.weight_m});
    }
    out_.typical_thickness_m = WeightedMedian(typical);
    const double limit = out_.ThickestUsual_m(options_);
    out_.is_wall.assign(Map().num_faces(), false);
    for (uint32_t f = 1; f < Map().num_faces(); ++f) out_.is_wall[f] = thickness_m[f] > 0 && thickness_m[f] <= limit;
    MarkFilled();
    MarkPiers(thickness_m);
    ClearRooms();
    CountSingleLines();
  }

  // A closet can be as narrow as a wall; that the drawing outlines it as a room tells.
  void ClearRooms() {
    for (const DrawnSpace& space : drawing_.spaces) {
      const double area_m2 = AreaOf(space.outline);
      const Eigen::Vector2d slack = Eigen::Vector2d::Constant(kAround_m);
      const Eigen::AlignedBox2d box(BoxOf(space.outline).min() - slack, BoxOf(space.outline).max() + slack);
      std::set<uint32_t> faces;
      for (size_t i = 0; i < space.outline.size(); ++i) {
        const Eigen::Vector2d a = space.outline[i], d = space.outline[(i + 1) % space.outline.size()] - a;
        if (d.norm() == 0) continue;
        for (const double side_m : {-kBeside_m, kBeside_m}) faces.insert(Map().FaceAt(a + 0.5 * d + side_m * Perp(d).normalized()));
      }
      for (const uint32_t f : faces) {
        if (f == 0 || !out_.is_wall[f] || 2 * Map().AreaOf(f) < area_m2) continue;
        if (box.contains(BoxOf(Map().RingAt(Map().LoopsOf(f)[0])))) out_.is_wall[f] = false;
      }
    }
  }

  void MarkFilled() {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const auto& ring : fills_) boxes.push_back(BoxOf(ring));
    const BoxTree<2> tree(std::move(boxes));
    for (uint32_t f = 1; f < Map().num_faces() && !fills_.empty(); ++f) {
      const std::optional<Eigen::Vector2d> p = Map().PointIn(f);
      if (!p) continue;
      tree.ForEachIn(Eigen::AlignedBox2d(*p), [&](uint32_t i) {
        if (Contains(fills_[i], *p)) out_.is_wall[f] = true;
      });
    }
  }

  // Outlines with free space around them; the outline of a room has walls around it.
  void MarkPiers(const std::vector<double>& width_m) {
    for (uint32_t f = 1; f < Map().num_faces(); ++f) {
      if (!out_.is_wall[f] && IsPier(f, width_m[f])) out_.is_wall[f] = true;
    }
  }

  bool IsPier(uint32_t face, double width_m) const {
    const uint32_t start = Map().LoopsOf(face)[0], source = Map().edges()[start / 2].source;
    double free_m = 0, length_m = 0;
    bool one_outline = source < drawing_.paths.size() && drawing_.paths[source].closed;
    for (const uint32_t loop : Map().LoopsOf(face)) {
      uint32_t h = loop;
      do {
        const LineMap::Edge& edge = Map().edges()[h / 2];
        if (edge.source < drawing_.paths.size() && drawing_.paths[edge.source].role == LineRole::kAny) return false;
        const double length = (Map().ToPoint(h) - Map().FromPoint(h)).norm();
        one_outline = one_outline && edge.source == source;
        length_m += length;
        if (!out_.is_wall[Map().FaceOf(h ^ 1u)]) free_m += length;
        h = Map().Next(h);
      } while (h != loop);
    }
    if (2 * free_m <= length_m) return false;
    // A wall much thicker than most; a strip that leans on a wall with one long side is a ledge, or the air below one.
    if (width_m > 0 && width_m <= options_.max_thickness_m && free_m >= kFreeShare * length_m) return true;
    return Map().LoopsOf(face).size() == 1 &&
           LesserSide(Map().RingAt(start)) <= (one_outline ? options_.max_pier_m : options_.max_loose_pier_m);
  }

  void CountSingleLines() {
    double bounding_m = 0;
    out_.single_m = 0;
    for (uint32_t e = 0; e < Map().edges().size(); ++e) {
      const double length = (Map().ToPoint(2 * e) - Map().FromPoint(2 * e)).norm();
      if (out_.IsSingle(e, drawing_.paths.size())) out_.single_m += length;
      else bounding_m += length;
    }
    out_.single_lines = out_.single_m > 0 && bounding_m <= options_.max_double_share * (bounding_m + out_.single_m);
  }

  void AddSingleLines() {
    std::vector<bool> is_single;
    for (uint32_t e = 0; e < Map().edges().size(); ++e) is_single.push_back(out_.IsSingle(e, drawing_.paths.size()));
    WidenedLines widened = WidenSingleLines(Map(), is_single, ArcsOf(drawing_, paths_), options_);
    lines_ = std::move(widened.lines);
    std::move(widened.outlines.begin(), widened.outlines.end(), std::back_inserter(fills_));
    sides_ = std::move(widened.arcs);
  }

  const Drawing& drawing_;
  const std::vector<uint32_t>& paths_;
  const MassOptions& options_;
  std::vector<MapLine> lines_;
  std::vector<std::vector<Eigen::Vector2d>> fills_;
  std::vector<SourcedArc> sides_;  // of arcs that were given a thickness
  WallMass out_;
};

}  // namespace

std::string MassOptions::Check() const {
  if (!(join_m > 0 && join_m < 0.05)) return fmt::format("MassOptions.join_m = {}; must be in (0, 0.05)", join_m);
  if (!(heal_share >= 0 && heal_share <= 0.5)) return fmt::format("MassOptions.heal_share = {}; must be in [0, 0.5]", heal_share);
  if (!(max_undershoot_m >= 0 && max_undershoot_m < 0.5))
    return fmt::format("MassOptions.max_undershoot_m = {}; must be in [0, 0.5)", max_undershoot_m);
  if (!(max_break_m >= 0 && max_break_m < 1)) return fmt::format("MassOptions.max_break_m = {}; must be in [0, 1)", max_break_m);
  if (!(min_thickness_m > 0 && min_thickness_m < max_thickness_m))
    return fmt::format("MassOptions.min_thickness_m = {}; must be in (0, max_thickness_m)", min_thickness_m);
  if (!(max_thickness_m > 0.1 && max_thickness_m < 3))
    return fmt::format("MassOptions.max_thickness_m = {}; must be in (0.1, 3)", max_thickness_m);
  if (!(single_line_thickness_m > 0.01 && single_line_thickness_m < 1))
    return fmt::format("MassOptions.single_line_thickness_m = {}; must be in (0.01, 1)", single_line_thickness_m);
  return {};
}

std::optional<WallMass> FindWallMass(const Drawing& drawing, const std::vector<uint32_t>& paths, const MassOptions& options) {
  return MassFinder(drawing, paths, options).Run();
}

}  // namespace plumb::compiler
