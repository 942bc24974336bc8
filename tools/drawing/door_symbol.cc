#include "tools/drawing/door_symbol.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tools/drawing/plane.h"
#include "tools/drawing/section.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kWidestLeaf_m = 1.4;  // wider doors have two
constexpr double kFillsDoor = 0.8;     // share of the doorway, from which on one leaf is drawn as wide as that
constexpr double kArrowOff_m = 0.12;   // of the arrow beside a sliding leaf
constexpr double kArrowHead_m = 0.08;
constexpr double kLifted_m = 0.3;   // of a lifted leaf that shows
constexpr double kBehind_m = 0.03;  // between the middles of panels that slide past each other, to the wall's middle

size_t DoorwaysOf(const AGraph& g, RoomId room) {
  return static_cast<size_t>(
      std::count_if(g.doorways.begin(), g.doorways.end(), [room](const Doorway& d) { return d.room_a == room || d.room_b == room; }));
}

// How far a room reaches from the doorway; outside, as far as one likes.
double DepthOf(const AGraph& g, RoomId room, const Doorway& d, const Vector2d& way) {
  if (!room.valid()) return std::numeric_limits<double>::max();
  double depth_m = 0;
  for (const Vector2d& corner : g.rooms[room.index()].polygon) depth_m = std::max(depth_m, way.dot(corner - d.position.head<2>()));
  return depth_m;
}

// The room into which a leaf opens where the plan does not say.
bool OpensTowardsB(const AGraph& g, const Doorway& d) {
  const double leaf_m = d.width_m > kWidestLeaf_m ? 0.5 * d.width_m : d.width_m;
  const Vector2d through = Direction(d.yaw_rad);
  const bool fits_a = DepthOf(g, d.room_a, d, -through) > leaf_m, fits_b = DepthOf(g, d.room_b, d, through) > leaf_m;
  if (fits_a != fits_b) return fits_b;  // closets are shallow
  if (!d.room_b.valid()) return false;
  if (!d.room_a.valid()) return true;
  const size_t ways_a = DoorwaysOf(g, d.room_a), ways_b = DoorwaysOf(g, d.room_b);
  if (ways_a != ways_b) return ways_b < ways_a;
  return g.rooms[d.room_b.index()].area_m2 <= g.rooms[d.room_a.index()].area_m2;
}

// Draws in the doorway's own frame: `s` along the wall, to the left of who passes from room_a to room_b; `t` on that way.
class DoorSymbol {
 public:
  DoorSymbol(const AGraph& graph, const Doorway& doorway, const Sheet& sheet)
      : g_(graph),
        d_(doorway),
        sheet_(sheet),
        through_(Direction(doorway.yaw_rad)),
        left_(Left(through_)),
        thickness_m_(doorway.wall.valid() ? graph.walls[doorway.wall.index()].thickness_m : kUnknownThickness_m) {}

  std::string Draw() const {
    const Ring ring = RectangleAlong(At(0, 0), left_, d_.width_m, thickness_m_ + 0.02);
    const std::string opening = Path("opening", sheet_.Closed(ring));
    const std::string edges = sheet_.Line(ring[0], ring[1]) + sheet_.Line(ring[2], ring[3]);
    if (!d_.has_leaf) return opening + Path("lintel", edges);
    return opening + (d_.leaves.empty() ? Assumed() : DrawLeaves(d_.leaves)) + Path("sill", edges);
  }

 private:
  // A leaf with everything that its drawing needs. The hinge is at `s_m`, the closed leaf goes from there to s_m + inwards * width_m.
  struct Panel {
    LeafOperation operation = LeafOperation::kSwing;
    double s_m = 0, inwards = 1, width_m = 0;
    double side = 1;  // 1: to room_b, -1: to room_a
    [[nodiscard]] double latch_m() const { return s_m + inwards * width_m; }
  };

  static std::string Path(const char* style, const std::string& data) {
    return fmt::format("<path class=\"{}\" d=\"{}\"/>\n", style, data);
  }

  [[nodiscard]] Vector2d At(double s_m, double t_m) const { return d_.position.head<2>() + s_m * left_ + t_m * through_; }
  [[nodiscard]] std::string Line(double s0_m, double t0_m, double s1_m, double t1_m) const {
    return sheet_.Line(At(s0_m, t0_m), At(s1_m, t1_m));
  }
  [[nodiscard]] double Face(double side) const { return 0.5 * thickness_m_ * side; }

  // One leaf or two that swing, as is common. What is too wide for two rolls or slides, and is drawn shut.
  [[nodiscard]] std::string Assumed() const {
    if (d_.width_m > 2 * kWidestLeaf_m) return Group(DrawLeaves({{LeafOperation::kFixed, Jamb::kUnknown, DoorwaySide::kUnknown, 0}}));
    return DrawLeaves(std::vector<DoorLeaf>(d_.width_m > kWidestLeaf_m ? 2 : 1));
  }

