#include "compiler/frontends/ifc/ifc_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "compiler/geometry/b_spline.h"
#include "compiler/geometry/polyline.h"
#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxDepth = 32;
constexpr double kSamePoint_m = 1e-6;
constexpr double kTwoPi = 2 * std::numbers::pi;

bool IsConic(IfcType type) { return type == IfcType::kIfcCircle || type == IfcType::kIfcEllipse; }

Vector2d Radii(const IfcModel& model, const IfcInstance& conic) {
  if (conic.type == IfcType::kIfcCircle) return Vector2d::Constant(model.Length(conic, attribute::kCircleRadius));
  return {model.Length(conic, attribute::kEllipseAxis1), model.Length(conic, attribute::kEllipseAxis2)};
}

bool IsCurveOnSurface(IfcType type) {
  return type == IfcType::kIfcSurfaceCurve || type == IfcType::kIfcSeamCurve || type == IfcType::kIfcIntersectionCurve;
}

void Reverse(CurvePoints& curve) {
  std::reverse(curve.points.begin(), curve.points.end());
  std::reverse(curve.arcs.begin(), curve.arcs.end());
  for (Arc& arc : curve.arcs) {
    arc.start_rad += arc.sweep_rad;
    arc.sweep_rad = -arc.sweep_rad;
  }
}

void Append(const CurvePoints& from, CurvePoints& into) {
  for (const Vector3d& p : from.points) {
    if (into.points.empty() || (into.points.back() - p).norm() > kSamePoint_m) into.points.push_back(p);
  }
  into.arcs.insert(into.arcs.end(), from.arcs.begin(), from.arcs.end());
}

// In (0, 2 pi] for forward, [-2 pi, 0) else.
double Sweep(double from_rad, double to_rad, bool forward) {
  double sweep = std::fmod(forward ? to_rad - from_rad : from_rad - to_rad, kTwoPi);
  if (sweep <= 1e-9) sweep += kTwoPi;
  return forward ? sweep : -sweep;
}

bool IsSpline(IfcType type) { return type == IfcType::kIfcBSplineCurveWithKnots || type == IfcType::kIfcRationalBSplineCurveWithKnots; }

CurveTrim ReadTrim(const IfcModel& model, const PlacementReader& placements, StepValue list) {
  CurveTrim trim;
  for (const StepValue item : list.Items()) {
    if (const auto number = item.Real(); number && std::isfinite(*number)) trim.parameter = number;
    if (const IfcInstance point = model.Follow(item)) trim.point = placements.Point(point);
  }
  return trim;
}

std::vector<double> Numbers(StepValue list) {
  std::vector<double> out;
  for (const StepValue item : list.Items()) out.push_back(item.Real().value_or(0));
  return out;
}

}  // namespace

std::vector<Vector3d> CurveReader::PointList(const IfcInstance& list) const {
  std::vector<Vector3d> points;
  if (!list) return points;
  size_t bad = 0, not_finite = 0;
  for (const StepValue item : list[attribute::kPointListCoordinates].Items()) {
    Vector3d p;
    const TripleStatus status = ReadTriple(item, p);
    p *= model_.length_scale();
    const bool good = status == TripleStatus::kGood && IsCoordinate(p);
    points.push_back(good ? p : Vector3d::Zero());
    bad += good ? 0 : 1;
    not_finite += status == TripleStatus::kNotFinite || !IsNumber(p) ? 1 : 0;
  }
  if (!model_.Spend(points.size(), list.index)) return {};
  if (bad > 0) {
    model_.Emit(not_finite > 0 ? DiagnosticKind::kNumberNotFinite : DiagnosticKind::kBadAttribute, list.index,
                fmt::format("{} points of {} lie over {} m from the origin or are no numbers; they are taken as the origin", bad,
                            model_.Label(list.index), kMaxCoordinate_m));
  }
  return points;
}

bool CurveReader::TooLong(size_t points, uint32_t whole) const {
  if (points <= kMaxCurvePoints) return false;
  model_.Emit(DiagnosticKind::kPlanTooComplex, whole,
              fmt::format("{} has over {} points; at most that many are read", model_.Label(whole), kMaxCurvePoints));
  return true;
}

