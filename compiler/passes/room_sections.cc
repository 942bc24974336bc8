#include "compiler/passes/room_sections.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "compiler/geometry/for_each_job.h"
#include "compiler/passes/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kStepOff_m = 0.02;    // before a section, to see which room it faces
constexpr double kSameFloor_m = 0.01;  // floors this close are cut together
constexpr double kRoomCell_m = 2.0;    // of the grid that finds the room at a place
constexpr double kMinCell_m = 0.25;    // of the grid that finds points
constexpr double kMinSlope = 0.1;      // horizontal part of the normal of a face that is no floor
constexpr size_t kLeastCompared = 16;  // points of a room
constexpr int kMaxCells = 256;         // along one side of a grid
constexpr size_t kLeastTriangles = 512;  // that are cut in one go

bool IsFixed(const Element& e) {
  return e.material != Material::kGlass && e.kind != ElementKind::kDoor && e.kind != ElementKind::kFurniture && !e.doorway.valid();
}

int CellsAlong(double length_m, double cell_m) { return std::clamp(static_cast<int>(length_m / cell_m) + 1, 1, kMaxCells); }
int CellAt(double offset_m, double cell_m, int cells) { return std::clamp(static_cast<int>(std::floor(offset_m / cell_m)), 0, cells - 1); }

// Rooms with one floor, found by place.
class Level {
 public:
  Level(double floor_z_m, const Eigen::Vector2d& origin) : floor_z_m_(floor_z_m), origin_(origin) {}

  void Add(RoomId id, const Room& room) {
    std::vector<Ring> rings = {room.polygon};
    rings.insert(rings.end(), room.holes.begin(), room.holes.end());
    for (Ring& ring : rings) {
      for (Eigen::Vector2d& p : ring) p -= origin_;
    }
    rooms_.push_back({id, BoundingBox(rings), std::move(rings)});
    box_.extend(rooms_.back().box);
  }

  void BuildGrid() {
    cell_m_ = std::max(kRoomCell_m, box_.sizes().maxCoeff() / kMaxCells);
    columns_ = CellsAlong(box_.sizes().x(), cell_m_);
    rows_ = CellsAlong(box_.sizes().y(), cell_m_);
    cells_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
    for (size_t i = 0; i < rooms_.size(); ++i) {
      const Eigen::Vector2d lo = rooms_[i].box.min() - box_.min(), hi = rooms_[i].box.max() - box_.min();
      for (int y = CellAt(lo.y(), cell_m_, rows_); y <= CellAt(hi.y(), cell_m_, rows_); ++y) {
        for (int x = CellAt(lo.x(), cell_m_, columns_); x <= CellAt(hi.x(), cell_m_, columns_); ++x) CellOf(x, y).push_back(i);
      }
    }
  }

  [[nodiscard]] RoomId RoomAt(const Eigen::Vector2d& p) const {
    if (!box_.contains(p)) return {};
    const Eigen::Vector2d at = p - box_.min();
    for (size_t i : CellOf(CellAt(at.x(), cell_m_, columns_), CellAt(at.y(), cell_m_, rows_))) {
      if (rooms_[i].box.contains(p) && WindingNumber(rooms_[i].rings, p) != 0) return rooms_[i].id;
    }
    return {};
  }

  [[nodiscard]] double floor_z_m() const { return floor_z_m_; }
  [[nodiscard]] const Eigen::AlignedBox2d& box() const { return box_; }

 private:
  struct Outline {
    RoomId id;
    Eigen::AlignedBox2d box;
    std::vector<Ring> rings;
  };
  std::vector<size_t>& CellOf(int x, int y) {
    return cells_[static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x)];
  }
  [[nodiscard]] const std::vector<size_t>& CellOf(int x, int y) const {
    return cells_[static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x)];
  }

  double floor_z_m_;
  Eigen::Vector2d origin_;
  std::vector<Outline> rooms_;
  Eigen::AlignedBox2d box_;
  double cell_m_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<size_t>> cells_;
};

