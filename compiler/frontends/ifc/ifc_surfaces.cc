#include "compiler/frontends/ifc/ifc_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "compiler/geometry/b_spline.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kSeam_m = 1e-4;  // what ends where it began
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

 private:
  [[nodiscard]] Vector3d Across(const Vector3d& v) const { return v - direction_.dot(v) * direction_; }

  Ring3 points_;
  Vector3d direction_;
  std::vector<double> along_m_;
};

// The parameters of the nearest point, times the size of the surface.
class SplineSurface {
 public:
  // One curve along u for each row of control points along v.
  SplineSurface(std::vector<BSpline> columns, BSpline across) : columns_(std::move(columns)), across_(std::move(across)) {
    nodes_u_ = NodesOf(columns_.front());
    nodes_v_ = NodesOf(across_);
    for (const double u : nodes_u_) {
      for (const double v : nodes_v_) nodes_.push_back(At(u, v));
    }
    scale_ = {LengthOver(nodes_v_.size(), 1) / (nodes_u_.back() - nodes_u_.front()),
              LengthOver(1, nodes_v_.size()) / (nodes_v_.back() - nodes_v_.front())};
  }

  [[nodiscard]] size_t num_nodes() const { return nodes_.size(); }
  [[nodiscard]] bool is_ruled() const { return columns_.front().degree == 1 || across_.degree == 1; }

  [[nodiscard]] Vector2d Flat(const Vector3d& p) const {
    const auto nearest = std::min_element(
        nodes_.begin(), nodes_.end(), [&](const Vector3d& a, const Vector3d& b) { return (a - p).squaredNorm() < (b - p).squaredNorm(); });
    const auto node = static_cast<size_t>(nearest - nodes_.begin());
    return Refine(p, {nodes_u_[node / nodes_v_.size()], nodes_v_[node % nodes_v_.size()]}).cwiseProduct(scale_);
  }

  [[nodiscard]] Vector2d Periods() const {
    Vector2d range(nodes_u_.back() - nodes_u_.front(), nodes_v_.back() - nodes_v_.front());
    const size_t n = nodes_v_.size();
    for (size_t k = 0; k < n; ++k) {
      if ((nodes_[k] - nodes_[nodes_.size() - n + k]).norm() > kSeam_m) range.x() = 0;
    }
    for (size_t k = 0; k < nodes_.size(); k += n) {
      if ((nodes_[k] - nodes_[k + n - 1]).norm() > kSeam_m) range.y() = 0;
    }
    return range.cwiseProduct(scale_);
  }

