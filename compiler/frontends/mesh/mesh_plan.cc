#include "compiler/frontends/mesh/mesh_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "compiler/frontends/mesh/mesh_levels.h"
#include "compiler/frontends/mesh/mesh_names.h"
#include "compiler/frontends/mesh/mesh_sections.h"
#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNamedShare = 0.4;  // of the upright area in objects that are named walls: then these are the walls
constexpr double kSkin_m = 0.02;     // triangles this close to a wall's box are its faces
constexpr double kFloorSlack_m = 0.15, kLevel = 0.9;
constexpr double kMaxDoorSill_m = 0.15, kMinDoorHeight_m = 1.6, kMinDoorWidth_m = 0.4;
constexpr double kMaxStep_m = 0.3, kMaxSteppedDoor_m = 1.6;
constexpr double kMinWindow_m2 = 0.05;
constexpr double kWeld_m = 1e-4;
constexpr uint32_t kPool = 0;  // group of the objects that make walls only together

struct StoreyWalls {
  StoreyRange range;
  std::vector<WallPiece> pieces;
  std::vector<std::vector<std::vector<uint32_t>>> triangles;  // by piece and object
};

// A door's threshold may be a step; a window as low as that is wide.
bool IsPassage(const WallVoid& v, double floor_z_m) {
  const bool narrow = v.span.s1_m - v.span.s0_m <= kMaxSteppedDoor_m;
  return v.z0_m <= floor_z_m + (narrow ? kMaxStep_m : kMaxDoorSill_m) && v.z1_m - std::max(v.z0_m, floor_z_m) >= kMinDoorHeight_m &&
         v.span.s1_m - v.span.s0_m >= kMinDoorWidth_m;
}

class Planner {
 public:
  Planner(const MeshScene& scene, const MeshOptions& options, DiagnosticSink& sink)
      : objects_(scene.objects), options_(options), sink_(sink) {}

  PlanIr Run() {
    ChooseWallObjects();
    directions_ = FindDirections(wall_objects_);
    for (const StoreyRange& range : FindStoreys(wall_objects_, objects_)) {
      PlanStorey storey;
      storey.name = fmt::format("Level {}", plan_.storeys.size());
      storey.elevation_m = range.floor_z_m;
      plan_.storeys.push_back(storey);
      storeys_.push_back({range, WallsOf(range), {}});
    }
    AssignTriangles();
    AddWalls();
    for (uint32_t o = 0; o < objects_.size(); ++o) AddRest(o);
    return std::move(plan_);
  }

 private:
  // All but furniture, doors and panes; where most of what stands upright is named as walls, only these.
  void ChooseWallObjects() {
    double named_m2 = 0, all_m2 = 0;
    for (const MeshObject& o : objects_) {
      const double area_m2 = SurfaceArea(o.solid);
      all_m2 += area_m2;
      if (HintOfName(o.name) == NameHint::kWall) named_m2 += area_m2;
    }
    const bool only_named = named_m2 >= kNamedShare * all_m2;
    for (uint32_t i = 0; i < objects_.size(); ++i) {
      const NameHint hint = HintOfName(objects_[i].name);
      if (hint != NameHint::kWall && (only_named || hint != NameHint::kNone)) continue;
      wall_objects_.push_back(objects_[i]);
      source_of_.push_back(i);
    }
    // Names that tell of no wall at all tell nothing.
    if (!wall_objects_.empty()) return;
    wall_objects_ = objects_;
    for (uint32_t i = 0; i < objects_.size(); ++i) source_of_.push_back(i);
  }

  std::vector<WallPiece> WallsOf(const StoreyRange& range) {
    const std::vector<double> breaks = FindBreaks(wall_objects_, range);
    SectionStack stack;
    for (size_t k = 0; k + 1 < breaks.size(); ++k) {
      stack.heights_m.push_back(0.5 * (breaks[k] + breaks[k + 1]));
      stack.segments.push_back(CutScene(wall_objects_, stack.heights_m.back()));
    }
    const Facing facing = FindFacing(directions_, stack, options_);
    std::vector<uint32_t> group_of(wall_objects_.size(), kPool);
    if (wall_objects_.size() > 1) {
      for (uint32_t i = 0; i < group_of.size(); ++i) group_of[i] = i + 1;
      const auto alone =
          FindWalls(directions_, WithoutSheets(FindBands(directions_, stack, group_of, facing, options_)), breaks, range, options_);
      std::set<uint32_t> able;
      for (const WallPiece& p : alone) {
        if (p.closed_gaps == 0 && !p.parapet) able.insert(p.group);
      }
      for (uint32_t i = 0; i < group_of.size(); ++i) {
        if (!able.contains(i + 1)) group_of[i] = kPool;
      }
    }
    return FindWalls(directions_, FindBands(directions_, stack, group_of, facing, options_), breaks, range, options_);
  }