std::vector<Level> LevelsOf(const AGraph& graph, const std::vector<bool>& wanted) {
  std::vector<size_t> order;
  for (size_t r = 0; r < graph.rooms.size(); ++r) {
    if (wanted[r]) order.push_back(r);
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return graph.rooms[a].floor_z_m < graph.rooms[b].floor_z_m; });
  std::vector<Level> levels;
  for (size_t r : order) {
    const double floor_z_m = graph.rooms[r].floor_z_m - graph.origin.z();
    if (levels.empty() || floor_z_m > levels.back().floor_z_m() + kSameFloor_m) levels.emplace_back(floor_z_m, graph.origin.head<2>());
    levels.back().Add(RoomId(r), graph.rooms[r]);
  }
  for (Level& level : levels) level.BuildGrid();
  return levels;
}

struct Plane {
  double z_m = 0;
  uint32_t level = 0, height = 0;
};

std::vector<Plane> PlanesOf(const std::vector<Level>& levels, const std::vector<double>& heights_m) {
  std::vector<Plane> planes;
  for (uint32_t l = 0; l < levels.size(); ++l) {
    for (uint32_t h = 0; h < heights_m.size(); ++h) planes.push_back({levels[l].floor_z_m() + heights_m[h], l, h});
  }
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.z_m < b.z_m; });
  return planes;
}

}  // namespace

std::string SectionOptions::Check() const {
  if (heights_m.empty() || heights_m.size() > 8)
    return fmt::format("SectionOptions.heights_m has {} entries; must have 1 to 8", heights_m.size());
  for (double h : heights_m) {
    if (!(h > 0 && h < 10)) return fmt::format("SectionOptions.heights_m has {}; must be in (0, 10)", h);
  }
  if (!(step_m >= 0.01 && step_m <= 1)) return fmt::format("SectionOptions.step_m = {}; must be in [0.01, 1]", step_m);
  if (!(tolerance_m > 0 && tolerance_m < 1)) return fmt::format("SectionOptions.tolerance_m = {}; must be in (0, 1)", tolerance_m);
  if (!(max_turn_rad > 0 && max_turn_rad < 1.57))
    return fmt::format("SectionOptions.max_turn_rad = {}; must be in (0, pi/2)", max_turn_rad);
  if (max_compared == 0) return "SectionOptions.max_compared = 0; must be positive";
  return {};
}

// Cuts triangle by triangle. Points come at equal steps along all sections of an element, however finely they are divided.
class RoomSections::Cutter {
 public:
  Cutter(const AGraph& graph, const std::vector<Level>& levels, const std::vector<Plane>& planes, const SectionOptions& options)
      : graph_(graph), options_(options), levels_(levels), planes_(planes) {}

  // Points with their rooms, of the triangles from the first of an element to the last of one.
  Found Run(std::span<const Triangle> triangles) {
    uint32_t element = kNoElement;
    for (const Triangle& t : triangles) {
      if (!IsFixed(graph_.elements[t.element])) continue;
      if (t.element != element) owed_m_ = options_.step_m / 2;
      element = t.element;
      CutTriangle(t);
    }
    return std::move(found_);
  }

 private:
  void CutTriangle(const Triangle& t) {
    const Eigen::Vector3f &a = graph_.mesh.vertices[t.a], &b = graph_.mesh.vertices[t.b], &c = graph_.mesh.vertices[t.c];
    const double low = std::min({a.z(), b.z(), c.z()}), high = std::max({a.z(), b.z(), c.z()});
    auto plane = std::lower_bound(planes_.begin(), planes_.end(), low, [](const Plane& p, double z) { return p.z_m <= z; });
    if (plane == planes_.end() || plane->z_m > high) return;
    const std::array<Eigen::Vector3d, 3> corners = {a.cast<double>(), b.cast<double>(), c.cast<double>()};
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double level_part = normal.head<2>().norm();
    if (level_part <= kMinSlope * normal.norm()) return;
    for (; plane != planes_.end() && plane->z_m <= high; ++plane) CutAt(*plane, corners, {normal.head<2>() / level_part, t.element, plane->height});
  }