Ring3 CurveReader::Points(StepValue list, uint32_t whole) const {
  Ring3 points;
  points.reserve(4);  // of most loops
  for (const StepValue item : list.Items()) {
    points.push_back(placements_.Point(item));
    if (points.size() > kMaxCurvePoints) break;
  }
  if (TooLong(points.size(), whole) || !model_.Spend(points.size(), whole)) points.clear();
  return points;
}

CurvePoints CurveReader::Read(const IfcInstance& curve, int depth) const {
  CurvePoints out;
  if (!curve) return out;
  if (depth > kMaxDepth) {
    model_.Emit(DiagnosticKind::kReferenceCycle, curve.index,
                fmt::format("the curve {} contains itself or is nested more than {} deep", model_.Label(curve.index), kMaxDepth));
    return out;
  }
  if (!model_.Spend(1, curve.index)) return out;
  switch (curve.type) {
    case IfcType::kIfcPolyline: out.points = Points(curve[attribute::kPolylinePoints], curve.index); return out;
    case IfcType::kIfcIndexedPolyCurve: return Indexed(curve);
    case IfcType::kIfcCompositeCurve:
    case IfcType::kIfc2DCompositeCurve:  // IFC2X
    case IfcType::kIfcCompositeCurveOnSurface:
    case IfcType::kIfcBoundaryCurve:
    case IfcType::kIfcOuterBoundaryCurve: return Composite(curve, depth);
    case IfcType::kIfcTrimmedCurve: return Trimmed(curve, depth);
    case IfcType::kIfcCircle:
    case IfcType::kIfcEllipse: return Conic(curve, 0, kTwoPi);
    case IfcType::kIfcBSplineCurveWithKnots:
    case IfcType::kIfcRationalBSplineCurveWithKnots: return Spline(curve, {}, {});
    default: break;
  }
  model_.Emit(DiagnosticKind::kUnsupportedGeometry, curve.index,
              fmt::format("the curve {} is of a type that is not read", model_.Label(curve.index)));
  return out;
}

Ring2 CurveReader::ReadRing(const IfcInstance& curve, std::vector<Arc>* arcs) const {
  CurvePoints points = Read(curve);
  if (arcs != nullptr) arcs->insert(arcs->end(), points.arcs.begin(), points.arcs.end());
  Ring2 ring;
  for (const Vector3d& p : points.points) ring.emplace_back(p.head<2>());
  DropRepeatedPoints(kSamePoint_m, ring);
  return ring;
}

CurvePoints CurveReader::Composite(const IfcInstance& curve, int depth) const {
  CurvePoints out;
  for (const StepValue item : curve[attribute::kCompositeSegments].Items()) {
    const IfcInstance segment = model_.Follow(item);
    if (model_.is_too_complex()) return {};
    if (!segment) continue;
    CurvePoints part = Read(model_.Follow(segment[attribute::kSegmentCurve]), depth + 1);
    if (part.points.empty()) continue;
    if (!segment[attribute::kSegmentSameSense].Boolean().value_or(true)) Reverse(part);
    // Some programs state the sense wrongly: what joins on counts.
    if (!out.points.empty()) {
      const Vector3d& end = out.points.back();
      if ((part.points.front() - end).norm() > kSamePoint_m && (part.points.back() - end).norm() < 0.1 * (part.points.front() - end).norm())
        Reverse(part);
    }
    if (TooLong(out.points.size() + part.points.size(), curve.index)) return {};
    Append(part, out);
  }
  return out;
}

