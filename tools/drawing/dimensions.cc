#include "tools/drawing/dimensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

#include "tools/drawing/floor_plan.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kUpright_deg = 0.5;
constexpr double kRightAngle = std::numbers::pi / 2;
constexpr double kShortest_m = 0.01;                        // stops closer than this are one
constexpr double kFaces = 0.99;                             // cosine: a facade looks that way
constexpr double kSmallest = 13, kLargest = 20;             // fonts
constexpr double kFirstRow = 80, kRowStep = 80, kTick = 9;  // units of the sheet

// To (-pi/4, pi/4]: directions that differ by quarter turns are one.
double Folded(double angle_rad) { return angle_rad - kRightAngle * std::ceil(angle_rad / kRightAngle - 0.5); }

struct Opening {
  double from_m, to_m, depth_m;
};

// The openings in facades that look towards `outward`. Of those one behind the other the foremost is measured.
class Facade {
 public:
  Facade(const AGraph& graph, StoreyId storey, const Vector2d& along, const Vector2d& outward)
      : graph_(graph), storey_(storey), along_(along), outward_(outward) {
    for (const Doorway& d : graph.doorways) Add(d);
    for (const Window& w : graph.windows) Add(w);
  }

  std::vector<double> Stops() {
    std::stable_sort(openings_.begin(), openings_.end(), [](const Opening& a, const Opening& b) { return a.depth_m > b.depth_m; });
    std::vector<Opening> kept;
    for (const Opening& o : openings_) {
      const auto covers = [&o](const Opening& k) { return o.from_m < k.to_m && k.from_m < o.to_m; };
      if (std::none_of(kept.begin(), kept.end(), covers)) kept.push_back(o);
    }
    std::vector<double> stops;
    for (const Opening& o : kept) stops.push_back(o.from_m), stops.push_back(o.to_m);
    return stops;
  }

 private:
  template <class Node>
  void Add(const Node& node) {
    if (node.storey != storey_ || !node.wall.valid()) return;
    const Vector2d middle = node.position.template head<2>(), through(std::cos(node.yaw_rad), std::sin(node.yaw_rad));
    if (std::abs(through.dot(outward_)) < kFaces) return;
    for (const Surface& s : graph_.surfaces) {
      if (s.wall != node.wall || s.storey != storey_ || s.room.valid() || s.arc || s.normal.head<2>().dot(outward_) < kFaces) continue;
      const double t = (middle - s.start).dot(s.end - s.start) / std::max(1e-12, (s.end - s.start).squaredNorm());
      if (t < 0 || t > 1) continue;
      const double at_m = middle.dot(along_);
      openings_.push_back({at_m - 0.5 * node.width_m, at_m + 0.5 * node.width_m, s.start.dot(outward_)});
      return;
    }
  }

  const AGraph& graph_;
  StoreyId storey_;
  Vector2d along_, outward_;
  std::vector<Opening> openings_;
};

// Posts and strays of the drawing that stand by themselves and are smaller than this are no part of the building's size.
constexpr double kSmallestPart_m = 1.0;

// By wall: is it part of something that size, or is nothing of that size? Walls whose boxes touch are of one part.
std::vector<bool> WallsOfParts(const AGraph& graph, StoreyId storey) {
  constexpr double kTouch_m = 0.05;
  std::vector<Eigen::AlignedBox2d> boxes(graph.walls.size());
  for (const Surface& s : graph.surfaces) {
    if (s.storey != storey) continue;
    for (const Vector2d& p : PointsAlong(s)) boxes[s.wall.index()].extend(p);
  }
  std::vector<size_t> order, part(graph.walls.size());
  std::iota(part.begin(), part.end(), size_t{0});
  for (size_t w = 0; w < boxes.size(); ++w) {
    if (!boxes[w].isEmpty()) order.push_back(w);
  }
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return boxes[a].min().x() < boxes[b].min().x(); });
  const auto root = [&part](size_t w) {
    while (part[w] != w) w = part[w] = part[part[w]];
    return w;
  };
  const Vector2d touch(kTouch_m, kTouch_m);
  for (size_t i = 0; i < order.size(); ++i) {
    const Eigen::AlignedBox2d reach(boxes[order[i]].min() - touch, boxes[order[i]].max() + touch);
    for (size_t k = i + 1; k < order.size() && boxes[order[k]].min().x() <= reach.max().x(); ++k) {
      if (reach.intersects(boxes[order[k]])) part[root(order[k])] = root(order[i]);
    }
  }
  std::vector<Eigen::AlignedBox2d> parts(graph.walls.size());
  for (const size_t w : order) parts[root(w)].extend(boxes[w]);
  std::vector<bool> out(graph.walls.size(), false);
  for (const size_t w : order) out[w] = parts[root(w)].sizes().maxCoeff() >= kSmallestPart_m;
  if (std::find(out.begin(), out.end(), true) == out.end()) out.assign(out.size(), true);
  return out;
}