  void CutAt(const Plane& plane, const std::array<Eigen::Vector3d, 3>& corners, const Cut& cut) {
    std::array<Eigen::Vector2d, 2> ends;
    size_t n = 0;
    for (size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d &p = corners[i], &q = corners[(i + 1) % 3];
      if ((p.z() < plane.z_m) == (q.z() < plane.z_m)) continue;
      if (n < 2) ends[n++] = p.head<2>() + (plane.z_m - p.z()) / (q.z() - p.z()) * (q - p).head<2>();
    }
    const Level& level = levels_[plane.level];
    if (n < 2) return;
    const Eigen::AlignedBox2d before =
        Eigen::AlignedBox2d(ends[0].cwiseMin(ends[1]), ends[0].cwiseMax(ends[1])).translated(kStepOff_m * cut.normal);
    if (!level.box().intersects(before)) return;
    const double length_m = (ends[1] - ends[0]).norm();
    const size_t num_points = found_.points.size();
    for (; owed_m_ < length_m; owed_m_ += options_.step_m) {
      const Eigen::Vector2d at = ends[0] + owed_m_ / length_m * (ends[1] - ends[0]);
      const RoomId room = level.RoomAt(at + kStepOff_m * cut.normal);
      if (room.valid()) found_.points.push_back({at, static_cast<uint32_t>(found_.cuts.size()), room.value});
    }
    if (found_.points.size() > num_points) found_.cuts.push_back(cut);
    owed_m_ -= length_m;
  }

  static constexpr uint32_t kNoElement = 0xffffffffu;

  const AGraph& graph_;
  const SectionOptions& options_;
  const std::vector<Level>& levels_;
  const std::vector<Plane>& planes_;
  Found found_;
  double owed_m_ = 0;  // to the next point
};

// Parts of the mesh that hold whole elements, which are cut alone: what is found does not depend on who cuts what.
std::vector<std::span<const Triangle>> RoomSections::PartsOf(const std::vector<Triangle>& triangles) {
  std::vector<std::span<const Triangle>> out;
  for (size_t first = 0, last = 0; first < triangles.size(); first = last) {
    last = std::min(first + kLeastTriangles, triangles.size());
    while (last < triangles.size() && triangles[last].element == triangles[last - 1].element) ++last;
    out.emplace_back(triangles.data() + first, last - first);
  }
  return out;
}

// By part of the mesh.
std::vector<RoomSections::Found> RoomSections::Find(const AGraph& graph, const std::vector<bool>& wanted) const {
  const std::vector<Level> levels = LevelsOf(graph, wanted);
  const std::vector<Plane> planes = PlanesOf(levels, options_.heights_m);
  const auto parts = PartsOf(graph.mesh.triangles);
  std::vector<Found> out(parts.size());
  ForEachJob(parts.size(), options_.min_parallel, [&](size_t i) { out[i] = Cutter(graph, levels, planes, options_).Run(parts[i]); });
  return out;
}

