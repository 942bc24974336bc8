#include "compiler/emit/emit.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>

#include "compiler/emit/freed_memory.h"

namespace plumb::compiler {
namespace {

// The triangles grow while the bodies go, and memory is given back so many times on the way: never is all there twice.
constexpr size_t kReleases = 8;
// Single precision holds 0.1 mm up to here.
constexpr double kFar_m = 1000;

// Finds the vertices of an element by their bits: a hash table of positions in the vector, with open addresses. One for each element, as a
// table of all would miss the cache at every look-up.
class VertexTable {
 public:
  explicit VertexTable(std::vector<Eigen::Vector3f>& vertices) : vertices_(vertices) {}

  // Forgets those of the element before.
  void Start(size_t max_vertices) { slots_.assign(std::bit_ceil(2 * max_vertices + 1), kEmpty); }

  // Position of `v`, which is added if it is new. -0 and 0 are one point.
  uint32_t FindOrAdd(Eigen::Vector3f v) {
    v += Eigen::Vector3f::Zero();
    uint32_t& slot = slots_[SlotOf(v)];
    if (slot == kEmpty) {
      slot = static_cast<uint32_t>(vertices_.size());
      vertices_.push_back(v);
    }
    return slot;
  }

 private:
  static constexpr uint32_t kEmpty = 0xffffffffu;

  // Where `v` is, or where it would go.
  [[nodiscard]] size_t SlotOf(const Eigen::Vector3f& v) const {
    uint64_t hash = 0;
    for (float c : {v.x(), v.y(), v.z()}) hash = (hash ^ std::bit_cast<uint32_t>(c)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
    size_t at = hash & (slots_.size() - 1);
    while (slots_[at] != kEmpty && vertices_[slots_[at]] != v) at = (at + 1) & (slots_.size() - 1);
    return at;
  }

  std::vector<Eigen::Vector3f>& vertices_;
  std::vector<uint32_t> slots_;  // their number is a power of two
};

class MeshBuilder {
 public:
  MeshBuilder(const Eigen::Vector3d& shift, Mesh& mesh) : shift_(shift), mesh_(mesh), table_(mesh.vertices) {}

  void Add(const Solid& body, uint32_t element) {
    index_.clear();
    table_.Start(body.vertices.size());
    for (const auto& v : body.vertices) index_.push_back(table_.FindOrAdd((v - shift_).cast<float>()));
    for (const Eigen::Vector3i& t : body.triangles) {
      const Triangle out{Index(t[0]), Index(t[1]), Index(t[2]), element};
      if (out.a != out.b && out.b != out.c && out.c != out.a) mesh_.triangles.push_back(out);
    }
  }

 private:
  [[nodiscard]] uint32_t Index(int vertex) const { return index_[static_cast<size_t>(vertex)]; }

  Eigen::Vector3d shift_;
  Mesh& mesh_;
  VertexTable table_;
  std::vector<uint32_t> index_;  // in the mesh, by the body's vertex
};

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

void EmitMesh(PlanIr& plan, AGraph& graph) {
  const Eigen::Vector3d shift = ShiftOf(plan);
  graph.origin = plan.origin + shift;
  size_t vertices = 0, triangles = 0;
  for (const PlanElement& e : plan.elements) {
    vertices += e.body.vertices.size();
    triangles += e.body.triangles.size();
  }
  graph.mesh.vertices.reserve(vertices);
  graph.mesh.triangles.reserve(triangles);
  MeshBuilder builder(shift, graph.mesh);
  size_t kept = 0;  // triangles of the bodies that were freed since memory was given back
  for (uint32_t e = 0; e < plan.elements.size(); ++e) {
    Solid& body = plan.elements[e].body;
    builder.Add(body, e);
    kept += body.triangles.size();
    body = {};
    if (kept * kReleases < triangles) continue;
    ReturnFreedMemory();
    kept = 0;
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
