#include "compiler/frontends/ifc/ifc_surfaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compiler/frontends/ifc/ifc_flat_rings.h"
#include "compiler/geometry/b_spline_surface.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kSeam_m = 1e-4;              // what ends where it began
constexpr size_t kMaxUnrolledPoints = 20000;  // of a face; the surface of more is not worth following
constexpr size_t kStepsPerSide = 4;
constexpr double kTwoPi = 2 * std::numbers::pi;

// Angle times radius and height. Its own radius of a surface of revolution changes with height: any will do.
struct RoundSurface {
  Isometry3d T_surface_file = Isometry3d::Identity();  // z is the axis
  double radius_m = 0;

  [[nodiscard]] Vector2d Flat(const Vector3d& p) const {
    const Vector3d q = T_surface_file * p;
    return {radius_m * std::atan2(q.y(), q.x()), q.z()};
  }
  [[nodiscard]] Vector2d Periods() const { return {kTwoPi * radius_m, 0}; }
  [[nodiscard]] bool IsPole(const Vector3d& p) const { return (T_surface_file * p).head<2>().norm() < kSeam_m; }
};

// Length along the directrix and way along the extrusion.
class ExtrudedSurface {
 public:
  ExtrudedSurface(Ring3 directrix, const Vector3d& direction) : points_(std::move(directrix)), direction_(direction) {
    along_m_.push_back(0);
    for (size_t i = 1; i < points_.size(); ++i) along_m_.push_back(along_m_.back() + Across(points_[i] - points_[i - 1]).norm());
  }

  [[nodiscard]] Vector2d Flat(const Vector3d& p) const {
    double least_m2 = std::numeric_limits<double>::infinity(), along_m = 0;
    for (size_t i = 1; i < points_.size(); ++i) {
      const Vector3d side = Across(points_[i] - points_[i - 1]), to = Across(p - points_[i - 1]);
      const double length2 = side.squaredNorm();
      const double share = length2 > 0 ? std::clamp(to.dot(side) / length2, 0.0, 1.0) : 0;
      const double off_m2 = (to - share * side).squaredNorm();
      if (off_m2 >= least_m2) continue;
      least_m2 = off_m2;
      along_m = along_m_[i - 1] + share * (along_m_[i] - along_m_[i - 1]);
    }
    return {along_m, direction_.dot(p)};
  }
  [[nodiscard]] Vector2d Periods() const { return {Across(points_.front() - points_.back()).norm() < kSeam_m ? along_m_.back() : 0, 0}; }
  [[nodiscard]] static bool IsPole(const Vector3d&) { return false; }

 private:
  [[nodiscard]] Vector3d Across(const Vector3d& v) const { return v - direction_.dot(v) * direction_; }

  Ring3 points_;
  Vector3d direction_;
  std::vector<double> along_m_;
};

// Flattens ring by ring, each point as close as the periods allow to the one before. Empty: the rings bound no area of the plane.
template <class Surface>
UnrolledFace Flatten(const IfcModel& model, const Surface& surface, const std::vector<Ring3>& rings) {
  const Vector2d periods = surface.Periods();
  std::vector<FlatRing> flat_rings;
  for (const Ring3& ring : rings) {
    FlatRing flat{{}, ring};
    for (const Vector3d& p : ring) {
      const Vector2d q = surface.Flat(p);
      flat.flat.push_back(flat.flat.empty() ? q : Vector2d(q + WholePeriods(periods, q, flat.flat.back())));
      flat.has_pole |= surface.IsPole(p);
    }
    if (!flat.flat.empty()) flat.turn = WholePeriods(periods, flat.flat.front(), flat.flat.back());
    flat_rings.push_back(std::move(flat));
  }
  if (!PlaceRings(model, periods, flat_rings)) return {};
  UnrolledFace out;
  for (FlatRing& ring : flat_rings) {
    out.rings.push_back(std::move(ring.flat));
    out.points.insert(out.points.end(), ring.points.begin(), ring.points.end());
  }
  return out;
}

std::vector<double> Numbers(StepValue list) {
  std::vector<double> out;
  for (const StepValue item : list.Items()) out.push_back(item.Real().value_or(0));
  return out;
}