CurvePoints CurveReader::Trimmed(const IfcInstance& curve, int depth) const {
  CurvePoints out;
  const IfcInstance basis = model_.Follow(curve[attribute::kTrimBasis]);
  if (!basis) return out;
  const CurveTrim a = ReadTrim(model_, placements_, curve[attribute::kTrim1]), b = ReadTrim(model_, placements_, curve[attribute::kTrim2]);
  const bool sense = curve[attribute::kTrimSense].Boolean().value_or(true);
  const bool by_point = curve[attribute::kTrimMaster].Enumeration() == "CARTESIAN";
  if (IsConic(basis.type)) {
    const auto angle = [&](const CurveTrim& t) {
      if (t.point && (by_point || !t.parameter)) return AngleOnConic(basis, *t.point);
      return t.parameter.value_or(0) * model_.angle_scale();
    };
    const double start = angle(a);
    return Conic(basis, start, Sweep(start, angle(b), sense));
  }
  if (basis.type == IfcType::kIfcLine) {
    const Vector3d origin = placements_.Point(basis[attribute::kLinePoint]);
    const IfcInstance vector = model_.Follow(basis[attribute::kLineDirection]);
    const Vector3d direction =
        vector ? placements_.Direction(vector[attribute::kVectorOrientation], Vector3d::UnitX()).normalized() : Vector3d::UnitX();
    const double magnitude_m = vector ? model_.Length(vector, attribute::kVectorMagnitude, model_.length_scale()) : model_.length_scale();
    const auto at = [&](const CurveTrim& t) -> Vector3d {
      if (t.point && (by_point || !t.parameter)) return *t.point;
      return origin + direction * (t.parameter.value_or(0) * magnitude_m);
    };
    out.points = {at(a), at(b)};
    return out;
  }
  out = IsSpline(basis.type) ? Spline(basis, a, b) : Read(basis, depth + 1);
  if (a.point && b.point && out.points.size() == 2) out.points = {*a.point, *b.point};
  if (!sense) Reverse(out);
  return out;
}

double CurveReader::AngleOnConic(const IfcInstance& conic, const Vector3d& p) const {
  const Vector2d radii = Radii(model_, conic).cwiseMax(1e-9);
  const Vector3d local = placements_.AxisPlacement(conic[attribute::kConicPosition]).inverse() * p;
  return std::atan2(local.y() / radii.y(), local.x() / radii.x());
}

CurvePoints CurveReader::Conic(const IfcInstance& conic, double start_rad, double sweep_rad) const {
  CurvePoints out;
  const Vector2d radii = Radii(model_, conic);
  if (!(radii.minCoeff() > 0)) {
    model_.Emit(DiagnosticKind::kBadAttribute, conic.index,
                fmt::format("{} has a radius of {} m; must be positive", model_.Label(conic.index), radii.minCoeff()));
    return out;
  }
  const Isometry3d T = placements_.AxisPlacement(conic[attribute::kConicPosition]);
  const int steps = ArcSegments(radii.maxCoeff(), sweep_rad, chord_tolerance_m_);
  for (int i = 0; i <= steps; ++i) {
    const double angle = start_rad + sweep_rad * i / steps;
    out.points.push_back(T * Vector3d(radii.x() * std::cos(angle), radii.y() * std::sin(angle), 0));
  }
  const Vector3d z = T.linear().col(2);
  if (conic.type == IfcType::kIfcCircle && std::abs(z.z()) > 1 - 1e-9) {
    const double turned = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
    const double sign = z.z() > 0 ? 1 : -1;
    out.arcs.push_back({T.translation().head<2>(), radii.x(), turned + sign * start_rad, sign * sweep_rad});
  }
  return out;
}

void CurveReader::AddArcThrough(const Vector3d& a, const Vector3d& b, const Vector3d& c, CurvePoints& out) const {
  const Vector3d ab = b - a, ac = c - a;
  const Vector3d normal = ab.cross(ac);
  CurvePoints arc;
  if (normal.norm() <= 1e-9 * ab.norm() * ac.norm()) {
    arc.points = {a, b, c};
    Append(arc, out);
    return;
  }
  const Vector3d to_center = (ac.squaredNorm() * normal.cross(ab) - ab.squaredNorm() * normal.cross(ac)) / (2 * normal.squaredNorm());
  const Vector3d center = a + to_center;
  const double radius_m = to_center.norm();
  const Vector3d x = -to_center / radius_m, y = normal.normalized().cross(x);
  const double end_rad = std::atan2((c - center).dot(y), (c - center).dot(x));
  const double sweep_rad = Sweep(0, end_rad, true);  // the normal makes a, b, c counter-clockwise
  const int steps = ArcSegments(radius_m, sweep_rad, chord_tolerance_m_);
  for (int i = 0; i < steps; ++i) {
    const double angle = sweep_rad * i / steps;
    arc.points.push_back(center + radius_m * (std::cos(angle) * x + std::sin(angle) * y));
  }
  arc.points.push_back(c);
  const double up = normal.normalized().z();
  if (std::abs(up) > 1 - 1e-9) {
    arc.arcs.push_back({center.head<2>(), radius_m, std::atan2(x.y(), x.x()), up > 0 ? sweep_rad : -sweep_rad});
  }
  Append(arc, out);
}

