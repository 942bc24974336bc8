#include "compiler/emit/emit.h"

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace plumb::compiler {
namespace {

// Single precision holds 0.1 mm up to here.
constexpr double kFar_m = 1000;

std::array<uint32_t, 3> BitsOf(const Eigen::Vector3f& v) {
  const Eigen::Vector3f positive_zero = v + Eigen::Vector3f::Zero();  // -0 and 0 are one point
  return {std::bit_cast<uint32_t>(positive_zero.x()), std::bit_cast<uint32_t>(positive_zero.y()),
          std::bit_cast<uint32_t>(positive_zero.z())};
}

Eigen::Vector3d ShiftOf(const PlanIr& plan) {
  Eigen::AlignedBox3d box;
  for (const PlanElement& e : plan.elements) {
    for (const auto& v : e.body.vertices) box.extend(v);
  }
  if (box.isEmpty() || box.center().norm() < kFar_m) return Eigen::Vector3d::Zero();
  return box.center().array().round();
}

class Mover {
 public:
  explicit Mover(const Eigen::Vector3d& shift) : xyz_(shift), xy_(shift.head<2>()), z_m_(shift.z()) {}

  void Move(Eigen::Vector3d& p) const { p += xyz_; }
  void Move(Eigen::Vector2d& p) const { p += xy_; }
  void Move(Ring& ring) const {
    for (auto& p : ring) p += xy_;
  }
  void MoveHeights(double& a, double& b) const {
    a += z_m_;
    b += z_m_;
  }
  void Move(Surface& s) const {
    Move(s.start);
    Move(s.end);
    s.d_m -= s.normal.dot(xyz_);
    MoveHeights(s.z_min_m, s.z_max_m);
    if (s.arc) Move(s.arc->center);
  }
  void Move(Room& r) const {
    Move(r.polygon);
    for (Ring& hole : r.holes) Move(hole);
    Move(r.center);
    MoveHeights(r.floor_z_m, r.ceiling_z_m);
  }

 private:
  Eigen::Vector3d xyz_;
  Eigen::Vector2d xy_;
  double z_m_;
};

}  // namespace

void EmitMesh(const PlanIr& plan, AGraph& graph) {
  const Eigen::Vector3d shift = ShiftOf(plan);
  graph.origin = plan.origin + shift;
  std::map<std::array<uint32_t, 3>, uint32_t> known;
  for (uint32_t e = 0; e < plan.elements.size(); ++e) {
    const Solid& body = plan.elements[e].body;
    std::vector<uint32_t> index;
    for (const auto& v : body.vertices) {
      const Eigen::Vector3f p = (v - shift).cast<float>();
      const auto [it, fresh] = known.emplace(BitsOf(p), static_cast<uint32_t>(graph.mesh.vertices.size()));
      if (fresh) graph.mesh.vertices.push_back(p);
      index.push_back(it->second);
    }
    for (const Eigen::Vector3i& t : body.triangles) {
      const Triangle out{index[static_cast<size_t>(t[0])], index[static_cast<size_t>(t[1])], index[static_cast<size_t>(t[2])], e};
      if (out.a != out.b && out.b != out.c && out.c != out.a) graph.mesh.triangles.push_back(out);
    }
  }
}

void MoveToPlanFrame(const PlanIr& plan, AGraph& graph) {
  const Mover mover(plan.origin);
  for (Storey& s : graph.storeys) s.elevation_m += plan.origin.z();
  for (Wall& w : graph.walls) {
    mover.Move(w.axis_start);
    mover.Move(w.axis_end);
    mover.MoveHeights(w.z_min_m, w.z_max_m);
  }
  for (Surface& s : graph.surfaces) mover.Move(s);
  for (Room& r : graph.rooms) mover.Move(r);
  for (Doorway& d : graph.doorways) mover.Move(d.position);
  for (Window& w : graph.windows) mover.Move(w.position);
  for (OpenBoundary& b : graph.open_boundaries) {
    mover.Move(b.start);
    mover.Move(b.end);
  }
  for (Column& c : graph.columns) {
    mover.Move(c.outline);
    mover.MoveHeights(c.z_min_m, c.z_max_m);
  }
}

void EmitProvenance(const PlanIr& plan, const std::vector<Option>& options, const DiagnosticSink& sink, AGraph& graph) {
  graph.tool_version = PLUMB_VERSION;
  graph.source_path = plan.source_path;
  graph.source_format = plan.source_format;
  graph.source_sha256 = plan.source_sha256;
  graph.options = options;
  graph.true_north_rad = plan.true_north_rad;
  graph.diagnostics = sink.Summary();
}

}  // namespace plumb::compiler