// Control points by u, then v; empty for too many. A surface may have many faces: its points are counted as steps on surfaces.
std::vector<std::vector<Vector4d>> ReadControlPoints(const IfcModel& model, const PlacementReader& placements, const IfcInstance& surface) {
  constexpr size_t kStepsPerPoint = 200;
  std::vector<std::vector<Vector4d>> grid;
  size_t points = 0;
  for (const StepValue row : surface[attribute::kSurfacePoints].Items()) {
    grid.emplace_back();
    for (const StepValue item : row.Items()) {
      if (++points > kMaxCurvePoints || !model.SpendOnSurface(kStepsPerPoint)) return {};
      grid.back().push_back(placements.Point(item).homogeneous());
    }
  }
  if (surface.type != IfcType::kIfcRationalBSplineSurfaceWithKnots) return grid;
  size_t i = 0;
  for (const StepValue row : surface[attribute::kSurfaceWeights].Items()) {
    const std::vector<double> weights = Numbers(row);
    for (size_t j = 0; i < grid.size() && j < std::min(weights.size(), grid[i].size()); ++j) grid[i][j] *= weights[j];
    ++i;
  }
  return grid;
}

std::optional<BSplineSurface> ReadSpline(const IfcModel& model, const PlacementReader& placements, const IfcInstance& surface) {
  const auto direction = [&](size_t degree_at, size_t multiplicities_at, size_t knots_at, size_t points) {
    BSpline out;
    const int64_t degree = surface[degree_at].Integer().value_or(0);
    if (degree < 1 || degree > static_cast<int64_t>(kMaxSplineDegree) || points <= static_cast<size_t>(degree)) return out;
    out.degree = static_cast<size_t>(degree);
    out.points.resize(points);
    out.knots = ExpandKnots(Numbers(surface[knots_at]), Numbers(surface[multiplicities_at]), out.degree, points);
    if (!out.knots.empty() && !(out.knots[points] > out.knots[out.degree])) out.knots.clear();
    return out;
  };
  const std::vector<std::vector<Vector4d>> grid = ReadControlPoints(model, placements, surface);
  if (grid.empty() || std::any_of(grid.begin(), grid.end(), [&](const auto& row) { return row.size() != grid[0].size(); }))
    return std::nullopt;
  const BSpline u = direction(attribute::kSurfaceDegreeU, attribute::kSurfaceMultiplicitiesU, attribute::kSurfaceKnotsU, grid.size());
  const BSpline v = direction(attribute::kSurfaceDegreeV, attribute::kSurfaceMultiplicitiesV, attribute::kSurfaceKnotsV, grid[0].size());
  if (u.knots.empty() || v.knots.empty()) return std::nullopt;
  std::vector<BSpline> columns(grid[0].size(), u);
  for (size_t i = 0; i < grid.size(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) columns[j].points[i] = grid[i][j];
  }
  return BSplineSurface{std::move(columns), v};
}

// The plane that fits points best; z is square to it.
Isometry3d PlaneThrough(const std::vector<Ring3>& rings, size_t points) {
  Isometry3d T_plane_file = Isometry3d::Identity();
  Vector3d middle = Vector3d::Zero();
  for (const Ring3& ring : rings) {
    for (const Vector3d& p : ring) middle += p / static_cast<double>(points);
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Ring3& ring : rings) {
    for (const Vector3d& p : ring) spread += (p - middle) * (p - middle).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  T_plane_file.linear() = axes.eigenvectors().rowwise().reverse().transpose();
  T_plane_file.translation() = -(T_plane_file.linear() * middle);
  return T_plane_file;
}

// A face whose bounds lie in a plane needs no unrolling. Empty: they do not.
UnrolledFace UnrollPlane(const BSplineSurface& surface, const std::vector<Ring3>& rings, size_t points, double tolerance_m) {
  const Isometry3d T_plane_file = PlaneThrough(rings, points);
  UnrolledFace out;
  for (const Ring3& ring : rings) {
    out.rings.emplace_back();
    for (const Vector3d& p : ring) {
      const Vector3d q = T_plane_file * p;
      if (!(std::abs(q.z()) <= tolerance_m)) return {};
      out.rings.back().emplace_back(q.head<2>());
      out.points.push_back(p);
    }
  }
  const auto in_plane = [&](const Vector4d& p) {
    return p.w() != 0 && std::abs((T_plane_file * (p.head<3>() / p.w())).z()) <= tolerance_m;
  };
  out.is_ruled = surface.is_ruled() || std::all_of(surface.columns.begin(), surface.columns.end(), [&](const BSpline& column) {
                   return std::all_of(column.points.begin(), column.points.end(), in_plane);
                 });
  return out;
}

}  // namespace

