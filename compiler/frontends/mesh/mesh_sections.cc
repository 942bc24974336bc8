#include "compiler/frontends/mesh/mesh_sections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "compiler/frontends/mesh/mesh_marks.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUpright = 0.1;    // of the normal's z: six degrees off the vertical
constexpr double kBin_rad = 0.001;  // of the histogram of directions

double AngleOf(const Vector2d& v) {
  const double a = std::atan2(v.y(), v.x());
  return a < 0 ? a + std::numbers::pi : a >= std::numbers::pi ? a - std::numbers::pi : a;
}

double AngleBetween(double a_rad, double b_rad) {
  const double d = std::abs(a_rad - b_rad);
  return std::min(d, std::numbers::pi - d);
}

}  // namespace

std::vector<FaceSegment> CutScene(const std::vector<MeshObject>& objects, double z_m) {
  std::vector<FaceSegment> out;
  for (uint32_t o = 0; o < objects.size(); ++o) {
    const Solid& solid = objects[o].solid;
    for (const Eigen::Vector3i& t : solid.triangles) {
      FaceSegment f{{}, {}, o};
      int crossings = 0;
      for (int k = 0; k < 3; ++k) {
        const Vector3d &p = solid.vertices[static_cast<size_t>(t[k])], &q = solid.vertices[static_cast<size_t>(t[(k + 1) % 3])];
        const bool p_above = p.z() >= z_m, q_above = q.z() >= z_m;
        if (p_above == q_above) continue;
        const Vector3d &low = p_above ? q : p, &high = p_above ? p : q;
        const double ratio = (z_m - low.z()) / (high.z() - low.z());
        (p_above ? f.a : f.b) = (low + ratio * (high - low)).head<2>();
        ++crossings;
      }
      if (crossings == 2 && f.a != f.b) out.push_back(f);
    }
  }
  return out;
}

std::vector<FaceDirection> FindDirections(const std::vector<MeshObject>& objects) {
  struct Face {
    double angle_rad, area_m2;
  };
  std::vector<Face> faces;
  std::map<int, double> bins;
  for (const MeshObject& o : objects) {
    for (const Eigen::Vector3i& t : o.solid.triangles) {
      const Vector3d& p = o.solid.vertices[static_cast<size_t>(t[0])];
      const Vector3d n = (o.solid.vertices[static_cast<size_t>(t[1])] - p).cross(o.solid.vertices[static_cast<size_t>(t[2])] - p);
      const double twice_area = n.norm();
      if (!(twice_area > 0) || std::abs(n.z()) > kUpright * twice_area) continue;
      faces.push_back({AngleOf({-n.y(), n.x()}), 0.5 * twice_area});
      bins[static_cast<int>(faces.back().angle_rad / kBin_rad)] += faces.back().area_m2;
    }
  }
  std::vector<std::pair<double, int>> order;
  for (const auto& [bin, area_m2] : bins) order.emplace_back(-area_m2, bin);
  std::sort(order.begin(), order.end());
  std::vector<FaceDirection> out;
  std::vector<double> angles;
  for (const auto& [minus_area, bin] : order) {
    const double middle = (bin + 0.5) * kBin_rad;
    if (std::any_of(angles.begin(), angles.end(), [&](double a) { return AngleBetween(a, middle) < kSameDirection_rad; })) continue;
    double sum = 0, weight = 0;
    for (const Face& f : faces) {
      if (AngleBetween(f.angle_rad, middle) > kBin_rad) continue;
      double off = f.angle_rad - middle;
      if (off > 1) off -= std::numbers::pi;
      if (off < -1) off += std::numbers::pi;
      sum += off * f.area_m2;
      weight += f.area_m2;
    }
    const double angle = middle + (weight > 0 ? sum / weight : 0);
    angles.push_back(middle);
    FaceDirection d;
    d.along = {std::cos(angle), std::sin(angle)};
    d.across = {-d.along.y(), d.along.x()};
    out.push_back(d);
  }
  return out;
}

Facing FindFacing(const std::vector<FaceDirection>& directions, const SectionStack& stack, const MeshOptions& options) {
  double apart_m = 0, towards_m = 0, same_m = 0;
  for (size_t k = 0; k < stack.heights_m.size(); ++k) {
    std::vector<std::vector<Mark>> by_direction(directions.size());
    for (const FaceSegment& f : stack.segments[k]) {
      if (const auto d = DirectionOf(directions, f.b - f.a)) by_direction[*d].push_back(MarkOf(directions[*d], f, k));
    }
    for (std::vector<Mark>& marks : by_direction) {
      const std::vector<double> offsets = NumberLines(marks, options.line_tolerance_m);
      std::vector<const Mark*> pointers;
      for (const Mark& m : marks) pointers.push_back(&m);
      Sweep(pointers, [&](double s0_m, double s1_m, const std::vector<Active>& lines) {
        for (size_t i = 0; i + 1 < lines.size(); ++i) {
          const Active &a = lines[i], &b = lines[i + 1];
          const double t_m = offsets[b.line] - offsets[a.line];
          if (t_m < options.min_wall_thickness_m || t_m > options.max_wall_thickness_m) continue;
          const int sign_a = a.leaving - a.entering, sign_b = b.leaving - b.entering;
          if (sign_a < 0 && sign_b > 0) apart_m += s1_m - s0_m;
          if (sign_a > 0 && sign_b < 0) towards_m += s1_m - s0_m;
          if (sign_a * sign_b > 0) same_m += s1_m - s0_m;
        }
      });
    }
  }
  if (apart_m >= 2 * towards_m && apart_m >= 2 * same_m) return Facing::kOutward;
  if (towards_m >= 2 * apart_m && towards_m >= 2 * same_m) return Facing::kInward;
  return Facing::kUnknown;
}

}  // namespace plumb::compiler