CurvePoints CurveReader::Indexed(const IfcInstance& curve) const {
  CurvePoints out;
  const std::vector<Vector3d> points = PointList(model_.Follow(curve[attribute::kIndexedPoints]));
  const StepItems segments = curve[attribute::kIndexedSegments].Items();
  if (segments.empty()) {
    if (!TooLong(points.size(), curve.index)) out.points = points;
    return out;
  }
  for (const StepValue segment : segments) {
    if (TooLong(out.points.size(), curve.index)) return {};
    std::vector<Vector3d> corners;
    for (const StepValue item : segment.Inner().Items()) {
      const auto number = item.Integer();
      if (number && *number >= 1 && static_cast<uint64_t>(*number) <= points.size()) {
        corners.push_back(points[static_cast<size_t>(*number - 1)]);
      } else {
        model_.Emit(DiagnosticKind::kBadAttribute, curve.index,
                    fmt::format("a segment of {} names a point outside 1..{}", model_.Label(curve.index), points.size()));
      }
    }
    if (segment.TypeName() == "IFCARCINDEX" && corners.size() == 3) {
      AddArcThrough(corners[0], corners[1], corners[2], out);
    } else {
      Append({corners, {}}, out);
    }
  }
  return out;
}

CurvePoints CurveReader::Spline(const IfcInstance& curve, const CurveTrim& a, const CurveTrim& b) const {
  const auto degree = curve[attribute::kSplineDegree].Integer().value_or(0);
  BSpline spline;
  for (const Vector3d& p : Points(curve[attribute::kSplinePoints], curve.index)) spline.points.push_back(p.homogeneous());
  if (curve.type == IfcType::kIfcRationalBSplineCurveWithKnots) {
    const std::vector<double> weights = Numbers(curve[attribute::kSplineWeights]);
    for (size_t i = 0; i < std::min(weights.size(), spline.points.size()); ++i) spline.points[i] *= weights[i];
  }
  if (degree >= 1 && degree <= static_cast<int64_t>(kMaxSplineDegree) && spline.points.size() > static_cast<size_t>(degree)) {
    spline.degree = static_cast<size_t>(degree);
    spline.knots = ExpandKnots(Numbers(curve[attribute::kSplineKnots]), Numbers(curve[attribute::kSplineMultiplicities]), spline.degree,
                               spline.points.size());
  }
  if (spline.knots.empty()) {
    model_.Emit(DiagnosticKind::kBadAttribute, curve.index,
                fmt::format("the knots of {} do not fit to its points and degree", model_.Label(curve.index)));
    return {};
  }
  const double from = a.parameter.value_or(spline.first()), to = b.parameter.value_or(spline.last());
  CurvePoints out;
  out.points = spline.Sample(std::min(from, to), std::max(from, to), chord_tolerance_m_, kMaxCurvePoints);
  if (TooLong(out.points.size(), curve.index)) return {};
  return out;
}

Ring3 CurveReader::ReadBetween(const IfcInstance& edge_curve, const Vector3d& start, const Vector3d& end, bool same_sense) const {
  const bool on_surface = edge_curve && IsCurveOnSurface(edge_curve.type);
  const IfcInstance curve = on_surface ? model_.Follow(edge_curve[attribute::kCurve3D]) : edge_curve;
  if (curve && IsConic(curve.type)) {
    const double from = AngleOnConic(curve, start);
    Ring3 points = Conic(curve, from, Sweep(from, AngleOnConic(curve, end), same_sense)).points;
    if (points.size() >= 2) {
      points.front() = start;
      points.back() = end;
      return points;
    }
  } else if (curve && curve.type != IfcType::kIfcLine) {
    Ring3 points = Read(curve).points;
    if (points.size() >= 2) return PartOfPolyline(std::move(points), start, end, same_sense);
  }
  return {start, end};
}

}  // namespace plumb::compiler