  static std::vector<Band> WithoutSheets(std::vector<Band> bands) {
    std::erase_if(bands, [](const Band& b) { return b.sheet; });
    return bands;
  }

  // Each triangle to the wall whose box holds its middle: one of its own object's walls first.
  void AssignTriangles() {
    taken_.resize(objects_.size());
    for (size_t o = 0; o < objects_.size(); ++o) taken_[o].assign(objects_[o].solid.triangles.size(), 0);
    for (StoreyWalls& storey : storeys_) {
      storey.triangles.assign(storey.pieces.size(), std::vector<std::vector<uint32_t>>(wall_objects_.size()));
      for (uint32_t i = 0; i < wall_objects_.size(); ++i) {
        const Solid& solid = wall_objects_[i].solid;
        for (uint32_t t = 0; t < solid.triangles.size(); ++t) {
          if (taken_[source_of_[i]][t] != 0) continue;
          if (const size_t p = PieceOf(storey, solid, solid.triangles[t], i + 1); p != storey.pieces.size()) {
            storey.triangles[p][i].push_back(t);
            taken_[source_of_[i]][t] = 1;
          }
        }
      }
    }
  }

  size_t PieceOf(const StoreyWalls& storey, const Solid& solid, const Eigen::Vector3i& t, uint32_t group) const {
    const Vector3d middle = (solid.vertices[static_cast<size_t>(t[0])] + solid.vertices[static_cast<size_t>(t[1])] +
                             solid.vertices[static_cast<size_t>(t[2])]) /
                            3;
    size_t best = storey.pieces.size();
    for (size_t p = 0; p < storey.pieces.size(); ++p) {
      const WallPiece& piece = storey.pieces[p];
      if (middle.z() < piece.z0_m - 2 * kFloorSlack_m || middle.z() > piece.z1_m + kSkin_m) continue;
      if (!piece.Contains(directions_[piece.direction], middle.head<2>(), kSkin_m)) continue;
      if (piece.group == group) return p;
      if (best == storey.pieces.size()) best = p;
    }
    return best;
  }

  static double AreaOf(const Solid& solid, const std::vector<uint32_t>& triangles) {
    double out = 0;
    for (const uint32_t t : triangles) {
      const Eigen::Vector3i& i = solid.triangles[t];
      const Vector3d& a = solid.vertices[static_cast<size_t>(i[0])];
      out += 0.5 * (solid.vertices[static_cast<size_t>(i[1])] - a).cross(solid.vertices[static_cast<size_t>(i[2])] - a).norm();
    }
    return out;
  }

  static void Append(const Solid& from, const std::vector<uint32_t>& triangles, Solid& into) {
    Solid part;
    part.vertices = from.vertices;
    for (const uint32_t t : triangles) part.triangles.push_back(from.triangles[t]);
    WeldSolid(kWeld_m, part);
    AppendSolid(std::move(part), into);
  }

  // The object that most of a wall's faces come from.
  uint32_t OwnerOf(const StoreyWalls& storey, size_t piece) const {
    const uint32_t group = storey.pieces[piece].group;
    uint32_t best = group == kPool ? 0 : group - 1;
    if (group != kPool) return best;
    double most = 0;
    for (uint32_t i = 0; i < wall_objects_.size(); ++i) {
      const double area = AreaOf(wall_objects_[i].solid, storey.triangles[piece][i]);
      if (area <= most) continue;
      most = area;
      best = i;
    }
    return best;
  }