// How far the storey reaches that way, columns before the walls included.
double Reach(const AGraph& graph, StoreyId storey, const std::vector<bool>& is_of_part, const Vector2d& outward) {
  double reach_m = std::numeric_limits<double>::lowest();
  for (const Surface& s : graph.surfaces) {
    if (s.storey != storey || !is_of_part[s.wall.index()]) continue;
    for (const Vector2d& p : PointsAlong(s)) reach_m = std::max(reach_m, p.dot(outward));
  }
  for (const Column& c : graph.columns) {
    for (const Vector2d& p : c.outline) {
      if (c.storey == storey) reach_m = std::max(reach_m, p.dot(outward));
    }
  }
  return reach_m;
}

void SortAndMerge(std::vector<double>& stops_m) {
  std::sort(stops_m.begin(), stops_m.end());
  stops_m.erase(std::unique(stops_m.begin(), stops_m.end(), [](double a, double b) { return b - a < kShortest_m; }), stops_m.end());
}

// One line on the paper, with what is written along it.
class Drawer {
 public:
  Drawer(const DimensionChain& chain, const Sheet& sheet)
      : chain_(chain), sheet_(sheet), outward_(chain.outward.x(), -chain.outward.y()), along_(chain.along.x(), -chain.along.y()) {
    // To be read from below or from the right; sides that are a little off the upright, as measured ones are, all from the same.
    angle_deg_ = std::atan2(along_.y(), along_.x()) * 180 / std::numbers::pi;
    if (angle_deg_ > 90 - kUpright_deg) angle_deg_ -= 180;
    if (angle_deg_ <= -90 - kUpright_deg) angle_deg_ += 180;
    const double rad = angle_deg_ * std::numbers::pi / 180;
    up_ = {std::sin(rad), -std::cos(rad)};
    font_size_ = FontSize();
  }

  std::string Run() {
    const std::vector<double>& stops = chain_.stops_m;
    std::string lines = Segment(At(stops.front(), Row()), At(stops.back(), Row())), ticks;
    for (const double stop : stops) {
      const Vector2d p = At(stop, Row()), slant = kTick * (along_ + outward_).normalized();
      lines += Segment(At(stop, chain_.row == 0 ? 25 : Row() - 25), At(stop, Row() + 12));
      ticks += Segment(p - slant, p + slant);
    }
    std::string out = fmt::format("<path class=\"dim\" d=\"{}\"/><path class=\"dim-tick\" d=\"{}\"/>\n", lines, ticks);
    for (size_t i = 0; i + 1 < stops.size(); ++i) out += Text(stops[i], stops[i + 1]);
    return out;
  }

 private:
  [[nodiscard]] double Row() const { return kFirstRow + kRowStep * chain_.row; }
  // On the paper: `along_m` along the building's side, `off` units before it.
  [[nodiscard]] Vector2d At(double along_m, double off) const {
    const Vector2d p = along_m * chain_.along + chain_.outward_m * chain_.outward;
    return Vector2d(sheet_.x(p.x()), sheet_.y(p.y())) + off * outward_;
  }
  // So large that most of the measures fit between their stops.
  [[nodiscard]] double FontSize() const {
    std::vector<double> fitting;
    for (size_t i = 0; i + 1 < chain_.stops_m.size(); ++i) {
      const double length_m = chain_.stops_m[i + 1] - chain_.stops_m[i];
      fitting.push_back(sheet_.Length(length_m) / TextWidth(fmt::format("{:.2f}", length_m), false));
    }
    const auto third = fitting.begin() + static_cast<std::ptrdiff_t>(fitting.size() / 3);
    std::nth_element(fitting.begin(), third, fitting.end());
    return std::clamp(0.95 * *third, kSmallest, kLargest);
  }
  static std::string Segment(const Vector2d& a, const Vector2d& b) {
    return fmt::format("M{} {}L{} {}", Decimal(a.x()), Decimal(a.y()), Decimal(b.x()), Decimal(b.y()));
  }
  // Above the line; measures shorter than their number stand below it in turns with the others.
  std::string Text(double from_m, double to_m) {
    const std::string text = fmt::format("{:.2f}", to_m - from_m);
    const bool is_narrow = sheet_.Length(to_m - from_m) < 0.95 * TextWidth(text, false) * font_size_;
    below_ = is_narrow && !below_;
    const Vector2d at = At(0.5 * (from_m + to_m), Row()) + (below_ ? -(font_size_ + 4) : 6.0) * up_;
    return fmt::format("<text class=\"dim-text\" x=\"{0}\" y=\"{1}\" font-size=\"{2}\" transform=\"rotate({3:.2f} {0} {1})\">{4}</text>\n",
                       Decimal(at.x()), Decimal(at.y()), Decimal(font_size_), angle_deg_, text);
  }

