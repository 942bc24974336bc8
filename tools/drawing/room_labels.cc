#include "tools/drawing/room_labels.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "schema/polygon.h"

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

// Units of the sheet: 0.1 mm.
constexpr double kSmallest = 13, kLargest = 26;
constexpr double kLine = 1.15;  // step of a line, of the font's size

template <class Visit>
void VisitEdges(const Room& room, Visit visit) {
  const auto walk = [&visit](const Ring& ring) {
    for (size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  walk(room.polygon);
  for (const Ring& hole : room.holes) walk(hole);
}

// Distance to the boundary, negative outside.
double Clearance(const Room& room, const Vector2d& p) {
  double nearest = DistanceToRing(room.polygon, p);
  for (const Ring& hole : room.holes) nearest = std::min(nearest, DistanceToRing(hole, p));
  return Contains(room, p) ? nearest : -nearest;
}

// A grid over the room's box; some of its points lie outside the room.
std::vector<Vector2d> GridOver(const Room& room) {
  Vector2d lo = room.polygon.front(), hi = lo;
  for (const Vector2d& p : room.polygon) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
  constexpr int kSteps = 24;
  std::vector<Vector2d> out;
  for (int i = 1; i < kSteps; ++i) {
    for (int k = 1; k < kSteps; ++k) out.emplace_back(lo + Vector2d(i, k).cwiseProduct(hi - lo) / kSteps);
  }
  return out;
}

// Where a label has most room: the centroid if it lies well inside, else the best point of a grid.
Vector2d LabelPoint(const Room& room) {
  Vector2d best = room.center.head<2>();
  double best_clearance = 1.25 * Clearance(room, best);
  for (const Vector2d& p : GridOver(room)) {
    const double clearance = Clearance(room, p);
    if (clearance <= best_clearance) continue;
    best_clearance = clearance;
    best = p;
  }
  return best;
}

// How far a line through `p` goes along +-`direction` before it meets the boundary, the shorter of both ways.
double HalfSpan(const Room& room, const Vector2d& p, const Vector2d& direction) {
  const Vector2d across(-direction.y(), direction.x());
  double span_m = std::numeric_limits<double>::max();
  VisitEdges(room, [&](const Vector2d& a, const Vector2d& b) {
    const double side_a = across.dot(a - p), side_b = across.dot(b - p);
    if ((side_a > 0) == (side_b > 0)) return;
    const Vector2d at = a + side_a / (side_a - side_b) * (b - a);
    span_m = std::min(span_m, std::abs(direction.dot(at - p)));
  });
  return span_m;
}

// In two lines of about the same length; in one where there is no space to break at.
std::vector<std::string> Broken(const std::string& name) {
  size_t best = std::string::npos;
  const auto off_middle = [&name](size_t at) { return at > name.size() / 2 ? at - name.size() / 2 : name.size() / 2 - at; };
  for (size_t at = name.find(' '); at != std::string::npos; at = name.find(' ', at + 1)) {
    if (best == std::string::npos || off_middle(at) < off_middle(best)) best = at;
  }
  if (best == std::string::npos) return {name};
  return {name.substr(0, best), name.substr(best + 1)};
}

struct Label {
  std::vector<std::string> lines;
  bool upright = false;
  double size = 0;       // of the font
  bool has_area = true;  // as the last line
};

Label Fit(const Room& room, const Vector2d& at, std::vector<std::string> lines, bool upright, const Sheet& sheet) {
  const Vector2d along = upright ? Vector2d::UnitY() : Vector2d::UnitX(), across(-along.y(), along.x());
  lines.push_back(fmt::format("{:.2f} m²", room.area_m2));
  double width = 1;
  for (const std::string& line : lines) width = std::max(width, TextWidth(line, true));
  const double rows = kLine * static_cast<double>(lines.size());
  double size = std::min(kLargest, 2 * sheet.Length(HalfSpan(room, at, across)) / rows);
  // The block of lines must fit at its upper and lower edge, too.
  for (const double edge : {-0.5, 0.0, 0.5}) {
    const Vector2d p = at + edge * rows * size / sheet.Length(1) * across;
    size = std::min(size, 0.94 * 2 * sheet.Length(HalfSpan(room, p, along)) / width);
  }
  return {std::move(lines), upright, size, true};
}

// Upright or broken lines must be worth it.
Label BestLabel(const Room& room, const Vector2d& at, const Sheet& sheet) {
  Label best = Fit(room, at, {room.name}, false, sheet);
  for (const bool upright : {false, true}) {
    for (auto& lines : {Broken(room.name), std::vector<std::string>{room.name}}) {
      Label other = Fit(room, at, lines, upright, sheet);
      if (best.size < 0.75 * kLargest && other.size > 1.25 * best.size) best = std::move(other);
    }
  }
  // A name that the source gives is written even where it reaches into the walls.
  if (best.size < kSmallest) best.size = room.guid.empty() ? 0 : kSmallest;
  return best;
}

// A label at its place on the sheet.
struct Placed {
  Label label;
  Vector2d at;

  [[nodiscard]] double SizeOf(size_t line) const { return (label.has_area && line + 1 == label.lines.size() ? 0.88 : 1) * label.size; }
  [[nodiscard]] Eigen::AlignedBox2d Box() const {
    Vector2d half(0, 0.5 * kLine * label.size * static_cast<double>(label.lines.size()));
    for (size_t i = 0; i < label.lines.size(); ++i) half.x() = std::max(half.x(), 0.5 * TextWidth(label.lines[i], true) * SizeOf(i));
    if (label.upright) half = half.reverse().eval();
    return {at - half, at + half};
  }
};

std::string Draw(const Placed& placed) {
  const Label& label = placed.label;
  const std::string x = Decimal(placed.at.x()), y = Decimal(placed.at.y());
  std::string out = label.upright ? fmt::format("<g transform=\"rotate(-90 {} {})\">", x, y) : "<g>";
  const double step = kLine * label.size;
  double baseline = placed.at.y() - 0.5 * step * static_cast<double>(label.lines.size()) + 0.8 * label.size;
  for (size_t i = 0; i < label.lines.size(); ++i, baseline += step) {
    const bool is_area = label.has_area && i + 1 == label.lines.size();
    fmt::format_to(std::back_inserter(out), "<text class=\"{}\" x=\"{}\" y=\"{}\" font-size=\"{}\">{}</text>",
                   is_area ? "room-area" : "room-name", x, Decimal(baseline), Decimal(placed.SizeOf(i)), EscapeXml(label.lines[i]));
  }
  return out + "</g>\n";
}

// Labels that do not cross, the larger ones first. One that would is moved within its room, then does without its area, then is turned;
// where nothing helps, a name that the source gives stays where it was, and a made one is left out.
class Placer {
 public:
  explicit Placer(const Sheet& sheet) : sheet_(sheet) {}

  void Place(const Room& room, const Vector2d& at_m, const Label& label) {
    const Placed wanted{label, OnSheet(at_m)};
    if (Take(wanted)) return;
    std::vector<Vector2d> points = GridOver(room);
    std::erase_if(points, [&](const Vector2d& p) { return Clearance(room, p) <= 0; });
    std::stable_sort(points.begin(), points.end(),
                     [&](const Vector2d& a, const Vector2d& b) { return (a - at_m).squaredNorm() < (b - at_m).squaredNorm(); });
    Placed bare = wanted, turned = wanted;
    bare.label.lines.pop_back();
    bare.label.has_area = false;
    turned.label = bare.label;
    turned.label.upright = !label.upright;
    for (Placed other : {wanted, bare, turned}) {
      for (const Vector2d& p : points) {
        other.at = OnSheet(p);
        if (Take(other)) return;
      }
    }
    if (!room.guid.empty()) Add(bare);
  }

  [[nodiscard]] const std::string& drawing() const { return drawing_; }

 private:
  [[nodiscard]] Vector2d OnSheet(const Vector2d& p_m) const { return {sheet_.x(p_m.x()), sheet_.y(p_m.y())}; }
  bool Take(const Placed& placed) {
    const Eigen::AlignedBox2d box = placed.Box();
    if (std::any_of(taken_.begin(), taken_.end(), [&](const Eigen::AlignedBox2d& other) { return other.intersects(box); })) return false;
    Add(placed);
    return true;
  }
  void Add(const Placed& placed) {
    taken_.push_back(placed.Box());
    drawing_ += Draw(placed);
  }

  const Sheet& sheet_;
  std::vector<Eigen::AlignedBox2d> taken_;
  std::string drawing_;
};

}  // namespace

std::string DrawRoomLabels(const AGraph& graph, StoreyId storey, const Sheet& sheet) {
  struct Wanted {
    const Room* room;
    Vector2d at_m;
    Label label;
  };
  std::vector<Wanted> wanted;
  for (const Room& room : graph.rooms) {
    if (room.storey != storey || room.polygon.empty()) continue;
    const Vector2d at_m = LabelPoint(room);
    Label label = BestLabel(room, at_m, sheet);
    if (label.size > 0) wanted.push_back({&room, at_m, std::move(label)});
  }
  std::stable_sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) { return a.label.size > b.label.size; });
  Placer placer(sheet);
  for (const Wanted& w : wanted) placer.Place(*w.room, w.at_m, w.label);
  return placer.drawing();
}

}  // namespace plumb::tools