  void AddWalls() {
    std::map<std::string, size_t> total, count;
    std::vector<std::vector<uint32_t>> owners;
    for (const StoreyWalls& storey : storeys_) {
      owners.emplace_back();
      for (size_t p = 0; p < storey.pieces.size(); ++p) {
        owners.back().push_back(OwnerOf(storey, p));
        ++total[wall_objects_[owners.back().back()].name];
      }
    }
    for (uint32_t s = 0; s < storeys_.size(); ++s) {
      for (size_t p = 0; p < storeys_[s].pieces.size(); ++p) {
        const MeshObject& owner = wall_objects_[owners[s][p]];
        const std::string base = owner.name.empty() ? "mesh" : owner.name;
        const std::string guid = total[owner.name] > 1 ? fmt::format("{}#{}", base, ++count[owner.name]) : base;
        AddWall(s, p, owner, guid);
      }
    }
  }

  Solid BoxOf(const WallPiece& piece, const Span& span, double z0_m, double z1_m) const {
    const FaceDirection& d = directions_[piece.direction];
    Eigen::Affine3d T_plan_wall = Eigen::Affine3d::Identity();
    T_plan_wall.linear().col(0) << d.along, 0;
    T_plan_wall.linear().col(1) << d.across, 0;
    return MakeBox({span.s0_m, piece.c0_m, z0_m}, {span.s1_m, piece.c1_m, z1_m}, T_plan_wall);
  }

  void AddWall(uint32_t s, size_t p, const MeshObject& owner, const std::string& guid) {
    const StoreyWalls& storey = storeys_[s];
    const WallPiece& piece = storey.pieces[p];
    PlanElement wall;
    wall.kind = piece.column ? ElementKind::kColumn : ElementKind::kWall;
    wall.guid = wall.name = guid;
    wall.location = owner.location;
    wall.location.guid = guid;
    wall.type = owner.location.type;
    wall.storey = s;
    wall.thickness_m = piece.thickness_m();
    wall.uncut = BoxOf(piece, piece.span, piece.z0_m, piece.z1_m);
    for (uint32_t i = 0; i < wall_objects_.size(); ++i) {
      if (!storey.triangles[p][i].empty()) Append(wall_objects_[i].solid, storey.triangles[p][i], wall.body);
    }
    Report(piece, wall.location);
    const auto element = static_cast<uint32_t>(plan_.elements.size());
    plan_.elements.push_back(std::move(wall));
    if (piece.column) return;
    for (size_t v = 0; v < piece.voids.size(); ++v) AddOpening(s, piece, piece.voids[v], element, fmt::format("{}/{}", guid, v + 1));
  }

  void AddOpening(uint32_t s, const WallPiece& piece, const WallVoid& v, uint32_t wall, const std::string& guid) {
    PlanOpening opening;
    opening.guid = guid;
    opening.location = plan_.elements[wall].location;
    opening.wall = wall;
    const double floor_z_m = storeys_[s].range.floor_z_m;
    const bool passage = IsPassage(v, floor_z_m);
    opening.body = BoxOf(piece, v.span, passage ? std::min(v.z0_m, std::max(floor_z_m, piece.z0_m)) : v.z0_m, v.z1_m);
    opening.width_m = v.span.s1_m - v.span.s0_m;
    opening.height_m = v.z1_m - v.z0_m;
    if (!passage) {
      if (*opening.width_m * *opening.height_m < kMinWindow_m2) return;
      PlanElement window;
      window.kind = ElementKind::kWindow;
      window.material = Material::kGlass;
      window.guid = window.name = guid;
      window.location = opening.location;
      window.location.guid = guid;
      window.type = plan_.elements[wall].type;
      window.storey = s;
      opening.filling = static_cast<uint32_t>(plan_.elements.size());
      plan_.elements.push_back(std::move(window));
    }
    plan_.openings.push_back(std::move(opening));
  }

