#include "compiler/frontends/drawing/openings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/frontends/drawing/curved_openings.h"
#include "compiler/frontends/drawing/door_leaves.h"
#include "compiler/frontends/drawing/framed_doors.h"
#include "compiler/frontends/drawing/opening_places.h"
#include "compiler/frontends/drawing/opening_symbols.h"
#include "compiler/frontends/drawing/openings_on_walls.h"
#include "compiler/frontends/drawing/plane.h"
#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kOff_m = 1e-4;
constexpr double kAgainst = 0.96;      // cosine between sides that face each other
constexpr double kSkewEnds = 0.87;     // ... between ends of walls: the two lines of a wall often end askew
constexpr double kSquareEnd = 0.9995;  // ... between a wall's sides, and between them and the normal of its end: 1.8 degrees
constexpr double kSlipEnd = 0.96;      // ends that are more askew are drawn so
constexpr double kMinEnd_m = 0.03;     // narrower ends are no walls
constexpr double kBeyond_m = 0.15;     // from the faces of a wall into the rooms beside it
constexpr double kFrame_m = 0.2;       // a frame's width and a bit
constexpr double kSillShare = 0.85;    // a window's line runs from jamb to jamb

// A gap between two sides of walls, as a rectangle: `from` to `to` and half the depth to both sides.
struct Gap {
  DrawnOpening opening;
  uint32_t side_a = 0, side_b = 0;
  bool between_ends = false;
};