  const DimensionChain& chain_;
  const Sheet& sheet_;
  Vector2d outward_, along_, up_;  // on the paper, y down
  double angle_deg_ = 0, font_size_ = kLargest;
  bool below_ = false;
};

}  // namespace

double MainDirection(const AGraph& graph, StoreyId storey) {
  std::array<double, 90> length_m{};
  const auto visit = [&](auto use) {
    for (const Surface& s : graph.surfaces) {
      if (s.storey != storey || s.arc) continue;
      const Vector2d d = s.end - s.start;
      use(Folded(std::atan2(d.y(), d.x())), d.norm());
    }
  };
  const auto bin_of = [](double angle_rad) {
    return std::min<size_t>(89, static_cast<size_t>((angle_rad + kRightAngle / 2) / kRightAngle * 90));
  };
  visit([&](double angle_rad, double l_m) { length_m[bin_of(angle_rad)] += l_m; });
  const auto best = static_cast<size_t>(std::max_element(length_m.begin(), length_m.end()) - length_m.begin());
  const double middle_rad = (static_cast<double>(best) + 0.5) / 90 * kRightAngle - kRightAngle / 2;
  double sum = 0, weight = 0;
  visit([&](double angle_rad, double l_m) {
    const double off_rad = Folded(angle_rad - middle_rad);
    if (std::abs(off_rad) > 0.02) return;
    sum += l_m * off_rad;
    weight += l_m;
  });
  return weight > 0 ? Folded(middle_rad + sum / weight) : 0;
}

OuterRectangle OuterRectangleOf(const AGraph& graph, StoreyId storey) {
  OuterRectangle out;
  const double yaw_rad = MainDirection(graph, storey);
  out.u = {std::cos(yaw_rad), std::sin(yaw_rad)};
  out.v = {-std::sin(yaw_rad), std::cos(yaw_rad)};
  const auto add = [&out](const Vector2d& p) { out.size.extend(Vector2d(p.dot(out.u), p.dot(out.v))); };
  const std::vector<bool> is_of_part = WallsOfParts(graph, storey);
  for (const bool exterior_only : {true, false}) {
    for (const Surface& s : graph.surfaces) {
      if (s.storey != storey || (exterior_only && s.room.valid()) || !is_of_part[s.wall.index()]) continue;
      for (const Vector2d& p : PointsAlong(s)) add(p);
    }
    if (!out.size.isEmpty()) break;
  }
  return out;
}

std::vector<DimensionChain> DimensionsOf(const AGraph& graph, StoreyId storey) {
  const OuterRectangle outer = OuterRectangleOf(graph, storey);
  if (outer.size.isEmpty()) return {};
  const Vector2d lo = outer.size.min(), hi = outer.size.max();
  struct Side {
    Vector2d along, outward;
    double from_m, to_m;
    bool overall;
  };
  const std::array<Side, 4> sides = {Side{outer.u, -outer.v, lo.x(), hi.x(), true}, Side{outer.v, -outer.u, lo.y(), hi.y(), true},
                                     Side{outer.u, outer.v, lo.x(), hi.x(), false}, Side{outer.v, outer.u, lo.y(), hi.y(), false}};
  const std::vector<bool> is_of_part = WallsOfParts(graph, storey);
  std::vector<DimensionChain> out;
  for (const Side& side : sides) {
    const double outward_m = Reach(graph, storey, is_of_part, side.outward);
    DimensionChain openings{side.along, side.outward, outward_m, Facade(graph, storey, side.along, side.outward).Stops(), 0};
    if (!openings.stops_m.empty()) {
      openings.stops_m.push_back(side.from_m);
      openings.stops_m.push_back(side.to_m);
      SortAndMerge(openings.stops_m);
      out.push_back(std::move(openings));
    }
    if (side.overall && side.to_m - side.from_m > kShortest_m)
      out.push_back({side.along, side.outward, outward_m, {side.from_m, side.to_m}, 1});
  }
  return out;
}

std::string DrawDimensions(const AGraph& graph, StoreyId storey, const Sheet& sheet) {
  std::string out;
  for (const DimensionChain& chain : DimensionsOf(graph, storey)) out += Drawer(chain, sheet).Run();
  return out;
}

}  // namespace plumb::tools