 private:
  static std::vector<double> NodesOf(const BSpline& spline) {
    constexpr size_t kInSpan = 8, kMost = 64;
    const size_t steps = std::min(kMost, kInSpan * (spline.points.size() - spline.degree));
    const double low = spline.knots[spline.degree], high = spline.knots[spline.points.size()];
    std::vector<double> out;
    for (size_t i = 0; i <= steps; ++i) out.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(steps));
    return out;
  }

  // Of the longest line of nodes with this distance from one to the next in `nodes_`, lines beginning `next` apart.
  [[nodiscard]] double LengthOver(size_t step, size_t next) const {
    const size_t in_line = (step == 1 ? nodes_v_ : nodes_u_).size(), lines = nodes_.size() / in_line;
    double out = 0;
    for (size_t line = 0; line < lines; ++line) {
      double length_m = 0;
      for (size_t k = 1; k < in_line; ++k) length_m += (nodes_[line * next + k * step] - nodes_[line * next + (k - 1) * step]).norm();
      out = std::max(out, length_m);
    }
    return out;
  }

  [[nodiscard]] Vector3d At(double u, double v) const {
    BSpline row = across_;
    for (size_t j = 0; j < columns_.size(); ++j) row.points[j] = columns_[j].HomogeneousAt(u);
    return row.At(v);
  }

  // Gauss-Newton from the nearest node.
  [[nodiscard]] Vector2d Refine(const Vector3d& p, Vector2d at) const {
    constexpr int kMaxSteps = 10;
    constexpr double kDifference = 1e-6, kDone = 1e-9;  // shares of the range
    const Vector2d low(nodes_u_.front(), nodes_v_.front()), high(nodes_u_.back(), nodes_v_.back()), range = high - low;
    for (int step = 0; step < kMaxSteps; ++step) {
      const Vector3d off = p - At(at.x(), at.y());
      Eigen::Matrix<double, 3, 2> J;
      for (int k = 0; k < 2; ++k) {
        Vector2d beside = at;
        const double sign = at[k] + kDifference * range[k] > high[k] ? -1 : 1;
        beside[k] += sign * kDifference * range[k];
        J.col(k) = (At(beside.x(), beside.y()) - At(at.x(), at.y())) / (sign * kDifference);
      }
      const Eigen::Matrix2d H = J.transpose() * J;
      if (!(std::abs(H.determinant()) > 1e-12 * H.squaredNorm())) break;
      const Vector2d before = at;
      at = (at + (H.inverse() * J.transpose() * off).cwiseProduct(range)).cwiseMax(low).cwiseMin(high);
      if (((at - before).cwiseQuotient(range)).norm() < kDone) break;
    }
    return at;
  }

  std::vector<BSpline> columns_;
  BSpline across_;
  std::vector<double> nodes_u_, nodes_v_;
  std::vector<Vector3d> nodes_;  // by u, then v
  Vector2d scale_ = Vector2d::Ones();
};

// Flattens ring by ring: each point as close as the periods allow to the one before, each inner ring to the middle of the outer one.
template <class Surface>
std::vector<Ring2> Flatten(const Surface& surface, const std::vector<Ring3>& rings) {
  const Vector2d periods = surface.Periods();
  const auto shift = [&](const Vector2d& from, const Vector2d& to) {
    Vector2d out = Vector2d::Zero();
    for (int k = 0; k < 2; ++k) {
      if (periods[k] > 0) out[k] = periods[k] * std::round((to[k] - from[k]) / periods[k]);
    }
    return out;
  };
  const auto middle = [](const Ring2& ring) {
    Eigen::AlignedBox2d box;
    for (const Vector2d& p : ring) box.extend(p);
    return Vector2d(box.center());
  };
  std::vector<Ring2> out;
  for (const Ring3& ring : rings) {
    Ring2 flat;
    for (const Vector3d& p : ring) {
      const Vector2d q = surface.Flat(p);
      flat.push_back(flat.empty() ? q : Vector2d(q + shift(q, flat.back())));
    }
    const Vector2d by = out.empty() ? Vector2d(Vector2d::Zero()) : shift(middle(flat), middle(out[0]));
    for (Vector2d& p : flat) p += by;
    out.push_back(std::move(flat));
  }
  return out;
}

std::vector<double> Numbers(StepValue list) {
  std::vector<double> out;
  for (const StepValue item : list.Items()) out.push_back(item.Real().value_or(0));
  return out;
}

