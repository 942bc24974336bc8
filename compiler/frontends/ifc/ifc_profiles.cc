#include "compiler/frontends/ifc/ifc_profiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxDepth = 16;
constexpr double kSamePoint_m = 1e-6;
constexpr double kClosed_m = 1e-4;  // a centre line whose ends are closer goes round
constexpr double kAlongStep = 0.9;  // cosine: an arc that goes on as the step at its end does

Ring2 Rectangle(double x_m, double y_m) { return {{-x_m / 2, -y_m / 2}, {x_m / 2, -y_m / 2}, {x_m / 2, y_m / 2}, {-x_m / 2, y_m / 2}}; }

void Transform(const Affine3d& T, Profile& profile) {
  const Eigen::Matrix2d m = T.linear().topLeftCorner<2, 2>();
  for (Ring2& ring : profile.area) {
    for (Vector2d& p : ring) p = m * p + T.translation().head<2>();
  }
  const double scale = m.col(0).norm();
  const bool is_similarity = std::abs(m.col(1).norm() - scale) < 1e-9 * scale && std::abs(m.col(0).dot(m.col(1))) < 1e-9 * scale * scale;
  if (!is_similarity) {
    profile.arcs.clear();
    return;
  }
  const double sign = m.determinant() > 0 ? 1 : -1;
  for (Arc& arc : profile.arcs) {
    const Vector2d spoke = m * Vector2d(std::cos(arc.start_rad), std::sin(arc.start_rad));
    arc.center = m * arc.center + T.translation().head<2>();
    arc.radius_m *= scale;
    arc.start_rad = std::atan2(spoke.y(), spoke.x());
    arc.sweep_rad *= sign;
  }
}

// Square to the line at one of its ends: exactly where an arc begins or ends there, else square to its first or last step.
Vector2d NormalAtEnd(const Vector2d& end, const Vector2d& step, const std::vector<Arc>& arcs) {
  const Vector2d normal = Vector2d(-step.y(), step.x()).normalized();
  for (const Arc& arc : arcs) {
    for (const double angle : {arc.start_rad, arc.start_rad + arc.sweep_rad}) {
      const Vector2d radial(std::cos(angle), std::sin(angle));
      if ((arc.center + arc.radius_m * radial - end).norm() < kSamePoint_m && std::abs(radial.dot(normal)) > kAlongStep)
        return radial.dot(normal) > 0 ? radial : Vector2d(-radial);
    }
  }
  return normal;
}

// From the line to the left side of a band at a corner, in half widths.
Vector2d Miter(const Vector2d& in, const Vector2d& out) {
  const Vector2d n_in(-in.y(), in.x()), n_out(-out.y(), out.x()), miter = n_in + n_out;
  return miter.norm() > 0.1 ? Vector2d(miter / std::max(0.25, miter.squaredNorm() / 2)) : n_in;
}

// Both sides of a band of constant width along a line with at least two points, mitred at its corners.
std::array<Ring2, 2> SidesOf(const Ring2& line, const std::vector<Arc>& arcs, double thickness_m, bool is_closed) {
  std::array<Ring2, 2> sides;
  const size_t n = line.size();
  for (size_t i = 0; i < n; ++i) {
    const bool at_end = !is_closed && (i == 0 || i + 1 == n);
    const size_t from = at_end ? std::max<size_t>(i, 1) - 1 : (i + n - 1) % n;
    const Vector2d in = (line[at_end ? from + 1 : i] - line[from]).normalized();
    const Vector2d miter = at_end ? NormalAtEnd(line[i], in, arcs) : Miter(in, (line[(i + 1) % n] - line[i]).normalized());
    sides[0].push_back(line[i] + miter * thickness_m / 2);
    sides[1].push_back(line[i] - miter * thickness_m / 2);
  }
  return sides;
}

// Whether the inner side of a closed line still goes round as the line does. One moved beyond the middle is turned inside out.
bool GoesRound(const Ring2& inner, const Ring2& line) {
  double along_m2 = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    const size_t next = (i + 1) % line.size();
    along_m2 += (inner[next] - inner[i]).dot(line[next] - line[i]);
  }
  return along_m2 > 0 && SignedArea(inner) * SignedArea(line) > 0;
}

// The band and the arcs of its sides. A closed line makes two rings; wider than what it goes round, it leaves no hole.
Profile Band(const Ring2& line, const std::vector<Arc>& arcs, double thickness_m, bool is_closed) {
  auto [left, right] = SidesOf(line, arcs, thickness_m, is_closed);
  Profile out;
  if (is_closed) {
    const bool inner_is_left = SignedArea(line) > 0;
    Ring2& inner = inner_is_left ? left : right;
    out.area.push_back(std::move(inner_is_left ? right : left));
    if (GoesRound(inner, line)) out.area.push_back(std::move(inner));
  } else {
    left.insert(left.end(), right.rbegin(), right.rend());
    out.area.push_back(std::move(left));
  }
  for (const Arc& arc : arcs) {
    for (const double offset_m : {-0.5 * thickness_m, 0.5 * thickness_m}) {
      if (arc.radius_m + offset_m > 0) out.arcs.push_back({arc.center, arc.radius_m + offset_m, arc.start_rad, arc.sweep_rad});
    }
  }
  return out;
}

}  // namespace

