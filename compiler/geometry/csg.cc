#include "compiler/geometry/csg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "compiler/geometry/stitch.h"

namespace plumb::compiler {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

struct Plane {
  Vector3d n = Vector3d::UnitZ();
  double d = 0;
  [[nodiscard]] double Distance(const Vector3d& p) const { return n.dot(p) + d; }
};

struct Polygon {
  std::vector<Vector3d> points;  // convex, counter-clockwise seen along -plane.n
  Plane plane;
  uint32_t tool = 0;  // of a cut, that it bounds
};
using Polygons = std::vector<Polygon>;

// Thrown across the recursion only; Run() turns it into an Error.
struct LimitReached {};

enum Relation : unsigned { kOn = 0, kFront = 1, kBack = 2, kSpanning = 3 };

struct Node {
  Plane plane;
  std::unique_ptr<Node> front, back;  // null: a leaf, outside in front and inside behind
};

class Csg {
 public:
  explicit Csg(const CsgOptions& options)
      : epsilon_m_(options.plane_epsilon_m), max_polygons_(options.max_polygons), max_depth_(options.max_depth) {}

  std::unique_ptr<Node> Build(Polygons polygons, int depth = 0) {
    if (polygons.empty()) return nullptr;
    if (depth > max_depth_) throw LimitReached();
    auto node = std::make_unique<Node>();
    node->plane = Splitter(polygons);
    Polygons front, back;
    for (Polygon& p : polygons) {
      switch (Relate(node->plane, p)) {
        case kOn: break;  // the node itself
        case kFront: front.push_back(std::move(p)); break;
        case kBack: back.push_back(std::move(p)); break;
        case kSpanning: Split(node->plane, p, front, back); break;
      }
    }
    polygons.clear();
    node->front = Build(std::move(front), depth + 1);
    node->back = Build(std::move(back), depth + 1);
    return node;
  }

  // Keeps the fragments of `polygon` that bound a - b as faces of a: those with space outside of b just behind them.
  // Returns whether all of it was kept.
  bool KeepOutside(const Node* node, bool leaf_is_inside, Polygon polygon, Polygons& kept) {
    if (node == nullptr) {
      if (!leaf_is_inside) Add(std::move(polygon), kept);
      return !leaf_is_inside;
    }
    Polygons front, back;
    switch (Relate(node->plane, polygon)) {
      case kOn:
        if (polygon.plane.n.dot(node->plane.n) > 0) return KeepOutside(node->back.get(), true, std::move(polygon), kept);
        return KeepOutside(node->front.get(), false, std::move(polygon), kept);
      case kFront: return KeepOutside(node->front.get(), false, std::move(polygon), kept);
      case kBack: return KeepOutside(node->back.get(), true, std::move(polygon), kept);
      case kSpanning: Split(node->plane, polygon, front, back); break;
    }
    bool all = true;
    for (Polygon& p : front) all &= KeepOutside(node->front.get(), false, std::move(p), kept);
    for (Polygon& p : back) all &= KeepOutside(node->back.get(), true, std::move(p), kept);
    return all;
  }

  // Keeps the fragments that lie in the inside of the solid, with the inside on both of their sides.
  bool KeepInside(const Node* node, bool leaf_is_inside, Polygon polygon, Polygons& kept) {
    if (node == nullptr) {
      if (leaf_is_inside) Add(std::move(polygon), kept);
      return leaf_is_inside;
    }
    Polygons front, back;
    switch (Relate(node->plane, polygon)) {
      case kOn: {
        bool all = KeepInside(node->front.get(), false, std::move(polygon), front);
        for (Polygon& p : front) all &= KeepInside(node->back.get(), true, std::move(p), kept);
        return all;
      }
      case kFront: return KeepInside(node->front.get(), false, std::move(polygon), kept);
      case kBack: return KeepInside(node->back.get(), true, std::move(polygon), kept);
      case kSpanning: Split(node->plane, polygon, front, back); break;
    }
    bool all = true;
    for (Polygon& p : front) all &= KeepInside(node->front.get(), false, std::move(p), kept);
    for (Polygon& p : back) all &= KeepInside(node->back.get(), true, std::move(p), kept);
    return all;
  }

 private:
  unsigned Relate(const Plane& plane, const Polygon& polygon) const {
    unsigned sides = kOn;
    for (const Vector3d& p : polygon.points) {
      const double distance = plane.Distance(p);
      sides |= distance > epsilon_m_ ? kFront : distance < -epsilon_m_ ? kBack : kOn;
    }
    return sides;
  }

