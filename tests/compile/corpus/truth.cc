#include "tests/compile/corpus/truth.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"

namespace plumb::corpus {
namespace {

using compiler::kNoIndex;
using compiler::PlanElement;
using compiler::PlanOpening;
using compiler::PlanSpace;
using compiler::Solid;

constexpr double kEyes_m = 1.0;            // spaces and doors are looked at this high above their feet
constexpr double kAtWall_m = 0.35;         // spaces are drawn to finished faces, to structural faces or to the middle of walls
constexpr double kEnclosedShare = 0.95;    // of the outline
constexpr double kReach_m = 1.0;           // from the middle of a door to the space behind its wall
constexpr double kMinCell_m2 = 0.25;        // closets may be as small; smaller ones are cavities and the space between a leaf and its frame
constexpr double kElongated = 2;           // sides of a rectangle whose longer one is a direction

bool Blocks(const PlanElement& e) {
  switch (e.kind) {
    case ElementKind::kWall:
    case ElementKind::kCurtainWall:
    case ElementKind::kColumn:
    case ElementKind::kDoor:
    case ElementKind::kWindow:
      return true;
    default:
      return false;
  }
}

Ring BoxOf(const Solid& solid) {
  std::vector<Eigen::Vector2d> points;
  for (const auto& v : solid.vertices) points.push_back(v.head<2>());
  return compiler::LeastRectangle(std::move(points));
}

// Of the longer side; none if no side is much longer.
std::optional<Eigen::Vector2d> LongSide(const Ring& box) {
  if (box.size() < 4) return std::nullopt;
  const Eigen::Vector2d u = box[1] - box[0], v = box[2] - box[1];
  if (std::max(u.norm(), v.norm()) < kElongated * std::min(u.norm(), v.norm())) return std::nullopt;
  return (u.norm() > v.norm() ? u : v).normalized();
}

std::string StoreyName(const compiler::PlanIr& plan, uint32_t storey) { return storey == kNoIndex ? "" : plan.storeys[storey].name; }

}  // namespace

Truth::Truth(const compiler::PlanIr& plan) : plan_(plan) {
  ReadSpaces();
  ReadDoors();
}

const Raster& Truth::RasterAt(double z_m) {
  const int key = static_cast<int>(std::lround(z_m / 0.1));
  const auto known = rasters_.find(key);
  if (known != rasters_.end()) return known->second;
  std::vector<Rings> regions;
  for (const PlanElement& e : plan_.elements) {
    if (Blocks(e)) regions.push_back(compiler::CutSolid(e.uncut.empty() ? e.body : e.uncut, z_m).rings);
  }
  return rasters_.emplace(key, Raster(regions)).first->second;
}

void Truth::ReadSpaces() {
  for (const PlanSpace& s : plan_.spaces) {
    TrueSpace out;
    out.name = s.long_name.empty() || s.long_name == s.name ? s.name : s.name + " " + s.long_name;
    out.guid = s.guid;
    out.storey = StoreyName(plan_, s.storey);
    const Eigen::AlignedBox3d box = compiler::Bounds(s.body);
    if (!box.isEmpty()) {
      out.z_m = std::min(box.min().z() + kEyes_m, box.center().z());
      out.outline = compiler::CutSolid(s.body, out.z_m).rings;
    }
    size_t samples = 0, at_wall = 0;
    for (const Ring& ring : out.outline) {
      for (size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d from = ring[i], step = ring[(i + 1) % ring.size()] - from;
        const int count = std::max(1, static_cast<int>(step.norm() / 0.1));
        for (int k = 0; k < count; ++k) {
          ++samples;
          at_wall += RasterAt(out.z_m).SolidWithin(from + (k + 0.5) / count * step, kAtWall_m);
        }
      }
    }
    out.enclosed = samples > 0 && static_cast<double>(at_wall) >= kEnclosedShare * static_cast<double>(samples);
    spaces_.push_back(std::move(out));
  }
}

void Truth::ReadDoors() {
  std::map<uint32_t, const PlanOpening*> opening_of;
  for (const PlanOpening& o : plan_.openings) {
    if (o.filling != kNoIndex) opening_of.emplace(o.filling, &o);
  }
  std::set<std::string> known;  // panes have their door's GlobalId
  for (uint32_t e = 0; e < plan_.elements.size(); ++e) {
    const PlanElement& element = plan_.elements[e];
    if (element.kind != ElementKind::kDoor || !known.insert(element.guid).second) continue;
    const auto it = opening_of.find(e);
    AddDoor(e, it == opening_of.end() ? nullptr : it->second);
  }
}

Eigen::Vector2d Truth::Along(uint32_t element, const PlanOpening* opening) const {
  const bool has_void = opening != nullptr && !opening->body.empty();
  if (opening != nullptr && opening->wall != kNoIndex && plan_.elements[opening->wall].arcs.empty()) {
    const PlanElement& wall = plan_.elements[opening->wall];
    if (const auto along = LongSide(BoxOf(wall.uncut.empty() ? wall.body : wall.uncut))) return *along;
  }
  if (const auto along = LongSide(BoxOf(plan_.elements[element].body))) return *along;
  const Ring box = BoxOf(has_void ? opening->body : plan_.elements[element].body);
  if (box.size() < 4) return Eigen::Vector2d::UnitX();
  const Eigen::Vector2d u = box[1] - box[0], v = box[2] - box[1];
  return (u.norm() > v.norm() ? u : v).normalized();
}

void Truth::AddDoor(uint32_t element, const PlanOpening* opening) {
  const PlanElement& e = plan_.elements[element];
  TrueDoor out;
  out.name = e.name;
  out.guid = e.guid;
  out.storey = StoreyName(plan_, e.storey);
  const Solid& solid = opening != nullptr && !opening->body.empty() ? opening->body : e.body;
  const Ring box = BoxOf(solid);
  if (box.size() == 4) {
    const Eigen::AlignedBox3d bounds = compiler::Bounds(solid);
    out.z_m = std::min(bounds.min().z() + kEyes_m, bounds.center().z());
    out.center = 0.5 * (box[0] + box[2]);
    const Eigen::Vector2d along = Along(element, opening), across(-along.y(), along.x());
    double lo = 0, hi = 0;
    for (const auto& p : box) {
      lo = std::min(lo, along.dot(p - out.center));
      hi = std::max(hi, along.dot(p - out.center));
    }
    out.sides[0] = SideOf(out, along, across, hi - lo);
    out.sides[1] = SideOf(out, along, -across, hi - lo);
  }
  doors_.push_back(std::move(out));
}

DoorSide Truth::SideOf(const TrueDoor& door, const Eigen::Vector2d& along, const Eigen::Vector2d& away, double width_m) {
  constexpr double kStep_m = 0.02, kFurther_m = 0.04;  // a little into the space: its edge may lie within a wall
  const Raster& raster = RasterAt(door.z_m);
  DoorSide cell;
  for (const double abreast : {0.0, -0.3, 0.3}) {
    const Eigen::Vector2d from = door.center + abreast * width_m * along;
    for (double t = kStep_m; t <= kReach_m; t += kStep_m) {
      const Eigen::Vector2d p = from + t * away, q = p + kFurther_m * away;
      const int32_t at = raster.At(p);
      if (at == Raster::kSolid || (at != Raster::kOutside && raster.area_m2(at) < kMinCell_m2)) continue;
      for (size_t s = 0; s < spaces_.size(); ++s) {
        const Eigen::AlignedBox3d box = compiler::Bounds(plan_.spaces[s].body);
        if (!box.isEmpty() && box.min().z() < door.z_m && door.z_m < box.max().z() && Inside(spaces_[s].outline, q))
          return {DoorSide::Kind::kSpace, q, static_cast<int32_t>(s), !spaces_[s].enclosed && at == Raster::kOutside};
      }
      if (cell.kind == DoorSide::Kind::kBlocked)
        cell = {at == Raster::kOutside ? DoorSide::Kind::kOutside : DoorSide::Kind::kCell, q, at, false};
    }
  }
  return cell;
}

}  // namespace plumb::corpus