  static std::string Group(const std::string& drawn) { return "<g class=\"assumed\">\n" + drawn + "</g>\n"; }

  // Whether the plan leaves open where it swings.
  static bool IsAssumed(const std::vector<DoorLeaf>& leaves, const DoorLeaf& leaf) {
    if (leaf.operation == LeafOperation::kUnknown) return true;
    if (leaf.operation != LeafOperation::kSwing && leaf.operation != LeafOperation::kFolding) return false;
    return leaf.opens_to == DoorwaySide::kUnknown || (leaf.jamb == Jamb::kUnknown && leaves.size() == 1);
  }

  [[nodiscard]] std::string DrawLeaves(const std::vector<DoorLeaf>& leaves) const {
    const auto slides_past = [](const DoorLeaf& l) { return l.operation == LeafOperation::kSliding && l.jamb == Jamb::kUnknown; };
    if (leaves.size() > 1 && std::all_of(leaves.begin(), leaves.end(), slides_past)) return DrawSlidingPast();
    std::string out;
    for (size_t i = 0; i < leaves.size(); ++i) {
      const std::string panel = DrawPanel(PanelOf(leaves, i));
      out += IsAssumed(leaves, leaves[i]) ? Group(panel) : panel;
    }
    return out;
  }

  [[nodiscard]] Panel PanelOf(const std::vector<DoorLeaf>& leaves, size_t i) const {
    const DoorLeaf& leaf = leaves[i];
    Panel out;
    if (leaf.operation != LeafOperation::kUnknown) out.operation = leaf.operation;
    const bool to_b = leaf.opens_to == DoorwaySide::kUnknown ? OpensTowardsB(g_, d_) : leaf.opens_to == DoorwaySide::kRoomB;
    out.side = to_b ? 1 : -1;
    out.width_m = WidthOf(leaves, i);
    bool at_left = leaf.jamb == Jamb::kLeft;
    if (leaf.jamb == Jamb::kUnknown) {
      const Jamb other = leaves.size() > 1 ? leaves[1 - i].jamb : Jamb::kUnknown;
      const bool first = other == Jamb::kUnknown ? i == 0 : other == Jamb::kRight;
      at_left = leaves.size() > 1 ? first : HangsLeft(out.side);
    }
    out.s_m = (at_left ? 0.5 : -0.5) * d_.width_m;
    out.inwards = at_left ? -1 : 1;
    return out;
  }

  // Leaves fill the doorway: frames are counted in by some sources and not by others. One that is much narrower is drawn so.
  [[nodiscard]] double WidthOf(const std::vector<DoorLeaf>& leaves, size_t i) const {
    const double own_m = leaves[i].width_m;
    if (leaves.size() == 1) return own_m > 0 && own_m < kFillsDoor * d_.width_m ? own_m : d_.width_m;
    double sum_m = 0;
    for (const DoorLeaf& l : leaves) sum_m += l.width_m;
    const bool all_known = std::all_of(leaves.begin(), leaves.end(), [](const DoorLeaf& l) { return l.width_m > 0; });
    if (all_known) return own_m / sum_m * d_.width_m;
    const double equal_m = d_.width_m / static_cast<double>(leaves.size());
    if (leaves.size() > 2 || !(sum_m > 0 && sum_m < d_.width_m)) return equal_m;
    return own_m > 0 ? own_m : d_.width_m - sum_m;
  }

  // The jamb at which a leaf hangs where the plan does not say: the one nearer to a corner of the room, so that it opens against a wall.
  [[nodiscard]] bool HangsLeft(double side) const {
    const RoomId room = side > 0 ? d_.room_b : d_.room_a;
    if (!room.valid()) return false;
    double to_left_m = std::numeric_limits<double>::max(), to_right_m = to_left_m;
    for (const Vector2d& corner : g_.rooms[room.index()].polygon) {
      to_left_m = std::min(to_left_m, (corner - At(0.5 * d_.width_m, Face(side))).norm());
      to_right_m = std::min(to_right_m, (corner - At(-0.5 * d_.width_m, Face(side))).norm());
    }
    return to_left_m < to_right_m;
  }

