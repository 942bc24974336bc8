#include "compiler/frontends/mesh/mesh_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "compiler/frontends/mesh/mesh_curves.h"
#include "compiler/frontends/mesh/mesh_levels.h"
#include "compiler/frontends/mesh/mesh_names.h"
#include "compiler/frontends/mesh/mesh_parts.h"
#include "compiler/frontends/mesh/mesh_voids.h"
#include "compiler/geometry/sweep.h"
#include "schema/counted.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNamedShare = 0.4;  // of the upright area in objects that are named walls: then these are the walls
constexpr double kFloorSlack_m = 0.15, kLevel = 0.9;
constexpr double kMaxDoorSill_m = 0.15, kMinDoorHeight_m = 1.6, kMinDoorWidth_m = 0.4;
constexpr double kMaxStep_m = 0.3, kMaxSteppedDoor_m = 1.6;
constexpr double kMinWindow_m2 = 0.05;
constexpr double kWeld_m = 1e-4;

// A door's threshold may be a step; a window as low as that is wide.
bool IsPassage(const MeshOpening& o, double floor_z_m) {
  const bool narrow = o.width_m <= kMaxSteppedDoor_m;
  return o.z0_m <= floor_z_m + (narrow ? kMaxStep_m : kMaxDoorSill_m) && o.z1_m - std::max(o.z0_m, floor_z_m) >= kMinDoorHeight_m &&
         o.width_m >= kMinDoorWidth_m;
}

class Planner {
 public:
  Planner(const MeshScene& scene, const MeshOptions& options, DiagnosticSink& sink)
      : objects_(scene.objects), options_(options), sink_(sink) {
    plan_.origin = scene.origin;
  }

  PlanIr Run() {
    ChooseWallObjects();
    face_directions_ = directions_ = FindDirections(wall_objects_);
    for (const StoreyRange& range : FindStoreys(wall_objects_, objects_)) {
      PlanStorey storey;
      storey.name = fmt::format("Level {}", plan_.storeys.size());
      storey.elevation_m = range.floor_z_m;
      plan_.storeys.push_back(storey);
      storeys_.push_back({range, WallsOf(range), {}});
    }
    const std::vector<std::vector<bool>> of_walls = AssignTriangles(wall_objects_, directions_, storeys_);
    for (const MeshObject& o : objects_) in_wall_.emplace_back(o.solid.triangles.size(), false);
    for (size_t i = 0; i < of_walls.size(); ++i) in_wall_[source_of_[i]] = of_walls[i];
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
    const Facing facing = FindFacing(face_directions_, stack, options_);
    std::vector<uint32_t> group_of(wall_objects_.size(), kPool);
    if (wall_objects_.size() > 1) {
      for (uint32_t i = 0; i < group_of.size(); ++i) group_of[i] = i + 1;
      std::vector<FaceDirection> directions = face_directions_;
      const auto alone =
          FindWalls(WithoutSheets(FindBands(face_directions_, stack, group_of, facing, options_)), breaks, range, options_, directions);
      std::set<uint32_t> able;
      for (const WallPiece& p : alone) {
        if (p.closed_gaps == 0 && !p.parapet && !p.gap) able.insert(p.group);
      }
      for (uint32_t i = 0; i < group_of.size(); ++i) {
        if (!able.contains(i + 1)) group_of[i] = kPool;
      }
    }
    return FindWalls(FindBands(face_directions_, stack, group_of, facing, options_), breaks, range, options_, directions_);
  }

  static std::vector<Band> WithoutSheets(std::vector<Band> bands) {
    std::erase_if(bands, [](const Band& b) { return b.sheet; });
    return bands;
  }

  // Facets of a curve that are of one object are one wall; those of a doorway have none and are of the wall beside it.
  void AddWalls() {
    std::map<std::string, size_t> total, count;
    std::vector<std::vector<uint32_t>> owners;
    std::vector<WallCurves> curves;
    for (const StoreyWalls& storey : storeys_) {
      owners.emplace_back();
      curves.push_back(FindCurves(directions_, storey.pieces));
      for (size_t p = 0; p < storey.pieces.size(); ++p) {
        size_t& first = curves.back().first[p];
        owners.back().push_back(storey.pieces[p].gap && first < p ? owners.back()[first] : OwnerOf(wall_objects_, storey, p));
        if (owners.back()[first] != owners.back()[p]) first = p;
        if (first == p) ++total[wall_objects_[owners.back().back()].name];
      }
    }
    for (uint32_t s = 0; s < storeys_.size(); ++s) {
      std::map<size_t, std::vector<size_t>> members;  // by the first piece of each wall
      for (size_t p = 0; p < storeys_[s].pieces.size(); ++p) members[curves[s].first[p]].push_back(p);
      for (const auto& [first, pieces] : members) {
        const MeshObject& owner = wall_objects_[owners[s][first]];
        const std::string base = owner.name.empty() ? "mesh" : owner.name;
        const auto wall = static_cast<uint32_t>(plan_.elements.size());
        AddWall(s, storeys_[s].pieces[first], owner, total[owner.name] > 1 ? fmt::format("{}#{}", base, ++count[owner.name]) : base);
        for (const size_t p : pieces) AddPiece(s, p, curves[s].corners[p], wall);
        if (storeys_[s].pieces[first].column) continue;
        for (const MeshOpening& o : JoinVoids(directions_, storeys_[s].pieces, curves[s], pieces)) AddOpening(s, o, wall);
      }
    }
  }