Profile ProfileReader::Read(const IfcInstance& profile, int depth) const {
  Profile out;
  if (!profile) return out;
  if (depth > kMaxDepth) {
    model_.Emit(DiagnosticKind::kReferenceCycle, profile.index,
                fmt::format("the profile {} contains itself or is nested more than {} deep", model_.Label(profile.index), kMaxDepth));
    return out;
  }
  if (!model_.Spend(1, profile.index)) return out;
  switch (profile.type) {
    case IfcType::kIfcArbitraryClosedProfileDef:
    case IfcType::kIfcArbitraryProfileDefWithVoids: return Arbitrary(profile);
    case IfcType::kIfcCenterLineProfileDef: return AlongCenterLine(profile);
    case IfcType::kIfcCompositeProfileDef:
      for (const StepValue item : profile[attribute::kCompositeProfiles].Items()) {
        const Profile part = Read(model_.Follow(item), depth + 1);
        out.area.insert(out.area.end(), part.area.begin(), part.area.end());
        out.arcs.insert(out.arcs.end(), part.arcs.begin(), part.arcs.end());
      }
      return out;
    case IfcType::kIfcDerivedProfileDef:
      out = Read(model_.Follow(profile[attribute::kParentProfile]), depth + 1);
      Transform(placements_.Operator(profile[attribute::kDerivedOperator]), out);
      return out;
    case IfcType::kIfcMirroredProfileDef: {
      out = Read(model_.Follow(profile[attribute::kParentProfile]), depth + 1);
      Affine3d mirror = Affine3d::Identity();
      mirror.linear()(0, 0) = -1;
      Transform(mirror, out);
      return out;
    }
    default: break;
  }
  return Parameterized(profile);
}

Profile ProfileReader::AlongCenterLine(const IfcInstance& profile) const {
  const CurvePoints curve = curves_.Read(model_.Follow(profile[attribute::kProfileCurve]));
  const double thickness_m = model_.Length(profile, attribute::kCenterLineThickness);
  Ring2 line;
  for (const Vector3d& p : curve.points) line.emplace_back(p.head<2>());
  const bool is_closed = line.size() > 3 && (line.front() - line.back()).norm() <= kClosed_m;
  if (is_closed) line.pop_back();
  DropRepeatedPoints(kSamePoint_m, line);
  if (line.size() < 2 || !(thickness_m > 0)) return {};
  return Band(line, curve.arcs, thickness_m, is_closed && line.size() > 2);
}

Profile ProfileReader::Arbitrary(const IfcInstance& profile) const {
  Profile out;
  Ring2 outer = curves_.ReadRing(model_.Follow(profile[attribute::kProfileCurve]), &out.arcs);
  if (outer.size() < 3) return {};
  out.area.push_back(std::move(outer));
  if (profile.type != IfcType::kIfcArbitraryProfileDefWithVoids) return out;
  for (const StepValue item : profile[attribute::kProfileInnerCurves].Items()) {
    Ring2 inner = curves_.ReadRing(model_.Follow(item), &out.arcs);
    if (inner.size() >= 3) out.area.push_back(std::move(inner));
  }
  return out;
}

Profile ProfileReader::Round(double x_m, double y_m, double hollow_m) const {
  Profile out;
  if (!(std::min(x_m, y_m) > 0)) return out;
  const auto ring = [&](double a, double b) {
    Ring2 points;
    const int n = ArcSegments(std::max(a, b), 2 * std::numbers::pi, chord_tolerance_m_);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      points.emplace_back(a * std::cos(angle), b * std::sin(angle));
    }
    return points;
  };
  out.area.push_back(ring(x_m, y_m));
  if (x_m == y_m) out.arcs.push_back({Vector2d::Zero(), x_m, 0, 2 * std::numbers::pi});
  if (hollow_m > 0 && hollow_m < std::min(x_m, y_m)) {
    out.area.push_back(ring(hollow_m, hollow_m));
    out.arcs.push_back({Vector2d::Zero(), hollow_m, 0, 2 * std::numbers::pi});
  }
  return out;
}

