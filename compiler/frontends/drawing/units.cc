#include "compiler/frontends/drawing/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

struct KnownUnit {
  const char* name;
  double metres;
  bool usual;  // in which buildings are drawn
};

constexpr std::array<KnownUnit, 8> kUnits = {{{"mm", 1e-3, true},
                                              {"cm", 1e-2, true},
                                              {"dm", 0.1, false},
                                              {"m", 1.0, true},
                                              {"km", 1e3, false},
                                              {"in", 0.0254, true},
                                              {"ft", 0.3048, true},
                                              {"yd", 0.9144, false}}};
constexpr size_t kSamples = 400;
constexpr double kParallel = 1e-3;
constexpr double kContradiction = 1.5;  // of misfits: sizes wrong by more than a factor of four
constexpr double kMinPlan_m = 2, kMaxPlan_m = 3000;
constexpr double kLargestPaper_m = 4;

struct Line {
  Eigen::Vector2d a, u;
  double length;
};

std::vector<Line> LinesOf(const Drawing& drawing) {
  std::vector<Line> out;
  const bool stated = std::any_of(drawing.paths.begin(), drawing.paths.end(), [](const DrawnPath& p) { return p.role == LineRole::kWall; });
  for (const DrawnPath& path : drawing.paths) {
    if (path.curved || path.role != (stated ? LineRole::kWall : LineRole::kAny)) continue;
    const size_t sides = path.points.size() < 2 ? 0 : path.points.size() - (path.closed ? 0 : 1);
    for (size_t i = 0; i < sides; ++i) {
      const Eigen::Vector2d d = path.points[(i + 1) % path.points.size()] - path.points[i];
      if (d.norm() > 0) out.push_back({path.points[i], d.normalized(), d.norm()});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Line& a, const Line& b) { return a.length > b.length; });
  return out;
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// To the nearest parallel line beside at least half of `line`, or that has half of its own length beside it.
double DistanceToPartner(const Line& line, const std::vector<Line>& lines, double least) {
  double best = std::numeric_limits<double>::infinity();
  for (const Line& other : lines) {
    if (&other == &line || std::abs(Cross(line.u, other.u)) > kParallel) continue;
    const double distance = std::abs(Cross(line.u, other.a - line.a));
    if (distance >= best || distance < least) continue;
    const double s0 = line.u.dot(other.a - line.a), s1 = s0 + line.u.dot(other.u) * other.length;
    const double overlap = std::min(line.length, std::max(s0, s1)) - std::max(0.0, std::min(s0, s1));
    if (overlap > 0.5 * std::min(line.length, other.length)) best = distance;
  }
  return best;
}

// How far sizes are from usual ones, as a factor's logarithm.
double Misfit(const DrawnSizes& sizes, double metres, const UnitOptions& options) {
  double out = 0;
  if (sizes.wall > 0) out += std::abs(std::log(sizes.wall * metres / options.usual_wall_m));
  if (sizes.door > 0) out += 2 * std::abs(std::log(sizes.door * metres / options.usual_door_m));
  if (sizes.extent * metres < kMinPlan_m || sizes.extent * metres > kMaxPlan_m) out += 5;
  return out;
}

}  // namespace

std::optional<LengthUnit> FindUnit(const std::string& name) {
  for (const KnownUnit& unit : kUnits) {
    if (name == unit.name) return LengthUnit{unit.name, unit.metres};
  }
  return std::nullopt;
}

bool SizesHold(const DrawnSizes& sizes, double metres, const UnitOptions& options) {
  const auto within = [&](double value, double lo, double hi) { return value <= 0 || (value * metres >= lo && value * metres <= hi); };
  const bool extent = sizes.extent * metres >= kMinPlan_m && sizes.extent * metres <= kMaxPlan_m;
  return extent && within(sizes.wall, options.min_wall_m, options.max_wall_m) && within(sizes.door, options.min_door_m, options.max_door_m);
}

DrawnSizes FirmSizes(const DrawnSizes& sizes, double metres) {
  DrawnSizes out = sizes;
  if (sizes.door > 0 || sizes.extent * metres > kLargestPaper_m) out.wall = 0;
  return out;
}

std::string DescribeSizes(const DrawnSizes& sizes, const LengthUnit& unit) {
  std::string out = fmt::format("in {} the plan is {:.3g} m long", unit.name == "in" ? "inches" : unit.name, sizes.extent * unit.metres);
  if (sizes.wall > 0) out += fmt::format(", walls {:.2g} m thick", sizes.wall * unit.metres);
  if (sizes.door > 0) out += fmt::format(", doors {:.2g} m wide", sizes.door * unit.metres);
  return out;
}

DrawnSizes MeasureSizes(const Drawing& drawing) {
  DrawnSizes out;
  const std::vector<Line> lines = LinesOf(drawing);
  Eigen::AlignedBox2d box;
  for (const Line& line : lines) box.extend(line.a).extend(line.a + line.length * line.u);
  if (box.isEmpty()) {  // nothing but curves
    for (const DrawnPath& path : drawing.paths) box.extend(BoxOf(path.points));
  }
  if (box.isEmpty()) return out;
  out.extent = box.sizes().maxCoeff();
  std::vector<double> distances, radii, widths;
  for (size_t i = 0; i < std::min(kSamples, lines.size()); ++i) {
    const double d = DistanceToPartner(lines[i], lines, 1e-5 * out.extent);
    if (d < lines[i].length) distances.push_back(d);
  }
  for (const DrawnPath& path : drawing.paths) {
    if (path.role == LineRole::kWall || path.role == LineRole::kColumn) continue;
    if (path.role == LineRole::kDoor && path.closed && path.points.size() == 4)
      widths.push_back(std::max((path.points[1] - path.points[0]).norm(), (path.points[2] - path.points[1]).norm()));
    for (const Arc& arc : path.arcs) {
      if (std::abs(std::abs(arc.sweep_rad) - std::numbers::pi / 2) < 0.1) radii.push_back(arc.radius_m);
    }
  }
  out.wall = Median(std::move(distances));
  out.door = Median(std::move(radii.empty() ? widths : radii));
  return out;
}

UnitChoice ChooseUnit(const DrawnSizes& sizes, const std::optional<LengthUnit>& stated, const UnitOptions& options) {
  if (stated && (sizes.extent == 0 || SizesHold(FirmSizes(sizes, stated->metres), stated->metres, options)))
    return {*stated, true, DescribeSizes(sizes, *stated)};
  UnitChoice best;
  double best_misfit = std::numeric_limits<double>::infinity();
  for (const KnownUnit& unit : kUnits) {
    const double misfit = Misfit(sizes, unit.metres, options);
    if (!unit.usual || misfit >= best_misfit) continue;
    best_misfit = misfit;
    best.unit = {unit.name, unit.metres};
  }
  // The stated one stays where the sizes speak for no other.
  if (stated && Misfit(sizes, stated->metres, options) <= best_misfit + kContradiction)
    return {*stated, true, DescribeSizes(sizes, *stated)};
  best.stated_holds = false;
  best.reason = DescribeSizes(sizes, best.unit);
  return best;
}

}  // namespace plumb::compiler