class OpeningFinder {
 public:
  OpeningFinder(const Drawing& drawing, const std::vector<uint32_t>& paths, const Outline& outline, const OpeningOptions& options)
      : drawing_(drawing),
        paths_(paths),
        outline_(outline),
        options_(options),
        curves_(outline, options),
        symbols_(drawing, paths, options),
        leaves_(drawing, paths, options) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const DrawnSpace& space : drawing.spaces) boxes.push_back(BoxOf(space.outline));
    rooms_ = BoxTree<2>(std::move(boxes));
  }

  std::vector<DrawnOpening> Run() {
    AddGaps();
    for (const uint32_t p : paths_) {
      if (!symbols_.IsUsed(p)) AddFromSymbol(p);
    }
    JoinLeafPairs();
    // The narrowest first: between two doors there is a wider piece of wall with a frame at both ends, too.
    std::vector<DrawnOpening> all_framed = FindFramedDoors(drawing_, outline_.mass());
    std::stable_sort(all_framed.begin(), all_framed.end(), [](const auto& a, const auto& b) { return a.width_m() < b.width_m(); });
    for (DrawnOpening& framed : all_framed) {
      if (!IsKnown(framed) && !IsBetweenDoors(framed) && !IsWithinARoom(framed)) Keep(std::move(framed));
    }
    return std::move(out_);
  }

 private:
  // Square to the end; where it is a little askew, by a slip of the pen, along the wall.
  Eigen::Vector2d OutOf(uint32_t end) const {
    const auto& sides = outline_.sides();
    const Side &s = sides[end], &before = sides[s.prev], &after = sides[s.next];
    const Eigen::Vector2d square = -Perp(s.along());
    // A cap over two lines of which one ends early says nothing about where the wall goes on.
    const bool is_drawn = s.source < drawing_.paths.size(), between_sides = before.along().dot(after.along()) < -kSquareEnd;
    if (!is_drawn || !between_sides || std::max(before.length_m(), after.length_m()) < s.length_m()) return square;
    const Eigen::Vector2d wall = before.length_m() > after.length_m() ? before.along() : Eigen::Vector2d(-after.along());
    return wall.dot(square) > kSquareEnd || wall.dot(square) < kSlipEnd ? square : wall;
  }

  // Across the gap in front of an end of a wall.
  std::optional<Gap> GapBefore(uint32_t end) const {
    const Side& s = outline_.sides()[end];
    const double thickness = s.length_m();
    if (s.curved || thickness < kMinEnd_m || thickness > kMaxEnd_m || !outline_.IsEnd(end)) return std::nullopt;
    if (curves_.IsEndOfCurve(end)) {
      std::optional<CurvedGap> curved = curves_.GapBefore(end);
      if (!curved) return std::nullopt;
      return Gap{std::move(curved->opening), end, curved->far_side, outline_.IsEnd(curved->far_side)};
    }
    const Eigen::Vector2d out = OutOf(end), across = Perp(out);
    std::optional<SideHit> first;
    for (const double at : {0.5, 0.2, 0.8}) {
      const auto hit = outline_.Cast(s.a + at * (s.b - s.a) + kOff_m * out, out, options_.max_window_gap_m);
      if (hit && (!first || hit->t_m < first->t_m)) first = hit;
    }
    if (!first || first->t_m < options_.min_width_m) return std::nullopt;
    const Side& t = outline_.sides()[first->side];
    if (t.along().dot(across) > -kSkewEnds) return std::nullopt;
    Gap gap;
    gap.side_a = end;
    gap.side_b = first->side;
    gap.between_ends = outline_.IsEnd(first->side);
    // What both have in common, seen along the gap.
    const double lo = std::max(0.0, std::min((t.a - s.a).dot(across), (t.b - s.a).dot(across)));
    const double hi = std::min(thickness, std::max((t.a - s.a).dot(across), (t.b - s.a).dot(across)));
    if (hi - lo < 0.3 * thickness) return std::nullopt;
    gap.opening.from = s.a + 0.5 * (lo + hi) * s.along();
    gap.opening.to = gap.opening.from + (first->t_m + kOff_m) * out;
    gap.opening.depth_m = hi - lo;
    return gap;
  }

  void AddGaps() {
    std::vector<Gap> gaps;
    for (uint32_t s = 0; s < outline_.sides().size(); ++s) {
      if (std::optional<Gap> gap = GapBefore(s)) gaps.push_back(std::move(*gap));
    }
    // The shortest first: what lies across a closed gap is no gap.
    std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.opening.width_m() < b.opening.width_m(); });
    const auto take = [&](Gap& gap) {
      jambs_.insert({gap.side_a, gap.side_b});
      Keep(gap.opening);
    };
    for (Gap& gap : gaps) {
      if (!IsKnown(gap.opening) && !IsWithinARoom(gap.opening) && Judge(gap)) take(gap);
    }
    for (Gap& gap : gaps) {
      if (!IsKnown(gap.opening) && !IsWithinARoom(gap.opening) && IsPassage(gap)) take(gap);
    }
  }

  // The same place found from its other end, or a gap that another one crosses.
  bool IsKnown(const DrawnOpening& o) const {
    bool known = false;
    places_.ForEachNear(o, [&](uint32_t k) { known = known || Collide(o, out_[k]); });
    return known;
  }

  static bool Collide(const DrawnOpening& o, const DrawnOpening& k) {
    const Eigen::Vector2d offset = o.middle() - k.middle();
    if (std::abs(o.along().dot(k.along())) > kAgainst)
      return std::abs(offset.dot(k.along())) < 0.5 * std::max(o.width_m(), k.width_m()) &&
             std::abs(Cross(k.along(), offset)) < 0.5 * (k.depth_m + o.depth_m) + kMinEnd_m;
    const double side_a = Cross(k.along(), o.from - k.from), side_b = Cross(k.along(), o.to - k.from);
    const double side_c = Cross(o.along(), k.from - o.from), side_d = Cross(o.along(), k.to - o.from);
    return side_a * side_b < 0 && side_c * side_d < 0;
  }

  void Keep(DrawnOpening opening) {
    places_.Add(opening, static_cast<uint32_t>(out_.size()));
    out_.push_back(std::move(opening));
  }

  // Whether symbols make the gap a door or a window, and which.
  bool Judge(Gap& gap) {
    DrawnOpening& o = gap.opening;
    const double width = o.width_m();
    const SymbolEvidence e = symbols_.Look(o);
    const auto take = [&](DrawnUse use, uint32_t path) {
      o.use = use;
      o.path = path;
      o.location = drawing_.paths[path].location;
      symbols_.UseAllIn(o);
      return true;
    };
    if (e.swing != kNone && width <= options_.max_swing_gap_m) return take(DrawnUse::kDoor, e.swing);
    const double enough = options_.min_spanning_share;
    if (e.door_span >= enough && e.door_span >= e.window_span && width <= options_.max_door_gap_m) return take(DrawnUse::kDoor, e.door);
    if (e.window_span >= enough) return take(DrawnUse::kWindow, e.window);
    if (e.mixed_span >= enough && e.sliding && width <= options_.max_door_gap_m) return take(DrawnUse::kDoor, e.mixed);
    if (e.mixed_line >= kSillShare) return take(DrawnUse::kWindow, e.mixed);
    if (e.mixed_span >= enough && width <= options_.max_door_gap_m) return take(DrawnUse::kDoor, e.mixed);
    if (e.leaf != kNone && width <= options_.max_swing_gap_m) return take(DrawnUse::kDoor, e.leaf);
    return false;
  }

  // A gap alone is a passage, if it is as wide as one.
  bool IsPassage(Gap& gap) const {
    DrawnOpening& o = gap.opening;
    const double width = o.width_m();
    const Side& end = outline_.sides()[gap.side_a];
    // Between two doors a wall shows an end to the side as well, across a corridor.
    if (jambs_.contains(end.prev) || jambs_.contains(end.next) || jambs_.contains(gap.side_a)) return false;
    if (width > (gap.between_ends ? options_.max_bare_gap_m : options_.max_bare_end_gap_m)) return false;
    const uint32_t source = outline_.sides()[gap.side_a].source;
    if (source < drawing_.paths.size()) o.location = drawing_.paths[source].location;
    return true;
  }

  // On both of its sides is one room that the drawing outlines: a gap in what stands in the room, as toilet stalls and stairs.
  bool IsWithinARoom(const DrawnOpening& o) const {
    const Eigen::Vector2d across = (0.5 * o.depth_m + kBeyond_m) * Perp(o.along());
    bool within = false;
    rooms_.ForEachIn(Eigen::AlignedBox2d(o.middle()), [&](uint32_t r) {
      const auto& outline = drawing_.spaces[r].outline;
      within =
          within || (Contains(outline, o.middle() + across) && Contains(outline, o.middle()) && Contains(outline, o.middle() - across));
    });
    return within;
  }

  void AddFromSymbol(uint32_t p) {
    const DrawnPath& path = drawing_.paths[p];
    for (const auto& [a, b] : leaves_.Closed(p)) {
      const double width = (b - a).norm();
      if (width < options_.min_width_m || width > options_.max_door_gap_m) continue;
      const double near = options_.symbol_slack_m;
      if (outline_.DistanceTo(a, 2 * near) >= near || outline_.DistanceTo(b, 2 * near) >= near) continue;
      std::optional<DrawnOpening> o = curves_.Between(a, b);
      if (!o) o = OpeningOverWall(outline_, a, b);
      if (!o && !outline_.InWall(0.5 * (a + b))) o = OpeningBetweenWalls(outline_, a, b, options_.symbol_slack_m);
      if (!o) continue;
      o->use = DrawnUse::kDoor;
      o->path = p;
      o->location = path.location;
      if (IsKnown(*o) || IsWithinARoom(*o)) continue;
      symbols_.Use(p);
      Keep(std::move(*o));
      return;
    }
    if (path.role == LineRole::kWindow || path.role == LineRole::kDoor || path.role == LineRole::kPassage) AddOverWall(p);
  }

  // Its frame is that of a door beside it: the piece of wall from there to the next frame.
  bool IsBetweenDoors(const DrawnOpening& framed) const {
    bool shared = false;
    places_.ForEachNear(framed, [&](uint32_t k) {
      const DrawnOpening& o = out_[k];
      if (o.use == DrawnUse::kWindow || std::abs(o.along().dot(framed.along())) < kAgainst) return;
      for (const Eigen::Vector2d& p : {o.from, o.to}) {
        for (const Eigen::Vector2d& q : {framed.from, framed.to}) shared = shared || (p - q).norm() < kFrame_m;
      }
    });
    return shared;
  }

  // Two leaves that meet when closed are one doorway, also where something narrow stands between them.
  void JoinLeafPairs() {
    std::vector<bool> joined(out_.size(), false);
    for (const DrawnLeaf& leaf : leaves_.all()) {
      const std::optional<Eigen::Vector2d> mate = leaves_.HingeOfMate(leaf);
      const uint32_t a = mate ? DoorFrom(leaf.hinge, leaf.tip) : kNone, b = mate ? DoorFrom(*mate, leaf.tip) : kNone;
      if (a == kNone || b == kNone || a == b || joined[a] || joined[b]) continue;
      DrawnOpening &first = out_[std::min(a, b)], &second = out_[std::max(a, b)];
      const Eigen::Vector2d u = first.along();
      if (std::abs(u.dot(second.along())) < kAgainst || std::abs(Cross(u, second.middle() - first.middle())) > 0.5 * first.depth_m)
        continue;
      for (const Eigen::Vector2d& p : {second.from, second.to}) {
        const double s = u.dot(p - first.from);
        if (s < 0) first.from += s * u;
        if (s > first.width_m()) first.to = first.from + s * u;
      }
      first.in_wall = first.in_wall && second.in_wall;
      joined[std::max(a, b)] = true;
    }
    std::vector<DrawnOpening> kept;
    for (size_t i = 0; i < out_.size(); ++i) {
      if (!joined[i]) kept.push_back(std::move(out_[i]));
    }
    out_.clear();
    places_ = {};
    for (DrawnOpening& o : kept) Keep(std::move(o));
  }

  // The straight door that a closed leaf fills.
  uint32_t DoorFrom(const Eigen::Vector2d& hinge, const Eigen::Vector2d& tip) const {
    const double near_m = options_.symbol_slack_m;
    const auto at = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) { return (p - q).norm() < near_m + kLeavesMeet_m; };
    DrawnOpening closed;
    closed.from = hinge;
    closed.to = tip;
    uint32_t best = kNone;
    places_.ForEachNear(closed, [&](uint32_t i) {
      const DrawnOpening& o = out_[i];
      if (o.use != DrawnUse::kDoor || o.curve) return;
      if ((at(o.from, hinge) && at(o.to, tip)) || (at(o.to, hinge) && at(o.from, tip))) best = std::min(best, i);
    });
    return best;
  }

  // The paths of its symbol that can lie in the wall: boxes if there are any, as swings and open leaves stand out of it.
  std::vector<uint32_t> InWallPartsOf(uint32_t p) const {
    std::vector<uint32_t> boxes;
    for (const uint32_t q : symbols_.PathsWith(p)) {
      const auto& arcs = drawing_.paths[q].arcs;
      const bool swings = std::any_of(arcs.begin(), arcs.end(), [&](const Arc& arc) { return IsSwing(arc, options_); });
      if (drawing_.paths[q].closed && !swings) boxes.push_back(q);
    }
    return boxes.empty() ? symbols_.PathsWith(p) : boxes;
  }

  // The box around the paths, along the longest line among them, if it lies over a wall.
  std::optional<DrawnOpening> OfBox(const std::vector<uint32_t>& members) const {
    Eigen::AlignedBox2d box;
    Eigen::Vector2d u = Eigen::Vector2d::Zero();
    for (const uint32_t q : members) {
      const DrawnPath& other = drawing_.paths[q];
      for (size_t i = 0; i + 1 < other.points.size(); ++i) {
        const Eigen::Vector2d d = other.points[i + 1] - other.points[i];
        if (d.norm() > u.norm()) u = d;
      }
    }
    if (u.norm() < options_.min_width_m) return std::nullopt;
    u.normalize();
    for (const uint32_t q : members) {
      for (const auto& point : drawing_.paths[q].points) box.extend(Eigen::Vector2d(u.dot(point), Cross(u, point)));
    }
    const Eigen::Vector2d c = box.center(), m = c.x() * u + c.y() * Perp(u);
    const double half = 0.5 * box.sizes().x();
    if (box.sizes().y() > kMaxEnd_m || !outline_.InWall(m)) return std::nullopt;
    return OpeningOverWall(outline_, m - half * u, m + half * u);
  }

  // A window or a door without a swing that lies over a wall; its paths are looked at together.
  void AddOverWall(uint32_t p) {
    const DrawnPath& path = drawing_.paths[p];
    const std::vector<uint32_t> members = InWallPartsOf(p);
    std::vector<Eigen::Vector2d> points;
    for (const uint32_t q : members) points.insert(points.end(), drawing_.paths[q].points.begin(), drawing_.paths[q].points.end());
    std::optional<DrawnOpening> o = curves_.Along(points);
    if (!o) o = OfBox(members);
    if (!o || o->width_m() < options_.min_width_m || o->width_m() > options_.max_window_gap_m) return;
    o->use = path.role == LineRole::kDoor ? DrawnUse::kDoor : path.role == LineRole::kWindow ? DrawnUse::kWindow : DrawnUse::kPassage;
    o->path = p;
    o->location = path.location;
    if (!IsKnown(*o)) Keep(std::move(*o));
  }

  static constexpr double kMaxEnd_m = 1.0;

  const Drawing& drawing_;
  const std::vector<uint32_t>& paths_;  // of doors and windows
  const Outline& outline_;
  const OpeningOptions& options_;
  const CurvedOpenings curves_;
  OpeningSymbols symbols_;
  std::set<uint32_t> jambs_;  // sides at the ends of openings
  std::vector<DrawnOpening> out_;
  OpeningPlaces places_;  // of out_
  const DoorLeaves leaves_;
  BoxTree<2> rooms_;  // as the drawing outlines them
};

}  // namespace

std::vector<DrawnOpening> FindOpenings(const Drawing& drawing, const std::vector<uint32_t>& symbols, const Outline& outline,
                                       const OpeningOptions& options) {
  return OpeningFinder(drawing, symbols, outline, options).Run();
}

}  // namespace plumb::compiler
