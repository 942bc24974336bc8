#include "runtime/matching/plan_index.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kArcStep_rad = 0.26;      // a chord this wide is within 1 % of the radius of its arc
constexpr double kMinFaceLength_m = 0.05;
constexpr double kLevelMerge_m = 0.15;     // thresholds and ramps do not make a level
constexpr size_t kMaxLevels = 16;
constexpr double kGridCell_m = 3.0;
constexpr double kMaxGridCells = 512;      // along one axis; the last cells of a larger plan hold the rest

bool IsSoft(const Element& element) {
  if (element.material == Material::kGlass || element.doorway.valid()) return true;
  switch (element.kind) {
    case ElementKind::kDoor:
    case ElementKind::kWindow:
    case ElementKind::kFurniture:
    case ElementKind::kRailing:
    case ElementKind::kProxy:
      return true;
    default:
      return false;
  }
}

std::vector<bool> SoftTriangles(const AGraph& plan) {
  std::vector<bool> soft(plan.mesh.triangles.size());
  for (size_t i = 0; i < soft.size(); ++i) soft[i] = IsSoft(plan.elements[plan.mesh.triangles[i].element]);
  return soft;
}

std::vector<bool> Not(std::vector<bool> mask) {
  mask.flip();
  return mask;
}

Eigen::Vector2d PointOnArc(const Arc& arc, double ratio) {
  const double a = arc.start_rad + ratio * arc.sweep_rad;
  return arc.center + arc.radius_m * Eigen::Vector2d(std::cos(a), std::sin(a));
}

}  // namespace

PlanIndex::PlanIndex(const AGraph& plan)
    : plan_(plan),
      soft_(SoftTriangles(plan)),
      num_physical_walls_(static_cast<uint32_t>(plan.walls.size())),
      all_(plan.mesh),
      solid_(plan.mesh, Not(soft_)) {
  AddStructure();
}

PlanIndex::PlanIndex(const AGraph& image, const PlanIndex& original)
    : plan_(image),
      soft_(original.soft_),
      num_physical_walls_(static_cast<uint32_t>(image.walls.size())),
      all_(original.all_.Mirrored()),
      solid_(original.solid_.Mirrored()) {
  AddStructure();
}

void PlanIndex::AddStructure() {
  for (size_t i = 0; i < plan_.surfaces.size(); ++i) AddFaces(plan_.surfaces[i], SurfaceId(i));
  for (const Column& column : plan_.columns) AddFaces(column);
  AddToGrid();
  AddLevels();
  AddOpenings();
}

void PlanIndex::AddFaces(const Surface& surface, SurfaceId id) {
  std::vector<Eigen::Vector2d> points{surface.start, surface.end};
  if (surface.arc) {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(surface.arc->sweep_rad) / kArcStep_rad)));
    points.clear();
    for (int i = 0; i <= steps; ++i) points.push_back(PointOnArc(*surface.arc, static_cast<double>(i) / steps));
    if ((points.front() - surface.start).norm() > (points.back() - surface.start).norm()) std::reverse(points.begin(), points.end());
  }
  PlanFace face;
  face.surface = id;
  face.physical_wall = surface.wall.valid() ? surface.wall.value : num_physical_walls_++;
  face.z_min_m = surface.z_min_m - plan_.origin.z();
  face.z_max_m = surface.z_max_m - plan_.origin.z();
  AddChain(points, face);
}

void PlanIndex::AddFaces(const Column& column) {
  std::vector<Eigen::Vector2d> points = column.outline;
  if (points.size() < 3) return;
  points.push_back(points.front());
  double twice_area_m2 = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) twice_area_m2 += points[i].x() * points[i + 1].y() - points[i].y() * points[i + 1].x();
  if (twice_area_m2 > 0) std::reverse(points.begin(), points.end());  // free space is outside, to the left of a clockwise ring
  PlanFace face;
  face.physical_wall = num_physical_walls_++;
  face.z_min_m = column.z_min_m - plan_.origin.z();
  face.z_max_m = column.z_max_m - plan_.origin.z();
  AddChain(points, face);
}

void PlanIndex::AddChain(const std::vector<Eigen::Vector2d>& points, PlanFace face) {
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    face.start = points[i] - plan_.origin.head<2>();
    face.end = points[i + 1] - plan_.origin.head<2>();
    face.length_m = (face.end - face.start).norm();
    if (face.length_m < kMinFaceLength_m) continue;
    face.along = (face.end - face.start) / face.length_m;
    face.normal = {-face.along.y(), face.along.x()};
    face.d_m = -face.normal.dot(face.start);
    faces_.push_back(face);
  }
}