  static Solid Upright(const std::array<Vector2d, 4>& footprint, double z0_m, double z1_m) {
    Solid out = Extrude({Ring(footprint.begin(), footprint.end())}, {0, 0, z1_m - z0_m});
    for (Vector3d& v : out.vertices) v.z() += z0_m;
    return out;
  }

  void AddWall(uint32_t s, const WallPiece& piece, const MeshObject& owner, const std::string& guid) {
    PlanElement wall;
    wall.kind = piece.column ? ElementKind::kColumn : ElementKind::kWall;
    wall.guid = wall.name = guid;
    wall.location = owner.location;
    wall.location.guid = guid;
    wall.type = owner.location.type;
    wall.storey = s;
    wall.thickness_m = piece.thickness_m();
    plan_.elements.push_back(std::move(wall));
  }

  void AddPiece(uint32_t s, size_t p, const std::array<Vector2d, 4>& corners, uint32_t element) {
    const StoreyWalls& storey = storeys_[s];
    const WallPiece& piece = storey.pieces[p];
    PlanElement& wall = plan_.elements[element];
    AppendSolid(Upright(corners, piece.z0_m, piece.z1_m), wall.uncut);
    for (const auto& [object, triangles] : storey.triangles[p]) AppendPart(wall_objects_[object].solid, triangles, wall.body);
    Report(piece, wall.location);
  }

  void AddOpening(uint32_t s, const MeshOpening& o, uint32_t wall) {
    PlanOpening opening;
    opening.guid = fmt::format("{}/{}", plan_.elements[wall].guid, ++num_openings_[wall]);
    opening.location = plan_.elements[wall].location;
    opening.wall = wall;
    const double floor_z_m = storeys_[s].range.floor_z_m;
    const bool passage = IsPassage(o, floor_z_m);
    // Down to the floor, also where the wall or a threshold ends above it.
    for (const auto& footprint : o.footprints)
      AppendSolid(Upright(footprint, passage ? std::min(o.z0_m, floor_z_m) : o.z0_m, o.z1_m), opening.body);
    opening.width_m = o.width_m;
    opening.height_m = o.z1_m - o.z0_m;
    if (!passage) {
      if (*opening.width_m * *opening.height_m < kMinWindow_m2) return;
      PlanElement window;
      window.kind = ElementKind::kWindow;
      window.material = Material::kGlass;
      window.guid = window.name = opening.guid;
      window.location = opening.location;
      window.location.guid = opening.guid;
      window.type = plan_.elements[wall].type;
      window.storey = s;
      opening.filling = static_cast<uint32_t>(plan_.elements.size());
      plan_.elements.push_back(std::move(window));
    }
    plan_.openings.push_back(std::move(opening));
  }

  void Report(const WallPiece& piece, const SourceLocation& location) {
    const FaceDirection& d = directions_[piece.direction];
    const Vector2d at = d.At(0.5 * (piece.span.s0_m + piece.span.s1_m), 0.5 * (piece.c0_m + piece.c1_m)) + plan_.origin.head<2>();
    if (piece.sheet) {
      sink_.Emit(DiagnosticKind::kMeshWallOfOneFace, location,
                 fmt::format("the wall around ({:.2f}, {:.2f}) has one face only; it is taken to be {:.2f} m thick", at.x(), at.y(),
                             piece.thickness_m()));
    }
    if (piece.closed_gaps > 0) {
      sink_.Emit(DiagnosticKind::kMeshGapClosed, location,
                 fmt::format("{} of full height in the line of the wall around ({:.2f}, {:.2f}) {}", Counted(piece.closed_gaps, "gap"),
                             at.x(), at.y(), piece.closed_gaps == 1 ? "is taken for a doorway" : "are taken for doorways"));
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
      if (!in_wall_[o][t]) (IsFloor(object.solid, object.solid.triangles[t]) ? level : rest).push_back(t);
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
    AppendPart(object.solid, triangles, e.body);
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
  std::vector<uint32_t> source_of_;                          // in objects_, by wall object
  std::vector<FaceDirection> face_directions_, directions_;  // of the mesh's faces; these, then those of doorways in curves
  std::vector<StoreyWalls> storeys_;
  std::vector<std::vector<bool>> in_wall_;   // by object and triangle
  std::map<uint32_t, size_t> num_openings_;  // of walls, by element
  PlanIr plan_;
};

}  // namespace

PlanIr MakePlan(const MeshScene& scene, const MeshOptions& options, DiagnosticSink& sink) { return Planner(scene, options, sink).Run(); }

}  // namespace plumb::compiler
