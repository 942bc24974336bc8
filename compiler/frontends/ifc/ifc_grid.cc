#include "compiler/frontends/ifc/ifc_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/frontends/ifc/ifc_placement.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kChordTolerance_m = 1e-4;
constexpr double kMinSegment_m = 1e-6;

// A point where two axes meet, in the grid's plane.
struct Meeting {
  Vector3d point = Vector3d::Zero();
  Vector2d tangent = Vector2d::UnitX();  // of the first axis
};

// A piece of an axis, moved aside.
struct Segment {
  Vector2d start, direction;  // the direction has length 1
  double length_m;
};

std::vector<Segment> SegmentsAside(const CurvePoints& curve, double offset_m) {
  std::vector<Segment> out;
  for (size_t i = 1; i < curve.points.size(); ++i) {
    const Vector2d start = curve.points[i - 1].head<2>(), along = curve.points[i].head<2>() - start;
    const double length_m = along.norm();
    if (length_m < kMinSegment_m) continue;
    const Vector2d direction = along / length_m;
    out.push_back({start + offset_m * Vector2d(-direction.y(), direction.x()), direction, length_m});  // positive to the left
  }
  return out;
}

double Beyond(double at_m, const Segment& segment) { return std::max({0.0, -at_m, at_m - segment.length_m}); }

// Axes end where the drawing has it, and arcs moved aside leave gaps: of all pairs of segments the one that has to be drawn out least.
std::optional<Meeting> Meet(const std::vector<Segment>& first, const std::vector<Segment>& second) {
  constexpr double kParallel = 1e-9;
  std::optional<Meeting> best;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Segment& a : first) {
    for (const Segment& b : second) {
      const auto cross = [](const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); };
      const double sine = cross(a.direction, b.direction);
      if (std::abs(sine) < kParallel) continue;
      const Vector2d between = b.start - a.start;
      const double on_a_m = cross(between, b.direction) / sine, on_b_m = cross(between, a.direction) / sine;
      const double beyond_m = Beyond(on_a_m, a) + Beyond(on_b_m, b);
      if (!(beyond_m < least_m)) continue;
      least_m = beyond_m;
      const Vector2d at = a.start + on_a_m * a.direction;
      best = Meeting{{at.x(), at.y(), 0}, a.direction};
    }
  }
  return best;
}

std::optional<Meeting> ReadIntersection(const IfcModel& model, const IfcInstance& intersection, const CurveReader& curves) {
  if (!intersection || intersection.type != IfcType::kIfcVirtualGridIntersection) return std::nullopt;
  std::vector<double> offsets_m;
  for (const StepValue offset : intersection[attribute::kGridOffsets].Items()) {
    offsets_m.push_back(offset.Real().value_or(0) * model.length_scale());
  }
  offsets_m.resize(3, 0.0);
  std::vector<std::vector<Segment>> axes;
  for (const StepValue item : intersection[attribute::kIntersectingAxes].Items()) {
    const IfcInstance axis = model.Follow(item);
    if (!axis || axis.type != IfcType::kIfcGridAxis || axes.size() == 2) return std::nullopt;
    CurvePoints curve = curves.Read(model.Follow(axis[attribute::kGridAxisCurve]));
    if (!axis[attribute::kGridAxisSameSense].Boolean().value_or(true)) std::reverse(curve.points.begin(), curve.points.end());
    axes.push_back(SegmentsAside(curve, offsets_m[axes.size()]));
  }
  if (axes.size() != 2 || !model.Spend(axes[0].size() * axes[1].size(), intersection.index)) return std::nullopt;
  std::optional<Meeting> meeting = Meet(axes[0], axes[1]);
  if (meeting) meeting->point.z() = offsets_m[2];
  return meeting;
}

// From IFC4X3 on what it is relative to comes first.
size_t FirstOwnAttribute(const IfcModel& model, const IfcInstance& grid_placement) {
  const IfcInstance first = model.Follow(grid_placement[0]);
  return first && first.type == IfcType::kIfcVirtualGridIntersection ? 0 : 1;
}

}  // namespace

GridReader::GridReader(const IfcModel& model) : model_(model) {
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcGrid)) {
    const IfcInstance grid = model.Get(index);
    for (const size_t axes : {attribute::kGridUAxes, attribute::kGridVAxes, attribute::kGridWAxes}) {
      for (const StepValue item : grid[axes].Items()) {
        if (const IfcInstance axis = model.Follow(item)) grid_of_axis_.emplace(axis.index, index);
      }
    }
  }
}

IfcInstance GridReader::ParentOf(const IfcInstance& grid_placement) const {
  const size_t own = FirstOwnAttribute(model_, grid_placement);
  if (own == 1 && !grid_placement[attribute::kPlacementRelTo].is_null()) return model_.Follow(grid_placement[attribute::kPlacementRelTo]);
  const IfcInstance intersection = model_.Follow(grid_placement[own]);
  if (!intersection || intersection.type != IfcType::kIfcVirtualGridIntersection) return {};
  for (const StepValue axis : intersection[attribute::kIntersectingAxes].Items()) {
    const auto grid = grid_of_axis_.find(model_.Resolve(axis));
    if (grid != grid_of_axis_.end()) return model_.Follow(model_.Get(grid->second)[attribute::kPlacement]);
  }
  return {};
}

std::optional<Isometry3d> GridReader::Read(const IfcInstance& grid_placement, const PlacementReader& placements) const {
  const CurveReader curves(model_, placements, kChordTolerance_m);
  const size_t own = FirstOwnAttribute(model_, grid_placement);
  const std::optional<Meeting> origin = ReadIntersection(model_, model_.Follow(grid_placement[own]), curves);
  if (!origin || !IsCoordinate(origin->point)) return std::nullopt;
  Vector2d x = origin->tangent;
  const StepValue reference = grid_placement[own + 1];
  if (const IfcInstance toward = model_.Follow(reference)) {
    const std::optional<Meeting> other = ReadIntersection(model_, toward, curves);
    const Vector2d direction = other ? Vector2d((other->point - origin->point).head<2>())
                                     : Vector2d(placements.Direction(reference, {x.x(), x.y(), 0}).head<2>());
    if (direction.norm() > kMinSegment_m) x = direction.normalized();
  }
  Isometry3d T = Isometry3d::Identity();
  T.linear().col(0) << x.x(), x.y(), 0;
  T.linear().col(1) << -x.y(), x.x(), 0;
  T.translation() = origin->point;
  return T;
}

}  // namespace plumb::compiler