void PlanIndex::AddToGrid() {
  if (faces_.empty()) return;
  Eigen::AlignedBox2d box;
  for (const PlanFace& f : faces_) box.extend(f.start).extend(f.end);
  grid_low_ = box.min();
  grid_size_ = (box.sizes() / kGridCell_m).cwiseMin(kMaxGridCells - 1.0).cast<int>().array() + 1;
  grid_.resize(static_cast<size_t>(grid_size_.prod()));
  for (uint32_t i = 0; i < faces_.size(); ++i) {
    const Eigen::Vector2i lo = CellOf(faces_[i].start.cwiseMin(faces_[i].end)), hi = CellOf(faces_[i].start.cwiseMax(faces_[i].end));
    for (int y = lo.y(); y <= hi.y(); ++y) {
      for (int x = lo.x(); x <= hi.x(); ++x) grid_[static_cast<size_t>(y) * grid_size_.x() + x].push_back(i);
    }
  }
}

Eigen::Vector2i PlanIndex::CellOf(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d last = (grid_size_.array() - 1).cast<double>();
  return ((p - grid_low_) / kGridCell_m).array().floor().matrix().cwiseMax(0.0).cwiseMin(last).cast<int>();
}

void PlanIndex::FacesNear(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin_m, std::vector<uint32_t>& out) const {
  out.clear();
  if (faces_.empty()) return;
  const Eigen::Vector2d margin(margin_m, margin_m);
  const Eigen::Vector2i lo = CellOf(a.cwiseMin(b) - margin), hi = CellOf(a.cwiseMax(b) + margin);
  for (int y = lo.y(); y <= hi.y(); ++y) {
    for (int x = lo.x(); x <= hi.x(); ++x) {
      const std::vector<uint32_t>& cell = grid_[static_cast<size_t>(y) * grid_size_.x() + x];
      out.insert(out.end(), cell.begin(), cell.end());
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

void PlanIndex::AddLevels() {
  std::vector<PlanLevel> floors;
  for (const Room& room : plan_.rooms) {
    floors.push_back({room.storey, room.floor_z_m - plan_.origin.z(), room.ceiling_z_m - plan_.origin.z(), room.area_m2});
  }
  if (floors.empty()) {
    for (size_t i = 0; i < plan_.storeys.size(); ++i) {
      const double z_m = plan_.storeys[i].elevation_m - plan_.origin.z();
      floors.push_back({StoreyId(i), z_m, z_m + plan_.storeys[i].height_m, 1.0});
    }
  }
  std::stable_sort(floors.begin(), floors.end(), [](const PlanLevel& a, const PlanLevel& b) { return a.floor_z_m < b.floor_z_m; });
  double largest_m2 = 0;  // of the rooms merged into the last level: it lends its heights and storey
  for (const PlanLevel& floor : floors) {
    if (levels_.empty() || floor.floor_z_m - levels_.back().floor_z_m > kLevelMerge_m) {
      levels_.push_back(floor);
      largest_m2 = floor.area_m2;
      continue;
    }
    const double area_m2 = levels_.back().area_m2 + floor.area_m2;
    if (floor.area_m2 > largest_m2) {
      levels_.back() = floor;
      largest_m2 = floor.area_m2;
    }
    levels_.back().area_m2 = area_m2;
  }
  std::stable_sort(levels_.begin(), levels_.end(), [](const PlanLevel& a, const PlanLevel& b) { return a.area_m2 > b.area_m2; });
  if (levels_.size() > kMaxLevels) levels_.resize(kMaxLevels);
}

void PlanIndex::AddOpenings() {
  const auto add = [&](WallId wall, const Eigen::Vector3d& position, double width_m, double height_m) {
    const double thickness_m = wall.valid() ? plan_.walls[wall.index()].thickness_m : 0.0;
    openings_.push_back({position - plan_.origin, std::hypot(width_m, thickness_m) / 2, height_m});
  };
  for (const Doorway& d : plan_.doorways) add(d.wall, d.position, d.width_m, d.height_m);
  for (const Window& w : plan_.windows) add(w.wall, w.position, w.width_m, w.height_m);
}

PlanHit PlanIndex::Cast(const Ray& ray) const {
  PlanHit hit;
  hit.first = hit.solid = all_.Cast(ray);
  hit.soft = hit.first.hit() && soft_[hit.first.triangle];
  if (hit.soft) hit.solid = solid_.Cast(ray);
  return hit;
}

bool PlanIndex::NearOpening(const Eigen::Vector3d& point, double margin_m) const {
  return std::any_of(openings_.begin(), openings_.end(), [&](const Opening& o) {
    const Eigen::Vector3d v = point - o.sill;
    return v.z() > -margin_m && v.z() < o.height_m + margin_m && v.head<2>().norm() < o.reach_m + margin_m;
  });
}

}  // namespace plumb::runtime