UnrolledFace SurfaceReader::Unroll(const IfcInstance& surface, const std::vector<Ring3>& rings) const {
  UnrolledFace out;
  size_t points = 0;
  for (const Ring3& ring : rings) points += ring.size();
  if (points == 0 || points > kMaxUnrolledPoints) return out;
  const auto swept_curve = [&] {
    const IfcInstance profile = model_.Follow(surface[attribute::kSweptCurve]);
    return profile ? curves_.Read(model_.Follow(profile[attribute::kProfileCurve])).points : Ring3();
  };
  const auto position = [&] { return placements_.AxisPlacement(surface[attribute::kSweptSurfacePosition]); };
  switch (surface.type) {
    case IfcType::kIfcCylindricalSurface: {
      const double radius_m = model_.Length(surface, attribute::kCylinderSurfaceRadius);
      if (!(radius_m > 0)) return out;
      out = Flatten(model_, RoundSurface{placements_.AxisPlacement(surface[attribute::kSurfacePosition]).inverse(), radius_m}, rings);
      out.is_ruled = true;
      return out;
    }
    case IfcType::kIfcSurfaceOfRevolution: {
      const IfcInstance axis = model_.Follow(surface[attribute::kRevolvedSurfaceAxis]);
      if (!axis) return out;
      const Isometry3d T_file_surface = position();
      const Vector3d direction = T_file_surface.linear() * placements_.Direction(axis[attribute::kAxis], Vector3d::UnitZ());
      if (!(direction.norm() > 0)) return out;
      Isometry3d T_file_axis = Isometry3d::Identity();
      T_file_axis.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), direction).toRotationMatrix();
      T_file_axis.translation() = T_file_surface * placements_.Point(axis[attribute::kLocation]);
      RoundSurface round{T_file_axis.inverse(), 0};
      for (const Ring3& ring : rings) {
        for (const Vector3d& p : ring) round.radius_m = std::max(round.radius_m, (round.T_surface_file * p).head<2>().norm());
      }
      if (!(round.radius_m > 0)) return out;
      out = Flatten(model_, round, rings);
      out.is_ruled = swept_curve().size() == 2;
      return out;
    }
    case IfcType::kIfcSurfaceOfLinearExtrusion: {
      const Isometry3d T_file_surface = position();
      const Vector3d direction =
          T_file_surface.linear() * placements_.Direction(surface[attribute::kExtrudedSurfaceDirection], Vector3d::UnitZ());
      Ring3 directrix = swept_curve();
      if (directrix.size() < 2 || !(direction.norm() > 0) || !model_.SpendOnSurface(kStepsPerSide * points * directrix.size())) return out;
      for (Vector3d& p : directrix) p = T_file_surface * p;
      out = Flatten(model_, ExtrudedSurface(std::move(directrix), direction.normalized()), rings);
      out.is_ruled = true;
      return out;
    }
    case IfcType::kIfcBSplineSurfaceWithKnots:
    case IfcType::kIfcRationalBSplineSurfaceWithKnots: {
      const std::optional<BSplineSurface> spline = ReadSpline(model_, placements_, surface);
      if (!spline) return out;
      out = UnrollPlane(*spline, rings, points, plane_tolerance_m_);
      if (!out.rings.empty() || !model_.SpendOnSurface(BSplineUnroller::StepsFor(*spline, points))) return out;
      out = Flatten(model_, BSplineUnroller(*spline), rings);
      out.is_ruled = spline->is_ruled();
      return out;
    }
    default: return out;
  }
}

}  // namespace plumb::compiler