std::optional<SplineSurface> ReadSpline(const IfcModel& model, const CurveReader& curves, const IfcInstance& surface) {
  constexpr int64_t kMaxDegree = 16;
  std::vector<std::vector<Vector4d>> grid;  // by u, then v
  for (const StepValue row : surface[attribute::kSurfacePoints].Items()) {
    grid.emplace_back();
    for (const Vector3d& p : curves.Points(row, surface.index)) grid.back().push_back(p.homogeneous());
    if (grid.size() * grid.back().size() > kMaxCurvePoints) return std::nullopt;
  }
  if (surface.type == IfcType::kIfcRationalBSplineSurfaceWithKnots) {
    size_t i = 0;
    for (const StepValue row : surface[attribute::kSurfaceWeights].Items()) {
      const std::vector<double> weights = Numbers(row);
      for (size_t j = 0; i < grid.size() && j < std::min(weights.size(), grid[i].size()); ++j) grid[i][j] *= weights[j];
      ++i;
    }
  }
  const auto direction = [&](size_t degree_at, size_t multiplicities_at, size_t knots_at, size_t points) {
    BSpline out;
    const int64_t degree = surface[degree_at].Integer().value_or(0);
    if (degree < 1 || degree > kMaxDegree || points <= static_cast<size_t>(degree)) return out;
    out.degree = static_cast<size_t>(degree);
    out.points.resize(points);
    out.knots = ExpandKnots(Numbers(surface[knots_at]), Numbers(surface[multiplicities_at]), out.degree, points);
    if (!out.knots.empty() && !(out.knots[points] > out.knots[out.degree])) out.knots.clear();
    return out;
  };
  if (grid.empty() || std::any_of(grid.begin(), grid.end(), [&](const auto& row) { return row.size() != grid[0].size(); }))
    return std::nullopt;
  const BSpline u = direction(attribute::kSurfaceDegreeU, attribute::kSurfaceMultiplicitiesU, attribute::kSurfaceKnotsU, grid.size());
  const BSpline v = direction(attribute::kSurfaceDegreeV, attribute::kSurfaceMultiplicitiesV, attribute::kSurfaceKnotsV, grid[0].size());
  if (u.knots.empty() || v.knots.empty()) return std::nullopt;
  std::vector<BSpline> columns(grid[0].size(), u);
  for (size_t i = 0; i < grid.size(); ++i) {
    for (size_t j = 0; j < columns.size(); ++j) columns[j].points[i] = grid[i][j];
  }
  constexpr size_t kNodes = 65 * 65;
  if (!model.Spend(kNodes * columns.size(), surface.index)) return std::nullopt;
  return SplineSurface(std::move(columns), v);
}

}  // namespace

UnrolledFace SurfaceReader::Unroll(const IfcInstance& surface, const std::vector<Ring3>& rings) const {
  UnrolledFace out;
  size_t points = 0;
  for (const Ring3& ring : rings) points += ring.size();
  const auto swept_curve = [&] {
    const IfcInstance profile = model_.Follow(surface[attribute::kSweptCurve]);
    return profile ? curves_.Read(model_.Follow(profile[attribute::kProfileCurve])).points : Ring3();
  };
  const auto position = [&] { return placements_.AxisPlacement(surface[attribute::kSweptSurfacePosition]); };
  switch (surface.type) {
    case IfcType::kIfcCylindricalSurface: {
      const double radius_m = model_.Length(surface, attribute::kCylinderSurfaceRadius);
      if (!(radius_m > 0)) return out;
      out.rings = Flatten(RoundSurface{placements_.AxisPlacement(surface[attribute::kSurfacePosition]).inverse(), radius_m}, rings);
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
      out.rings = Flatten(round, rings);
      out.is_ruled = swept_curve().size() == 2;
      return out;
    }
    case IfcType::kIfcSurfaceOfLinearExtrusion: {
      const Isometry3d T_file_surface = position();
      const Vector3d direction =
          T_file_surface.linear() * placements_.Direction(surface[attribute::kExtrudedSurfaceDirection], Vector3d::UnitZ());
      Ring3 directrix = swept_curve();
      if (directrix.size() < 2 || !(direction.norm() > 0) || !model_.Spend(points * directrix.size(), surface.index)) return out;
      for (Vector3d& p : directrix) p = T_file_surface * p;
      out.rings = Flatten(ExtrudedSurface(std::move(directrix), direction.normalized()), rings);
      out.is_ruled = true;
      return out;
    }
    case IfcType::kIfcBSplineSurfaceWithKnots:
    case IfcType::kIfcRationalBSplineSurfaceWithKnots: {
      const std::optional<SplineSurface> spline = ReadSpline(model_, curves_, surface);
      if (!spline || !model_.Spend(points * spline->num_nodes(), surface.index)) return out;
      out.rings = Flatten(*spline, rings);
      out.is_ruled = spline->is_ruled();
      return out;
    }
    default: return out;
  }
}

}  // namespace plumb::compiler