  void Split(const Plane& plane, const Polygon& polygon, Polygons& front, Polygons& back) {
    Polygon f, b;
    f.plane = b.plane = polygon.plane;
    f.tool = b.tool = polygon.tool;
    const size_t n = polygon.points.size();
    for (size_t i = 0; i < n; ++i) {
      const Vector3d& p = polygon.points[i];
      const Vector3d& q = polygon.points[(i + 1) % n];
      const double dp = plane.Distance(p), dq = plane.Distance(q);
      if (dp >= -epsilon_m_) f.points.push_back(p);
      if (dp <= epsilon_m_) b.points.push_back(p);
      const bool crosses = (dp > epsilon_m_ && dq < -epsilon_m_) || (dp < -epsilon_m_ && dq > epsilon_m_);
      if (!crosses) continue;
      const Vector3d middle = p + (q - p) * (dp / (dp - dq));
      f.points.push_back(middle);
      b.points.push_back(middle);
    }
    if (f.points.size() >= 3) Add(std::move(f), front);
    if (b.points.size() >= 3) Add(std::move(b), back);
  }

  void Add(Polygon polygon, Polygons& to) const {
    if (to.size() >= max_polygons_) throw LimitReached();
    to.push_back(std::move(polygon));
  }

  // Of some candidates spread over the list, the plane that splits few polygons and leaves both sides alike.
  Plane Splitter(const Polygons& polygons) const {
    constexpr size_t kCandidates = 5, kSample = 200;
    size_t best = 0;
    double best_cost = 1e300;
    const size_t step = std::max<size_t>(1, polygons.size() / kCandidates);
    const size_t sample_step = std::max<size_t>(1, polygons.size() / kSample);
    for (size_t c = 0; c < polygons.size(); c += step) {
      double front = 0, back = 0, split = 0;
      for (size_t i = 0; i < polygons.size(); i += sample_step) {
        switch (Relate(polygons[c].plane, polygons[i])) {
          case kFront: ++front; break;
          case kBack: ++back; break;
          case kSpanning: ++split; break;
          default: break;
        }
      }
      const double cost = 8 * split + std::abs(front - back);
      if (cost < best_cost) {
        best_cost = cost;
        best = c;
      }
    }
    return polygons[best].plane;
  }