  [[nodiscard]] std::string DrawPanel(const Panel& p) const {
    switch (p.operation) {
      case LeafOperation::kUnknown:
      case LeafOperation::kSwing: return Leaf(p.s_m, Face(p.side), p) + Swing(p.s_m, Face(p.side), p.side, p);
      case LeafOperation::kDoubleActing: return Leaf(p.s_m, 0, p) + Swing(p.s_m, 0, 1, p) + Swing(p.s_m, 0, -1, p);
      case LeafOperation::kSliding: return Closed(p) + Arrow(p);
      case LeafOperation::kFolding: return Folded(p);
      case LeafOperation::kRevolving: return Revolving();
      case LeafOperation::kLifting: return Closed(p) + Lifted(p);
      case LeafOperation::kFixed: return Closed(p);
    }
    return {};
  }

  // Standing open by 90 degrees.
  [[nodiscard]] std::string Leaf(double s_m, double t_m, const Panel& p) const {
    return Path("leaf", Line(s_m, t_m, s_m, t_m + p.side * p.width_m));
  }

  // The way of its free end.
  [[nodiscard]] std::string Swing(double s_m, double t_m, double side, const Panel& p) const {
    const Vector2d tip = At(s_m, t_m + side * p.width_m), latch = At(p.latch_m(), t_m);
    const int sweep = side * p.inwards < 0 ? 1 : 0;  // 1 is clockwise on the sheet
    const std::string radius = Decimal(sheet_.Length(p.width_m));
    return Path("swing", fmt::format("M{}A{} {} 0 0 {} {}", sheet_.At(tip), radius, radius, sweep, sheet_.At(latch)));
  }

  [[nodiscard]] std::string Closed(const Panel& p) const { return Path("leaf", Line(p.s_m, 0, p.latch_m(), 0)); }

  // Beside a sliding leaf, the way that it opens.
  [[nodiscard]] std::string Arrow(const Panel& p) const {
    const double t_m = Face(p.side) + kArrowOff_m * p.side, tip_m = p.s_m + 0.2 * p.inwards * p.width_m;
    const double back_m = tip_m + kArrowHead_m * p.inwards;
    return Path("swing", Line(p.s_m + 0.8 * p.inwards * p.width_m, t_m, tip_m, t_m) + Line(back_m, t_m + kArrowHead_m / 2, tip_m, t_m) +
                             Line(back_m, t_m - kArrowHead_m / 2, tip_m, t_m));
  }

  // Two panels, each half of the doorway, one behind the other.
  [[nodiscard]] std::string DrawSlidingPast() const {
    constexpr double kReach = 0.52;  // of the doorway's width
    const double half_m = 0.5 * d_.width_m, inner_m = (kReach - 0.5) * d_.width_m;
    return Path("leaf", Line(half_m, kBehind_m, -inner_m, kBehind_m)) + Path("leaf", Line(-half_m, -kBehind_m, inner_m, -kBehind_m));
  }

  // Two halves that stand half open, and the track to the latch.
  [[nodiscard]] std::string Folded(const Panel& p) const {
    constexpr double kRise = 0.866;  // of a half that stands at 60 degrees
    const double face_m = Face(p.side), quarter_m = 0.25 * p.width_m * p.inwards;
    const double knee_m = face_m + p.side * kRise * 0.5 * p.width_m;
    return Path("leaf", Line(p.s_m, face_m, p.s_m + quarter_m, knee_m) + Line(p.s_m + quarter_m, knee_m, p.s_m + 2 * quarter_m, face_m)) +
           Path("swing", Line(p.s_m + 2 * quarter_m, face_m, p.latch_m(), face_m));
  }

  [[nodiscard]] std::string Revolving() const {
    const double radius_m = 0.5 * d_.width_m, wing_m = 0.7071 * radius_m;
    const std::string r = Decimal(sheet_.Length(radius_m)), from = sheet_.At(At(radius_m, 0)), to = sheet_.At(At(-radius_m, 0));
    return Path("swing", fmt::format("M{0}A{2} {2} 0 0 1 {1}A{2} {2} 0 0 1 {0}", from, to, r)) +
           Path("leaf", Line(-wing_m, -wing_m, wing_m, wing_m) + Line(-wing_m, wing_m, wing_m, -wing_m));
  }

  // Above the plane of the cut: dashed.
  [[nodiscard]] std::string Lifted(const Panel& p) const {
    const double face_m = Face(p.side), end_m = face_m + kLifted_m * p.side;
    return Path("lintel", sheet_.Closed({At(p.s_m, face_m), At(p.latch_m(), face_m), At(p.latch_m(), end_m), At(p.s_m, end_m)}));
  }

  const AGraph& g_;
  const Doorway& d_;
  const Sheet& sheet_;
  Vector2d through_, left_;
  double thickness_m_;
};

}  // namespace

std::string DrawDoor(const AGraph& graph, const Doorway& doorway, const Sheet& sheet) { return DoorSymbol(graph, doorway, sheet).Draw(); }

}  // namespace plumb::tools