  void Report(const WallPiece& piece, const SourceLocation& location) {
    const FaceDirection& d = directions_[piece.direction];
    const Vector2d at = d.At(0.5 * (piece.span.s0_m + piece.span.s1_m), 0.5 * (piece.c0_m + piece.c1_m));
    if (piece.sheet) {
      sink_.Emit(DiagnosticKind::kMeshWallOfOneFace, location,
                 fmt::format("the wall around ({:.2f}, {:.2f}) has one face only; it is taken to be {:.2f} m thick", at.x(), at.y(),
                             piece.thickness_m()));
    }
    if (piece.closed_gaps > 0) {
      sink_.Emit(DiagnosticKind::kMeshGapClosed, location,
                 fmt::format("{} gap(s) of full height in the line of the wall around ({:.2f}, {:.2f}) are taken for doorways",
                             piece.closed_gaps, at.x(), at.y()));
    }
    if (piece.parapet) {
      sink_.Emit(DiagnosticKind::kMeshParapet, location,
                 fmt::format("the wall around ({:.2f}, {:.2f}) is low; it bounds rooms as if it reached the height of the section", at.x(),
                             at.y()));
    }
  }

  // Floors and ceilings, doors and windows that are objects of their own, and all else.
  void AddRest(uint32_t o) {
    const MeshObject& object = objects_[o];
    const NameHint hint = HintOfName(object.name);
    if (hint == NameHint::kDoor || hint == NameHint::kWindow) {
      AddFillings(o, hint);
      return;
    }
    std::vector<uint32_t> level, rest;
    for (uint32_t t = 0; t < object.solid.triangles.size(); ++t) {
      if (taken_[o][t] == 0) (IsFloor(object.solid, object.solid.triangles[t]) ? level : rest).push_back(t);
    }
    AddElement(object, ElementKind::kSlab, level);
    AddElement(object, ElementKind::kOther, rest);
  }

  bool IsFloor(const Solid& solid, const Eigen::Vector3i& t) const {
    const Vector3d &a = solid.vertices[static_cast<size_t>(t[0])], &b = solid.vertices[static_cast<size_t>(t[1])],
                   &c = solid.vertices[static_cast<size_t>(t[2])];
    const Vector3d n = (b - a).cross(c - a);
    if (std::abs(n.z()) < kLevel * n.norm()) return false;
    const double z = (a.z() + b.z() + c.z()) / 3;
    return std::any_of(storeys_.begin(), storeys_.end(), [&](const StoreyWalls& s) {
      return std::abs(z - s.range.floor_z_m) < kFloorSlack_m || std::abs(z - s.range.top_z_m) < 3 * kFloorSlack_m;
    });
  }

  void AddElement(const MeshObject& object, ElementKind kind, const std::vector<uint32_t>& triangles) {
    if (triangles.empty()) return;
    PlanElement e;
    e.kind = kind;
    e.guid = e.name = object.name;
    e.location = object.location;
    e.type = object.location.type;
    Append(object.solid, triangles, e.body);
    plan_.elements.push_back(std::move(e));
  }

  void AddFillings(uint32_t o, NameHint hint) {
    const MeshObject& object = objects_[o];
    Solid welded = object.solid;
    WeldSolid(kWeld_m, welded);
    size_t number = 0;
    for (Solid& part : ConnectedPieces(welded)) {
      const Vector3d size = Bounds(part).sizes();
      const bool upright = size.z() >= (hint == NameHint::kDoor ? kMinDoorHeight_m : 0.3) && size.head<2>().maxCoeff() >= kMinDoorWidth_m;
      PlanElement e;
      e.kind = !upright ? ElementKind::kOther : hint == NameHint::kDoor ? ElementKind::kDoor : ElementKind::kWindow;
      e.guid = e.name = fmt::format("{}#{}", object.name, ++number);
      e.location = object.location;
      e.location.guid = e.guid;
      e.type = object.location.type;
      if (hint == NameHint::kWindow) e.material = Material::kGlass;
      e.body = std::move(part);
      plan_.elements.push_back(std::move(e));
    }
  }

  const std::vector<MeshObject>& objects_;
  const MeshOptions& options_;
  DiagnosticSink& sink_;
  std::vector<MeshObject> wall_objects_;
  std::vector<uint32_t> source_of_;  // in objects_, by wall object
  std::vector<FaceDirection> directions_;
  std::vector<StoreyWalls> storeys_;
  std::vector<std::vector<char>> taken_;  // by object and triangle
  PlanIr plan_;
};

}  // namespace

PlanIr MakePlan(const MeshScene& scene, const MeshOptions& options, DiagnosticSink& sink) { return Planner(scene, options, sink).Run(); }

}  // namespace plumb::compiler