  double epsilon_m_;
  size_t max_polygons_;
  int max_depth_;
};

// Triangles thinner than the planes have no plane of their own and bound nothing.
Polygons ToPolygons(const Solid& solid, const Vector3d& origin, double epsilon_m) {
  Polygons out;
  out.reserve(solid.triangles.size());
  for (const Eigen::Vector3i& t : solid.triangles) {
    Polygon p;
    for (int k = 0; k < 3; ++k) p.points.push_back(solid.vertices[static_cast<size_t>(t[k])] - origin);
    const Vector3d a = p.points[1] - p.points[0], b = p.points[2] - p.points[0];
    const Vector3d normal = a.cross(b);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    const double twice_area = normal.norm();
    if (!(twice_area > epsilon_m * longest)) continue;
    p.plane.n = normal / twice_area;
    p.plane.d = -p.plane.n.dot((p.points[0] + p.points[1] + p.points[2]) / 3);
    out.push_back(std::move(p));
  }
  return out;
}

Solid ToSolid(Polygons polygons, const Vector3d& origin, double epsilon_m) {
  std::vector<Ring3> rings;
  rings.reserve(polygons.size());
  for (Polygon& p : polygons) rings.push_back(std::move(p.points));
  // Cuts by different planes meet within the planes' thickness, not in one point.
  Solid solid = StitchPolygons(rings, 2 * epsilon_m);
  for (Vector3d& v : solid.vertices) v += origin;
  return solid;
}

AlignedBox3d BoundsOf(const Polygons& polygons) {
  AlignedBox3d box;
  for (const Polygon& p : polygons) {
    for (const Vector3d& v : p.points) box.extend(v);
  }
  return box;
}

bool Overlaps(const Polygon& polygon, const AlignedBox3d& box) {
  AlignedBox3d own;
  for (const Vector3d& v : polygon.points) own.extend(v);
  return own.intersects(box);
}

AlignedBox3d Grown(AlignedBox3d box, double margin_m) {
  box.min().array() -= margin_m;
  box.max().array() += margin_m;
  return box;
}

struct Tools {
  Polygons faces;
  std::vector<AlignedBox3d> boxes;  // with the planes' thickness around
};

Tools ToTools(std::span<const Solid* const> solids, const Vector3d& origin, double epsilon_m) {
  Tools out;
  for (const Solid* solid : solids) {
    Polygons faces = ToPolygons(*solid, origin, epsilon_m);
    for (Polygon& p : faces) p.tool = static_cast<uint32_t>(out.boxes.size());
    out.boxes.push_back(Grown(BoundsOf(faces), epsilon_m));
    out.faces.insert(out.faces.end(), std::make_move_iterator(faces.begin()), std::make_move_iterator(faces.end()));
  }
  return out;
}

// A face that is not all left was cut by a tool's face within the solid, unless a tool holds all of it.
void MarkTheToolAround(const Polygon& face, const Tools& tools, std::vector<bool>& cuts) {
  AlignedBox3d box;
  for (const Vector3d& v : face.points) box.extend(v);
  for (size_t t = 0; t < tools.boxes.size(); ++t) {
    if (tools.boxes[t].contains(box)) cuts[t] = true;
  }
}

Expected<DifferenceOfMany> Run(const Solid& a, std::span<const Solid* const> solids, bool close, const CsgOptions& options) {
  if (std::string problem = options.Check(); !problem.empty()) return Fail(ErrorCode::kBadOption, std::move(problem));
  DifferenceOfMany out;
  out.cuts.resize(solids.size());
  const auto unchanged = [&] {
    out.rest = a;
    return std::move(out);
  };
  if (a.empty()) return unchanged();
  const double epsilon_m = options.plane_epsilon_m;
  const Vector3d origin = Bounds(a).center();
  Polygons faces_a = ToPolygons(a, origin, epsilon_m);
  const Tools tools = ToTools(solids, origin, epsilon_m);
  const AlignedBox3d box_a = Grown(BoundsOf(faces_a), epsilon_m), box_b = Grown(BoundsOf(tools.faces), epsilon_m);
  if (!box_a.intersects(box_b)) return unchanged();
  try {
    Csg csg(options);
    const std::unique_ptr<Node> tree_b = csg.Build(tools.faces);
    if (tree_b == nullptr) return unchanged();
    Polygons kept;
    bool untouched = true;
    for (const Polygon& p : faces_a) {
      const size_t before = kept.size();
      bool all = true;
      if (Overlaps(p, box_b)) all = csg.KeepOutside(tree_b.get(), false, p, kept);
      if (all) {
        kept.resize(before);  // its fragments, if any: the polygon itself will do
        kept.push_back(p);
      }
      if (!all) MarkTheToolAround(p, tools, out.cuts);
      untouched &= all;
    }
    if (close) {
      const std::unique_ptr<Node> tree_a = csg.Build(std::move(faces_a));
      for (const Polygon& p : tools.faces) {
        if (!Overlaps(p, box_a)) continue;
        Polygons inside;
        if (csg.KeepInside(tree_a.get(), false, p, inside)) inside.assign(1, p);
        for (Polygon& piece : inside) {
          std::reverse(piece.points.begin(), piece.points.end());
          out.cuts[piece.tool] = true;
          kept.push_back(std::move(piece));
          untouched = false;
        }
      }
    }
    if (untouched) return unchanged();
    out.rest = ToSolid(std::move(kept), origin, epsilon_m);
    return out;
  } catch (const LimitReached&) {
    return Fail(ErrorCode::kInternal,
                fmt::format("the difference of solids of {} and {} triangles needs more than {} polygons or {} levels", a.triangles.size(),
                            tools.faces.size(), options.max_polygons, options.max_depth));
  }
}

Expected<Solid> RunOne(const Solid& a, const Solid& b, bool close, const CsgOptions& options) {
  const Solid* tool = &b;
  return Run(a, {&tool, 1}, close, options).map([](DifferenceOfMany&& difference) { return std::move(difference.rest); });
}

}  // namespace

std::string CsgOptions::Check() const {
  if (!(plane_epsilon_m > 0) || plane_epsilon_m > 1e-2)
    return fmt::format("CsgOptions.plane_epsilon_m = {}; must be in (0, 0.01]", plane_epsilon_m);
  if (max_polygons == 0) return "CsgOptions.max_polygons = 0; must be positive";
  if (max_depth <= 0 || max_depth > 10000) return fmt::format("CsgOptions.max_depth = {}; must be in 1..10000", max_depth);
  return {};
}

Expected<Solid> Subtract(const Solid& a, const Solid& b, const CsgOptions& options) { return RunOne(a, b, true, options); }

Expected<DifferenceOfMany> SubtractAll(const Solid& a, std::span<const Solid* const> tools, const CsgOptions& options) {
  return Run(a, tools, true, options);
}

Expected<Solid> ClipOutside(const Solid& a, const Solid& b, const CsgOptions& options) { return RunOne(a, b, false, options); }

Expected<Solid> CutByPlane(const Solid& a, const Vector3d& n, double d_m, const CsgOptions& options) {
  if (a.empty()) return a;
  // A box on the plane's positive side that covers all of a.
  const AlignedBox3d box = Bounds(a);
  const double reach_m = box.diagonal().norm() + 1;
  const Vector3d center = box.center() - (n.dot(box.center()) + d_m) * n;
  Eigen::Affine3d T_out_plane = Eigen::Affine3d::Identity();
  const Vector3d u = n.unitOrthogonal();
  T_out_plane.linear() << u, n.cross(u), n;
  T_out_plane.translation() = center;
  const double depth_m = reach_m + std::abs(n.dot(box.center()) + d_m);
  return RunOne(a, MakeBox({-reach_m, -reach_m, 0}, {reach_m, reach_m, depth_m}, T_out_plane), true, options);
}

}  // namespace plumb::compiler