RoomSections::RoomSections(const AGraph& graph, const std::vector<bool>& wanted, const SectionOptions& options)
    : options_(options), min_cos_(std::cos(options.max_turn_rad)), begin_(graph.rooms.size() + 1), grids_(graph.rooms.size()) {
  std::vector<Found> found = Find(graph, wanted);
  size_t count = 0, num_cuts = 0;
  for (const Found& part : found) {
    count += part.points.size();
    num_cuts += part.cuts.size();
    for (const Point& p : part.points) ++begin_[p.room + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  stride_ = 1 + count / options_.max_compared;
  cuts_.reserve(num_cuts);
  points_.resize(count);
  std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (Found& part : found) {
    const auto first_cut = static_cast<uint32_t>(cuts_.size());
    for (const Point& p : part.points) points_[next[p.room]++] = {p.at, first_cut + p.cut, p.room};
    cuts_.insert(cuts_.end(), part.cuts.begin(), part.cuts.end());
    part = {};
  }
  ForEachJob(grids_.size(), options_.min_parallel, [this](size_t r) { BuildGrid(r); });
}

void RoomSections::BuildGrid(size_t room) {
  const uint32_t first = begin_[room], last = begin_[room + 1];
  if (first == last) return;
  Grid& grid = grids_[room];
  Eigen::AlignedBox2d box;
  for (uint32_t i = first; i < last; ++i) box.extend(points_[i].at);
  grid.low = box.min();
  grid.cell_m = std::max(kMinCell_m, box.sizes().maxCoeff() / kMaxCells);
  grid.columns = CellsAlong(box.sizes().x(), grid.cell_m);
  grid.rows = CellsAlong(box.sizes().y(), grid.cell_m);
  const auto cell = [&](const Point& p) {
    const Eigen::Vector2d at = p.at - grid.low;
    return (static_cast<size_t>(cuts_[p.cut].height) * static_cast<size_t>(grid.rows) + static_cast<size_t>(CellAt(at.y(), grid.cell_m, grid.rows))) *
               static_cast<size_t>(grid.columns) +
           static_cast<size_t>(CellAt(at.x(), grid.cell_m, grid.columns));
  };
  const std::vector<Point> unsorted(points_.begin() + first, points_.begin() + last);
  grid.begin.assign(options_.heights_m.size() * static_cast<size_t>(grid.rows) * static_cast<size_t>(grid.columns) + 1, 0);
  for (const Point& p : unsorted) ++grid.begin[cell(p) + 1];
  grid.begin[0] = first;
  std::partial_sum(grid.begin.begin(), grid.begin.end(), grid.begin.begin());
  std::vector<uint32_t> next(grid.begin.begin(), grid.begin.end() - 1);
  for (const Point& p : unsorted) points_[next[cell(p)]++] = p;
}

bool RoomSections::Coincides(RoomId room, const Eigen::Vector2d& place, const Eigen::Vector2d& normal, uint32_t height) const {
  const Grid& grid = grids_[room.index()];
  const double along_m = options_.step_m / 2 + options_.tolerance_m;
  const Eigen::Vector2d at = place - grid.low;
  const int x0 = CellAt(at.x() - along_m, grid.cell_m, grid.columns), x1 = CellAt(at.x() + along_m, grid.cell_m, grid.columns);
  const int y0 = CellAt(at.y() - along_m, grid.cell_m, grid.rows), y1 = CellAt(at.y() + along_m, grid.cell_m, grid.rows);
  for (int y = y0; y <= y1; ++y) {
    const size_t row =
        (static_cast<size_t>(height) * static_cast<size_t>(grid.rows) + static_cast<size_t>(y)) * static_cast<size_t>(grid.columns);
    for (uint32_t i = grid.begin[row + static_cast<size_t>(x0)]; i < grid.begin[row + static_cast<size_t>(x1) + 1]; ++i) {
      const Eigen::Vector2d off = points_[i].at - place;
      if (std::abs(off.dot(normal)) <= options_.tolerance_m && std::abs(Cross(normal, off)) <= along_m &&
          cuts_[points_[i].cut].normal.dot(normal) >= min_cos_) {
        return true;
      }
    }
  }
  return false;
}

void RoomSections::CompareOneWay(RoomId from, const PlanarMotion& motion, RoomId to, SectionComparison& out) const {
  const size_t stride = std::clamp<size_t>(NumPoints(from) / kLeastCompared, 1, stride_);
  for (size_t i = begin_[from.index()]; i < begin_[from.index() + 1]; i += stride) {
    const Cut& cut = cuts_[points_[i].cut];
    ++out.points;
    if (!Coincides(to, motion.Apply(points_[i].at), motion.Rotate(cut.normal), cut.height)) out.unmatched_elements.push_back(cut.element);
  }
}

SectionComparison RoomSections::Compare(RoomId from, const PlanarMotion& motion, RoomId to) const {
  SectionComparison out;
  if (NumPoints(from) == 0 || NumPoints(to) == 0) return out;
  CompareOneWay(from, motion, to, out);
  CompareOneWay(to, motion.Inverse(), from, out);
  return out;
}

}  // namespace plumb::compiler
