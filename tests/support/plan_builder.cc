#include "tests/support/plan_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace plumb::test {
namespace {

using compiler::kNoIndex;
using compiler::PlanElement;
using compiler::PlanIr;
using compiler::PlanOpening;
using compiler::PlanSpace;
using compiler::Solid;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool IsEar(const Ring& ring, const std::vector<int>& left, size_t i) {
  const size_t n = left.size();
  const auto at = [&](size_t k) { return ring[static_cast<size_t>(left[k % n])]; };
  const Eigen::Vector2d a = at(i + n - 1), b = at(i), c = at(i + 1);
  if (Cross(b - a, c - b) <= 0) return false;
  for (size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d p = at(k);
    if (p == a || p == b || p == c) continue;
    if (Cross(b - a, p - a) >= 0 && Cross(c - b, p - b) >= 0 && Cross(a - c, p - c) >= 0) return false;
  }
  return true;
}

// Ear clipping.
std::vector<Eigen::Vector3i> Triangulate(const Ring& ring) {
  std::vector<int> left(ring.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<Eigen::Vector3i> out;
  while (left.size() > 3) {
    size_t ear = 0;
    while (ear + 1 < left.size() && !IsEar(ring, left, ear)) ++ear;
    const size_t n = left.size();
    out.emplace_back(left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  out.emplace_back(left[0], left[1], left[2]);
  return out;
}

template <class T>
std::vector<uint32_t> Permute(std::vector<T>& items, std::mt19937_64& random) {
  std::vector<uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0u);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  std::vector<T> out;
  std::vector<uint32_t> new_index(items.size());
  for (uint32_t old : order) {
    new_index[old] = static_cast<uint32_t>(out.size());
    out.push_back(items[old]);
  }
  items = std::move(out);
  return new_index;
}

}  // namespace

Solid Prism(const Ring& ring, double z_min_m, double z_max_m) {
  Solid out;
  const int n = static_cast<int>(ring.size());
  for (double z : {z_min_m, z_max_m}) {
    for (const auto& p : ring) out.vertices.emplace_back(p.x(), p.y(), z);
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    out.triangles.emplace_back(i, j, j + n);
    out.triangles.emplace_back(i, j + n, i + n);
  }
  for (const Eigen::Vector3i& t : Triangulate(ring)) {
    out.triangles.emplace_back(t[0], t[2], t[1]);
    out.triangles.emplace_back(t[0] + n, t[1] + n, t[2] + n);
  }
  return out;
}

Ring Rectangle(const Eigen::Vector2d& lo, const Eigen::Vector2d& hi) { return {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}}; }

uint32_t PlanBuilder::Storey(const std::string& name, double elevation_m) {
  compiler::PlanStorey s;
  s.guid = "storey-" + name;
  s.name = name;
  s.elevation_m = elevation_m;
  plan.storeys.push_back(s);
  return storey_ = static_cast<uint32_t>(plan.storeys.size() - 1);
}

PlanBuilder& PlanBuilder::On(uint32_t storey) {
  storey_ = storey;
  return *this;
}

uint32_t PlanBuilder::Prismatic(ElementKind kind, const std::string& guid, const Ring& ring, double z_min_m, double z_max_m) {
  PlanElement e;
  e.kind = kind;
  e.guid = e.name = e.location.guid = guid;
  e.type = "Test";
  e.storey = storey_;
  e.body = Prism(ring, z_min_m, z_max_m);
  plan.elements.push_back(std::move(e));
  return static_cast<uint32_t>(plan.elements.size() - 1);
}

uint32_t PlanBuilder::Wall(const std::string& guid, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness_m,
                           double z_min_m, double z_max_m) {
  const Eigen::Vector2d along = (to - from).normalized(), half = 0.5 * thickness_m * Eigen::Vector2d(-along.y(), along.x());
  const uint32_t wall = Prismatic(ElementKind::kWall, guid, {from - half, to - half, to + half, from + half}, z_min_m, z_max_m);
  lines_[wall] = {from, to, thickness_m};
  return wall;
}

Solid PlanBuilder::Void(const CentreLine& line, double along_m, double width_m, double depth_m, double z_min_m, double z_max_m) const {
  const Eigen::Vector2d u = (line.to - line.from).normalized(), v(-u.y(), u.x()), c = line.from + along_m * u;
  const Eigen::Vector2d w = 0.5 * width_m * u, d = 0.5 * depth_m * v;
  return Prism({c - w - d, c + w - d, c + w + d, c - w + d}, z_min_m, z_max_m);
}

uint32_t PlanBuilder::Opening(const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m, double z_max_m) {
  PlanOpening o;
  o.guid = o.name = o.location.guid = guid;
  o.wall = wall;
  o.body = Void(lines_.at(wall), along_m, width_m, lines_.at(wall).thickness_m + 0.02, z_min_m, z_max_m);
  plan.openings.push_back(std::move(o));
  return static_cast<uint32_t>(plan.openings.size() - 1);
}

uint32_t PlanBuilder::Fill(ElementKind kind, const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m,
                           double z_max_m) {
  PlanElement e;
  e.kind = kind;
  e.guid = e.name = e.location.guid = guid;
  e.type = "Test";
  e.storey = storey_;
  e.body = Void(lines_.at(wall), along_m, width_m, 0.05, z_min_m, z_max_m);
  plan.elements.push_back(std::move(e));
  PlanOpening& o = plan.openings[Opening("opening-" + guid, wall, along_m, width_m, z_min_m, z_max_m)];
  o.filling = static_cast<uint32_t>(plan.elements.size() - 1);
  o.width_m = width_m;
  o.height_m = z_max_m - z_min_m;
  return o.filling;
}

uint32_t PlanBuilder::Door(const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m, double z_max_m) {
  return Fill(ElementKind::kDoor, guid, wall, along_m, width_m, z_min_m, z_max_m);
}

uint32_t PlanBuilder::Window(const std::string& guid, uint32_t wall, double along_m, double width_m, double z_min_m, double z_max_m) {
  return Fill(ElementKind::kWindow, guid, wall, along_m, width_m, z_min_m, z_max_m);
}

uint32_t PlanBuilder::Space(const std::string& name, const Ring& ring, double z_min_m, double z_max_m) {
  PlanSpace s;
  s.guid = "space-" + name;
  s.name = name;
  s.storey = storey_;
  s.body = Prism(ring, z_min_m, z_max_m);
  plan.spaces.push_back(std::move(s));
  return static_cast<uint32_t>(plan.spaces.size() - 1);
}

PlanIr TwoRooms() {
  PlanBuilder b;
  b.Storey("Ground", 0);
  const uint32_t south = b.Wall("south", {-0.3, -0.15}, {8.3, -0.15}, 0.3);
  const uint32_t east = b.Wall("east", {8.15, 0}, {8.15, 4}, 0.3);
  b.Wall("north", {8.3, 4.15}, {-0.3, 4.15}, 0.3);
  b.Wall("west", {-0.15, 4}, {-0.15, 0}, 0.3);
  const uint32_t inner = b.Wall("inner", {5, 0}, {5, 4}, 0.2);
  b.Door("D", inner, 1.5);
  b.Door("E", south, 2.3);
  b.Window("W", east, 2.0);
  b.Prismatic(ElementKind::kSlab, "floor", Rectangle({-0.3, -0.3}, {8.3, 4.3}), -0.2, 0);
  b.Prismatic(ElementKind::kSlab, "ceiling", Rectangle({-0.3, -0.3}, {8.3, 4.3}), 2.5, 2.7);
  b.Space("West", Rectangle({0, 0}, {4.9, 4}));
  b.Space("East", Rectangle({5.1, 0}, {8, 4}));
  return b.plan;
}

PlanIr Moved(const PlanIr& plan, double yaw_rad, const Eigen::Vector3d& translation) {
  const Eigen::Rotation2Dd rotation(yaw_rad);
  const auto move2 = [&](Eigen::Vector2d& p) { p = rotation * p + translation.head<2>(); };
  const auto move = [&](Solid& solid) {
    for (auto& v : solid.vertices) v << rotation * v.head<2>() + translation.head<2>(), v.z() + translation.z();
  };
  PlanIr out = plan;
  for (auto& s : out.storeys) s.elevation_m += translation.z();
  for (auto& e : out.elements) {
    move(e.body);
    move(e.uncut);
    if (e.axis) {
      move2(e.axis->first);
      move2(e.axis->second);
    }
    for (Arc& arc : e.arcs) {
      move2(arc.center);
      arc.start_rad += yaw_rad;
    }
    for (compiler::PlanLeaf& leaf : e.leaves) {
      leaf.to_jamb = rotation * leaf.to_jamb;
      leaf.opens_to = rotation * leaf.opens_to;
    }
  }
  for (auto& o : out.openings) move(o.body);
  for (auto& s : out.spaces) move(s.body);
  return out;
}

PlanIr Shuffled(const PlanIr& plan, uint64_t seed) {
  std::mt19937_64 random(seed);
  PlanIr out = plan;
  const std::vector<uint32_t> element = Permute(out.elements, random);
  Permute(out.openings, random);
  Permute(out.spaces, random);
  for (auto& o : out.openings) {
    if (o.wall != kNoIndex) o.wall = element[o.wall];
    if (o.filling != kNoIndex) o.filling = element[o.filling];
  }
  return out;
}

}  // namespace plumb::test