Profile ProfileReader::Parameterized(const IfcInstance& profile) const {
  Profile out;
  const double x_m = model_.Length(profile, attribute::kProfileX), y_m = model_.Length(profile, attribute::kProfileY);
  switch (profile.type) {
    case IfcType::kIfcRectangleProfileDef:
    case IfcType::kIfcRoundedRectangleProfileDef:
    case IfcType::kIfcRectangleHollowProfileDef: {
      if (x_m > 0 && y_m > 0) out.area.push_back(Rectangle(x_m, y_m));
      const bool hollow = profile.type == IfcType::kIfcRectangleHollowProfileDef;
      const double thickness_m = hollow ? model_.Length(profile, attribute::kHollowRectangleThickness) : 0;
      if (thickness_m > 0 && 2 * thickness_m < std::min(x_m, y_m))
        out.area.push_back(Rectangle(x_m - 2 * thickness_m, y_m - 2 * thickness_m));
      break;
    }
    case IfcType::kIfcCircleProfileDef: out = Round(x_m, x_m, 0); break;
    case IfcType::kIfcCircleHollowProfileDef: out = Round(x_m, x_m, x_m - model_.Length(profile, attribute::kHollowCircleThickness)); break;
    case IfcType::kIfcEllipseProfileDef: out = Round(x_m, y_m, 0); break;
    default: out.area = RolledSection(profile); break;
  }
  if (out.area.empty()) {
    model_.Emit(DiagnosticKind::kUnsupportedGeometry, profile.index,
                fmt::format("the profile {} is of a type that is not read, or its measures are not positive", model_.Label(profile.index)));
    return out;
  }
  Transform(placements_.AxisPlacement(profile[attribute::kProfilePosition]), out);
  return out;
}

Area ProfileReader::RolledSection(const IfcInstance& profile) const {
  const double a = model_.Length(profile, attribute::kShapeDim1), b = model_.Length(profile, attribute::kShapeDim2);
  const double c = model_.Length(profile, attribute::kShapeDim3), d = model_.Length(profile, attribute::kShapeDim4);
  if (!(a > 0)) return {};
  const bool has_four = b > 0 && c > 0 && d > 0;
  switch (profile.type) {
    case IfcType::kIfcTrapeziumProfileDef: {  // bottom, top, height, offset of the top's start
      if (!(b > 0 && c > 0)) return {};
      return {{{-a / 2, -c / 2}, {a / 2, -c / 2}, {-a / 2 + d + b, c / 2}, {-a / 2 + d, c / 2}}};
    }
    case IfcType::kIfcAsymmetricIShapeProfileDef:
    case IfcType::kIfcIShapeProfileDef: {  // width, depth, web, flange
      if (!has_four) return {};
      const double x = a / 2, y = b / 2, w = c / 2, f = y - d;
      return {{{-x, -y}, {x, -y}, {x, -f}, {w, -f}, {w, f}, {x, f}, {x, y}, {-x, y}, {-x, f}, {-w, f}, {-w, -f}, {-x, -f}}};
    }
    case IfcType::kIfcLShapeProfileDef: {  // depth, width (if unset, the depth), thickness
      const double y = a / 2, x = (b > 0 ? b : a) / 2;
      if (!(c > 0)) return {};
      return {{{-x, -y}, {x, -y}, {x, -y + c}, {-x + c, -y + c}, {-x + c, y}, {-x, y}}};
    }
    case IfcType::kIfcTShapeProfileDef: {  // depth, width, web, flange; the flange is on top
      if (!has_four) return {};
      const double y = a / 2, x = b / 2, w = c / 2;
      return {{{-w, -y}, {w, -y}, {w, y - d}, {x, y - d}, {x, y}, {-x, y}, {-x, y - d}, {-w, y - d}}};
    }
    case IfcType::kIfcUShapeProfileDef: {  // depth, width, web, flange
      if (!has_four) return {};
      const double y = a / 2, x = b / 2;
      return {{{-x, -y}, {x, -y}, {x, -y + d}, {-x + c, -y + d}, {-x + c, y - d}, {x, y - d}, {x, y}, {-x, y}}};
    }
    case IfcType::kIfcCShapeProfileDef: {  // depth, width, thickness, girth
      if (!has_four) return {};
      const double y = a / 2, x = b / 2, t = c, g = d;
      return {{{-x, -y},
               {x, -y},
               {x, -y + g},
               {x - t, -y + g},
               {x - t, -y + t},
               {-x + t, -y + t},
               {-x + t, y - t},
               {x - t, y - t},
               {x - t, y - g},
               {x, y - g},
               {x, y},
               {-x, y}}};
    }
    case IfcType::kIfcZShapeProfileDef: {  // depth, width, web, flange
      if (!has_four) return {};
      const double y = a / 2, x = b, w = c / 2, f = d;
      return {{{-w, -y}, {x - w, -y}, {x - w, -y + f}, {w, -y + f}, {w, y}, {-x + w, y}, {-x + w, y - f}, {-w, y - f}}};
    }
    default: return {};
  }
}

}  // namespace plumb::compiler
